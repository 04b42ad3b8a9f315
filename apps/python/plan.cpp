// SPDX-License-Identifier: Apache-2.0
/// Plans over time, and control that is planned anew.

#include <cmath>

#include "apps/python/at_state.hpp"
#include "apps/python/held.hpp"
#include "apps/python/options.hpp"
#include "softgauss/io/simulation/plan_control.hpp"

namespace softgauss::python {
namespace {

/// What was planned, its knots in rows.
struct Plan {
  Plan(const planning::MotionPlan& plan, double h)
      : q(rowsOf(plan.q)),
        v(rowsOf(plan.v)),
        a(rowsOf(plan.a)),
        u(rowsOf(plan.tau)),
        step(h),
        figures(plan) {
    for (auto* rows : {&figures.q, &figures.v, &figures.a, &figures.tau}) rows->clear();
  }
  static RowMajorMatrixX rowsOf(const std::vector<VectorX>& knots) {
    RowMajorMatrixX rows(knots.size(), knots.empty() ? 0 : knots[0].size());
    for (Eigen::Index t = 0; t < rows.rows(); ++t) rows.row(t) = knots[std::size_t(t)];
    return rows;
  }
  VectorX time() const {
    return VectorX::LinSpaced(q.rows(), 0.0, step * static_cast<double>(q.rows() - 1));
  }

  RowMajorMatrixX q, v, a, u;
  double step;
  planning::MotionPlan figures;  ///< without the knots
};

/// The simulation of a task, by whose controller its plan is acted out.
class Mpc {
 public:
  Mpc(const std::filesystem::path& file, const std::optional<py::dict>& task, int threads,
      SimulationOptions options, bool receding = true)
      : sim_(Simulation::load(file, withoutGoals(std::move(options)))),
        control_(sim_.scene(), read(file, task, threads), receding) {
    const py::gil_scoped_release release;
    control_.planner().progress = [](const planning::MotionPlan&) {
      seeSignals();
      return true;
    };
    control_.solve();
    control_.planner().progress = {};
    control_.attach(sim_.controller());
  }

  VectorX update(const py::object& q, const py::object& v, std::optional<double> time) {
    const Turn turn(busy_, "this Mpc");
    const VectorX nowQ = vectorOf(q, "q", sim_.model().nq, "nq"),
                  nowV = vectorOf(v, "v", sim_.model().nv, "nv");
    expectConfiguration(sim_.model(), nowQ);
    finite(nowV, "v", "a velocity");
    const double now = time.value_or(begun_ ? time_ + timestep() : 0.0);
    if (!std::isfinite(now) || (begun_ && now < time_))
      throw py::value_error("time: found " + std::to_string(now) + " s, expected " +
                            std::to_string(time_) + " s, that of the last update, or later");
    const py::gil_scoped_release release;
    State& state = sim_.state();
    state.q = nowQ, state.v = nowV, state.time = now;
    if (!begun_) control_.begin(state);
    begun_ = true, time_ = now;
    control_.update(state);
    const ControlSolution& answer = sim_.solve(nowQ, nowV);
    if (isRefused(answer.status)) throw StepError(sim_.failure());
    return answer.tau;
  }

  void move(const std::string& link, const py::object& target) {
    const Turn turn(busy_, "this Mpc");
    gdd::Goal& goal = targetOf("plan " + link, "link: found '" + link +
                                                   "', expected one of plan.final.points or "
                                                   "plan.running.points");
    const VectorX place = finite(vectorOf(target, "target", 3, "3"), "target", "a place");
    std::copy_n(place.data(), 3, goal.soughtPlace());
  }
  void seek(const py::object& q) {
    const Turn turn(busy_, "this Mpc");
    const VectorX sought = vectorOf(q, "q", sim_.model().nq, "nq");
    expectConfiguration(sim_.model(), sought);
    *targetOf("plan", "").soughtPositions() = sought;
  }

  Plan plan() const { return {control_.planner().plan(), control_.task().steps.step}; }
  double timestep() const { return sim_.model().options.timestep; }
  double time() const { return time_; }
  const planning::HorizonReport& report() const { return control_.report(); }

 private:
  static const VectorX& finite(const VectorX& x, const char* name, const char* expected) {
    if (x.allFinite()) return x;
    throw StepError(std::string(name) + ": found NaN or ∞, expected " + expected);
  }
  io::PlanTask read(const std::filesystem::path& file, const std::optional<py::dict>& given,
                    int threads) const {
    const State& start = sim_.scene().initial;
    io::PlanTask task =
        given ? io::parsePlanTask("{\"plan\": " + jsonOf(*given) + "}", "task", sim_.model(), start)
              : io::readPlanTask(file, sim_.model(), start);
    task.steps.threads = threads;
    return task;
  }
  /// Arrays as lists.
  static std::string jsonOf(const py::dict& task) {
    const py::cpp_function listed([](const py::object& array) { return array.attr("tolist")(); });
    return py::str(py::module_::import("json").attr("dumps")(task, py::arg("default") = listed));
  }
  gdd::Goal& targetOf(const std::string& name, const std::string& what) {
    for (const auto& goal : sim_.controller().goals)
      if (goal->name() == name) return *goal;
    throw py::value_error(what);
  }
  static SimulationOptions withoutGoals(SimulationOptions options) {
    options.withoutGoals = true;
    return options;
  }

