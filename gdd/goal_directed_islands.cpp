// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goal_directed_islands.hpp"

#include <algorithm>
#include <utility>

namespace softgauss::gdd {
namespace {

[[noreturn]] void failTied(const std::string& element, const std::string& what) {
  throw ModelError({}, element,
                   what +
                       " robots that may be in different islands, expected none where islands are "
                       "solved separately");
}

/// The whole's actuators that pull dofs of the island, in its dofs; `taken`: which they are.
std::vector<Actuator> actuatorsWithin(const Transmission& transmission, const Model& whole,
                                      const SubModel& island, std::vector<int>& taken) {
  std::vector<Actuator> actuators;
  for (std::size_t k = 0; k < transmission.actuators().size(); ++k) {
    Actuator actuator = transmission.actuators()[k];
    for (Actuator::Pull& pull : actuator.pulls) pull.dof = island.dofOf(whole, pull.dof);
    const auto away = std::count_if(actuator.pulls.begin(), actuator.pulls.end(),
                                    [](const Actuator::Pull& pull) { return pull.dof < 0; });
    if (away == static_cast<long>(actuator.pulls.size())) continue;
    if (away > 0) failTied("actuator '" + actuator.name + "'", "pulls joints of");
    actuators.push_back(std::move(actuator));
    taken.push_back(static_cast<int>(k));
  }
  return actuators;
}

/// R of the island's dofs. A dense R must not tie them to others.
ForceMetric metricWithin(const ForceMetric& metric, const Model& whole, const SubModel& island) {
  if (metric.isInverseMass()) return {};
  VectorX part(island.model.nv);
  if (metric.entries().size() > 0) {
    island.gather(whole, metric.entries(), part);
    return ForceMetric::diagonal(part);
  }
  const MatrixX R = metric.root() * metric.root().transpose();
  MatrixX ofPart(island.model.nv, island.model.nv);
  for (int i = 0; i < whole.nv; ++i) {
    const int here = island.dofOf(whole, i);
    if (here < 0) continue;
    const VectorX column = R.col(i);
    island.gather(whole, column, part);
    if (part.squaredNorm() != column.squaredNorm()) failTied("control cost", "ties");
    ofPart.col(here) = part;
  }
  return ForceMetric::dense(ofPart);
}

}  // namespace

/// Control of one island: where it has actuators, the controller of its own model.
class GoalDirectedIslands::Control final : public IslandControl {
 public:
  Control(GoalDirectedIslands& owner, const SubModel& island) : owner_(owner), island_(island) {
    const int unit = owner.units_.ofTree[static_cast<std::size_t>(island.trees.front())];
    alone_ = owner.units_.trees[static_cast<std::size_t>(unit)] == island.trees;
    read();
    owner_.controls_.push_back(this);
  }
  ~Control() override { std::erase(owner_.controls_, this); }

  /// Goals, box and options, from the controller of the whole.
  void read() {
    const Model& whole = owner_.model_;
    const GoalDirectedController& from = owner_.controller_;
    std::vector<std::unique_ptr<Goal>> goals;
    concerned_.clear();
    for (const std::unique_ptr<Goal>& goal : from.goals) {
      std::unique_ptr<Goal> here = goal->within(whole, island_);
      concerned_.push_back(here != nullptr);
      if (here) goals.push_back(std::move(here));
    }
    ControlLimits limits(island_.model);
    actuators_.clear();
    if (from.limits.transmission)
      limits.transmission = std::make_shared<const Transmission>(
          island_.model.nv, actuatorsWithin(*from.limits.transmission, whole, island_, actuators_));
    island_.gather(whole, from.limits.lower, limits.lower);
    island_.gather(whole, from.limits.upper, limits.upper);
    mayChoose_ = (limits.lower.array() < limits.upper.array()).any();
    mustPull_ = !((limits.lower.array() <= 0.0) && (limits.upper.array() >= 0.0)).all();
    if (!hasActuators()) return part_.reset();

    if (!part_) part_ = std::make_unique<GoalDirectedController>(island_.model);
    part_->goals = std::move(goals);
    part_->limits = std::move(limits);
    part_->forceMetric = metricWithin(from.forceMetric, whole, island_);
    part_->takeSettings(from);
  }

