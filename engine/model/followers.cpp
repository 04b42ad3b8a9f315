// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/followers.hpp"

#include "softgauss/engine/core/index.hpp"

namespace softgauss {

std::vector<const JointCoupling*> leadersFirst(const Model& model) {
  std::vector<const JointCoupling*> by(model.bodies.size(), nullptr), order, chain;
  for (const JointCoupling& c : model.couplings) by[idx(c.follower)] = &c;
  for (const JointCoupling& c : model.couplings) {
    for (const JointCoupling* up = &c; up; up = by[idx(up->leader)]) {
      if (!by[idx(up->follower)]) break;
      chain.push_back(up);
      by[idx(up->follower)] = nullptr;
    }
    order.insert(order.end(), chain.rbegin(), chain.rend());
    chain.clear();
  }
  return order;
}

std::optional<double> followedPosition(const Model& model, int body, const VectorX& q) {
  for (const JointCoupling& c : model.couplings)
    if (c.follower == body && c.leader != 0) return c.value(q[model.bodies[idx(c.leader)].q]);
  return std::nullopt;
}

void placeFollowers(const Model& model, const std::set<int>& kept, VectorX& q) {
  for (const JointCoupling* c : leadersFirst(model)) {
    if (kept.count(c->follower)) continue;
    q[model.bodies[idx(c->follower)].q] =
        c->leader == 0 ? c->polynomial[0] : c->value(q[model.bodies[idx(c->leader)].q]);
  }
}

}  // namespace softgauss
