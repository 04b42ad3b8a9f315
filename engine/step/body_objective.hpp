// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The objective of (1.1) on bodies, in O(n + rows): two sweeps for each gradient and ray, and P⁻¹
/// of (1.3) by articulated bodies. Neither M, J nor P is made. It is a sum over the islands of the
/// rows (tree_islands.hpp), each of which is an objective of its own.

#include <vector>

#include "softgauss/engine/constraints/constraints.hpp"

namespace softgauss {

/// Memory of it.
struct BodySolution {
  ArticulatedFactor massFactor;            ///< of M̂, or with a diagonal that follows the solve
  bool massFactored = false;               ///< massFactor is that of the present M̂, alone
  ArticulatedFactor factor;                ///< of P = M̂ + Jᵀ∇²s J
  std::vector<Motion> A;                   ///< (bodies) by the present a
  std::vector<Motion> ray;                 ///< (bodies) by the search direction d
  std::vector<Force> IA, Iray;             ///< (bodies) I A and that of the ray
  std::vector<Force> force;                ///< (bodies) scratch
  VectorX diagonal;                        ///< (nv) armature and MassMatrix::added
  VectorX divided;                         ///< (nv) scratch of solveMass()
  std::vector<std::pair<int, int>> pairs;  ///< scratch: bodies that rows couple
  /// Those for which islands and factor are, and who was asleep.
  std::vector<std::pair<int, int>> lastPairs;
  std::vector<std::uint8_t> lastStill;
  std::vector<std::pair<int, int>> tied;  ///< bodies that are of one island besides: by goals
  TreeIslands islands;                    ///< of the present rows

  BodySolution() = default;
  explicit BodySolution(const Model& model);
  /// Finds the islands of the rows and of what is tied, and readies them and the factor for each of
  /// these. `trees`: those of the stages.
  void divide(const Model& model, const MassMatrix& inertia, const TreeSelection& trees,
              Constraints& rows);
  /// A and I A of the joint acceleration a.
  void moveTo(const Model& model, const Kinematics& k, const MassMatrix& inertia, const VectorX& a);
  /// The same of these bodies, where the diagonal is known.
  void moveTo(const Model& model, const Kinematics& k, const MassMatrix& inertia, Segments bodies,
              const VectorX& a);
  /// y ← M̂ x.
  void multiplyMass(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                    const VectorX& x, VectorX& y);
  /// tau ← tau − M̂ a + Jᵀf of the present a and f.
  void addForces(const Model& model, const Kinematics& k, const Constraints& rows, const VectorX& a,
                 VectorX& tau);
  /// The same of these bodies and their joints; the rows that are selected are theirs.
  void addForces(const Model& model, const Kinematics& k, const Constraints& rows, Segments bodies,
                 Segments dofs, const VectorX& a, VectorX& tau);

 private:
  void findDiagonal(const Model& model, const MassMatrix& inertia, Segments dofs);
};

struct Data;

/// data.forward.scale ← what forces are told by: the largest of the smooth ones of these dofs, in
/// their common unit, counts 1 at most.
/// Returns that largest, or 1.
double setForceScale(Segments dofs, Data& data);

/// A NewtonObjective, of one island of those that BodySolution::divide() has found; it selects that
/// island's rows. Reads the stages of `data` up to constraints; a and its scratch vectors are those
/// of Data::forward, of which it touches what is of the island.
class BodyObjective {
 public:
  BodyObjective(const Model& model, Data& data, int island);

  int rowCount() const { return rows_.selectedRows(); }
  /// Moves to a; returns the cost.
  double moveTo(const VectorX& a);
  double gradient(VectorX& g);
  bool cellChanged() const { return changed_; }
  bool factorize();
  /// The joint whose pivot was not positive.
  int failedJoint() const { return s_.factor.failedJoint(); }
  double direction(const VectorX& g, VectorX& d);
  double unit() const { return unit_; }
  bool staysInCell() const { return newFactor_ && rows_.staysInCell(); }
  Jet along(double alpha) const;
  void advance(const VectorX& d, double alpha);

 private:
  const Model& model_;
  Data& data_;
  int island_;
  Segments bodies_, dofs_;
  Constraints& rows_;
  BodySolution& s_;
  bool changed_ = true;
  bool fresh_ = false;
  bool newFactor_ = false;  ///< no step has been taken with it
  double unit_ = 1.0;
  double slope_ = 0.0, curvature_ = 0.0;
};

}  // namespace softgauss
