// SPDX-License-Identifier: Apache-2.0
/// Simulation: loading, stepping, state.

#include "softgauss/io/simulation/simulation.hpp"

#include "apps/python/at_state.hpp"
#include "apps/python/goals.hpp"
#include "apps/python/held.hpp"
#include "apps/python/options.hpp"

namespace softgauss::python {
namespace {

/// A 4 × 4 matrix: rotation, then position.
RowMajorMatrixX poseOf(Held& held, const std::string& link) {
  Simulation& sim = held.sim();
  expectConfiguration(sim.model(), sim.state().q);
  const Transform X = sim.pose(link);
  RowMajorMatrixX pose = RowMajorMatrixX::Identity(4, 4);
  pose.topLeftCorner<3, 3>() = X.R;
  pose.topRightCorner<3, 1>() = X.p;
  return pose;
}

void push(Held& held, const std::string& link, const py::object& force, const py::object& moment,
          const py::object& point) {
  Simulation& sim = held.sim();
  held.pushes().set(sim, link, vector3Of(force, "force"), vector3Of(moment, "moment"),
                    vector3Of(point, "point"));
  if (held.pushes().empty()) sim.input().wrenches.clear();
}

VectorX& appliedForce(Simulation& sim) {
  VectorX& tau = sim.input().tau;
  if (tau.size() == 0) tau = VectorX::Zero(sim.model().nv);
  return tau;
}

void bindStepping(HeldClass& sim) {
  sim.def("step", &Held::step, py::arg("n") = 1,
          "n steps of `timestep`. Raises StepError where one is refused; the state is then as it\n"
          "was before that step. Other threads run meanwhile.");
  sim.def("run", &Held::run, py::arg("seconds"),
          "Steps until `seconds` [s] later. Raises StepError.");
  sim.def(
      "reset", [](Held& h) { h.sim().reset(); }, "Back to the start; goals stay.");
  sim.def(
      "save", [](Held& h) { return py::bytes(h.sim().save()); },
      "State and time as bytes: restore() goes on from them to the same bits, in another\n"
      "process too, with the same file, options, goals and forces from outside.");
  sim.def(
      "restore", [](Held& h, const py::bytes& saved) { h.sim().restore(std::string_view(saved)); },
      py::arg("saved"),
      "Back to where save() was called. Raises ModelError where the bytes are of another scene\n"
      "or were changed; the state is then as it was.");
  sim.def(
      "record", [](Held& h) { h.sim().record(); },
      "From here on the run is recorded, for save_replay(); again: anew. Goals that are set later\n"
      "are not shown.");
  sim.def(
      "save_replay", [](Held& h, const std::filesystem::path& file) { h.sim().saveReplay(file); },
      py::arg("file"),
      "Writes what was recorded until now as a page that any browser shows. RuntimeError where\n"
      "nothing is recorded, ModelError where the file cannot be made.");
  sim.def(
      "stand_on_ground", [](Held& h) { h.sim().standOnGround(); },
      "Every floating base is moved up or down until its lowest point touches the ground.");
}

void bindState(HeldClass& sim) {
  sim.def_property(
      "q", [](const py::object& self) { return viewOf(self.cast<Held&>().sim().state().q, self); },
      [](Held& h, const py::object& q) { readInto(h.sim().state().q, q, "q", "nq"); },
      "(nq,) configuration [rad or m; a base: x y z qw qx qy qz], a view: what is written there\n"
      "is where the next step starts.");
  sim.def_property(
      "v", [](const py::object& self) { return viewOf(self.cast<Held&>().sim().state().v, self); },
      [](Held& h, const py::object& v) { readInto(h.sim().state().v, v, "v", "nv"); },
      "(nv,) velocity [rad/s or m/s], a view.");
  sim.def_property(
      "tau",
      [](const py::object& self) { return viewOf(appliedForce(self.cast<Held&>().sim()), self); },
      [](Held& h, const py::object& tau) { readInto(appliedForce(h.sim()), tau, "tau", "nv"); },
      "(nv,) generalised force [N m or N] that acts in every step besides the controller, a view.");
  sim.def_property_readonly(
      "time", [](Held& h) { return h.sim().time(); }, "[s]");
  sim.def_property_readonly(
      "a",
      [](Held& h) -> VectorX {
        const Data& data = h.sim().data();
        return data.plan.drifts ? data.acceleration : data.forward.a;
      },
      "(nv,) acceleration of the last step [rad/s² or m/s²].");
}

void bindByName(HeldClass& sim) {
  sim.def(
      "position", [](Held& h, const std::string& j) { return h.sim().position(j); },
      py::arg("joint"), "Of a joint of one degree of freedom [rad or m].");
  sim.def(
      "velocity", [](Held& h, const std::string& j) { return h.sim().velocity(j); },
      py::arg("joint"), "[rad/s or m/s]");
  sim.def(
      "set_position", [](Held& h, const std::string& j, double q) { h.sim().setPosition(j, q); },
      py::arg("joint"), py::arg("q"), "Joints that follow it go with it [rad or m].");
  sim.def(
      "set_velocity", [](Held& h, const std::string& j, double v) { h.sim().setVelocity(j, v); },
      py::arg("joint"), py::arg("v"), "[rad/s or m/s]");
  sim.def(
      "set_set_point",
      [](Held& h, const std::string& j, double q, double v) { h.sim().setSetPoint(j, q, v); },
      py::arg("joint"), py::arg("set_point"), py::arg("rate") = 0.0,
      "Tells the servo of a joint where to go [rad or m] and how fast that moves [rad/s or m/s], "
      "in\nevery step from now on. Without goals; they choose forces themselves.");
  sim.def(
      "set_point", [](Held& h, const std::string& j) { return h.sim().setPoint(j); },
      py::arg("joint"),
      "What the servo of a joint is to be told to make the force of the last step [rad or m]: of "
      "a\n"
      "robot under goals, what its drive would be sent.");
  sim.def(
      "asleep", [](Held& h, const std::string& link) { return h.sim().asleep(link); },
      py::arg("link"), "Whether a link sleeps, with the option sleep.");
  sim.def(
      "wake", [](Held& h, const std::string& link) { h.sim().wake(link); }, py::arg("link"),
      "Wakes a link and all that sleeps with it: after its place in q was changed.");
  sim.def(
      "pose", poseOf, py::arg("link"),
      "(4, 4) pose of the link's frame in the world, now: rotation and position [m]. StepError\n"
      "where q is no configuration.");
  sim.def(
      "torque", [](Held& h, const std::string& j) { return h.sim().torque(j); }, py::arg("joint"),
      "What acted on the joint in the last step from its actuator and from `tau` [N m or N].");
  sim.def(
      "contact_force",
      [](Held& h, const std::string& link) { return h.sim().contactForceOn(link); },
      py::arg("link"), "(3,) sum of the contact forces on a link in the last step, world [N].");
  const py::tuple zero = py::make_tuple(0.0, 0.0, 0.0);
  sim.def(
      "push", push, py::arg("link"), py::arg("force"), py::arg("moment") = zero,
      py::arg("point") = zero,
      "A force (3,) [N] and a moment (3,) [N m], world axes, act in every step from now on at a\n"
      "point (3,) of the link [m], in place of what pushed that link before; zero: nothing.");
}

}  // namespace

void bindSimulation(py::module_&, HeldClass& sim) {
  sim.def(py::init([](const std::filesystem::path& file, const py::kwargs& options) {
            return std::make_unique<Held>(Simulation::load(file, optionsFrom(options)));
          }),
          py::arg("file"),
          "A .urdf file, or a .yaml scene with its own goals. Options are those of simulate_gdd:\n"
          "base, base_height, ground, q0, srdf, state, timestep, integrator,\n"
          "integration_tolerance, step_doubling, cone, sleep, exact_diagonal, effects, without, "
          "zero_effort,\n"
          "infer_inertia, ignore_velocity_limits, no_balance, gdd_solver, control_cost, "
          "budget, meshes, collision,\n"
          "compatibility, package_paths, most_dofs; and without_goals, without_servos, "
          "visual_meshes. Raises "
          "ModelError and "
          "OptionError.");
  sim.def_property_readonly(
      "goals", py::cpp_function([](Held& h) { return GoalList{h}; }, py::keep_alive<0, 1>()),
      "What the controller seeks; without goals robots are passive.");
  bindStepping(sim);
  bindState(sim);
  bindByName(sim);
}

}  // namespace softgauss::python
