// SPDX-License-Identifier: Apache-2.0
#include "gdd/goal.hpp"

namespace softgauss::gdd {

std::unique_ptr<Goal> Goal::within(const Model&, const SubModel&) const {
  throw ModelError({}, "goal '" + name() + "'",
                   "is one of all that moves together, expected goals of robots and links where "
                   "islands are solved apart");
}

}  // namespace softgauss::gdd
