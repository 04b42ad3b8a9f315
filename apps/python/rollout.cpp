// SPDX-License-Identifier: Apache-2.0
/// Rollout, States: many runs on all cores.

#include "softgauss/io/simulation/rollout.hpp"

#include <optional>

#include "apps/python/rollout_call.hpp"
#include "softgauss/io/simulation/simulation_parts.hpp"

namespace softgauss::python {
namespace {

/// A Rollout of a simulation's scene; Python sees that the simulation stays.
class HeldRollout {
 public:
  HeldRollout(Held& held, int threads)
      : held_(held), rollout_(held.sim().scene(), held.sim().parts().options, threads) {}

  Runs run(long steps, const RolloutArguments& arguments) {
    const Turn turn(busy_, "this rollout");
    std::optional<Turn> ofStates;
    if (arguments.states) ofStates.emplace(arguments.states->busy(), States::kName);
    RolloutCall call(held_.sim(), rollout_, steps, arguments);
    if (arguments.goals.is_none() && !held_.hasGoalsOfFile())
      throw py::value_error(
          "rollout: found other goals of the simulation than its file's, which runs would not "
          "have, expected goals=… in run(); goals=[] for those of the file alone");
    return call.run(rollout_);
  }
  const Rollout& rollout() const { return rollout_; }

 private:
  Held& held_;
  Rollout rollout_;
  std::atomic<bool> busy_ = false;
};

}  // namespace
}  // namespace softgauss::python

SOFTGAUSS_MADE_ONLY(softgauss::python::HeldRollout)

namespace softgauss::python {
namespace {

constexpr const char* kRunDoc =
    "Runs of `steps` steps on all cores, without the interpreter's lock. A run depends on its own\n"
    "rows alone: the bits are the same for any number of threads.\n\n"
    "runs        how many; where it is not said, as many as the first array has rows\n"
    "q0, v0      (runs, nq), (runs, nv) where they start; else as the scene does\n"
    "tau         (runs, steps, nv), or (runs, nv) that stays: force besides the goals [N m or N]\n"
    "parameters  {name: (runs,) or a number}: mass:LINK, friction:*, damping:JOINT, … (batch.md)\n"
    "goals       as of Goals.add(), beside those of the scene's file\n"
    "targets     (runs, k) targets of the first goals of `goals`, one after the other\n"
    "pushes      {link: (runs, 3)} forces on origins of links, world axes [N]\n"
    "states      States that the runs go on from, and leave where they end\n"
    "outputs     some of q, v, a, tau, contact_forces; a row after each `every` steps\n"
    "progress    called as progress(done, runs)\n\n"
    "A run that fails costs only itself. Raises ValueError, UnknownName, ModelError.";

py::object arrayOf(const Runs& runs, const char* name) {
  const auto found = runs.arrays.find(name);
  return found == runs.arrays.end() ? py::object(py::none()) : py::object(found->second);
}

void bindRuns(py::module_& m) {
  py::class_<Runs> runs(m, "Runs", "What a rollout gave. What comes after a failed step is NaN.");
  const std::pair<const char*, const char*> arrays[] = {
      {"q", "(runs, rows, nq) after the step, or None"},
      {"v", "(runs, rows, nv) after the step, or None"},
      {"a", "(runs, rows, nv) of the step, or None"},
      {"tau", "(runs, rows, nv) applied in the step [N m or N], or None"},
      {"contact_forces",
       "(runs, rows, links, 3) world [N], links as Rollout.contact_links, or None"}};
  for (const auto& [name, doc] : arrays)
    runs.def_property_readonly(
        name, [name = name](const Runs& r) { return arrayOf(r, name); }, doc);
  runs.def_readonly("status", &Runs::status, "completed or failed, a run each");
  runs.def_readonly("failure", &Runs::failure, "why it failed, or ''")
      .def_readonly("steps", &Runs::steps, "(runs,) that were taken");
}

void bindStates(py::module_& m) {
  py::class_<States>(m, "States",
                     "Many states of one simulation's scene, for runs that go on. They belong to\n"
                     "one thread at a time: RuntimeError while a rollout has them.")
      .def(py::init<Held&, long>(), py::arg("sim"), py::arg("n"), py::keep_alive<1, 2>(),
           "The present state of the simulation, n times.")
      .def("reset", &States::reset, py::arg("rows") = py::none(), py::arg("q") = py::none(),
           py::arg("v") = py::none(),
           "Puts these rows, or all, where the scene starts, at q (rows, nq) and v (rows, nv). "
           "rows:\n"
           "indices, or a mask (n,) of True and False. Raises TypeError, IndexError, ValueError.")
      .def_property_readonly("q", &States::q, "(n, nq) a copy")
      .def_property_readonly("v", &States::v, "(n, nv) a copy")
      .def_property_readonly("time", &States::time, "(n,) [s]")
      .def_property_readonly("nbytes", &States::bytes, "Memory of all of them.")
      .def("__len__", &States::size);
}

}  // namespace

void bindRollout(py::module_& m) {
  bindRuns(m);
  bindStates(m);
  py::class_<HeldRollout>(m, "Rollout", "Runs a simulation's scene many times on all cores.")
      .def(py::init<Held&, int>(), py::arg("sim"), py::arg("threads") = 0, py::keep_alive<1, 2>(),
           "threads 0: as many as the machine has. Runs have the goals of the simulation's file\n"
           "and those of run(). Where the simulation was given others, run() asks for them.")
      .def(
          "run",
          [](HeldRollout& r, long steps, const py::object& runs, const py::object& q0,
             const py::object& v0, const py::object& tau, const py::object& parameters,
             const py::object& goals, const py::object& targets, const py::object& pushes,
             States* states, const std::vector<std::string>& outputs, long every,
             const py::object& progress) {
            return r.run(steps, {runs, q0, v0, tau, parameters, goals, targets, pushes, states,
                                 outputs, every, progress});
          },
          py::arg("steps"), py::kw_only(), py::arg("runs") = py::none(), py::arg("q0") = py::none(),
          py::arg("v0") = py::none(), py::arg("tau") = py::none(),
          py::arg("parameters") = py::none(), py::arg("goals") = py::none(),
          py::arg("targets") = py::none(), py::arg("pushes") = py::none(),
          py::arg("states") = py::none(), py::arg("outputs") = std::vector<std::string>{"q", "v"},
          py::arg("every") = 1, py::arg("progress") = py::none(), kRunDoc)
      .def_property_readonly(
          "threads", [](HeldRollout& r) { return r.rollout().threads(); }, "That share the runs.")
      .def_property_readonly(
          "contact_links", [](HeldRollout& r) { return r.rollout().contactLinks(); },
          "Links that move and can touch.")
      .def_property_readonly(
          "bytes_per_run", [](HeldRollout& r) { return r.rollout().bytesPerRun(); },
          "Memory of a run while it runs, besides its arrays.")
      .def_property_readonly(
          "bytes_per_thread", [](HeldRollout& r) { return r.rollout().bytesPerThread(); },
          "Memory of a thread: model, contacts, controller.");
}

}  // namespace softgauss::python
