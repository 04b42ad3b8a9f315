// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contacts without a collision library.

#include "softgauss/engine/step/contact_source.hpp"
#include "tests/support/random.hpp"

namespace softgauss::test {

/// Planes of the world against spheres, capsules (both ends) and boxes (all corners); spheres
/// against spheres of other bodies, unless one is the other's parent.
class SampleContacts final : public ContactSource {
 public:
  bool spheresTouch = true;
  /// First tangent along the x axis of the plane, so that it turns with the world.
  bool tangentOfPlane = false;

  void detect(const Model& model, const Kinematics& k, ContactSet& contacts) noexcept override;
};

/// `count` contacts between random geometries near random bodies: between branches, between trees
/// and with the world on either side; most of them penetrate by up to 2 mm.
FixedContacts randomContacts(const Model& model, const Kinematics& k, Random& random, int count);

}  // namespace softgauss::test
