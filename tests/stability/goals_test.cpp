// SPDX-License-Identifier: Apache-2.0
/// Family 7: goals without measure, actuators that are too weak or missing, contacts that come and
/// go, warm starts that are wrong.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "softgauss/gdd/gdd.hpp"
#include "tests/gdd/solvers.hpp"
#include "tests/stability/energy_watch.hpp"
#include "tests/stability/scenes.hpp"
#include "tests/support/random.hpp"
#include "tests/support/same_contacts.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

/// A robot under goals, watched at every step: the state is finite, every control within its box,
/// forward dynamics converged, and the goal directed solve ended with a certificate or is counted.
/// Nothing is done in place of what was asked, unless `mayRefuse` says so.
class Course {
 public:
  Course(std::string name, Model m, gdd::GddSolver solver)
      : model(std::move(m)),
        state(model),
        data(model),
        contacts(model),
        controller(model),
        unpruned_(model, std::numeric_limits<int>::max(), false),
        name_(std::move(name)) {
    controller.solver = solver;
    name_ += solver == gdd::GddSolver::activeSet ? ", solver 2" : ", solver 1";
    input.tau = VectorX::Zero(model.nv);
  }
  ~Course() { writeBits(name_, state); }
  Course(const Course&) = delete;
  Course& operator=(const Course&) = delete;

  Model model;
  State state;
  Data data;
  collision::SceneContacts contacts;
  gdd::GoalDirectedController controller;
  Input input;

  /// [J] above the energy of the start and the work. What controls drive is not passive: they are
  /// held over a step that moves.
  double mayGain = kInfinity;
  bool mayRefuse = false;  ///< guesses that are not finite
  int refused = 0;         ///< of these guesses, in all steps

  int uncertified = 0;  ///< solves that ended without a certificate
  int steps = 0;
  double worstViolation = 0.0;  ///< of the box, by the solve's own force [N or N m]
  double fastest = 0.0;         ///< largest |v_i|
  double work = 0.0;            ///< of the controls and `input.tau` [J]
  double gained = 0.0;          ///< most energy above that of the start and of the work [J]
  bool broken = false;

  gdd::Reach& reach(const std::string& link, const Vector3& target, double weight) {
    auto goal = std::make_unique<gdd::Reach>(model, link, target);
    goal->weight = weight;
    controller.goals.push_back(std::move(goal));
    return static_cast<gdd::Reach&>(*controller.goals.back());
  }
  void damping() { controller.goals.push_back(std::make_unique<gdd::VirtualDamping>()); }
  void posture(double weight) {
    auto goal = std::make_unique<gdd::Posture>(state.q);
    goal->weight = weight;
    controller.goals.push_back(std::move(goal));
  }
  Vector3 position(const std::string& link) {
    computeKinematics(model, state, data.kinematics);
    return framePose(model, data.kinematics, model.findFrame(link)).p;
  }

  double energy() {
    computeKinematics(model, state, kinematics_);
    return computeEnergy(model, kinematics_, state.q, state.v).total();
  }

