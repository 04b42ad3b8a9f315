// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Engines behind one call, so that they run the same problems alternately in one process.

#include <memory>
#include <string>
#include <vector>

#include "apps/accuracy_cost/problem.hpp"

namespace softgauss::app {

/// Integrator of ours: (7.1) without its middle of the step, as MuJoCo's Euler.
inline constexpr const char* kMujocoEuler = "mujoco-euler";

/// One curve of a picture: everything but the step size.
struct Method {
  std::string engine;      ///< "softgauss" or "mujoco"
  std::string integrator;  ///< its name there
  std::string label;       ///< of the curve; it has no comma, for the table
  Cone cone = Cone::pyramidal;
  double tolerance = 0.0;             ///< of the solver; 0: the engine's default
  double integrationTolerance = 0.0;  ///< of error control; 0: none
  bool warmStart = true;
  bool doubling = false;  ///< Options::stepDoubling

  bool operator==(const Method&) const = default;
  /// Not the solver, start and cones that there are by default.
  bool variesSolver() const { return tolerance > 0.0 || !warmStart || cone != Cone::pyramidal; }
};

/// A problem in an engine with a method and a step size.
class EngineUnderTest {
 public:
  virtual ~EngineUnderTest() = default;
  virtual const Model& model() const = 0;
  /// Begins there, cold.
  virtual void start(const State& state) = 0;
  /// Takes so many steps under τ (nv); empty: none. False where the state is no longer finite.
  virtual bool advance(const VectorX& tau, int steps) = 0;
  virtual const State& state() = 0;
  /// Deepest overlap of a contact that the last step has seen [m], ≥ 0.
  virtual double deepestOverlap() const = 0;
};

/// MuJoCo's methods, none where it was not found when this was built.
std::vector<Method> mujocoMethods(const Problem& problem);
/// Its Euler with other tolerances of its solver, 1e-8 by default.
std::vector<Method> mujocoVariants(const Problem& problem);
std::unique_ptr<EngineUnderTest> makeMujoco(const Problem& problem, const Method& method, double h);

/// Of the engine; `h` divides kPeriod.
std::unique_ptr<EngineUnderTest> makeEngine(const Problem& problem, const Method& method, double h);

/// What can be compared for a problem: ours, then MuJoCo's where it was found.
std::vector<Method> methodsFor(const Problem& problem);

/// With contact: other solver tolerances, starts and cones of three of these, which methodsFor()
/// has for the leapfrog alone. They are measured at kSolverSteps, and not drawn.
std::vector<Method> solverVariants(const Problem& problem);
inline constexpr int kSolverSteps = 16;  // in a period: 2 ms

/// Ours alone, for a fine search: tolerances of error control by half decades.
std::vector<Method> fineMethods();

/// What a method is compared with, where no closed form is: the most accurate method of the same
/// model, and one that tells how good it is. Without contact that is ours for every engine; with
/// contact each engine and each kind of cone is a model of its own. There ours is led by its error,
/// for forces jump where contacts begin and end.
struct References {
  Method fine, coarse;
  int fineSteps = 1024, coarseSteps = 512;  ///< in a period

  bool operator==(const References&) const = default;
};
References referencesFor(const Problem& problem, const Method& method);

}  // namespace softgauss::app
