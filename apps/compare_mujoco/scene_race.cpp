// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/scene_race.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "apps/compare_mujoco/mjcf.hpp"
#include "apps/compare_mujoco/mujoco.hpp"
#include "apps/shared/cpu_time.hpp"
#include "apps/shared/pose_error.hpp"
#include "apps/shared/wall_clock.hpp"
#include "softgauss/engine/step/forward_derivative.hpp"

namespace softgauss::app {
namespace {

constexpr int kUntimed = 2;    ///< steps of a window before those that are timed
constexpr int kInverses = 10;  ///< evaluations of inverse dynamics, or derivatives, timed at once

/// Why a race is given up.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Window {
  State start;
  std::vector<VectorX> torques;  ///< of each step, timed or not
};

/// Both engines with the same scene.
class Race {
 public:
  explicit Race(const TableScene& what)
      : what_(what),
        scene_(what.make()),
        mujoco_(Mujoco::withRoom(mjcfOf(scene_->model, scene_->contacts->filter()))),
        ours_(scene_->model),
        theirs_(scene_->model) {
    const Model& model = scene_->model;
    if (mujoco_.nq() != model.nq || mujoco_.nv() != model.nv)
      throw Refused(fmt::format("MuJoCo has {} dofs, ours {}", mujoco_.nv(), model.nv));
    for (int i = 0; i < what.warmUp; ++i) walk();
    for (int w = 0; w < what.windows; ++w) {
      Window window{scene_->state, {}};
      for (int i = 0; i < kUntimed + what.steps; ++i) window.torques.push_back(walk());
      windows_.push_back(std::move(window));
      for (int i = 0; i < what.between; ++i) walk();
    }
  }

  int dofs() const { return scene_->model.nv; }
  const std::vector<Window>& windows() const { return windows_; }

  /// Times of a step [µs].
  double timeOurs(const Window& window) {
    begin(window);
    return timeSteps([&](int i) { follow(window, i); });
  }
  double timeMujoco(const Window& window) {
    beginMujoco(window);
    return timeSteps([&](int i) { followMujoco(window, i); });
  }
  double timeReaching(const Window& window) {
    begin(window);
    return timeSteps([&](int) { accept(stepWithGoals()); });
  }

  /// Times of inverse dynamics a step after the start, at the acceleration that each has there.
  double timeOurInverse(const Window& window) {
    begin(window);
    follow(window, 0);
    input_.tau = window.torques[1];
    VectorX a, tau;
    const auto stages = [&] {
      computeBodyStages(scene_->model, input_, scene_->state, *scene_->data,
                        scene_->contacts.get());
    };
    stages();
    forwardDynamics(scene_->model, scene_->state, *scene_->data);
    a = scene_->data->forward.a;
    return timeOften([&] {
      stages();
      inverseDynamics(scene_->model, a, *scene_->data, tau);
    });
  }
  double timeMujocoInverse(const Window& window) {
    beginMujoco(window);
    followMujoco(window, 0);
    mujoco_.setForce(window.torques[1]);
    mujoco_.forward();
    return timeOften([&] { mujoco_.inverse(); });
  }

  /// Times of the derivatives of a step after the start.
  double timeOurDerivatives(const Window& window) {
    begin(window);
    follow(window, 0);
    input_.tau = window.torques[1];
    Model bare = scene_->model;
    bare.options = StepDerivative::bareStep(bare.options);
    Data data(bare);
    StepDerivative derivative(bare);
    return timeOften([&] {
      accept(derivative.compute(bare, input_, scene_->state, scene_->contacts.get(), data));
    });
  }
  double timeMujocoDerivatives(const Window& window) {
    beginMujoco(window);
    followMujoco(window, 0);
    mujoco_.setForce(window.torques[1]);
    return timeOften([&] { mujoco_.differentiateStep(); });
  }

  /// How far the links of both are from each other at the end of a window [m].
  double compare(const Window& window) {
    begin(window);
    beginMujoco(window);
    for (int i = 0; i < static_cast<int>(window.torques.size()); ++i) {
      follow(window, i);
      followMujoco(window, i);
    }
    if (const std::string warning = mujoco_.firstWarning(); !warning.empty())
      throw Refused("MuJoCo warns: " + warning);
    State other = scene_->state;
    other.q = mujoco_.q();
    if (!other.q.allFinite()) throw Refused("MuJoCo's state is not finite");
    ours_.set(scene_->state);
    theirs_.set(other);
    const double apart = ours_.against(theirs_).total;
    theirs_.set(window.start);
    const double way = ours_.against(theirs_).total;
    if (!(apart <= std::max(kMostApart, kMostOfWay * way)))
      throw Refused(fmt::format("the engines part: {:.2g} m after {} steps and {:.2g} m", apart,
                                window.torques.size(), way));
    return apart;
  }