  bool step() {
    if (broken) return false;
    if (steps == 0) startEnergy_ = energy();
    if (steps == 0 && mayGain < kInfinity) {  // passive, but for what the controls do
      watch_.emplace(model);
      watch_->begin(state, input);
    }
    before_ = state.v;
    const SolveStatus status = controller.step(model, input, state, data, &contacts);
    const auto breaks = [&](const std::string& law) {
      broken = true;
      ADD_FAILURE() << name_ << ": " << law << " at t = " << state.time << ", residual "
                    << data.stats.residual;
      return false;
    };
    ++steps;
    if (unpruned_.mayTouch()) {  // data.kinematics is that of the last part's start
      const Options whole = model.options;
      model.options.nextTimestep = whole.timestep, model.options.timestep /= data.stats.parts;
      unpruned_.detect(model, data.kinematics, all_);
      model.options = whole;
      if (!sameContacts(data.contacts, all_)) return breaks("other contacts without pruning");
    }
    if (status == SolveStatus::notFinite) return breaks("not finite");
    if (status != SolveStatus::converged) return breaks("forward dynamics ended short");
    if (!state.q.allFinite() || !state.v.allFinite()) return breaks("a state that is not finite");
    for (int i = 0; i < model.nv; ++i) {
      const double u = controller.control[i];
      if (!(controller.limits.lower[i] <= u && u <= controller.limits.upper[i]))
        return breaks("a control out of its limits");
    }
    const gdd::GddReport& report = controller.report;
    const StepStats& stats = data.stats;
    refused += stats.invalidWarmStarts;
    if (!mayRefuse && stats.invalidWarmStarts > 0) return breaks("a guess refused");
    if (report.restarts > 0) return breaks("a solve begun again");
    if (stats.abandonedTrees + stats.minimumStepsAccepted > 0)
      return breaks("something done in place of what was asked");
    uncertified += report.status != gdd::GddStatus::converged &&
                   report.status != gdd::GddStatus::nonsmoothMinimum;
    worstViolation = std::max(worstViolation, report.violation);
    fastest = std::max(fastest, state.v.cwiseAbs().maxCoeff());
    work += 0.5 * model.options.timestep * (controller.control + input.tau).dot(before_ + state.v);
    gained = std::max(gained, energy() - startEnergy_ - work);
    if (gained > mayGain) return breaks("more energy than at the start and by work");
    if (!watch_) return true;
    driven_ = input;
    driven_.tau += controller.control;
    if (watch_->check(state, driven_, data, work) > mayGain)
      return breaks("more energy than at an earlier step");
    return true;
  }
  void run(double seconds) {
    for (int i = static_cast<int>(std::round(seconds / model.options.timestep)); i > 0; --i)
      if (!step()) return;
  }
  void expect(const std::string& quantity, double value, double bound, const std::string& unit) {
    std::printf("  %-44s h %4.1f ms %-24s %10.3g of %10.3g %s\n", name_.c_str(),
                1e3 * model.options.timestep, quantity.c_str(), value, bound, unit.c_str());
    EXPECT_SMALL(value, bound) << name_ << ", " << quantity << " [" << unit << "]";
  }
  /// The share of solves that may end without a certificate; they are counted, and the physics of
  /// the step is exact all the same.
  void expectCertified(double share) {
    expect("solves not certified", static_cast<double>(uncertified) / steps, share, "");
  }
  bool isDefault() const { return controller.solver == gdd::GddSolver::activeSet; }

 private:
  collision::SceneContacts unpruned_;
  ContactSet all_;
  std::string name_;
  Kinematics kinematics_{model};
  VectorX before_;  ///< v at the start of the step
  double startEnergy_ = 0.0;
  std::optional<EnergyWatch> watch_;
  Input driven_;  ///< `input` and the controls
};

/// Three links of 0.3 m and 1 kg that hang from hinges about x, y, y; 50 N m each.
ModelBuilder arm(double effort = 50.0) {
  ModelBuilder builder("arm");
  builder.link(emptyLink("world"));
  std::string parent = "world";
  for (int i = 0; i < 3; ++i) {
    const std::string name = "link" + std::to_string(i);
    builder.link(boxLink(name, 1.0, {0.02, 0.02, 0.15}, {0.0, 0.0, -0.15}));
    JointSpec hinge = jointSpec("hinge" + std::to_string(i), JointType::continuous, parent, name,
                                {Matrix3::Identity(), Vector3(0, 0, i > 0 ? -0.3 : 0.0)},
                                i == 0 ? Vector3::UnitX() : Vector3::UnitY());
    hinge.effort = effort;
    builder.joint(hinge);
    parent = name;
  }
  LinkSpec hand = emptyLink("hand");
  builder.link(hand);
  builder.joint(jointSpec("wrist", JointType::fixed, parent, "hand",
                          {Matrix3::Identity(), Vector3(0, 0, -0.3)}));
  return builder;
}

// Weights of sixteen decades. A goal of hardly any weight leaves the arm as it falls; one of any
// large weight is reached.
TEST(Goals, WeightsOfSixteenDecades) {
  const Vector3 target(0.2, 0.3, -0.6);
  for (const gdd::GddSolver solver : kSolvers)
    for (const double timestep : {0.002, 0.01}) {
      for (int decade = -8; decade <= 8; decade += 2) {
        Course c("arm, weight 1e" + std::to_string(decade), with(arm(), timestep).build(), solver);
        c.state.q = Vector3(0.1, 0.5, 0.8);
        c.controller.controlCost = gdd::ControlCost::total;  // about gravity, any weight wins
        c.reach("hand", target, std::pow(10.0, decade));
        c.damping();
        c.run(2.0);
        c.expectCertified(0.0);
        c.expect("box of the solve", c.worstViolation, 1e-6, "N m");
        if (decade >= 4) c.expect("hand", (c.position("hand") - target).norm(), 1e-2, "m");
        if (decade <= -8) {
          Course free("arm, no reach", with(arm(), timestep).build(), solver);
          free.state.q = Vector3(0.1, 0.5, 0.8);
          free.controller.controlCost = gdd::ControlCost::total;
          free.damping();
          free.run(2.0);
          c.expect("against no reach", (c.state.q - free.state.q).norm(), 1e-6, "rad");
        }
      }
    }
}

