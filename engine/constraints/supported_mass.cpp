// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/supported_mass.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "softgauss/engine/constraints/contact_softness.hpp"

namespace softgauss {
namespace {

/// (5.3) [kg]; 0 of a single body that is free, whose weight is known.
double partOf(const Model& model, int tree, int held) {
  constexpr double kOfContacts = 0.2;
  if (tree < 0 || held == 0 || model.isFree(model.trees[tree].rootBody)) return 0.0;
  return kOfContacts * model.trees[tree].mass / held;
}

/// Calls f(bodyA, bodyB, isEquality) for every contact and every equality constraint that carries.
template <class F>
void visitPairs(const Model& model, const ContactSet& contacts, F&& f) {
  for (const Contact& c : contacts.contacts) f(c.bodyA, c.bodyB, false);
  if (!model.options.effects.has(Effect::equality)) return;
  const auto visit = [&](const auto& tie) {
    if (!underdampedReference(tie.impedance, model.options)) f(tie.bodyA, tie.bodyB, true);
  };
  for (const Connection& c : model.connections) visit(c);
  for (const Weld& w : model.welds) visit(w);
}

}  // namespace

double contactShare(const Model& model, int bodyA, int bodyB, int heldA, int heldB) {
  const int a = model.bodies[bodyA].tree, b = model.bodies[bodyB].tree;
  return a == b ? 0.0 : std::max(partOf(model, a, heldA), partOf(model, b, heldB));
}

void SupportedMass::Load::add(const Load& other, double parts) {
  mass += other.mass / parts;
  moment += other.moment / parts;
  rotational += other.rotational / parts;
}

void SupportedMass::Load::raiseTo(double m) {
  if (!(mass > 0.0 && mass < m)) return;
  const double by = m / mass;
  mass = m;
  moment *= by;
  rotational *= by;
}

double SupportedMass::Load::about(const Vector3& p) const {
  return std::max(0.0, rotational - 2.0 * moment.dot(p) + mass * p.squaredNorm());
}

int SupportedMass::root(int tree) {
  while (parent_[tree] != tree) tree = parent_[tree] = parent_[parent_[tree]];
  return tree;
}

void SupportedMass::assemble(const Model& model, const Kinematics& kinematics,
                             const ContactSet& contacts, const InverseWeights& weights) {
  any_ = false;
  supports_.assign(model.trees.size(), {});
  visitPairs(model, contacts, [&](int bodyA, int bodyB, bool isEquality) {
    const int a = model.bodies[bodyA].tree, b = model.bodies[bodyB].tree;
    if (a == b) return;
    any_ |= a >= 0 && b >= 0;
    for (const int tree : {a, b})
      if (tree >= 0) ++(isEquality ? supports_[tree].equalities : supports_[tree].contacts);
  });
  if (!any_) return;
  weigh(model, kinematics, contacts, weights);
  findLayers();
  passDown(model);
}

double SupportedMass::contactShare(const Model& model, int bodyA, int bodyB) const {
  const auto held = [&](int body) {
    const int tree = model.bodies[body].tree;
    return tree < 0 ? 0 : supports_[tree].all();
  };
  return softgauss::contactShare(model, bodyA, bodyB, held(bodyA), held(bodyB));
}

double SupportedMass::equalityShare(const Model& model, int bodyA, int bodyB) const {
  const int a = model.bodies[bodyA].tree, b = model.bodies[bodyB].tree;
  if (a == b) return 0.0;
  double most = 0.0;
  for (const int tree : {a, b}) {
    if (!model.floats(tree) || model.isFree(model.trees[tree].rootBody)) continue;
    most = std::max(most, model.trees[tree].mass / supports_[tree].equalities);
  }
  return most;
}

bool SupportedMass::isTied(const Model& model, int bodyA, int bodyB) const {
  const auto tied = [&](int body) {
    const int tree = model.bodies[body].tree;
    return tree >= 0 && supports_[tree].equalities > 0;
  };
  return tied(bodyA) || tied(bodyB);
}

/// m of all trees, the islands' largest, and who holds whom.
void SupportedMass::weigh(const Model& model, const Kinematics& kinematics,
                          const ContactSet& contacts, const InverseWeights& weights) {
  const std::size_t trees = model.trees.size();
  const bool rotational = !model.welds.empty();
  if (rotational) origin_ = kinematics.X_WB[model.welds.front().bodyA].p;
  parent_.resize(trees);
  std::iota(parent_.begin(), parent_.end(), 0);
  self_.assign(trees, {});
  layer_.assign(trees, 0);
  head_.assign(trees, -1);
  links_.clear();
  order_.clear();
  visitPairs(model, contacts, [&](int bodyA, int bodyB, bool isEquality) {
    const int a = model.bodies[bodyA].tree, b = model.bodies[bodyB].tree;
    if (a == b) return;
    for (const auto& [body, tree, other] : {std::tuple(bodyA, a, b), std::tuple(bodyB, b, a)}) {
      if (tree < 0) continue;
      const bool stands = !model.floats(tree), isPart = stands && !isEquality;
      const double most = model.trees[tree].mass, w = weights.translation[body];
      const double mass = isPart           ? partOf(model, tree, supports_[tree].all())
                          : w * most > 1.0 ? 1.0 / w
                                           : most;
      if (mass > self_[tree].mass) {
        Load& own = self_[tree] = {mass};
        if (rotational) {
          const Vector3 c = kinematics.X_WB[body] * model.bodies[body].com - origin_;
          const double w_r = weights.rotation[body];
          own.moment = mass * c;
          own.rotational = mass * c.squaredNorm() + (w_r > 0.0 && !isPart ? 1.0 / w_r : 0.0);
        }
      }
      if (stands) continue;
      if (!model.floats(other)) {
        if (layer_[tree] == 0) order_.push_back(tree);
        layer_[tree] = 1;
        continue;
      }
      links_.push_back({other, head_[tree]});
      head_[tree] = static_cast<int>(links_.size()) - 1;
    }
    if (a >= 0 && b >= 0) parent_[root(a)] = root(b);
  });
  for (int t = 0; t < static_cast<int>(trees); ++t)
    if (model.floats(t)) self_[t].raiseTo(partOf(model, t, supports_[t].all()));
  island_.resize(trees);
  largest_.assign(trees, {});
  for (int t = 0; t < static_cast<int>(trees); ++t) {
    island_[t] = root(t);
    Largest& largest = largest_[island_[t]];
    if (massOf(t) > massOf(largest.first))
      largest = {t, largest.first};
    else if (massOf(t) > massOf(largest.second))
      largest.second = t;
  }
}

/// Breadth first from the trees that stand on the world.
void SupportedMass::findLayers() {
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const int tree = order_[i];
    for (int l = head_[tree]; l >= 0; l = links_[l].next) {
      const int other = links_[l].other;
      if (layer_[other] > 0) continue;
      layer_[other] = layer_[tree] + 1;
      order_.push_back(other);
    }
  }
}

