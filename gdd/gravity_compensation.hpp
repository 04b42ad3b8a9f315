// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The force that holds a robot at rest where it is, against gravity.
///
/// A control cost about zero, the paper's, pulls at all that stands: a reach comes to rest short
/// of its place, and a robot leans to where its motors have less to carry. Priced is therefore what
/// a control does beyond the force ĝ under which actuated dofs stay at rest, while all others (z: a
/// floating base, free bodies) do as they then must: fall, or stand on the rows that would press in
/// the fall, a_z = gravity for what floats. (At a = 0 rounding would choose among the corners of a
/// foot that has only just touched.) Statics, so without the forces of motion, and with those rows
/// stiffened κ times, so that they carry the whole weight:
///
///   P_zz x = −c_z(q, 0),   P = M̂ + κ JᵀH J,      ĝ = c(q, 0) + P_{·z} x                      (8.6)
///
/// ĝ_z = 0. An arm that is bolted down has no z, and ĝ is its gravity. In free fall without rows x
/// is that of gravity, and ĝ = 0. A humanoid on its feet is shared out among its contacts as one
/// rigid body would be.
///
/// c(q, 0) = c − (b(q, v) − b(q, 0)) − D v, and b(q, 0) is the weight of the links behind each dof:
///   b_i = S_iᵀ I^c_b(i) (0, −gravity)

#include <utility>
#include <vector>

#include "softgauss/engine/step/data.hpp"
#include "softgauss/gdd/problem.hpp"

namespace softgauss::gdd {

class GravityCompensation {
 public:
  explicit GravityCompensation(const Model& model);

  /// ĝ (nv) [N, N m] of the trees that are active in the data, with the rows that are selected; 0
  /// elsewhere. From data.forces, without an applied force in it. Leaves the rows evaluated in the
  /// fall. A dof is of z where no actuator acts on it, root forces that a price allows
  /// included, or where the box fixes it; ĝ is there what the box fixes, or 0.
  const VectorX& compute(const Model& model, const State& state, const ControlLimits& limits,
                         Data& data);

  const VectorX& force() const { return force_; }  ///< ĝ of the last compute() (nv)

 private:
  void setStatics(const Model& model, const State& state, const Data& data);
  bool findFree(const Model& model, const ControlLimits& limits, Segments dofs);
  void setFall(const Model& model, const Data& data);
  void stand(const Model& model, const ControlLimits& limits, Data& data);

  VectorX force_;                           ///< c(q, 0), then ĝ
  VectorX x_, Px_;                          ///< (nv)
  std::vector<char> free_;                  ///< of z
  ArticulatedFactor factor_;                ///< of P_zz: what is not of z is locked
  std::vector<Motion> motions_;             ///< (bodies) by x
  std::vector<std::pair<int, int>> pairs_;  ///< scratch: bodies that rows couple
};

}  // namespace softgauss::gdd