  Simulation sim_;
  PlanControl control_;
  bool begun_ = false;
  double time_ = 0.0;
  std::atomic<bool> busy_ = false;
};

}  // namespace
}  // namespace softgauss::python

SOFTGAUSS_MADE_ONLY(softgauss::python::Plan)
SOFTGAUSS_MADE_ONLY(softgauss::python::Mpc)

namespace softgauss::python {
namespace {

void bindPlanClass(py::module_& m) {
  py::class_<Plan>(m, "Plan", "A motion that was planned: N + 1 states, N controls between them.")
      .def_readonly("q", &Plan::q, "(N + 1, nq) configurations [rad or m]")
      .def_readonly("v", &Plan::v, "(N + 1, nv) velocities")
      .def_readonly("a", &Plan::a, "(N, nv) accelerations [rad/s² or m/s²]")
      .def_readonly("u", &Plan::u, "(N, nv) controls, 0 where nobody pulls [N m or N]")
      .def_property_readonly("time", &Plan::time, "(N + 1,) of the states [s]")
      .def_readonly("step", &Plan::step, "From one to the next [s].")
      .def_property_readonly(
          "cost", [](const Plan& p) { return p.figures.cost; }, "Of the whole motion.")
      .def_property_readonly(
          "costs", [](const Plan& p) { return p.figures.costs; },
          "After each iteration of the last stage.")
      .def_property_readonly(
          "status",
          [](const Plan& p) { return std::string(planning::planStatusName(p.figures.status)); },
          "converged, iteration limit, no descent.")
      .def_property_readonly(
          "root_force", [](const Plan& p) { return p.figures.rootForce; },
          "Largest force that nobody causes [N or N m]: 0.")
      .def_property_readonly(
          "gap", [](const Plan& p) { return p.figures.gap; },
          "Largest difference of a step's acceleration from what its control causes, over its "
          "size.")
      .def_property_readonly(
          "certificate", [](const Plan& p) { return p.figures.certificate; },
          "Share of the cost that the last model still promises.")
      .def_property_readonly(
          "iterations", [](const Plan& p) { return p.figures.iterations; }, "Of all stages.")
      .def_property_readonly(
          "seconds", [](const Plan& p) { return p.figures.seconds; }, "Wall time of planning [s].");
}

void bindMpc(py::module_& m) {
  py::class_<Mpc>(m, "Mpc",
                  "Control by a plan that is made anew from the present state, at plan.mpc.rate.")
      .def(py::init([](const std::filesystem::path& file, const std::optional<py::dict>& task,
                       int threads, const py::kwargs& options) {
             return std::make_unique<Mpc>(file, task, threads, optionsFrom(options));
           }),
           py::arg("file"), py::arg("task") = py::none(), py::kw_only(), py::arg("threads") = 1,
           "A scene with a key plan, or a robot and a `task` of what that key holds, which is\n"
           "planned here; options as of Simulation. Any number of threads gives the same bits.\n"
           "Raises ModelError, OptionError and PlanError.")
      .def("move", &Mpc::move, py::arg("link"), py::arg("target"),
           "From the next update on the plan's point of the link is to come to `target` (3,), in\n"
           "the world [m]. Raises ValueError where the task has no such point.")
      .def("seek", &Mpc::seek, py::arg("q"),
           "From the next update on the plan is to end in q (nq,), at rest, as the task weighs it.")
      .def(
          "update", &Mpc::update, py::arg("q"), py::arg("v"), py::arg("time") = py::none(),
          "The control (nv,) at q (nq,) and v (nv,). `time` [s] begins with the first call; where\n"
          "it is not given, each comes a timestep after the last. Raises StepError.")
      .def_property_readonly("plan", &Mpc::plan, "The first one.")
      .def_property_readonly("timestep", &Mpc::timestep, "From update to update [s].")
      .def_property_readonly("time", &Mpc::time, "Of the last update [s].")
      .def_property_readonly(
          "ticks", [](const Mpc& c) { return c.report().ticks; }, "How often it was planned anew.")
      .def_property_readonly(
          "failed", [](const Mpc& c) { return c.report().failed; },
          "Of these without a plan: the one before went on.")
      .def_property_readonly(
          "tick_seconds", [](const Mpc& c) { return c.report().last; },
          "Wall time of the last tick [s].")
      .def_property_readonly(
          "cost", [](const Mpc& c) { return c.report().cost; }, "Of the present plan.");
}

}  // namespace

void bindPlans(py::module_& m) {
  py::register_exception<PlanError>(m, "PlanError", PyExc_ArithmeticError).doc() =
      "No plan that the actuators can cause was found: what is left, and what to try.";
  bindPlanClass(m);
  bindMpc(m);
  m.def(
      "plan",
      [](const std::filesystem::path& file, const std::optional<py::dict>& task, int threads,
         const py::kwargs& options) {
        return Mpc(file, task, threads, optionsFrom(options), false).plan();
      },
      py::arg("file"), py::arg("task") = py::none(), py::kw_only(), py::arg("threads") = 1,
      "Plans what the key plan of a scene asks for, or for any robot a `task` of what that key\n"
      "holds; options as of Simulation. Any number of threads gives the same bits. Ctrl-C ends\n"
      "it. Raises ModelError, OptionError and PlanError.");
}

}  // namespace softgauss::python