 private:
  static void accept(SolveStatus status) {
    if (isRefused(status)) throw Refused("our state is not finite");
  }
  SolveStatus stepWithGoals() {
    return scene_->controller->step(scene_->model, {}, scene_->state, *scene_->data,
                                    scene_->contacts.get());
  }

  /// A step of the path, and the torques by which it was taken.
  VectorX walk() {
    const Model& model = scene_->model;
    if (scene_->controller) {
      accept(stepWithGoals());
      return scene_->controller->control;
    }
    input_.tau = what_.drive == Drive::torques ? swingingControl(model, scene_->state.time)
                                               : VectorX::Zero(model.nv);
    accept(step(model, input_, scene_->state, *scene_->data, scene_->contacts.get()));
    return input_.tau;
  }

  void begin(const Window& window) { scene_->state = window.start; }
  void beginMujoco(const Window& window) {
    mujoco_.set(window.start, window.torques.front());
    const WarmStart& warm = window.start.warmstart;
    mujoco_.setWarmStart(warm.valid ? warm.a : VectorX::Zero(scene_->model.nv));
  }
  void follow(const Window& window, int i) {
    input_.tau = window.torques[static_cast<std::size_t>(i)];
    accept(step(scene_->model, input_, scene_->state, *scene_->data, scene_->contacts.get()));
  }
  void followMujoco(const Window& window, int i) {
    mujoco_.setForce(window.torques[static_cast<std::size_t>(i)]);
    mujoco_.step();
  }

  template <class F>
  double timeSteps(F&& step) {
    for (int i = 0; i < kUntimed; ++i) step(i);
    const double start = cpuSeconds();
    for (int i = 0; i < what_.steps; ++i) step(kUntimed + i);
    return 1e6 * (cpuSeconds() - start) / what_.steps;
  }
  template <class F>
  static double timeOften(F&& work) {
    work();
    const double start = cpuSeconds();
    for (int i = 0; i < kInverses; ++i) work();
    return 1e6 * (cpuSeconds() - start) / kInverses;
  }

  const TableScene& what_;
  std::unique_ptr<Scene> scene_;
  Mujoco mujoco_;
  LinkPoses ours_, theirs_;
  Input input_;
  std::vector<Window> windows_;
};

/// One kind of work and the least time that it has taken in each window.
struct Contestant {
  std::function<double(const Window&)> time;
  double* mean;  ///< of these, at the end [µs]
  std::vector<double> least;
};

std::vector<Contestant> contestants(const TableScene& scene, Race& race, RaceResult& result) {
  std::vector<Contestant> all;
  const auto add = [&](double (Race::*time)(const Window&), double& mean) {
    const std::size_t windows = race.windows().size();
    all.push_back({[&race, time](const Window& window) { return (race.*time)(window); }, &mean,
                   std::vector<double>(windows, kInfinity)});
  };
  add(&Race::timeOurs, result.step.ours);
  add(&Race::timeMujoco, result.step.mujoco);
  if (scene.drive == Drive::reach) add(&Race::timeReaching, result.reaching);
  if (scene.inverse) {
    add(&Race::timeOurInverse, result.inverse.ours);
    add(&Race::timeMujocoInverse, result.inverse.mujoco);
  }
  if (scene.derivatives) {
    add(&Race::timeOurDerivatives, result.derivatives.ours);
    add(&Race::timeMujocoDerivatives, result.derivatives.mujoco);
  }
  return all;
}

}  // namespace

RaceResult race(const TableScene& scene, const RaceOptions& options) {
  RaceResult result;
  try {
    Race race(scene);
    result.dofs = race.dofs();
    for (const Window& window : race.windows())
      result.apart = std::max(result.apart, race.compare(window));
    std::vector<Contestant> all = contestants(scene, race, result);
    const auto start = Clock::now();
    for (; result.rounds < options.rounds; ++result.rounds) {
      if (result.rounds >= options.fewestRounds && secondsSince(start) > options.mostSeconds) break;
      for (std::size_t w = 0; w < race.windows().size(); ++w)
        for (std::size_t i = 0; i < all.size(); ++i) {
          // Each round begins with another one.
          Contestant& next = all[(i + static_cast<std::size_t>(result.rounds)) % all.size()];
          next.least[w] = std::min(next.least[w], next.time(race.windows()[w]));
        }
    }
    for (const Contestant& one : all)
      *one.mean = std::accumulate(one.least.begin(), one.least.end(), 0.0) /
                  static_cast<double>(one.least.size());
  } catch (const Refused& refused) {
    result.refused = refused.what();
  } catch (const ModelError& error) {
    result.refused = error.what();
  }
  return result;
}

}  // namespace softgauss::app
