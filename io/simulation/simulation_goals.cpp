// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/simulation_goals.hpp"

#include <algorithm>

#include "softgauss/io/names.hpp"
#include "softgauss/io/simulation/simulation_parts.hpp"

namespace softgauss {

void SimulationGoals::expectLink(const std::string& goal, const std::string& link) const {
  if (const std::string problem = io::linkProblem(parts_->scene->model, link); !problem.empty())
    throw NameError(goal + ": " + problem);
}

gdd::Goal& SimulationGoals::add(std::unique_ptr<gdd::Goal> goal) {
  auto& goals = parts_->controller->goals;
  const std::size_t place = goals.size() - parts_->regularisers;
  gdd::Goal& added =
      **goals.insert(goals.begin() + static_cast<std::ptrdiff_t>(place), std::move(goal));
  weighDefaults();
  return added;
}

void SimulationGoals::weighDefaults() {
  gdd::weighDefaults(parts_->scene->model, parts_->controller->goals);
  wakeAll(parts_->state.sleep);
}

gdd::Goal& SimulationGoals::addOwn(std::unique_ptr<gdd::Goal> goal) {
  gdd::Goal& added = add(std::move(goal));
  addRegularisers(std::nullopt);
  weighDefaults();
  return added;
}

void SimulationGoals::addRegularisers(std::optional<double> postureWeight) {
  if (parts_->hasRegularisers) return;
  parts_->hasRegularisers = true;
  for (auto& goal : regularisers(parts_->scene->initial.q, postureWeight)) {
    parts_->controller->goals.push_back(std::move(goal));
    ++parts_->regularisers;
  }
}

/// Between the goals that were asked for and the posture.
void SimulationGoals::addBalance() {
  if (parts_->hasBalance) return;
  parts_->hasBalance = true;
  auto& goals = parts_->controller->goals;
  for (auto& goal : balanceOf(*parts_->scene, parts_->options)) {
    goals.insert(goals.end() - static_cast<std::ptrdiff_t>(parts_->regularisers), std::move(goal));
    ++parts_->regularisers;
  }
}

gdd::Reach& SimulationGoals::reach(const std::string& link, const Vector3& p_WTarget,
                                   const Vector3& p_LP, std::optional<double> weight) {
  expectLink("reach", link);
  for (const auto& goal : parts_->controller->goals)
    if (auto* same = dynamic_cast<gdd::Reach*>(goal.get());
        same && same->link == link && same->p_FP == p_LP) {
      same->restAt(p_WTarget);
      if (weight) same->weight = *weight, same->defaultWeight.giveUp();
      weighDefaults();
      return *same;
    }
  auto goal = std::make_unique<gdd::Reach>(parts_->scene->model, link, p_WTarget, p_LP);
  if (weight) goal->weight = *weight, goal->defaultWeight.giveUp();
  gdd::Goal& added = addOwn(std::move(goal));
  addBalance();
  weighDefaults();
  return static_cast<gdd::Reach&>(added);
}

gdd::Hold& SimulationGoals::hold(const std::string& link) {
  expectLink("hold", link);
  return static_cast<gdd::Hold&>(addOwn(std::make_unique<gdd::Hold>(parts_->scene->model, link)));
}

/// The posture among the regularisers, anew where it was removed.
gdd::Posture& SimulationGoals::ownPosture(double weight) {
  auto& goals = parts_->controller->goals;
  for (std::size_t i = goals.size() - parts_->regularisers; i < goals.size(); ++i)
    if (auto* posture = dynamic_cast<gdd::Posture*>(goals[i].get())) return *posture;
  for (auto& goal : regularisers(parts_->scene->initial.q, weight))
    if (dynamic_cast<gdd::Posture*>(goal.get())) goals.push_back(std::move(goal));
  ++parts_->regularisers;
  return static_cast<gdd::Posture&>(*goals.back());
}

gdd::Posture& SimulationGoals::posture(double weight) {
  addRegularisers(weight);
  gdd::Posture& posture = ownPosture(weight);
  posture.weight = weight;
  posture.isRegulariser = false;
  weighDefaults();
  return posture;
}

std::vector<gdd::Goal*> SimulationGoals::read(const std::filesystem::path& file) {
  return addAll(readGoalFile(file, *parts_->scene));
}

std::vector<gdd::Goal*> SimulationGoals::readText(const std::string& text,
                                                  const std::string& name) {
  return addAll(parseGoals(text, name, *parts_->scene));
}

std::vector<gdd::Goal*> SimulationGoals::addAll(io::GoalFile asked) {
  if (asked.controlCost && !parts_->options.controlCost)
    parts_->controller->controlCost = *asked.controlCost;
  std::vector<gdd::Goal*> added;
  for (auto& goal : asked.goals) added.push_back(&add(std::move(goal)));
  return added;
}

void SimulationGoals::remove(const gdd::Goal& goal) {
  auto& goals = parts_->controller->goals;
  const auto place = std::find_if(goals.begin(), goals.end(),
                                  [&](const auto& mine) { return mine.get() == &goal; });
  if (place == goals.end())
    throw std::invalid_argument("remove: found a goal that this simulation does not have");
  if (goals.end() - place <= static_cast<std::ptrdiff_t>(parts_->regularisers))
    --parts_->regularisers;
  if (parts_->recording) parts_->recording->forgetGoal(goal);
  goals.erase(place);
  weighDefaults();
}

void SimulationGoals::clear() {
  if (parts_->recording) parts_->recording->forgetGoals();
  wakeAll(parts_->state.sleep);
  parts_->controller->goals.clear();
  parts_->hasRegularisers = parts_->hasBalance = false;
  parts_->regularisers = 0;
}

std::size_t SimulationGoals::size() const { return parts_->controller->goals.size(); }

gdd::Goal& SimulationGoals::operator[](std::size_t i) { return *parts_->controller->goals.at(i); }

}  // namespace softgauss
