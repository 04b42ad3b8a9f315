// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contact points of one step, as geometry alone knows them.

#include <cstdint>
#include <vector>

#include "softgauss/engine/core/types.hpp"

namespace softgauss {

/// A point at which two geometries touch or nearly touch.
struct Contact {
  int geometryA = 0;  ///< indices into Model::geometries
  int geometryB = 0;
  int bodyA = 0;  ///< their bodies
  int bodyB = 0;
  Vector3 p_WC = Vector3::Zero();  ///< midway between the two surfaces along the normal [m]
  Vector3 n_W = Vector3::UnitZ();  ///< unit normal from A to B: a force along +n pushes B away
  /// Wished first tangent, any length; zero or along n: chosen by frameFromNormal().
  Vector3 tangent_W = Vector3::Zero();
  double distance = 0.0;  ///< signed [m], negative when the shapes overlap
};

/// All contacts of a step; keeps its memory from step to step.
struct ContactSet {
  std::vector<Contact> contacts;
  std::int64_t growths = 0;       ///< times the capacity had to grow since construction
  std::int64_t detections = 0;    ///< times that contacts were looked for since construction
  std::int64_t pairsTested = 0;   ///< exact pair tests of this step
  std::int64_t pairsSkipped = 0;  ///< pairs whose query failed in this step, see ContactSource
  /// Points of meshes in this step that were left to others beside them, which carry as well.
  std::int64_t pointsReduced = 0;

  void clear() {
    contacts.clear();
    pairsTested = 0;
    pairsSkipped = 0;
    pointsReduced = 0;
  }
  void add(const Contact& contact) {
    if (contacts.size() == contacts.capacity()) ++growths;
    contacts.push_back(contact);
  }
  int size() const { return static_cast<int>(contacts.size()); }
};

}  // namespace softgauss
