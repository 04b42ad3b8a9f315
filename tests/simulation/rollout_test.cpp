// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/rollout.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "tests/io/temp_folder.hpp"
#include "tests/simulation/data_file.hpp"

namespace softgauss::test {
namespace {

/// A ball that hangs on a hinge.
std::string pendulum(double mass, double damping, double dryFriction) {
  const auto text = [](double x) { return std::to_string(x); };
  return "<robot name='pendulum'><link name='world'/>"
         "<joint name='hinge' type='revolute'><parent link='world'/><child link='rod'/>"
         "<origin xyz='0 0 1'/><axis xyz='0 1 0'/><limit lower='-1.5' upper='1.5' effort='5' "
         "velocity='9'/><dynamics damping='" +
         text(damping) + "' friction='" + text(dryFriction) +
         "'/></joint><link name='rod'><inertial><origin xyz='0 0 -0.5'/><mass value='" +
         text(mass) + "'/><inertia ixx='" + text(mass / 64) + "' iyy='" + text(mass / 64) +
         "' izz='" + text(mass / 256) +
         "' ixy='0' ixz='0' iyz='0'/></inertial><collision><origin xyz='0 0 -0.5'/><geometry>"
         "<sphere radius='0.1'/></geometry></collision></link></robot>";
}

struct Runs {
  std::vector<double> q, v, tau, forces;
  std::vector<RunOutcome> outcomes;
  bool operator==(const Runs& o) const {
    const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
      return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * 8) == 0;
    };
    return same(q, o.q) && same(v, o.v) && same(tau, o.tau) && same(forces, o.forces);
  }
};

/// Humanoids that start at other heights, with other friction, and keep their posture.
Runs humanoids(const Scene& scene, int threads, long runs, bool backwards = false) {
  const long steps = 40, every = 10, rows = steps / every;
  Rollout rollout(scene, {}, threads);
  std::vector<double> q0, values;
  for (long i = 0; i < runs; ++i) {
    const long run = backwards ? runs - 1 - i : i;
    VectorX q = scene.initial.q;
    q[2] += 0.002 * static_cast<double>(run);
    q0.insert(q0.end(), q.data(), q.data() + q.size());
    values.insert(values.end(), {0.2 + 0.1 * static_cast<double>(run), 0.5});
  }
  Runs result;
  const auto size = [&](long columns) { return static_cast<std::size_t>(runs * rows * columns); };
  result.q.resize(size(scene.model.nq));
  result.v.resize(size(scene.model.nv));
  result.tau.resize(size(scene.model.nv));
  result.forces.resize(size(3 * static_cast<long>(rollout.contactLinks().size())));
  RolloutInputs in{.runs = runs, .steps = steps, .q0 = q0};
  in.parameters = {"friction:*", "damping:right_knee"};
  in.values = values;
  RolloutOutputs out{every, result.q, result.v, {}, result.tau, result.forces};
  RolloutHooks hooks;
  hooks.begin = [](RolloutRun& run) { run.sim.goals.posture(); };
  result.outcomes = rollout.run(in, out, hooks);
  return result;
}

TEST(Rollout, GivesTheSameBitsForAnyNumberOfThreads) {
  const auto scene = loadScene(robot("humanoid"));
  const Runs one = humanoids(*scene, 1, 9);
  for (const RunOutcome& o : one.outcomes) EXPECT_EQ(o.status, RunOutcome::Status::completed);
  EXPECT_TRUE(one == humanoids(*scene, 2, 9));
  EXPECT_TRUE(one == humanoids(*scene, 7, 9));
}

TEST(Rollout, GivesTheSameBitsInAnyOrder) {
  const auto scene = loadScene(robot("humanoid"));
  const Runs forth = humanoids(*scene, 1, 5), back = humanoids(*scene, 2, 5, true);
  const std::size_t n = forth.q.size() / 5;
  for (std::size_t run = 0; run < 5; ++run)
    EXPECT_EQ(std::memcmp(&forth.q[run * n], &back.q[(4 - run) * n], n * sizeof(double)), 0);
}

TEST(Rollout, IsWhatASimulationDoes) {
  SimulationOptions options;
  const auto scene = loadScene(robot("arm"), options);
  const Vector3 target(0.5, 0.2, 0.4);
  std::vector<double> q(static_cast<std::size_t>(scene->model.nq));
  RolloutInputs in{.runs = 1, .steps = 50};
  RolloutOutputs out;
  out.every = 50;
  out.q = q;
  RolloutHooks hooks;
  hooks.begin = [&](RolloutRun& run) { run.sim.goals.reach("hand", target); };
  rollout(*scene, in, out, hooks);

  Simulation sim = Simulation::load(robot("arm"));
  sim.goals.reach("hand", target);
  for (int k = 0; k < 50; ++k) sim.step();
  for (int i = 0; i < scene->model.nq; ++i)
    EXPECT_EQ(q[static_cast<std::size_t>(i)], sim.state().q[i]);
}

