// SPDX-License-Identifier: Apache-2.0
#include "apps/python/goals.hpp"

#include <algorithm>
#include <cmath>

#include "apps/live/goal_settings.hpp"
#include "apps/python/arrays.hpp"

namespace softgauss::python {
namespace {

using Targets = std::vector<double*>;

template <class Vector>
Targets entriesOf(Vector& x) {
  Targets out;
  for (Eigen::Index i = 0; i < x.size(); ++i) out.push_back(&x[i]);
  return out;
}

Targets valuesOf(std::vector<gdd::JointTarget>& joints) {
  Targets out;
  for (gdd::JointTarget& joint : joints) out.push_back(&joint.value);
  return out;
}

Targets both(Vector3& first, Vector3& second) {
  Targets out = entriesOf(first);
  for (double* x : entriesOf(second)) out.push_back(x);
  return out;
}

// ---- What each kind seeks, and how much it weighs

/// None where a trajectory says what it is.
Targets placeOf(gdd::PlaceTarget& g) { return g.trajectory ? Targets{} : entriesOf(g.p_WTarget); }

Targets targetOfKind(gdd::Reach& g) { return placeOf(g); }
Targets targetOfKind(gdd::LookAt& g) { return placeOf(g); }
Targets targetOfKind(gdd::CenterOfMass& g) { return placeOf(g); }
Targets targetOfKind(gdd::CapturePoint& g) { return placeOf(g); }
Targets targetOfKind(gdd::CenterOfPressure& g) { return entriesOf(g.p_WTarget); }
Targets targetOfKind(gdd::ContactForce& g) { return entriesOf(g.force); }
Targets targetOfKind(gdd::MomentumGoal& g) { return both(g.linear, g.angular); }
Targets targetOfKind(gdd::LinkAcceleration& g) {
  return g.angular ? both(g.linear, *g.angular) : entriesOf(g.linear);
}
Targets targetOfKind(gdd::JointAcceleration& g) { return valuesOf(g.targets); }
Targets targetOfKind(gdd::JointPosture& g) {
  const bool follows = std::any_of(g.targets.begin(), g.targets.end(),
                                   [](const gdd::JointTarget& joint) { return joint.trajectory; });
  return follows ? Targets{} : valuesOf(g.targets);
}
Targets targetOfKind(gdd::JointVelocity& g) { return valuesOf(g.targets); }
Targets targetOfKind(gdd::Posture& g) { return entriesOf(g.q); }
Targets targetOfKind(gdd::KeepClear& g) { return {&g.distance}; }
Targets targetOfKind(gdd::Hold&) { return {}; }
Targets targetOfKind(gdd::VirtualDamping&) { return {}; }
Targets targetOfKind(gdd::Effort&) { return {}; }

/// How fast its target moves, and how that changes, where a target may move.
Targets rateOf(gdd::Goal& goal, Vector3 gdd::PlaceTarget::*ofPlace,
               double gdd::JointTarget::*ofJoint) {
  Targets out;
  if (auto* place = dynamic_cast<gdd::PlaceTarget*>(&goal)) {
    if (!place->trajectory) out = entriesOf(place->*ofPlace);
  } else if (auto* posture = dynamic_cast<gdd::JointPosture*>(&goal)) {
    if (!targetOfKind(*posture).empty())
      for (gdd::JointTarget& joint : posture->targets) out.push_back(&(joint.*ofJoint));
  }
  return out;
}

template <class Kind>
double* weightOfKind(Kind& g) {
  return &g.weight;
}
double* weightOfKind(gdd::MomentumGoal& g) { return &g.linearWeight; }

template <class Kind, class F>
bool callAs(gdd::Goal& goal, F&& f) {
  auto* kind = dynamic_cast<Kind*>(&goal);
  if (kind) f(*kind);
  return kind != nullptr;
}

template <class... Kinds, class F>
void callAsAny(gdd::Goal& goal, F&& f) {
  static_cast<void>((callAs<Kinds>(goal, f) || ...));
}

template <class F>
void visitKind(gdd::Goal& goal, F&& f) {
  using namespace gdd;
  callAsAny<Reach, JointAcceleration, JointPosture, JointVelocity, Posture, LinkAcceleration,
            LookAt, Hold, VirtualDamping, CenterOfMass, CapturePoint, CenterOfPressure,
            ContactForce, MomentumGoal, KeepClear, Effort>(goal, f);
}

// ---- Numbers that a goal of a file may have too, and no others

std::string numberText(double x) { return py::repr(py::float_(x)).cast<std::string>(); }

double checkedWeight(double weight) {
  if (!(weight >= 0.0 && weight < kInfinity))
    throw py::value_error("weight: found " + numberText(weight) +
                          ", expected a finite number >= 0");
  return weight;
}

/// ±∞: always.
double checkedTime(double time, const char* name) {
  if (std::isnan(time))
    throw py::value_error(std::string(name) + ": found " + numberText(time) +
                          ", expected a time [s]");
  return time;
}

Vector3 finiteVector3Of(const py::object& given, const char* name) {
  const Vector3 x = vector3Of(given, name);
  if (!x.allFinite())
    throw py::value_error(std::string(name) + ": found NaN or ∞, expected finite numbers");
  return x;
}

/// A goal as Python holds it: it looks whether the goal is there still.
class Handle {
 public:
  Handle(Held& held, gdd::Goal& goal) : held_(held), goal_(&goal), since_(held.goalsLeft()) {}

