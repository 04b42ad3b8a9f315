// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Differences between what this engine computes and what a log says, and what they are relative
/// to. Contacts and rows are matched first: their order means nothing.

#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/step/data.hpp"
#include "tests/parity/reference_log.hpp"

namespace softgauss::test {

/// max |a − b| / max(max |b|, floor). The floor, in the unit of b, is what counts as 0: a vector of
/// forces near 0 has no relative error.
double relativeDifference(const MatrixX& a, const MatrixX& b, double floor);

/// Forces and accelerations of two converged solvers, relative.
inline constexpr double kForward = 1e-7;

/// Accelerations below this count as 0 [m/s² or rad/s²].
inline constexpr double kSmallAcceleration = 1.0;
/// Forces below what gives such an acceleration count as 0.
double smallForce(const ReferenceState& state);

/// The contacts of a log as a source of contacts: same points, same frames.
std::vector<Contact> loggedContacts(const Model& model, const std::vector<ReferenceContact>& log);

/// The rows of the last assembled constraints, forces at the present residual.
std::vector<Row> rowsOf(const Model& model, const Data& data);

/// The largest differences of matched contacts or rows; or why they cannot be matched.
struct ContactDifference {
  std::optional<std::string> unmatched;
  double position = 0.0;  ///< [m]
  double normal = 0.0;
  double distance = 0.0;  ///< [m]
};
ContactDifference compareContacts(const Model& model, const ContactSet& contacts,
                                  const std::vector<ReferenceContact>& reference);

struct RowDifference {
  std::optional<std::string> unmatched;
  double J = 0.0;          ///< relative
  double D = 0.0;          ///< relative
  double reference = 0.0;  ///< relative
  double force = 0.0;      ///< relative to the largest force, or to `smallForce`
};
RowDifference compareRows(const std::vector<Row>& rows, const std::vector<Row>& reference,
                          double smallForce);

/// max |q ⊖ q_ref| and max |v − v_ref| of two states, positions of floating bases in m and rad.
double stateDifference(const Model& model, const VectorX& q, const VectorX& v, const VectorX& qRef,
                       const VectorX& vRef);

}  // namespace softgauss::test
