// SPDX-License-Identifier: Apache-2.0
#include "engine/model/followers.hpp"

#include "engine/core/index.hpp"

namespace softgauss {

void placeFollowers(const Model& model, const std::set<int>& kept, VectorX& q) {
  // A chain of followers is settled after as many rounds as it is long.
  for (std::size_t round = 0; round < model.couplings.size(); ++round)
    for (const JointCoupling& c : model.couplings) {
      if (kept.count(c.follower)) continue;
      const double leader = c.leader == 0 ? 0.0 : q[model.bodies[idx(c.leader)].q];
      q[model.bodies[idx(c.follower)].q] = c.leader == 0 ? c.polynomial[0] : c.value(leader);
    }
}

}  // namespace softgauss
