// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which contacts a goal is about, and which of their two sides: the force counted is the one that
/// acts on what is `on`, by what is `by`.

#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/gdd/goal.hpp"

namespace softgauss::gdd {

struct ContactSelection {
  std::vector<char> on, by;  ///< one a geometry; none is in both

  /// 1 where the contact's force on its body B is meant, −1 where that on body A is, else 0.
  double sign(const Contact& c) const { return sign(c.geometryA, c.geometryB); }
  double sign(int geometryA, int geometryB) const {
    if (on[idx(geometryB)] && by[idx(geometryA)]) return 1.0;
    return on[idx(geometryA)] && by[idx(geometryB)] ? -1.0 : 0.0;
  }

  /// Whether a geometry of the tree is meant, on either side.
  bool concerns(const Model& model, int tree) const;
  /// Calls f(contacts, i, contact, sign) for every contact meant: contacts of either cone, place in
  /// their contactsWithRows(), contact.
  template <class F>
  void visit(const Data& data, F&& f) const {
    data.constraints.visitContacts([&](const auto& contacts) {
      for (int i = 0; i < static_cast<int>(contacts.contactsWithRows().size()); ++i) {
        const Contact& c = data.contacts.contacts[contacts.contactsWithRows()[i].contact];
        if (const double s = sign(c); s != 0.0) f(contacts, i, c, s);
      }
    });
  }
};

/// The geometries written in a link. Throws ModelError, in the name of `goal`, when the model has
/// no such link or the link has no collision geometry.
std::vector<char> geometriesOf(const Model& model, const std::string& link,
                               const std::string& goal);

/// The geometries that are fixed to the world.
std::vector<char> geometriesOfWorld(const Model& model);

}  // namespace softgauss::gdd
