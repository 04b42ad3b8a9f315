// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/plan_task.hpp"

#include <fmt/format.h>

#include <cmath>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/scene_parts.hpp"
#include "softgauss/io/detail/unit_mistakes.hpp"
#include "softgauss/io/detail/yaml.hpp"

namespace softgauss::io {
namespace {

using detail::Range;
using detail::YamlMap;
using detail::YamlValue;

/// What a weight may be of: joints of one degree of freedom, and what floats.
class Degrees {
 public:
  explicit Degrees(const Model& model) : model_(model) {
    for (std::size_t b = 1; b < model.bodies.size(); ++b) {
      const Body& body = model.bodies[b];
      if (body.joint == JointKind::floating)
        floating_.push_back(static_cast<int>(b));
      else if (body.dofs == 1)
        joints_.insert(model.jointNames[b]);
    }
  }
  /// The joint that the entry's key names.
  const Body& joint(const YamlMap& map, const YamlMap::Entry& entry) const {
    if (joints_.count(entry.key) == 0)
      map.fail(entry, "found no joint of one degree of freedom of that name" +
                          detail::offered(entry.key, {joints_.begin(), joints_.end()}));
    return model_.bodies[idx(model_.findJoint(entry.key))];
  }
  /// The one that floats.
  const Body& base(const YamlMap& map, const YamlMap::Entry& entry) const {
    if (floating_.size() != 1)
      map.fail(entry,
               fmt::format("is of the floating base, and the scene has {}", floating_.size()));
    return model_.bodies[idx(floating_[0])];
  }

  /// A number for all, or a map. What is not given stays.
  void readWeights(const YamlMap& map, const std::string& key, VectorX& weights) const {
    const YamlMap::Entry* entry = map.find(key);
    if (!entry) return;
    if (entry->value.kind != YamlValue::Kind::map) {
      weights.setConstant(map.number(*entry, Range::notNegative));
      return;
    }
    const YamlMap some = map.map(*entry);
    if (const auto* all = some.find("all"))
      weights.setConstant(some.number(*all, Range::notNegative));
    for (const YamlMap::Entry& one : some.entries()) {
      if (one.key == "all") continue;
      const double weight = some.number(one, Range::notNegative);
      if (one.key == "base_position" || one.key == "base_rotation") {
        if (floating_.empty()) some.fail(one, "is of what floats, and nothing does");
        for (const int b : floating_)
          weights.segment<3>(model_.bodies[idx(b)].v + (one.key == "base_rotation" ? 3 : 0))
              .setConstant(weight);
        continue;
      }
      weights[joint(some, one).v] = weight;
    }
  }