  gdd::Goal& get() const {
    static_cast<void>(held_.sim());  // throws where another thread steps
    if (held_.hasLeft(goal_, since_))
      throw std::runtime_error("this goal is gone: it was removed from its simulation");
    return *goal_;
  }

  VectorX target() const { return valuesOf(targets()); }
  void setTarget(const py::object& given) const { set(targets(), given, "target"); }
  VectorX velocity() const { return valuesOf(velocities()); }
  void setVelocity(const py::object& given) const { set(velocities(), given, "velocity"); }
  VectorX acceleration() const { return valuesOf(accelerations()); }
  void setAcceleration(const py::object& given) const {
    set(accelerations(), given, "acceleration");
  }

  double& weight() const {
    double* weight = nullptr;
    visitKind(get(), [&](auto& kind) { weight = weightOfKind(kind); });
    if (!weight) throw py::type_error("goal '" + get().name() + "' has no weight");
    return *weight;
  }

  double& setting(double* live::GoalSettings::*place, const char* what) const {
    double* number = live::settingsOf(get()).*place;
    if (!number) throw py::type_error("goal '" + get().name() + "' has no " + what);
    return *number;
  }
  void setSetting(double* live::GoalSettings::*place, const char* what, double value) const {
    if (!(value >= 0.0 && value < kInfinity))
      throw py::value_error(std::string(what) + ": found " + numberText(value) +
                            ", expected a finite number >= 0");
    setting(place, what) = value;
    gdd::wake(held_.sim().model(), *goal_, held_.sim().state().sleep);
  }

  void setWeight(double weight) const {
    this->weight() = checkedWeight(weight);
    held_.sim().goals.weighDefaults();
  }
  void setStart(double time) const {
    get().startTime = checkedTime(time, "start");
    held_.sim().goals.weighDefaults();
  }
  void setEnd(double time) const {
    get().endTime = checkedTime(time, "end");
    held_.sim().goals.weighDefaults();
  }

  void remove() const { held_.removeGoal(get()); }

  std::vector<std::pair<std::string, double>> heldBack() const {
    const gdd::Goal& goal = get();
    std::vector<std::pair<std::string, double>> causes;
    for (const auto& [what, share] : held_.sim().heldBack(goal)) causes.emplace_back(what, share);
    return causes;
  }

 private:
  static VectorX valuesOf(const Targets& numbers) {
    VectorX x(static_cast<Eigen::Index>(numbers.size()));
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = *numbers[static_cast<std::size_t>(i)];
    return x;
  }

  void set(const Targets& numbers, const py::object& given, const char* what) const {
    const VectorX x = vectorOf(given, what, static_cast<Eigen::Index>(numbers.size()),
                               "numbers of goal '" + get().name() + "'");
    if (!x.allFinite())
      throw py::value_error(std::string(what) + ": found NaN or ∞, expected finite numbers");
    for (Eigen::Index i = 0; i < x.size(); ++i) *numbers[static_cast<std::size_t>(i)] = x[i];
    gdd::wake(held_.sim().model(), *goal_, held_.sim().state().sleep);
  }

