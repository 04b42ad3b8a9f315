// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The parts of contacts, for who keeps them (core/bytes.hpp).

#include "softgauss/engine/step/snapshot.hpp"

namespace softgauss {

template <class Archive>
void archive(Archive& a, Contact& contact) {
  auto& [geometryA, geometryB, bodyA, bodyB, p_WC, n_W, tangent_W, distance] = contact;
  a(geometryA, geometryB, bodyA, bodyB, p_WC, n_W, tangent_W, distance);
}
template <class Archive>
void archive(Archive& a, Snapshot::ContactForce& contact) {
  auto& [geometryA, geometryB, p_WC, n_W, force] = contact;
  a(geometryA, geometryB, p_WC, n_W, force);
}

/// Whether their indices are of the model.
inline bool fits(const Model& model, const std::vector<Contact>& contacts) {
  const auto within = [](int i, std::size_t size) {
    return i >= 0 && static_cast<std::size_t>(i) < size;
  };
  for (const Contact& c : contacts)
    if (!within(c.geometryA, model.geometries.size()) ||
        !within(c.geometryB, model.geometries.size()) || !within(c.bodyA, model.bodies.size()) ||
        !within(c.bodyB, model.bodies.size()))
      return false;
  return true;
}
inline bool fits(const Model& model, const std::vector<Snapshot::ContactForce>& contacts) {
  const auto known = [&](int g) {
    return g >= 0 && static_cast<std::size_t>(g) < model.geometries.size();
  };
  for (const Snapshot::ContactForce& c : contacts)
    if (!known(c.geometryA) || !known(c.geometryB)) return false;
  return true;
}

}  // namespace softgauss