 private:
  const Model& model_;
  std::set<std::string> joints_;
  std::vector<int> floating_;
};

int readCount(const YamlMap& map, const std::string& key, int fewest, int otherwise) {
  constexpr int kMost = 100000;
  const YamlMap::Entry* entry = map.find(key);
  if (!entry) return otherwise;
  const double x = map.number(*entry);
  if (!(x >= fewest && x <= kMost && x == std::floor(x)))
    map.fail(*entry, fmt::format("found {}, expected a whole number from {} to {}",
                                 entry->value.described(), fewest, kMost));
  return static_cast<int>(x);
}

void readContacts(const YamlMap& map, PlanTask& task) {
  map.expectOnly({"margin", "width", "d_min", "d_max", "stages", "factor", "iterations", "end"});
  planning::Continuation& c = task.contacts.emplace();
  map.read("margin", c.contacts.margin, Range::notNegative);
  map.read("width", c.contacts.width, Range::positive);
  for (const auto& [key, value] :
       {std::pair("d_min", &c.contacts.dMin), std::pair("d_max", &c.contacts.dMax),
        std::pair("factor", &c.factor)}) {
    map.read(key, *value, Range::positive);
    if (!(*value < 1.0))
      map.fail(*map.find(key), fmt::format("found {}, expected less than 1", *value));
  }
  c.stages = readCount(map, "stages", 0, 0);
  c.infeasible = c.feasible = readCount(map, "iterations", 1, c.infeasible);
  if (const auto* end = map.find("end"))
    task.endsOnOwnContacts = map.choice(*end, {"own", "planning"}) == "own";
}

void readSteps(const YamlMap& map, const Model& model, PlanTask& task) {
  constexpr double kLongest = 1.0, kMostNumbers = 5e7;  // some gigabytes
  map.read("step", task.steps.step, Range::positive);
  if (task.steps.step > kLongest)
    map.fail(*map.find("step"),
             fmt::format("found {}, expected at most {} s", task.steps.step, kLongest));
  task.steps.knots = readCount(map, "knots", 1, task.steps.knots);
  const double square = static_cast<double>(model.nv) * model.nv;
  if (task.steps.knots * square > kMostNumbers)
    map.fail("knots", map.line(),
             fmt::format("found {}, expected at most {:.0f} of {} degrees of freedom, for memory",
                         task.steps.knots, kMostNumbers / square, model.nv));
}

/// From which it is planned anew while it is acted out.
void readReceding(const YamlMap& map, PlanTask& task) {
  map.expectOnly({"rate", "iterations", "contacts", "keep", "seconds"});
  if (const auto* entry = map.find("keep")) task.mpc.keepsEnd = map.boolean(*entry);
  if (const auto* entry = map.find("contacts"))
    task.recedesOnOwnContacts = map.choice(*entry, {"own", "planning"}) == "own";
  planning::HorizonOptions& mpc = task.mpc;
  double rate = 1.0 / mpc.period;
  if (const auto* entry = map.find("rate")) {
    rate = map.number(*entry, Range::positive);
    // Rounding of 1/h.
    if (rate * task.steps.step < 1.0 - 1e-9)
      map.fail(*entry,
               fmt::format("found {} a second, expected at least {:.6g}, once a step of the "
                           "plan",
                           rate, 1.0 / task.steps.step));
  }
  mpc.period = std::min(1.0 / rate, task.steps.step);
  mpc.iterations = readCount(map, "iterations", 0, mpc.iterations);
  map.read("seconds", mpc.seconds, Range::positive);
}

/// A joint's place, within its range.
double readPlace(const YamlMap& joints, const YamlMap::Entry& joint, const Model& model,
                 const Body& body) {
  const double place = joints.number(joint);
  for (const JointRange& range : model.ranges)
    if (&model.bodies[idx(range.body)] == &body && !(place >= range.lower && place <= range.upper))
      joints.fail(
          joint,
          fmt::format("found {}{}, expected within the joint's range {:.4g} .. {:.4g}", place,
                      detail::radiansMeant(model, range, place), range.lower, range.upper));
  return place;
}

void readTarget(const YamlMap& map, const Model& model, const Degrees& degrees, const State& start,
                PlanTask& task) {
  map.expectOnly({"joints", "position", "rpy", "move", "steady"});
  VectorX &q = task.q[0], &v = task.v[0];
  if (const auto* entry = map.find("joints")) {
    const YamlMap joints = map.map(*entry);
    for (const YamlMap::Entry& joint : joints.entries()) {
      const Body& body = degrees.joint(joints, joint);
      q[body.q] = readPlace(joints, joint, model, body);
    }
  }
  if (const auto* entry = map.find("position"))
    q.segment<3>(degrees.base(map, *entry).q) = map.vector3(*entry);
  if (const auto* entry = map.find("rpy")) {
    const Vector3 rpy = map.vector3(*entry);
    const Quaternion turned(rpyRotation(rpy));
    const int at = degrees.base(map, *entry).q;
    q.segment<4>(at + 3) << turned.w(), turned.x(), turned.y(), turned.z();
  }
  if (const auto* entry = map.find("move"))
    q.segment<3>(degrees.base(map, *entry).q) += map.vector3(*entry);
  const auto* steady = map.find("steady");
  if (!steady || !map.boolean(*steady)) return;
  const int knots = task.steps.knots;
  const VectorX moved = positionDifference(model, start.q, q);
  v = moved / (knots * task.steps.step);
  task.q.assign(idx(knots) + 1, start.q);
  task.v.assign(idx(knots) + 1, v);
  for (int t = 0; t <= knots; ++t)
    integratePosition(model, moved, static_cast<double>(t) / knots, task.q[idx(t)]);
  task.v.back().setZero();
}

/// f(map, link) of each link that the map under `key` names, of a target and a weight.
template <class F>
void forLinks(const YamlMap& terms, const std::string& key, const Model& model, const F& f) {
  const YamlMap::Entry* entry = terms.find(key);
  if (!entry) return;
  std::set<std::string> links;
  for (const Frame& frame : model.frames) links.insert(frame.name);
  const YamlMap some = terms.map(*entry);
  for (const YamlMap::Entry& link : some.entries()) {
    if (links.count(link.key) == 0)
      some.fail(link, "found no link of that name" +
                          detail::offered(link.key, {links.begin(), links.end()}));
    f(some.map(link), link.key);
  }
}

double readWeight(const YamlMap& map) {
  return map.number(map.required("weight", "a number > 0"), Range::positive);
}

void readTerms(const YamlMap& map, const Model& model, PlanTask::StateWeights& terms) {
  forLinks(map, "points", model, [&](const YamlMap& of, const std::string& link) {
    of.expectOnly({"target", "weight", "velocity", "point"});
    PlanTask::Point& point = terms.points.emplace_back();
    point.link = link;
    point.target = of.vector3(of.required("target", "a place in the world [m]"));
    point.weight = readWeight(of);
    of.read("velocity", point.velocity, Range::notNegative);
    of.read("point", point.p_LP);
  });
  forLinks(map, "orientations", model, [&](const YamlMap& of, const std::string& link) {
    of.expectOnly({"rpy", "weight"});
    const Vector3 rpy = of.vector3(of.required("rpy", "roll, pitch and yaw in the world [rad]"));
    terms.orientations.push_back({link, rpyRotation(rpy), readWeight(of)});
  });
  if (const auto* entry = map.find("center_of_mass")) {
    const YamlMap of = map.map(*entry);
    of.expectOnly({"target", "weight"});
    const Vector3 target = of.vector3(of.required("target", "a place in the world [m]"));
    terms.centerOfMass = {target, readWeight(of)};
  }
}

PlanTask readPlan(const YamlMap& map, const Model& model, const State& start) {
  map.expectOnly({"step", "knots", "contacts", "iterations", "running", "final", "effort",
                  "root_force", "target", "spread", "best", "search", "mpc"});
  PlanTask task;
  readSteps(map, model, task);
  map.read("spread", task.spread, Range::notNegative);
  map.read("best", task.best, Range::positive);
  if (const auto* entry = map.find("contacts")) readContacts(map.map(*entry), task);
  if (const auto* entry = map.find("iterations")) {
    const YamlMap iterations = map.map(*entry);
    iterations.expectOnly({"infeasible", "feasible", "rho"});
    iterations.read("rho", task.options.inPhaseI.rho, Range::notNegative);
    task.options.infeasible = readCount(iterations, "infeasible", 1, task.options.infeasible);
    task.options.feasible = readCount(iterations, "feasible", 0, task.options.feasible);
  }
  if (const auto* entry = map.find("search")) {
    const YamlMap search = map.map(*entry);
    search.expectOnly({"tries", "reach"});
    task.search.tries = readCount(search, "tries", 0, task.search.tries);
    search.read("reach", task.search.reach, Range::positive);
  }
  task.mpc.period = std::min(task.mpc.period, task.steps.step);
  if (const auto* entry = map.find("mpc")) readReceding(map.map(*entry), task);
  const Degrees degrees(model);
  const auto readState = [&](const char* key, PlanTask::StateWeights& weights) {
    weights.position = weights.velocity = VectorX::Zero(model.nv);
    const auto* entry = map.find(key);
    if (!entry) return;
    const YamlMap state = map.map(*entry);
    state.expectOnly({"position", "velocity", "points", "orientations", "center_of_mass"});
    degrees.readWeights(state, "position", weights.position);
    degrees.readWeights(state, "velocity", weights.velocity);
    readTerms(state, model, weights);
  };
  readState("running", task.running);
  readState("final", task.final);
  task.effort = VectorX::Constant(model.nv, 0.01);
  degrees.readWeights(map, "effort", task.effort);
  task.rootForce = 100.0 * task.effort;
  degrees.readWeights(map, "root_force", task.rootForce);
  for (const bool pulls : {true, false}) {
    VectorX &weights = pulls ? task.effort : task.rootForce,
            &none = pulls ? task.rootForce : task.effort;
    for (int i = 0; i < model.nv; ++i) {
      if (model.dofs[idx(i)].actuated != pulls) continue;
      none[i] = 0.0;
      if (!(weights[i] > 0.0))
        map.fail(pulls ? "effort" : "root_force", map.line(),
                 "found 0 for a degree of freedom, expected a weight > 0");
    }
  }
  task.q.push_back(start.q);
  task.v.push_back(VectorX::Zero(model.nv));
  if (const auto* entry = map.find("target"))
    readTarget(map.map(*entry), model, degrees, start, task);
  return task;
}

void addTerms(const Model& model, const PlanTask::StateWeights& terms,
              std::vector<std::unique_ptr<planning::CostTerm>>& cost) {
  for (const PlanTask::Point& p : terms.points)
    cost.push_back(std::make_unique<planning::PointCost>(model, p.link, p.p_LP, p.target, p.weight,
                                                         p.velocity));
  for (const PlanTask::Orientation& o : terms.orientations)
    cost.push_back(std::make_unique<planning::OrientationCost>(model, o.link, o.target, o.weight));
  if (!terms.centerOfMass) return;
  auto centre = std::make_unique<planning::CentroidalCost>(model);
  centre->centre(terms.centerOfMass->first, terms.centerOfMass->second);
  cost.push_back(std::move(centre));
}

}  // namespace

void PlanTask::setCosts(planning::Planner& planner) const {
  const auto term = [&](const StateWeights& weights, bool last) {
    auto state = std::make_unique<planning::StateCost>(planner.model(), q[0]);
    state->positionWeight = weights.position, state->velocityWeight = weights.velocity;
    if (last)
      state->q = {q.back()}, state->v = {v.back()};
    else
      state->q = q, state->v = v;
    return state;
  };
  planner.cost.running.push_back(term(running, false));
  planner.cost.final.push_back(term(final, true));
  addTerms(planner.model(), running, planner.cost.running);
  addTerms(planner.model(), final, planner.cost.final);
  planner.cost.effort = effort;
  planner.rootCost = rootForce;
}

const planning::MotionPlan& PlanTask::solve(planning::Planner& planner, const State& start,
                                            const std::vector<VectorX>& accelerations) const {
  if (contacts && endsOnOwnContacts) {
    planner.solve(start, *contacts, options, accelerations);
  } else {
    if (contacts)
      planner.setContacts(contacts->contacts);
    else
      planner.setOwnContacts();
    planner.solve(start, options, accelerations);
  }
  return search.tries > 0 ? planner.search(start, search, options) : planner.plan();
}

const planning::MotionPlan& PlanTask::solveFeasible(
    planning::Planner& planner, const State& start, const planning::PlanOptions& feasible,
    const std::vector<VectorX>& accelerations) const {
  if (contacts) {
    planner.setContacts(contacts->contacts);
    const planning::MotionPlan& plan = planner.solveFeasible(start, feasible, accelerations);
    if (!endsOnOwnContacts || plan.status == planning::PlanStatus::refused) return plan;
  }
  const std::vector<VectorX> before = contacts ? planner.plan().a : accelerations;
  planner.setOwnContacts();
  return planner.solveFeasible(start, feasible, before);
}

PlanTask readPlanTask(const std::filesystem::path& file, const Model& model, const State& start) {
  return parsePlanTask(detail::readInput(file.string(), "a scene"),
                       detail::inputName(file.string()), model, start);
}

PlanTask parsePlanTask(const std::string& text, const std::string& path, const Model& model,
                       const State& start) {
  const YamlValue root = detail::parseYaml(path, text, "robots: [...] and plan: {…}");
  if (root.kind != YamlValue::Kind::map)
    throw ModelError({path, root.line}, "file",
                     fmt::format("found {}, expected keys such as robots: [...] and plan: {{…}}",
                                 root.described()));
  const YamlMap top(path, "", "", root);
  top.expectOnly(detail::kSceneKeys);
  const YamlMap plan =
      top.map(top.required("plan", "a map of what is planned, as in data/plans/acrobot.yaml"));
  return readPlan(plan, model, start);
}

}  // namespace softgauss::io