  Targets some(Targets numbers, const char* what) const {
    if (numbers.empty())
      throw py::type_error("goal '" + get().name() + "' has no " + what +
                           " that could be set: it seeks none, or follows a trajectory");
    return numbers;
  }
  Targets targets() const { return some(targetOf(get()), "target"); }
  Targets velocities() const {
    return some(rateOf(get(), &gdd::PlaceTarget::v_WTarget, &gdd::JointTarget::velocity),
                "velocity of a target");
  }
  Targets accelerations() const {
    return some(rateOf(get(), &gdd::PlaceTarget::a_WTarget, &gdd::JointTarget::acceleration),
                "acceleration of a target");
  }

  Held& held_;
  gdd::Goal* goal_;  ///< dangles once it has left
  unsigned long since_;
};

}  // namespace
}  // namespace softgauss::python

SOFTGAUSS_MADE_ONLY(softgauss::python::Handle)

namespace softgauss::python {
namespace {

std::vector<Handle> handlesOf(GoalList& list, const std::vector<gdd::Goal*>& goals) {
  std::vector<Handle> handles;
  for (gdd::Goal* goal : goals) handles.emplace_back(list.held, *goal);
  return handles;
}

/// A list whose handles keep the simulation.
py::list kept(const py::object& self, const std::vector<gdd::Goal*>& goals) {
  py::list out;
  for (const Handle& handle : handlesOf(self.cast<GoalList&>(), goals)) {
    py::object object = py::cast(handle);
    py::detail::keep_alive_impl(object, self);
    out.append(object);
  }
  return out;
}

auto gainOf(double* live::GoalSettings::*place, const char* what) {
  return [=](Handle& h) { return h.setting(place, what); };
}
auto setGain(double* live::GoalSettings::*place, const char* what) {
  return [=](Handle& h, double value) { h.setSetting(place, what, value); };
}

void bindHandle(py::module_& m) {
  py::class_<Handle>(m, "Goal", "A goal of a simulation, until it is removed.")
      .def_property_readonly(
          "name", [](Handle& h) { return h.get().name(); },
          "As in the summary: 'reach right_hand'.")
      .def_property(
          "target", &Handle::target, &Handle::setTarget,
          "What it seeks: a place (3,) [m], a force (3,) [N], accelerations, velocities or\n"
          "positions of its joints in their order, a configuration (nq,). TypeError where it\n"
          "seeks none, or follows a trajectory.")
      .def_property(
          "velocity", &Handle::velocity, &Handle::setVelocity,
          "How fast the target moves, for who moves it step by step: (3,) [m/s] of a place,\n"
          "[rad/s or m/s] of each joint of a joint_posture. At first 0. TypeError as for target.")
      .def_property("acceleration", &Handle::acceleration, &Handle::setAcceleration,
                    "The rate of that velocity.")
      .def_property("stiffness", gainOf(&live::GoalSettings::stiffness, "stiffness"),
                    setGain(&live::GoalSettings::stiffness, "stiffness"),
                    "Of the spring by which it is sought [1/s²], ≥ 0. TypeError where it has none.")
      .def_property("damping", gainOf(&live::GoalSettings::damping, "damping"),
                    setGain(&live::GoalSettings::damping, "damping"), "Of that spring [1/s], ≥ 0.")
      .def_property("rate", gainOf(&live::GoalSettings::rate, "rate"),
                    setGain(&live::GoalSettings::rate, "rate"),
                    "At which a velocity is sought [1/s], ≥ 0.")
      .def_property("weight", &Handle::weight, &Handle::setWeight, "In the unit of its kind, ≥ 0.")
      .def_property(
          "start", [](Handle& h) { return h.get().startTime; }, &Handle::setStart,
          "It acts from here on [s].")
      .def_property(
          "end", [](Handle& h) { return h.get().endTime; }, &Handle::setEnd, "And before this [s].")
      .def("held_back", &Handle::heldBack,
           "What holds it back in the present state: [(what, share), ...], the largest share "
           "first;\n"
           "shares add up to 1. [('posture', 0.97), ('range of elbow', 0.03)] says that a larger\n"
           "weight helps. Empty where it does not act, or pulls no more.")
      .def("remove", &Handle::remove,
           "It acts no more, and is gone; damping, balance and a weak posture that came with it\n"
           "stay, until Goals.clear().")
      .def("__repr__", [](Handle& h) { return "<softgauss.Goal '" + h.get().name() + "'>"; });
}

gdd::Goal& goalAt(GoalList& list, long i) {
  SimulationGoals& goals = list.held.sim().goals;
  const auto size = static_cast<long>(goals.size());
  if (i < -size || i >= size)
    throw py::index_error("goals: found " + std::to_string(i) + ", there are " +
                          std::to_string(size));
  return goals[static_cast<std::size_t>(i < 0 ? i + size : i)];
}

Handle reach(GoalList& list, const std::string& link, const py::object& target,
             const py::object& point, std::optional<double> weight) {
  if (weight) checkedWeight(*weight);
  return {list.held, list.held.sim().goals.reach(link, finiteVector3Of(target, "target"),
                                                 finiteVector3Of(point, "point"), weight)};
}

}  // namespace

std::vector<double*> targetOf(gdd::Goal& goal) {
  Targets out;
  visitKind(goal, [&](auto& kind) { out = targetOfKind(kind); });
  return out;
}

std::string goalText(const py::object& goals) {
  if (py::isinstance<py::str>(goals)) return goals.cast<std::string>();
  py::object all = goals;
  if (!py::isinstance<py::dict>(goals) || !goals.contains("goals")) {
    py::dict whole;
    whole["goals"] = py::isinstance<py::dict>(goals) ? py::object(py::cast(std::vector{goals}))
                                                     : py::object(py::list(goals));
    all = whole;
  }
  const auto arrays = py::cpp_function([](const py::object& x) { return x.attr("tolist")(); });
  return py::module_::import("json")
      .attr("dumps")(all, py::arg("default") = arrays, py::arg("ensure_ascii") = false)
      .cast<std::string>();
}

void bindGoals(py::module_& m) {
  bindHandle(m);
  const py::tuple zero = py::make_tuple(0.0, 0.0, 0.0);
  py::class_<GoalList>(
      m, "Goals", "The goals of a simulation. Reach, hold and posture come with virtual damping.")
      .def(
          "reach", reach, py::arg("link"), py::arg("target"), py::arg("point") = zero,
          py::arg("weight") = py::none(), py::keep_alive<0, 1>(),
          "A point (3,) of the link [m] seeks a place (3,) in the world [m]. Called again for the\n"
          "same point it moves the place. weight [kg]: 2.5 times the robot's mass, times the "
          "weight\n"
          "of the strongest posture beside it where that is above 1. UnknownName.")
      .def(
          "hold",
          [](GoalList& g, const std::string& link) {
            return Handle(g.held, g.held.sim().goals.hold(link));
          },
          py::arg("link"), py::keep_alive<0, 1>(), "The link stays where and as it is.")
      .def(
          "posture",
          [](GoalList& g, double weight) {
            return Handle(g.held, g.held.sim().goals.posture(checkedWeight(weight)));
          },
          py::arg("weight") = gdd::Posture::kDefaultWeight, py::keep_alive<0, 1>(),
          "All joints and bases seek the configuration of the start.")
      .def(
          "add",
          [](const py::object& self, const py::object& goals) {
            return kept(self, self.cast<GoalList&>().held.sim().goals.readText(goalText(goals)));
          },
          py::arg("goals"),
          "Any goals of docs/reference/goals.md: the text of such a file, a dict {kind: {key: "
          "value}} or a\n"
          "list of them. Nothing comes with them. Returns a list of Goal. Raises ModelError.")
      .def(
          "read",
          [](const py::object& self, const std::filesystem::path& file) {
            return kept(self, self.cast<GoalList&>().held.sim().goals.read(file));
          },
          py::arg("file"), "The same from a YAML file.")
      .def(
          "clear", [](GoalList& g) { g.held.clearGoals(); }, "No goals: robots are passive.")
      .def(
          "__delitem__", [](GoalList& g, long i) { g.held.removeGoal(goalAt(g, i)); }, py::arg("i"),
          "Removes goal i, as Goal.remove().")
      .def("__len__", [](GoalList& g) { return g.held.sim().goals.size(); })
      .def(
          "__getitem__", [](GoalList& g, long i) { return Handle(g.held, goalAt(g, i)); },
          py::arg("i"), py::keep_alive<0, 1>());
}

}  // namespace softgauss::python
