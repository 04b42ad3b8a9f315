// SPDX-License-Identifier: Apache-2.0
#include "apps/gdd_benchmark/solver_under_test.hpp"

#include <stdexcept>

namespace softgauss::app {
namespace {

constexpr const char* kActiveSet = "active-set";

template <class Solver>
class TestedSolver final : public SolverUnderTest {
 public:
  TestedSolver(std::string name, const Model& model)
      : SolverUnderTest(std::move(name)), solver_(model) {}
  gdd::GddReport solve(const Model& model, gdd::GoalCost& cost, const gdd::ControlLimits& limits,
                       Data& data, const WarmStart& warm) override {
    return solver_.solve(model, cost, limits, data, warm);
  }
  const VectorX& acceleration() const override { return solver_.acceleration(); }
  const VectorX& force() const override { return solver_.force(); }
  void keepWarmStart(WarmStart& warm) const override { solver_.keepWarmStart(warm); }

 private:
  Solver solver_;
};

}  // namespace

std::vector<std::string> solverNames() { return {kAugmentedLagrangian, kActiveSet}; }

std::unique_ptr<SolverUnderTest> makeSolver(const std::string& name, const Model& model) {
  if (name == kAugmentedLagrangian)
    return std::make_unique<TestedSolver<gdd::AugmentedLagrangian>>(name, model);
  if (name == kActiveSet) return std::make_unique<TestedSolver<gdd::ActiveSet>>(name, model);
  throw std::logic_error("no solver '" + name + "'");
}

}  // namespace softgauss::app
