// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How contacts of shapes without a closed form move with their bodies: central differences of the
/// detection of that pair alone, as one of the bodies is moved a little against the other.

#include "softgauss/engine/constraints/derivative/contact_shift.hpp"
#include "softgauss/engine/step/contact_source.hpp"

namespace softgauss {

class PairDifferences {
 public:
  explicit PairDifferences(const Model& model);

  /// The contacts to come are of these poses.
  void begin(const Kinematics& kinematics);
  /// Of contact i of `contacts`, which `source` finds.
  ContactShift::Measured of(const Model& model, const ContactSet& contacts, int i,
                            ContactSource& source);

 private:
  /// Finds the pair of `c` as B is moved against A by ± a little in each of six directions.
  void look(const Model& model, const Contact& c, ContactSource& source);

  Kinematics kinematics_;
  int geometryA_ = -1, geometryB_ = -1;  ///< of the pair that was looked at last
  Vector3 about_ = Vector3::Zero();      ///< the point about which it was turned
  ContactSet found_[12];                 ///< a little more and less of each direction
};

}  // namespace softgauss