/// q and v of the hinge after 0.6 s, from 1 rad and under a constant torque.
std::array<double, 2> endOf(const Model& model) {
  collision::SceneContacts contacts(model);
  Data data(model);
  State state(model);
  state.q[0] = 1.0;
  Input input;
  input.tau = VectorX::Constant(1, 0.25);
  for (int k = 1; k <= 300; ++k) {
    EXPECT_FALSE(isRefused(step(model, input, state, data, &contacts)));
    state.time = k * model.options.timestep;
  }
  return {state.q[0], state.v[0]};
}

/// The same of a rollout with one parameter.
std::array<double, 2> endOf(const Scene& scene, const std::string& name, double value) {
  std::vector<double> q0 = {1.0}, tau(300, 0.25), values = {value};
  std::array<double, 2> end{};
  RolloutInputs in{.runs = 1, .steps = 300, .q0 = q0, .tau = tau};
  in.parameters = {name};
  in.values = values;
  RolloutOutputs out;
  out.every = 300;
  out.q = std::span(end.data(), 1);
  out.v = std::span(end.data() + 1, 1);
  const auto outcome = rollout(scene, in, out).front();
  EXPECT_EQ(outcome.status, RunOutcome::Status::completed) << outcome.failure;
  return end;
}

TEST(Rollout, AParameterIsAModelBuiltSo) {
  const io::TempFolder folder;
  const auto scene = loadScene(folder.write("a.urdf", pendulum(2, 0.1, 0.1)));
  const auto built = [&](const std::string& urdf) {
    return loadScene(folder.write("b.urdf", urdf))->model;
  };
  const std::array<double, 2> as = endOf(scene->model);
  const auto expectSame = [&](const std::string& name, double value, const Model& model) {
    const std::array<double, 2> expected = endOf(model), found = endOf(*scene, name, value);
    EXPECT_EQ(expected, found) << name;
    EXPECT_NE(expected, as) << name << " changes nothing";
  };
  // Twice the mass: its inertia is twice as large, to the bit.
  expectSame("mass:rod", 4.0, built(pendulum(4, 0.1, 0.1)));
  expectSame("damping:hinge", 0.5, built(pendulum(2, 0.5, 0.1)));
  expectSame("dry_friction:hinge", 0.75, built(pendulum(2, 0.1, 0.75)));
  Model model = scene->model;
  model.dofs[0].armature = 0.5;
  expectSame("armature:hinge", 0.5, model);
  model = scene->model;
  model.options.gravity.z() = -1.625;
  expectSame("gravity:z", -1.625, model);
  model = scene->model;
  model.ranges[0].upper = 0.5;
  expectSame("upper:hinge", 0.5, model);
  model = scene->model;
  model.options.timestep = 0.001;
  expectSame("timestep", 0.001, model);
}

TEST(Rollout, FrictionOfAParameterIsFrictionOfTheShape) {
  // Along a slope of 30° a block slides with g (sin − μ cos) from rest; the tolerance is what a
  // pyramid of friction and the creep of softness leave at 2 ms.
  const io::TempFolder folder;
  folder.write("scene.yaml",
               "ground: none\nobjects:\n"
               "  - {name: slope, box: {size: [8, 2, 0.2]}, fixed: true, position: [0, 0, 0],"
               " rpy: [0, 0.5235987755982988, 0]}\n"
               "  - {name: block, box: {size: [0.2, 0.2, 0.1]}, mass: 1, position: [0.075, 0,"
               " 0.1299038105676658], rpy: [0, 0.5235987755982988, 0]}\n");
  const auto slope = loadScene(folder.path() / "scene.yaml");
  std::vector<double> values = {0.1, 0.3, 0.9}, v(3 * static_cast<std::size_t>(slope->model.nv));
  RolloutInputs in{.runs = 3, .steps = 250};
  in.parameters = {"friction:*"};
  in.values = values;
  RolloutOutputs out;
  out.every = 250;
  out.v = v;
  rollout(*slope, in, out);
  const double sine = 0.5, cosine = std::sqrt(0.75);
  for (std::size_t run = 0; run < 3; ++run) {
    const double* u = &v[run * static_cast<std::size_t>(slope->model.nv)];
    const double expected = std::max(0.0, 0.5 * 9.81 * (sine - values[run] * cosine));
    EXPECT_NEAR(std::hypot(u[0], u[2]), expected, 0.02 * 0.5 * 9.81) << "friction " << values[run];
  }
}

TEST(Rollout, AFailingRunCostsOnlyItselfAndTellsWhy) {
  const auto scene = loadScene(robot("arm"));
  const auto nv = static_cast<std::size_t>(scene->model.nv);
  std::vector<double> tau(3 * 10 * nv, 0.0), v(3 * 10 * nv, -1.0);
  tau[1 * 10 * nv + 4 * nv] = kNaN;  // run 1, step 4
  RolloutInputs in{.runs = 3, .steps = 10, .tau = tau};
  RolloutOutputs out;
  out.v = v;
  const auto outcomes = rollout(*scene, in, out, {}, 2);
  EXPECT_EQ(outcomes[0].status, RunOutcome::Status::completed);
  EXPECT_EQ(outcomes[2].status, RunOutcome::Status::completed);
  EXPECT_EQ(outcomes[1].status, RunOutcome::Status::failed);
  EXPECT_EQ(outcomes[1].steps, 4);
  EXPECT_NE(outcomes[1].failure.find("shoulder_yaw"), std::string::npos) << outcomes[1].failure;
  for (std::size_t row = 0; row < 10; ++row)
    EXPECT_EQ(std::isnan(v[(10 + row) * nv]), row >= 4) << row;
  EXPECT_EQ(std::memcmp(v.data(), &v[20 * nv], 10 * nv * sizeof(double)), 0);
}