  const std::vector<int>& trees() const { return island_.trees; }
  /// Whether the island is a single unit.
  bool alone() const { return alone_; }
  /// Whether goal k of the whole is about something here.
  bool has(std::size_t goal) const { return concerned_[goal] != 0; }
  bool hasActuators() const { return mayChoose_ || mustPull_; }

  bool acts(double time) const noexcept override {
    if (!part_) return false;
    return mustPull_ || std::any_of(part_->goals.begin(), part_->goals.end(),
                                    [&](const auto& goal) { return goal->actsAt(time); });
  }

  bool steady(double time) const noexcept override {
    return std::all_of(part_->goals.begin(), part_->goals.end(), [&](const auto& goal) {
      return !goal->actsAt(time) || goal->steadyAt(time);
    });
  }

  SolveStatus step(const Input& input, State& state, Data& data,
                   ContactSource* contacts) noexcept override {
    const SolveStatus status = part_->step(island_.model, input, state, data, contacts, true);
    GoalDirectedController& all = owner_.controller_;
    all.report.add(part_->report);
    all.solveTime += part_->solveTime;
    if (isRefused(status)) return status;
    island_.scatter(owner_.model_, part_->control, all.control);
    for (std::size_t k = 0; k < actuators_.size(); ++k)
      all.commands[actuators_[k]] = part_->commands[static_cast<Eigen::Index>(k)];
    return status;
  }

  void release() noexcept override {
    GoalDirectedController& all = owner_.controller_;
    for (const int tree : island_.trees) {
      const Tree& t = owner_.model_.trees[static_cast<std::size_t>(tree)];
      all.control.segment(t.firstDof, t.dofEnd - t.firstDof).setZero();
    }
    for (const int k : actuators_) all.commands[k] = 0.0;
  }

 private:
  GoalDirectedIslands& owner_;
  const SubModel& island_;
  bool alone_;
  std::unique_ptr<GoalDirectedController> part_;  ///< null: nothing to control with
  std::vector<char> concerned_;                   ///< (goals of the whole) is about something here
  std::vector<int> actuators_;                    ///< those of the transmission that are here
  bool mayChoose_ = false;                        ///< the box leaves a choice
  bool mustPull_ = false;                         ///< the box is without zero
};

GoalDirectedIslands::GoalDirectedIslands(const Model& model, GoalDirectedController& controller)
    : model_(model), units_(model), controller_(controller) {
  changed();
}

GoalDirectedIslands::~GoalDirectedIslands() = default;

void GoalDirectedIslands::changed() {
  if (const int i = controller_.limits.firstBad(model_.nv); i >= 0)
    throw ModelError({}, "control box",
                     "has bounds that cross or are not numbers at coordinate " + std::to_string(i));
  for (Control* control : controls_) control->read();
  controller_.control.setZero(model_.nv);
  const auto& transmission = controller_.limits.transmission;
  controller_.commands.setZero(
      transmission ? static_cast<Eigen::Index>(transmission->actuators().size()) : 0);
  acting_.assign(controller_.goals.size(), 0);
  changed_ = true;
}

void GoalDirectedIslands::changed(std::size_t goal) {
  for (Control* control : controls_)
    if (control->has(goal)) control->read();
  acting_[goal] = -1;
}

std::unique_ptr<IslandControl> GoalDirectedIslands::within(const SubModel& island) {
  return std::make_unique<Control>(*this, island);
}

void GoalDirectedIslands::begin(double time, std::vector<int>& trees) noexcept {
  controller_.report = {};
  controller_.solveTime = 0.0;
  const auto wake = [&](const auto& concerned) {
    for (const Control* control : controls_)
      if (control->alone() && concerned(*control))
        trees.insert(trees.end(), control->trees().begin(), control->trees().end());
  };
  if (changed_) wake([](const Control& control) { return control.hasActuators(); });
  changed_ = false;
  for (std::size_t k = 0; k < std::min(acting_.size(), controller_.goals.size()); ++k) {
    const Goal& goal = *controller_.goals[k];
    const int acts = !goal.actsAt(time) ? 0 : goal.steadyAt(time) ? 1 : 2;
    if (acts != acting_[k]) wake([&](const Control& control) { return control.has(k); });
    acting_[k] = acts;
  }
}

}  // namespace softgauss::gdd
