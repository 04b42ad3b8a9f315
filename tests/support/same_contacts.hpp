// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Whether two searches for contacts have found the same, bit for bit and in the same order.

#include <algorithm>

#include "softgauss/engine/constraints/contact_set.hpp"

namespace softgauss::test {

inline bool sameContacts(const ContactSet& x, const ContactSet& y) {
  return std::equal(x.contacts.begin(), x.contacts.end(), y.contacts.begin(), y.contacts.end(),
                    [](const Contact& a, const Contact& b) {
                      return a.geometryA == b.geometryA && a.geometryB == b.geometryB &&
                             a.p_WC == b.p_WC && a.n_W == b.n_W && a.tangent_W == b.tangent_W &&
                             a.distance == b.distance;
                    });
}

}  // namespace softgauss::test