/// From the farthest layer towards the world.
void SupportedMass::passDown(const Model& model) {
  supported_ = self_;
  for (std::size_t i = order_.size(); i-- > 0;) {
    const int tree = order_[i];
    const auto below = [&](const Link& link) { return layer_[link.other] == layer_[tree] - 1; };
    int shares = 0;
    for (int l = head_[tree]; l >= 0; l = links_[l].next) shares += below(links_[l]);
    Load all = supported_[tree];
    if (!model.isFree(model.trees[tree].rootBody)) {  // whose m_T is its mass
      Load whole = self_[tree];
      whole.raiseTo(model.trees[tree].mass);
      all.add(self_[tree], -1.0);
      all.add(whole, 1.0);
    }
    for (int l = head_[tree]; l >= 0; l = links_[l].next)
      if (below(links_[l])) supported_[links_[l].other].add(all, shares);
  }
}

SupportedMass::Supported SupportedMass::between(const Model& model, int bodyA, int bodyB) const {
  Supported supported;
  const int a = model.bodies[bodyA].tree, b = model.bodies[bodyB].tree;
  const int some = a >= 0 ? a : b;
  if (!any_ || some < 0) return supported;
  const Largest& largest = largest_[island_[some]];
  supported.excludeSelf = a < 0 || b < 0 || a == b;
  if (supported.excludeSelf) {
    supported.passing = some;
    supported.largest = massOf(some) == massOf(largest.first) ? largest.second : largest.first;
    return supported;
  }
  supported.largest = largest.first;
  supported.passing = layer_[a] < layer_[b] ? b : a;
  if (layer_[a] == layer_[b]) supported.other = b;
  return supported;
}

template <class F>
double SupportedMass::mostOf(const Supported& c, F&& size) const {
  double most = c.largest < 0 ? 0.0 : size(self_[c.largest]);
  for (const int tree : {c.passing, c.other}) {
    if (tree < 0) continue;
    Load passed = supported_[tree];
    if (c.excludeSelf) passed.add(self_[tree], -1.0);
    most = std::max(most, size(passed));
  }
  return most;
}

double SupportedMass::mass(const Model& model, int bodyA, int bodyB) const {
  return mostOf(between(model, bodyA, bodyB), [](const Load& load) { return load.mass; });
}

double SupportedMass::inertia(const Model& model, int bodyA, int bodyB, const Vector3& p_W) const {
  const Vector3 p = p_W - origin_;
  return mostOf(between(model, bodyA, bodyB), [&](const Load& load) { return load.about(p); });
}

}  // namespace softgauss