// Places a hundred metres away, and two places at once, each of great weight: the arm points at
// what it cannot reach, and stays between what it cannot have both.
TEST(Goals, UnreachableAndContradictory) {
  for (const gdd::GddSolver solver : kSolvers)
    for (const double timestep : {0.002, 0.01})
      for (const double weight : {1e2, 1e4, 1e6}) {
        const std::string name = ", weight " + std::to_string(static_cast<int>(weight));
        Course far("a place 100 m away" + name, with(arm(), timestep).build(), solver);
        far.state.q = Vector3(0.1, 0.5, 0.8);
        far.reach("hand", Vector3(0.0, 80.0, 60.0), weight);
        far.damping();
        far.run(3.0);
        far.expectCertified(far.isDefault() ? 0.01 : 1.0);
        if (far.isDefault()) far.expect("box of the solve", far.worstViolation, 1e-4, "N m");

        Course two("two places at once" + name, with(arm(), timestep).build(), solver);
        two.state.q = Vector3(0.1, 0.5, 0.8);
        two.reach("hand", Vector3(0.2, 0.2, -0.6), weight);
        two.reach("hand", Vector3(0.2, -0.2, -0.6), weight);
        two.damping();
        two.run(4.0);
        two.expectCertified(0.0);
        if (weight >= 1e4)
          two.expect("off the middle", (two.position("hand") - Vector3(0.2, 0, -0.6)).norm(), 1e-2,
                     "m");
      }
}

// Actuators of a thousandth of what is asked: all are at their bounds, and the robot does what is
// left. Counted: the share of controls at a bound.
TEST(Goals, AllActuatorsSaturated) {
  for (const gdd::GddSolver solver : kSolvers)
    for (const double timestep : {0.002, 0.01})
      for (const bool standing : {false, true}) {
        Course c(standing ? "humanoid of 1 mN m" : "arm of 1 mN m",
                 with(standing ? humanoid() : arm(), timestep).build(), solver);
        for (int i = 0; i < c.model.nv; ++i)
          if (c.model.dofs[i].actuated)
            c.controller.limits.lower[i] = -1e-3, c.controller.limits.upper[i] = 1e-3;
        c.mayGain = 1e-6;  // as of a Trial: these controls do less
        c.reach(standing ? "right_forearm" : "hand", Vector3(0.3, 0.2, standing ? 1.5 : 0.5), 1e4);
        c.posture(1e3);
        int bound = 0, driven = 0;
        for (int i = 0; i < static_cast<int>(1.0 / timestep); ++i) {
          if (!c.step()) break;
          for (int k = 0; k < c.model.nv; ++k) {
            if (!c.model.dofs[k].actuated) continue;
            ++driven;
            bound += std::abs(c.controller.control[k]) == 1e-3;
          }
        }
        EXPECT_GT(bound, driven / 3);
        c.expect("box of the solve", c.worstViolation, c.isDefault() ? 1e-9 : 1e-3, "N m");
        c.expect("fastest", c.fastest, standing ? 100.0 : 50.0, "rad/s");
        c.expectCertified(c.isDefault() ? 0.0 : 1.0);
      }
}

// Without actuators goals change nothing: the motion is that of a step without control.
TEST(Goals, NoActuators) {
  for (const gdd::GddSolver solver : kSolvers)
    for (const double timestep : {0.002, 0.01}) {
      Course c("humanoid without actuators", with(humanoid(), timestep).build(), solver);
      c.controller.limits.lower.setZero();
      c.controller.limits.upper.setZero();
      c.mayGain = 1e-6;
      c.reach("right_forearm", Vector3(0.3, 0.2, 1.5), 1e4);
      c.posture(1e3);
      Data data(c.model);
      State state(c.model);
      collision::SceneContacts contacts(c.model);
      double off = 0.0;
      for (int i = 0; i < static_cast<int>(1.0 / timestep); ++i) {
        State plain = c.state;
        ASSERT_EQ(step(c.model, c.input, plain, data, &contacts), SolveStatus::converged);
        if (!c.step()) break;
        off = std::max(off, (plain.v - c.state.v).cwiseAbs().maxCoeff());
        EXPECT_EQ(c.controller.control.cwiseAbs().maxCoeff(), 0.0);
      }
      c.expect("against a step without control", off, 1e-7, "rad/s");
    }
}

