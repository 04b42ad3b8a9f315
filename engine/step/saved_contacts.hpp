// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The parts of contacts, for who keeps them (core/bytes.hpp).

#include "softgauss/engine/step/snapshot.hpp"

namespace softgauss {

template <class Archive>
void archive(Archive& a, Snapshot::ContactForce& contact) {
  auto& [geometryA, geometryB, p_WC, n_W, force] = contact;
  a(geometryA, geometryB, p_WC, n_W, force);
}

/// Whether their indices are of the model.
inline bool fits(const Model& model, const std::vector<Snapshot::ContactForce>& contacts) {
  const auto known = [&](int g) {
    return g >= 0 && static_cast<std::size_t>(g) < model.geometries.size();
  };
  for (const Snapshot::ContactForce& c : contacts)
    if (!known(c.geometryA) || !known(c.geometryB)) return false;
  return true;
}

}  // namespace softgauss