TEST(Rollout, AHookThatThrowsFailsItsRunAlone) {
  const auto scene = loadScene(robot("arm"));
  RolloutHooks hooks;
  hooks.before = [](RolloutRun& run) {
    if (run.seed == 2 && run.step == 3) throw std::runtime_error("no policy for this");
  };
  const auto outcomes = rollout(*scene, {.runs = 4, .steps = 5}, {}, hooks, 3);
  for (const long run : {0, 1, 3})
    EXPECT_EQ(outcomes[static_cast<std::size_t>(run)].status, RunOutcome::Status::completed);
  EXPECT_EQ(outcomes[2].status, RunOutcome::Status::failed);
  EXPECT_EQ(outcomes[2].failure, "no policy for this");
  EXPECT_EQ(outcomes[2].steps, 3);
}

TEST(Rollout, AHookMayEndARun) {
  const auto scene = loadScene(robot("arm"));
  RolloutHooks hooks;
  hooks.after = [](RolloutRun& run) { return run.step < run.index; };
  const auto outcomes = rollout(*scene, {.runs = 5, .steps = 4}, {}, hooks, 2);
  EXPECT_EQ(outcomes[2].status, RunOutcome::Status::ended);
  EXPECT_EQ(outcomes[2].steps, 2);
  EXPECT_EQ(outcomes[4].status, RunOutcome::Status::completed);
}

TEST(Rollout, StopsWhenItIsAskedTo) {
  const auto scene = loadScene(robot("arm"));
  std::atomic<bool> stop = false;
  RolloutHooks hooks;
  hooks.stop = &stop;
  hooks.progress = [&](long done, long) { stop = done == 3; };
  const auto outcomes = rollout(*scene, {.runs = 100, .steps = 2}, {}, hooks, 1);
  EXPECT_EQ(outcomes[2].status, RunOutcome::Status::completed);
  EXPECT_EQ(outcomes[3].status, RunOutcome::Status::interrupted);
  EXPECT_EQ(outcomes[99].steps, 0);
}

TEST(Rollout, ARunIsItsArraysAndItsState) {
  const auto scene = loadScene(robot("humanoid"));
  const Rollout rollout(*scene, {}, 1);
  // 10⁵ humanoids fit into 1 GB.
  EXPECT_LT(rollout.bytesPerRun(), 10000u);
  EXPECT_GT(rollout.bytesPerRun(), sizeof(State));
  if (rollout.bytesPerThread() > 0) {  // a sanitizer's library does not count
    EXPECT_GT(rollout.bytesPerThread(), 100000u);
  }
}

TEST(Rollout, ArraysOfOtherSizesAreRefused) {
  const auto scene = loadScene(robot("arm"));
  std::vector<double> q0(3);
  try {
    rollout(*scene, {.runs = 2, .steps = 1, .q0 = q0}, {});
    ADD_FAILURE() << "an array of 3 was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("q0: found 3 numbers, expected 14"), std::string::npos)
        << error.what();
  }
}

TEST(Parameter, TellsWhatDoesNotExist) {
  const auto scene = loadScene(robot("arm"));
  const auto refusal = [&](const std::string& name) -> std::string {
    try {
      const Parameter parameter(scene->model, name);
    } catch (const NameError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::pair<const char*, const char*> cases[] = {
      {"mas:hand", "did you mean 'mass'"},
      {"mass:hnd", "did you mean 'hand'"},
      {"damping:elbow_pich", "did you mean 'elbow_pitch'"},
      {"friction:hnd", "did you mean 'hand'"},
      {"gravity:w", "expected one of x, y, z"},
      {"reach:hand", "expected one of x, y, z"},
      {"timestep:3", "alone"},
      {"mass", "expected KIND:NAME"},
      {"q:elbw_pitch", "did you mean 'elbow_pitch'"},
  };
  for (const auto& [name, expected] : cases)
    EXPECT_NE(refusal(name).find(expected), std::string::npos) << name << ": " << refusal(name);
  EXPECT_EQ(refusal("upper:elbow_pitch"), "accepted");
}

TEST(Parameter, ValuesAreBounded) {
  const auto scene = loadScene(robot("arm"));
  EXPECT_NE(Parameter(scene->model, "mass:hand").problem(0.0), "");
  EXPECT_EQ(Parameter(scene->model, "friction:*").problem(0.0), "");
  EXPECT_NE(Parameter(scene->model, "friction:*").problem(-1.0), "");
  EXPECT_NE(Parameter(scene->model, "q:elbow_pitch").problem(kNaN), "");
}

}  // namespace
}  // namespace softgauss::test
