// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How actuators pull: τ = B u, with any B of full column rank (8.2).
///
/// An actuator has one command u and pulls each of its dofs by a coefficient times u: one dof for a
/// motor with a gear, several for a differential or a tendon. A dof may have several actuators.
/// With Z an orthonormal basis of the left null space of B, ZᵀB = 0, every generalised force is
///   g = T y,   y = (u, z),   T = [B  Z],   T⁻¹ = C = [B⁺; Zᵀ],   B⁺ = (BᵀB)⁻¹Bᵀ (8.3)
/// so that g = B u is z = Zᵀg = 0: no force that no actuator causes (a root force).
///
/// T has a block for each set of dofs that actuators tie together, and is the identity elsewhere:
/// there the coordinate y_i is the force on dof i. In a block of k dofs and m actuators the first m
/// coordinates, in the order of dofs, are the actuators in theirs, the others z.

#include <string>
#include <vector>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/types.hpp"

namespace softgauss::gdd {

struct Actuator {
  struct Pull {
    int dof = 0;
    double coefficient = 1.0;  ///< force on the dof per command [N/[u] or N m/[u]]
  };
  std::string name = {};
  std::vector<Pull> pulls = {};
  double lower = -kInfinity;  ///< bounds of u, in its own unit
  double upper = kInfinity;
  SourceLocation where = {};
};

class Transmission {
 public:
  /// Throws ModelError, naming the actuators, where they are not linearly independent, where bounds
  /// cross, or where a dof or a coefficient is not usable.
  Transmission(int dofs, std::vector<Actuator> actuators);

  const std::vector<Actuator>& actuators() const { return actuators_; }
  /// The coordinate that is the command of an actuator.
  int coordinateOf(int actuator) const { return coordinate_[static_cast<std::size_t>(actuator)]; }

  const MatrixX& T() const { return T_; }  ///< (nv × nv) g = T y
  const MatrixX& C() const { return C_; }  ///< (nv × nv) y = C g
  bool pulls(int dof) const { return kind_[static_cast<std::size_t>(dof)] != Kind::free; }
  /// Whether coordinate i is the force on dof i.
  bool isPlain(int i) const { return plain_[static_cast<std::size_t>(i)] != 0; }
  /// Whether coordinate i is one of z, among dofs that actuators pull.
  bool isRootForce(int i) const { return kind_[static_cast<std::size_t>(i)] == Kind::root; }
  /// The largest force on a dof that coordinate i = 1 makes.
  double forcePerUnit(int i) const { return size_[i]; }

 private:
  enum class Kind : char { free, command, root };  ///< free: no actuator of the list pulls the dof

  void check() const;
  void setBlock(const std::vector<int>& dofs, const std::vector<int>& members);

  std::vector<Actuator> actuators_;
  std::vector<int> coordinate_;
  std::vector<Kind> kind_;
  std::vector<char> plain_;
  MatrixX T_, C_;
  VectorX size_;
};

}  // namespace softgauss::gdd
