// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The solvers of the goal directed problem, behind one face. To add one: a line in solverNames()
/// and one in makeSolver().

#include <memory>
#include <string>
#include <vector>

#include "softgauss/gdd/active_set.hpp"
#include "softgauss/gdd/augmented_lagrangian.hpp"

namespace softgauss::app {

/// The name of solver 1.
inline constexpr const char* kAugmentedLagrangian = "augmented-lagrangian";

class SolverUnderTest {
 public:
  explicit SolverUnderTest(std::string name) : name_(std::move(name)) {}
  virtual ~SolverUnderTest() = default;
  const std::string& name() const { return name_; }  ///< as --gdd-solver has it

  virtual gdd::GddReport solve(const Model& model, gdd::GoalCost& cost,
                               const gdd::ControlLimits& limits, Data& data,
                               const WarmStart& warm) = 0;
  virtual const VectorX& acceleration() const = 0;
  virtual const VectorX& force() const = 0;  ///< the control before it is clamped
  virtual void keepWarmStart(WarmStart& warm) const = 0;

 private:
  std::string name_;
};

std::vector<std::string> solverNames();
/// `name` is one of solverNames().
std::unique_ptr<SolverUnderTest> makeSolver(const std::string& name, const Model& model);

}  // namespace softgauss::app
