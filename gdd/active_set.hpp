// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Solver 2: a feasible path over the controls, by an active set of bounds and of rows at
/// breakpoints.
///
/// The forward form (7) of the problem (10.7):
///   min_u  F(u) = ½ (B u)ᵀ R (B u) + ℓ(f(u))    subject to   lower ≤ u ≤ upper
/// f = g⁻¹ is forward dynamics, B holds what the actuators pull (8.2). g_z = 0 holds by
/// construction, and a = f(u) is exact at all times. In a cell f is affine, F quadratic and convex:
///   S = ∂a/∂u = P⁻¹B,   q = ∂F/∂u = Bᵀ(R B u + P⁻¹∇ℓ),   K = ∂²F/∂u² = BᵀR B + Sᵀ∇²ℓ S
/// Each iteration minimises that quadratic within the limits, and, for rows held at their
/// breakpoints, on their side of it (quadratic_program.hpp), then follows the exact path f(u + t p)
/// through as many cells as descend (forward_path.hpp). It ends where every cell that meets at the
/// point promises nothing: all of them at once where the multipliers say so (10.10), one by one
/// otherwise.
///
/// Solves for the trees that are active in the data (Data::active), with the rows and the cost that
/// are selected: all, or an island (goal_islands.hpp). Vectors that come out are of their dofs, and
/// zero elsewhere.
///
/// Needs rows that are piecewise quadratic: no elliptic cones.

#include <cstdint>
#include <optional>
#include <vector>

#include "softgauss/gdd/cell_response.hpp"
#include "softgauss/gdd/cost.hpp"
#include "softgauss/gdd/deadline.hpp"
#include "softgauss/gdd/forward_path.hpp"
#include "softgauss/gdd/problem.hpp"
#include "softgauss/gdd/quadratic_program.hpp"
#include "softgauss/gdd/report.hpp"

namespace softgauss::gdd {

struct ActiveSetOptions {
  double tolerance = 1e-12;  ///< of the decrease still promised, over the objective
  int maxIterations = 100;
  Deadline deadline;       ///< past it, as past maxIterations
  int maxPatternRows = 6;  ///< dependent rows at their breakpoints of which all 2^n cells are tried
  /// A search for a better minimum follows the last one after 1, 2, 4 … solves, as many as this at
  /// most; after 1 again when it has found one. 0: none.
  int longestSearchWait = 32;
};

class ActiveSet {
 public:
  explicit ActiveSet(const Model& model);

  ActiveSetOptions options;

  /// Makes room for solves like the last one whose paths meet no more breakpoints than this.
  void reserve(int crossings);

  /// Reads the stages of `data` up to the rows and leaves the rows evaluated at the result; sets
  /// the applied force to the control found.
  GddReport solve(const Model& model, GoalCost& cost, const ControlLimits& limits, Data& data,
                  const WarmStart& warm);
  /// Writes the solution where the next solve starts from.
  void keepWarmStart(WarmStart& warm) const;

  /// After GddStatus::notFinite: the first dof whose force is not finite, or −1. After badLimits:
  /// the coordinate whose bounds are none.
  int badDof() const { return badDof_; }
  const VectorX& acceleration() const { return path_.a; }
  const VectorX& force() const { return force_; }  ///< B u, within the limits (nv)
  /// Whether a is f(u) but for residual(), which is rounding.
  bool isExact() const { return exact_; }
  const VectorX& residual() const { return residual_; }  ///< B u − g(a) (nv)

 private:
  enum class Next { done, cell, undecided };
  /// Paths that may cross a row freely. After that the program keeps it in its cell: where many
  /// rows meet, paths would else go back and forth between the same cells, ever shorter.
  static constexpr int kMaxFreeCrossings = 2;
  struct Solution {
    VectorX a, u;
    std::vector<BreakpointKey> breakpoints;
    GddReport report;
  };

  GddStatus start(const Model& model, const GoalCost& cost, const ControlLimits& limits, Data& data,
                  const WarmStart& warm);
  void chooseStart(const Model& model, const GoalCost& cost, Data& data);
  double moveTo(const Model& model, const GoalCost& cost, const VectorX* guess, Data& data);
  double moveAlongPath(const GoalCost& cost, const VectorX& a, Data& data);
  bool setInertia(const GoalCost& cost, const Data& data);
  void computeEffortSlope();
  double effort() const;
  double objective() const { return effort() + path_.value + forces_.value(); }  ///< F
  void computeResidual(const Data& data);
  bool enterCell(const GoalCost& cost, Data& data);
  bool knowsRowsAtKnots() const;
  void evaluateCost(const GoalCost& cost, const Data& data);
  void evaluateForces(Data& data);
  const VectorX& costSlope(Data& data);
  bool computeGradient(Data& data);
  double solveProgram();
  bool isRounding(const Data& data);
  PathEnd followPath(const GoalCost& cost, Data& data);
  Next tryNeighbourCell(Data& data);
  std::optional<GddStatus> descend(const GoalCost& cost, double wanted, Data& data);
  bool startAgain(const Model& model, const GoalCost& cost, const ControlLimits& limits,
                  Data& data);
  void finish(const Model& model, const ControlLimits& limits, const GoalCost& cost, Data& data);

  Segments dofs_;                     ///< that are solved for
  std::size_t tree_ = 0, trees_ = 0;  ///< the first tree of these; trees of the model
  CellResponse cell_;
  QuadraticProgram program_;
  ForwardPath path_;                  ///< holds a and the rows at their breakpoints
  ContactForceTerms forces_;          ///< ℓ_f, which path_ is without
  VectorX costSlope_;                 ///< ∇ℓ with that of ℓ_f (nv)
  std::vector<std::uint64_t> tried_;  ///< patterns of cells here that promise nothing
  VectorX u_, best_, lower_, upper_, stepLower_, stepUpper_;  ///< (columns of B)
  std::vector<int> constrained_;            ///< entries of path_.held that the program knows
  std::vector<int> atBreakpoint_;           ///< entries of path_.held that are at breakpoints
  std::vector<BreakpointKey> breakpoints_;  ///< at which the solution has rows
  VectorX distances_;
  VectorX gradient_;       ///< q
  RowMajorMatrixX sides_;  ///< a row for each row held
  VectorX effortSlope_;    ///< of the control cost in u
  VectorX givenSlope_;     ///< the same at u = 0: BᵀR (given force − ĝ)
  double givenEffort_ = 0.0;
  VectorX force_;  ///< B u (nv)
  VectorX Ma_, adjoint_, residual_, rate_;
  double merit_ = 0.0;     ///< size of the objective
  double constant_ = 0.0;  ///< in it, of functions: what they are worth whatever is done
  bool known_ = false;     ///< started from a last step
  bool ready_ = false;     ///< R is that of this solve
  bool entered_ = false;   ///< the response is that of the cell at a
  bool exact_ = false;     ///< isExact()
  GddReport report_;
  Solution first_;      ///< while another is looked for
  int searchAge_ = 0;   ///< WarmStart::gddSearchAge
  int searchWait_ = 1;  ///< WarmStart::gddSearchWait
  int badDof_ = -1;
};

}  // namespace softgauss::gdd
