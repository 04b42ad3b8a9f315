// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contact forces by link: the links that move and can touch, and the sum of the forces on each.

#include <string>
#include <vector>

#include "softgauss/engine/model/model.hpp"
#include "softgauss/engine/step/snapshot.hpp"

namespace softgauss::io {

/// Links with collision shapes on bodies that move, in the order of their shapes.
class ContactLinks {
 public:
  explicit ContactLinks(const Model& model);

  const std::vector<std::string>& names() const { return names_; }
  int size() const { return static_cast<int>(names_.size()); }
  /// Of a geometry: place in names(), or −1 where it is fixed to the world.
  int of(int geometry) const { return linkOf_[static_cast<std::size_t>(geometry)]; }
  /// The sum of the contact forces on each, world axes: x, y, z of the first, of the next … [N]
  void forces(const std::vector<Snapshot::ContactForce>& contacts, VectorX& out) const;

 private:
  std::vector<std::string> names_;
  std::vector<int> linkOf_;  ///< (geometries)
};

}  // namespace softgauss::io
