// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Mass matrix by the composite-rigid-body algorithm (Featherstone 2008, section 6.2).
///
///   M_ij = S_iᵀ I^c_b(i) S_j  for j an ancestor of i (or i itself),  + armature on the diagonal
///   (2.3)
///
/// I^c_b is the inertia of body b and everything that hangs from it, in world axes about O.

#include <vector>

#include "softgauss/engine/dynamics/kinematics.hpp"
#include "softgauss/engine/dynamics/tree_matrix.hpp"

namespace softgauss {

/// Stage written by computeMassMatrix().
struct MassMatrix {
  std::vector<Inertia> body;       ///< (bodies) inertia of each body alone, about O
  std::vector<Inertia> composite;  ///< (bodies) of its subtree
  TreeSparsity sparsity;
  TreeMatrix M;  ///< (nv × nv); off its diagonal where `whole`
  bool whole = false;
  VectorX motionScale;  ///< (nv) 1/√M_ii
  VectorX added;        ///< (nv) what implicit forces add to the diagonal (implicit_forces.hpp)
  TreeMatrix Mhat;      ///< M + diag(added), where anyAdded; as whole as M
  bool anyAdded = false;
  VectorX forceScale;  ///< (nv) 1/√M̂_ii: forces so scaled share one unit

  /// The inertia M̂ that the step solves with.
  const TreeMatrix& hat() const { return anyAdded ? Mhat : M; }

  MassMatrix() = default;
  explicit MassMatrix(const Model& model);
  MassMatrix(const MassMatrix&) = delete;  // M points at sparsity
  MassMatrix& operator=(const MassMatrix&) = delete;
};

/// `whole`: else the diagonal of M alone, in O(n), which is all that a solve on bodies needs.
void computeMassMatrix(const Model& model, const Kinematics& kinematics, MassMatrix& stage,
                       bool whole = true);
/// The same of these bodies and their dofs, of whole trees.
void computeMassMatrix(const Model& model, const Kinematics& kinematics, Segments bodies,
                       Segments dofs, MassMatrix& stage, bool whole);

}  // namespace softgauss
