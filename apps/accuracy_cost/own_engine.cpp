// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/accuracy_cost/engine_under_test.hpp"

namespace softgauss::app {
namespace {

class OwnEngine final : public EngineUnderTest {
 public:
  OwnEngine(const Problem& problem, const Method& method, double h)
      : warmStart_(method.warmStart),
        model_(build(problem, method, h)),
        contacts_(model_),
        data_(model_),
        state_(model_) {
    if (problem.softFriction) input_.controlled = allTrees(model_, kControlledSoft);
  }

  const Model& model() const override { return model_; }
  const State& state() override { return state_; }
  double deepestOverlap() const override { return data_.stats.maxPenetration; }

  void start(const State& state) override {
    state_.q = state.q;
    state_.v = state.v;
    state_.time = state.time;
    const State fresh(model_);
    state_.warmstart = fresh.warmstart;
    state_.forgetLastStep();
  }

  bool advance(const VectorX& tau, int steps) override {
    input_.tau = tau;
    for (int i = 0; i < steps; ++i) {
      if (!warmStart_) state_.warmstart.valid = false;
      if (isRefused(step(model_, input_, state_, data_, &contacts_))) return false;
    }
    return true;
  }

 private:
  static Model build(const Problem& problem, const Method& method, double h) {
    ModelBuilder builder = problem.build();
    builder.options.timestep = h;
    builder.options.cone = method.cone;
    if (method.tolerance > 0.0) builder.options.tolerance = method.tolerance;
    const bool likeMujoco = method.integrator == kMujocoEuler;
    if (likeMujoco) builder.options.implicitInSolve = false;
    builder.options.integrator =
        likeMujoco ? Integrator::semiImplicitEuler : integratorFromName(method.integrator).value();
    builder.options.stepDoubling = method.doubling;
    if (method.integrationTolerance > 0.0)
      builder.options.integrationTolerance = method.integrationTolerance;
    return builder.build();
  }

  bool warmStart_;
  Model model_;
  collision::SceneContacts contacts_;
  Data data_;
  State state_;
  Input input_;
};

/// A method with other tolerances of the solver, without warm start, and with elliptic cones.
void addVariants(const Method& plain, const std::string& name,
                 std::initializer_list<double> tolerances, std::vector<Method>& methods) {
  for (const double tolerance : tolerances) {
    Method loose = plain;
    loose.tolerance = tolerance;
    loose.label = fmt::format("{} with solver to {:.0e}", name, tolerance);
    methods.push_back(std::move(loose));
  }
  Method cold = plain;
  cold.warmStart = false;
  cold.label = name + " without warm start";
  methods.push_back(std::move(cold));
  Method elliptic = plain;
  elliptic.cone = Cone::elliptic;
  elliptic.label = name + " with elliptic cones";
  methods.push_back(std::move(elliptic));
}

/// Ours without error control, the default first.
std::vector<Method> fixedStepMethods() {
  return {{"softgauss", "leapfrog", "leapfrog"},
          {"softgauss", "semi-implicit-euler", "semi-implicit Euler"},
          {"softgauss", kMujocoEuler, "semi-implicit Euler as MuJoCo's"},
          {"softgauss", "implicit", "implicit in velocity"},
          {"softgauss", "implicit-midpoint", "implicit midpoint"},
          {"softgauss", "runge-kutta-4", "Runge-Kutta 4"}};
}

}  // namespace

std::unique_ptr<EngineUnderTest> makeEngine(const Problem& problem, const Method& method,
                                            double h) {
  if (method.engine == "mujoco") return makeMujoco(problem, method, h);
  return std::make_unique<OwnEngine>(problem, method, h);
}

References referencesFor(const Problem& problem, const Method& method) {
  References r;
  r.fine = r.coarse = {"softgauss", "runge-kutta-4", "reference"};
  if (!problem.contact) return r;
  if (method.engine == "mujoco") {
    r.fine = r.coarse = {"mujoco", "RK4", "reference"};
    return r;
  }
  r.fine = r.coarse = {"softgauss", "dormand-prince", "reference", method.cone};
  r.fine.integrationTolerance = problem.referenceTolerance;
  r.coarse.integrationTolerance = 100.0 * problem.referenceTolerance;
  r.fineSteps = 64, r.coarseSteps = 32;
  return r;
}

std::vector<Method> solverVariants(const Problem& problem) {
  std::vector<Method> methods;
  if (!problem.contact) return methods;
  Method adaptive{"softgauss", "dormand-prince", ""};
  adaptive.integrationTolerance = 1e-8;
  addVariants(adaptive, "Dormand-Prince to 1e-08", {1e-6, 1e-3}, methods);
  addVariants({"softgauss", "implicit-midpoint", ""}, "implicit midpoint", {1e-6, 1e-3}, methods);
  for (Method& method : mujocoVariants(problem)) methods.push_back(std::move(method));
  return methods;
}

std::vector<Method> fineMethods() {
  std::vector<Method> methods = fixedStepMethods();
  const Method plain = methods.front();
  for (int half = -4; half >= -22; --half) {
    Method adaptive{"softgauss", "dormand-prince", ""};
    adaptive.integrationTolerance = std::pow(10.0, 0.5 * half);
    adaptive.label = fmt::format("Dormand-Prince to {:.1e}", adaptive.integrationTolerance);
    if (half >= -14) {
      Method doubled = plain;
      doubled.doubling = true;
      doubled.integrationTolerance = adaptive.integrationTolerance;
      doubled.label =
          fmt::format("leapfrog with step doubling to {:.1e}", doubled.integrationTolerance);
      methods.push_back(std::move(doubled));
    }
    methods.push_back(std::move(adaptive));
  }
  return methods;
}

std::vector<Method> methodsFor(const Problem& problem) {
  std::vector<Method> methods = fixedStepMethods();
  const Method plain = methods.front();
  Method adaptive{"softgauss", "dormand-prince", ""};
  for (const double tolerance : {1e-5, 1e-8, 1e-11}) {
    adaptive.integrationTolerance = tolerance;
    adaptive.label = fmt::format("Dormand-Prince to {:.0e}", tolerance);
    methods.push_back(adaptive);
  }
  for (const double tolerance : {1e-4, 1e-6}) {
    Method doubled = plain;
    doubled.doubling = true;
    doubled.integrationTolerance = tolerance;
    doubled.label = fmt::format("leapfrog with step doubling to {:.0e}", tolerance);
    methods.push_back(doubled);
  }
  if (problem.contact) addVariants(plain, "leapfrog", {1e-6, 1e-3}, methods);
  for (Method& method : mujocoMethods(problem)) methods.push_back(std::move(method));
  return methods;
}

}  // namespace softgauss::app
