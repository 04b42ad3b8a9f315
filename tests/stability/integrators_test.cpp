// SPDX-License-Identifier: Apache-2.0
/// The cases of all families by every integrator. One holds a case where its figure is within its
/// bound and no step was given up; or it tells that it cannot: a step that is refused or ends
/// short, a part that was taken in spite of its estimate. None fails in silence.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "tests/stability/energy_watch.hpp"
#include "tests/stability/scenes.hpp"

namespace softgauss::test {
namespace {

struct Method {
  const char* name;
  Integrator integrator;
  bool doubling;
};
/// But for semi-implicit Euler, which takes Coriolis forces of the step's start as MuJoCo's does:
/// of what it gains by that a run is warned (io/step_warnings.cpp).
constexpr Method kMethods[] = {{"leapfrog", Integrator::leapfrog, false},
                               {"implicit", Integrator::implicit, false},
                               {"implicit-midpoint", Integrator::implicitMidpoint, false},
                               {"runge-kutta-4", Integrator::rungeKutta4, false},
                               {"dormand-prince", Integrator::dormandPrince, false},
                               {"step doubling", Integrator::leapfrog, true}};
constexpr std::size_t kCount = std::size(kMethods);

/// A scene, where it begins, and what is measured at its end.
struct Scene {
  std::string name;
  std::function<Model(double h)> make = {};
  std::function<void(State&)> begin = [](State&) {};
  double seconds = 1.0;
  std::function<double(const Model&, State&, Data&)> figure = {};
  std::function<double(double h)> bound = {};
  /// Energy that the integrator may be off by, of this scale [J].
  double scale = 1.0;
  bool contacts = false;
};

enum class Verdict : std::uint8_t { holds, tells, fails };

Verdict run(const Scene& scene, const Method& method, double h, Cone cone) {
  Model model = scene.make(h);
  model.options.integrator = method.integrator;
  model.options.stepDoubling = method.doubling;
  model.options.cone = cone;
  State state(model);
  scene.begin(state);
  Data data(model);
  collision::SceneContacts contacts(model);
  EnergyWatch watch(model);  // of q and v of one instant
  const auto energy = [&] { return watch.energy(state); };
  const double E0 = energy();
  double gained = 0.0;
  int told = 0;
  bool refused = false;
  for (int i = static_cast<int>(std::round(scene.seconds / h)); i > 0 && !refused; --i) {
    const SolveStatus status = step(model, {}, state, data, &contacts);
    const StepStats& s = data.stats;
    told += status != SolveStatus::converged || s.minimumStepsAccepted + s.abandonedTrees > 0;
    refused = status == SolveStatus::notFinite || status == SolveStatus::integratorDiverged;
    gained = std::max(gained, energy() - E0);
  }
  const double figure = refused ? kInfinity : std::abs(scene.figure(model, state, data));
  // What is implicit in velocity is of order 1, and off by what the weight does in half a step.
  const bool first = method.integrator == Integrator::implicit;
  const double mayGain = (first ? std::max(25.0 * h, 0.05) : 0.02) * scene.scale;
  const bool held = figure <= scene.bound(h) && gained <= mayGain;
  EXPECT_TRUE(told > 0 || gained <= mayGain) << scene.name << ", " << method.name << ", h " << h;
  const Verdict verdict = held ? Verdict::holds : told > 0 ? Verdict::tells : Verdict::fails;
  std::printf("  %-26s %-20s h %4.1f ms %-5s %10.3g of %10.3g, gains %9.2g of %8.2g J, told %d%s\n",
              scene.name.c_str(), method.name, 1e3 * h, cone == Cone::elliptic ? "cone" : "pyr.",
              figure, scene.bound(h), gained, mayGain, told,
              verdict == Verdict::holds   ? ""
              : verdict == Verdict::tells ? ", tells"
                                          : ", FAILS");
  return verdict;
}

double fastest(const Model&, State& s, Data&) { return s.v.cwiseAbs().maxCoeff(); }

double inertiaOfLink() { return 0.01 + (0.04 + 0.0016) / 12.0; }  // of levelArm()'s last hinge

std::vector<Scene> scenes() {
  std::vector<Scene> all;
  const auto still = [](double bound) { return [bound](double) { return bound; }; };
  {
    Scene s{"1000 kg on 1 kg"};
    s.make = [](double h) { return with(tower({1.0, 1000.0}), h).build(); };
    s.figure = [](const Model&, State&, Data& d) { return d.stats.maxPenetration; };
    s.bound = still(2e-3);
    s.scale = 3000.0, s.contacts = true;
    all.push_back(s);
  }
  {
    Scene s{"box lands turned"};
    s.make = [](double h) {
      ModelBuilder b = with(boxOnPlane(Vector3(0.1, 0.08, 0.05), 1.0, 0.8), h);
      b.X_WRoot.p.z() = 0.3;
      return b.build();
    };
    s.begin = [](State& x) { x.v.segment<3>(3) = Vector3(1, 2, 3); };
    s.seconds = 3.0;
    s.figure = fastest;
    s.bound = still(1e-3);
    s.scale = 3.0, s.contacts = true;
    all.push_back(s);
  }
  {
    Scene s{"bounces on a spring"};
    s.make = [](double h) {
      ModelBuilder b = with(sphereOnPlane(0.1, 1.0, 0.5), h);
      b.X_WRoot.p.z() = 0.6;
      Model m = b.build();
      for (Geometry& g : m.geometries)
        if (g.body != 0) g.material.spring = ContactSpring{2500.0, 0.0, 0.0, 0.1222};
      return m;
    };
    s.seconds = 6.0;
    s.figure = fastest;
    s.bound = still(1e-3);
    s.scale = 5.0, s.contacts = true;
    all.push_back(s);
  }
  {
    Scene s{"limit hit at 100 rad/s"};
    s.make = [](double h) {
      ModelBuilder b = with(pendulum(0.5, 1.0, 0.05), h);
      JointSpec& hinge = *b.findJoint("hinge");
      hinge.type = JointType::revolute, hinge.lower = -1.0, hinge.upper = 1.0;
      return b.build();
    };
    s.begin = [](State& x) { x.v[0] = 100.0; };
    s.seconds = 3.0;
    s.figure = [](const Model&, State& x, Data&) { return std::abs(x.q[0]); };
    s.bound = still(1.01);
    s.scale = 1250.0;
    all.push_back(s);
  }
  for (const double ratio : {1.0, 1e4}) {
    Scene s{ratio > 10.0 ? "h d/I = 10⁴" : "h d/I = 1"};
    s.make = [ratio](double h) {
      ModelBuilder b = with(levelArm(), h);
      for (const char* hinge : {"hinge0", "hinge1", "hinge2"})
        b.findJoint(hinge)->damping = ratio * inertiaOfLink() / h;
      return b.build();
    };
    s.begin = [](State& x) { x.v.setConstant(10.0); };
    s.figure = fastest;
    s.bound = [ratio](double h) {  // the creep of 3 kg at 0.3 m, or 10 rad/s
      return std::min(10.0, 2.0 * 3.0 * 9.81 * 0.3 * h / (ratio * inertiaOfLink()));
    };
    s.scale = 30.0;
    all.push_back(s);
  }
  {
    Scene s{"springs of h/10"};
    s.make = [](double h) {
      Model m = with(levelArm(), h).build();
      for (Dof& dof : m.dofs)
        dof.stiffness = inertiaOfLink() * std::pow(2.0 * M_PI * 10.0 / h, 2.0);
      return m;
    };
    s.begin = [](State& x) { x.v.setConstant(5.0); };
    s.figure = fastest;
    s.bound = still(10.0);  // undamped: no faster than it began, twice
    s.scale = 10.0;
    all.push_back(s);
  }
  {
    Scene s{"dry friction"};
    s.make = [](double h) {
      ModelBuilder b("held");
      b.link(emptyLink("world")).link(boxLink("arm", 1.0, {0.25, 0.02, 0.02}, {0.25, 0, 0}));
      JointSpec hinge =
          jointSpec("hinge", JointType::continuous, "world", "arm", {}, Vector3::UnitY());
      hinge.dryFriction = 3.0;
      b.joint(hinge);
      return with(b, h).build();
    };
    s.seconds = 3.0;
    s.figure = [](const Model&, State& x, Data&) { return std::abs(x.q[0]); };
    s.bound = still(1e-6);
    all.push_back(s);
  }
  {
    Scene s{"free body at 50 rad/s"};
    s.make = [](double h) {
      LinkSpec link = emptyLink("body");
      link.mass = 1.0;
      link.I_Lcm = Vector3(0.01, 0.02, 0.025).asDiagonal();
      ModelBuilder b = with(freeBody(link), h);
      b.options.gravity.setZero();
      return b.build();
    };
    s.begin = [](State& x) { x.v.tail<3>() = 50.0 * Vector3(0.1, 1.0, 0.1).normalized(); };
    s.figure = [](const Model& m, State& x, Data& d) {
      computeKinematics(m, x, d.kinematics);
      return computeEnergy(m, d.kinematics, x.q, x.v).kinetic / 24.95 - 1.0;
    };
    s.bound = still(0.02);
    s.scale = 25.0;
    all.push_back(s);
  }
  {
    Scene s{"chain of 3"};
    s.make = [](double h) { return with(levelArm(), h).build(); };
    s.seconds = 3.0;
    s.figure = [](const Model& m, State& x, Data& d) {
      computeKinematics(m, x, d.kinematics);
      return computeEnergy(m, d.kinematics, x.q, x.v).total() / 8.8;  // 3 kg × g × 0.3 m
    };
    s.bound = [](double h) { return std::max(25.0 * h, 0.05); };
    s.scale = 8.8;
    all.push_back(s);
  }
  return all;
}

/// What a method neither holds nor tells, for it is no error of a step: it only loses energy. The
/// midpoint rule turns the sign of what is damped at once, and takes hardly any of it; what is
/// implicit in velocity damps motion, of order 1.
bool onlyLoses(const Scene& scene, const Method& method, double h) {
  if (method.integrator == Integrator::implicitMidpoint) return scene.name == "h d/I = 10⁴";
  if (method.integrator != Integrator::implicit) return false;
  return scene.name == "free body at 50 rad/s" || (scene.name == "chain of 3" && h > 0.002);
}

/// Every method at these steps.
void expectHeldOrTold(const std::vector<double>& steps) {
  for (const Scene& scene : scenes())
    for (std::size_t m = 0; m < kCount; ++m)
      for (const double h : steps)
        for (const Cone cone : kCones) {
          if (cone == Cone::elliptic && !scene.contacts) continue;
          const Verdict verdict = run(scene, kMethods[m], h, cone);
          const bool loses = onlyLoses(scene, kMethods[m], h);
          EXPECT_TRUE(verdict != Verdict::fails || loses)
              << scene.name << ", " << kMethods[m].name << ", h " << h;
          // What is listed is so, or it is taken off the list.
          EXPECT_FALSE(verdict == Verdict::holds && loses && h == 0.002)
              << scene.name << ", " << kMethods[m].name;
        }
}

TEST(Integrators, HoldOrTell) { expectHeldOrTold({0.002}); }
TEST(Integrators, HoldOrTellAtEveryStepLong) { expectHeldOrTold({0.0005, 0.005, 0.01, 0.02}); }

}  // namespace
}  // namespace softgauss::test
