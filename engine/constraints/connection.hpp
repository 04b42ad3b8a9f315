// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Connections: a point of body A and a point of body B coincide. Three rows each, world axes.
///
/// Distance r = p_A − p_B, J = J_A − J_B of the two points, and the force f pulls body A along +f,
/// body B along −f:
///   x = J a − a_ref,   a_ref = −b ṙ − k d(|r|) r − J̇ v,   s(x) = ½ D x²                   (4.3)
/// with A = w_A + w_B, the bodies' translational inverse weights, or less where the connection
/// carries more than they are (5.1). With J̇ v, r̈ is the acceleration of the distance itself, and
/// closed loops do not drift when they turn fast. Where v lags by half a step, ṙ and J̇ v are those
/// of (4.5), by how r has come and would go on.

#include "softgauss/engine/constraints/assembly.hpp"
#include "softgauss/engine/constraints/block_rows.hpp"

namespace softgauss {

class ConnectionRows : public BlockRows {
 public:
  void assemble(const Assembly& in);
  /// Places in Model::connections of those that have rows, three each.
  const std::vector<int>& connections() const { return connections_; }
  std::size_t bytes() const { return BlockRows::bytes() + bytesOfAll(connections_); }

 private:
  std::vector<int> connections_;
};

/// Where a point of A is against a point of B, both given in their bodies' frames, and how that
/// changes (world axes).
struct PointOffset : Offset {
  PointOffset(const Assembly& in, int bodyA, const Vector3& p_AP, int bodyB, const Vector3& p_BP);

  Vector3 p_WA, p_WB;  ///< the points [m]
};

/// The Jacobian J_A − J_B of that offset.
RelativeMotion offsetMotion(int bodyA, const Vector3& p_WA, int bodyB, const Vector3& p_WB);

/// Whether an equality constraint of this impedance knows what it carries: those that bounce do not
/// (5.1).
bool usesSupportedMass(const Assembly& in, const Impedance& tie);
/// A of an equality constraint of two bodies' translation [1/kg]; `ofCenters`, what MuJoCo's model
/// takes for it (InverseWeights).
double equalityInverseMass(const Assembly& in, const Impedance& tie, int bodyA, int bodyB,
                           double ofCenters);

}  // namespace softgauss