// The arm is straight and the place is on its line: no acceleration of its joints moves the hand
// there, at first. It bends by whatever is not exact, and comes.
TEST(Goals, AGoalInASingularDirection) {
  for (const gdd::GddSolver solver : kSolvers)
    for (const double timestep : {0.002, 0.01})
      for (const double bend : {0.0, 1e-9, 1e-3})
        for (const double weight : {1e3, 1e6}) {
          Course c("straight arm, bent by " + std::to_string(bend), with(arm(), timestep).build(),
                   solver);
          c.state.q = Vector3(0.0, bend, -2.0 * bend);
          c.reach("hand", Vector3(0.0, 0.0, -0.5), weight);
          c.damping();
          c.run(3.0);
          c.expectCertified(c.isDefault() ? 0.0 : 0.01);
          c.expect("box of the solve", c.worstViolation, 1e-5, "N m");
          c.expect("fastest", c.fastest, 50.0, "rad/s");
          if (bend > 1e-6) {
            c.expect("hand", (c.position("hand") - Vector3(0, 0, -0.5)).norm(), 2e-2, "m");
          } else if (bend == 0.0) {
            c.expect("off the line", c.position("hand").head<2>().norm(), 0.45, "m");
          }
        }
}

// A humanoid that is lifted and dropped in turn at every step: feet touch and leave each time.
TEST(Goals, ContactsMadeAndBrokenAtEveryStep) {
  for (const gdd::GddSolver solver : kSolvers)
    for (const double timestep : {0.002, 0.01}) {
      Course c("humanoid, shaken", with(humanoid(), timestep).build(), solver);
      c.reach("right_forearm", Vector3(0.3, -0.2, 1.2), 100.0);
      c.posture(1e3);
      const double weight = c.model.totalMass() * 9.81;
      int changes = 0, last = 0;
      const int steps = static_cast<int>(2.0 / timestep);
      for (int i = 0; i < steps; ++i) {
        // 25 g up and 25 g down in turn: at 2 ms 1 mm, more than the depth of the soles.
        c.input.tau[2] = i % 2 == 0 ? 25.0 * weight : -25.0 * weight;
        if (!c.step()) break;
        changes += c.data.stats.rows != last;
        last = c.data.stats.rows;
      }
      EXPECT_GT(changes, steps / 4);
      if (c.isDefault()) c.expect("box of the solve", c.worstViolation, 1e-4, "N m");
      c.expect("fastest", c.fastest, 100.0, "rad/s");
      c.expectCertified(c.isDefault() ? 0.01 : 0.1);
    }
}

// Warm starts that are random, far too large or not finite. The robot still stands at the end.
TEST(Goals, WarmStartsAreGuesses) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const gdd::GddSolver solver : kSolvers)
    for (const double timestep : {0.002, 0.01}) {
      Course c("humanoid, warm starts", with(humanoid(), timestep).build(), solver);
      c.reach("right_forearm", Vector3(0.3, -0.2, 1.2), 100.0);
      c.posture(1e3);
      c.mayRefuse = true;
      int wrong = 0, inA = 0;
      Random random(11);
      const double sizes[] = {1.0, 1e3, 1e8, kNan};
      const int steps = static_cast<int>(2.0 / timestep);
      for (int i = 0; i < steps; ++i) {
        if (i % 5 == 4) {
          WarmStart& warm = c.state.warmstart;
          const double size = sizes[(i / 5) % 4];
          VectorX* parts[] = {&warm.gddA, &warm.multipliers, &warm.control, &warm.a};
          for (int k = 0; k < 4; ++k)
            if ((i / 20) % 5 == k || (i / 20) % 5 == 4)
              *parts[k] = size * random.vector(c.model.nv, 1.0);
          const int part = (i / 20) % 5, unread = c.isDefault() ? 1 : 2;  // multipliers, control
          wrong += std::isnan(size) && part != unread && part != 3;
          inA += std::isnan(size) && part == 3;
          for (BreakpointKey& breakpoint : warm.breakpoints)
            if (random.chance(0.5))
              breakpoint.row.first = random.index(40), breakpoint.index = random.index(3);
        }
        if (!c.step()) break;
      }
      // A fifth of the starts is wrong; solver 1 may lose as many certificates, and is clamped.
      if (c.isDefault()) c.expect("box of the solve", c.worstViolation, 1e-4, "N m");
      c.expect("pelvis", c.position("pelvis").z() - 0.9, 0.1, "m");
      c.expectCertified(c.isDefault() ? 0.02 : 0.2);
      // What is not finite is refused and counted; `a` is read where solver 1 is clamped alone.
      EXPECT_GT(wrong, 5);
      EXPECT_TRUE(c.refused >= wrong && c.refused <= wrong + (c.isDefault() ? 0 : inA));
    }
}

TEST(Goals, SameBits) {
  expectSameBits([] {
    Course c("arm", arm().build(), gdd::GddSolver::activeSet);
    c.reach("hand", Vector3(0.2, 0.3, -0.6), 1e8);
    c.damping();
    c.run(0.3);
    return hash(c.state);
  });
}

}  // namespace
}  // namespace softgauss::test
