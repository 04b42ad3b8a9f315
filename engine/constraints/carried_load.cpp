// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/carried_load.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "engine/constraints/contact_softness.hpp"

namespace softgauss {
namespace {

/// (T.131) [kg]; 0 of a single body that is free, whose weight is known.
double partOf(const Model& model, int tree, int held) {
  constexpr double kOfContacts = 0.2;
  if (tree < 0 || held == 0 || model.isFree(model.trees[tree].rootBody)) return 0.0;
  return kOfContacts * model.trees[tree].mass / held;
}

/// Calls f(bodyA, bodyB, isTie) for every contact and every tie that carries.
template <class F>
void visitPairs(const Model& model, const ContactSet& contacts, F&& f) {
  for (const Contact& c : contacts.contacts) f(c.bodyA, c.bodyB, false);
  if (!model.options.effects.has(Effect::equality)) return;
  const auto visit = [&](const auto& tie) {
    if (!bouncing(tie.impedance, model.options)) f(tie.bodyA, tie.bodyB, true);
  };
  for (const Connection& c : model.connections) visit(c);
  for (const Weld& w : model.welds) visit(w);
}

}  // namespace

double partOnContact(const Model& model, int bodyA, int bodyB, int heldA, int heldB) {
  const int a = model.bodies[bodyA].tree, b = model.bodies[bodyB].tree;
  return a == b ? 0.0 : std::max(partOf(model, a, heldA), partOf(model, b, heldB));
}

void CarriedLoad::Load::add(const Load& other, double parts) {
  mass += other.mass / parts;
  moment += other.moment / parts;
  turning += other.turning / parts;
}

void CarriedLoad::Load::growTo(double m) {
  if (!(mass > 0.0 && mass < m)) return;
  const double by = m / mass;
  mass = m;
  moment *= by;
  turning *= by;
}

double CarriedLoad::Load::about(const Vector3& p) const {
  return std::max(0.0, turning - 2.0 * moment.dot(p) + mass * p.squaredNorm());
}

int CarriedLoad::root(int tree) {
  while (parent_[tree] != tree) tree = parent_[tree] = parent_[parent_[tree]];
  return tree;
}

void CarriedLoad::assemble(const Model& model, const Kinematics& kinematics,
                           const ContactSet& contacts, const InverseWeights& weights) {
  any_ = false;
  held_.assign(model.trees.size(), {});
  visitPairs(model, contacts, [&](int bodyA, int bodyB, bool isTie) {
    const int a = model.bodies[bodyA].tree, b = model.bodies[bodyB].tree;
    if (a == b) return;
    any_ |= a >= 0 && b >= 0;
    for (const int tree : {a, b})
      if (tree >= 0) ++(isTie ? held_[tree].ties : held_[tree].contacts);
  });
  if (!any_) return;
  weigh(model, kinematics, contacts, weights);
  findLayers();
  passDown(model);
}

double CarriedLoad::partOnContact(const Model& model, int bodyA, int bodyB) const {
  const auto held = [&](int body) {
    const int tree = model.bodies[body].tree;
    return tree < 0 ? 0 : held_[tree].all();
  };
  return softgauss::partOnContact(model, bodyA, bodyB, held(bodyA), held(bodyB));
}

double CarriedLoad::partOnTie(const Model& model, int bodyA, int bodyB) const {
  const int a = model.bodies[bodyA].tree, b = model.bodies[bodyB].tree;
  if (a == b) return 0.0;
  double most = 0.0;
  for (const int tree : {a, b}) {
    if (!model.floats(tree) || model.isFree(model.trees[tree].rootBody)) continue;
    most = std::max(most, model.trees[tree].mass / held_[tree].ties);
  }
  return most;
}

/// m of all trees, the islands' largest, and who holds whom.
void CarriedLoad::weigh(const Model& model, const Kinematics& kinematics,
                        const ContactSet& contacts, const InverseWeights& weights) {
  const std::size_t trees = model.trees.size();
  const bool turning = !model.welds.empty();
  if (turning) origin_ = kinematics.X_WB[model.welds.front().bodyA].p;
  parent_.resize(trees);
  std::iota(parent_.begin(), parent_.end(), 0);
  own_.assign(trees, {});
  layer_.assign(trees, 0);
  head_.assign(trees, -1);
  links_.clear();
  order_.clear();
  visitPairs(model, contacts, [&](int bodyA, int bodyB, bool isTie) {
    const int a = model.bodies[bodyA].tree, b = model.bodies[bodyB].tree;
    if (a == b) return;
    for (const auto& [body, tree, other] : {std::tuple(bodyA, a, b), std::tuple(bodyB, b, a)}) {
      if (tree < 0) continue;
      const bool stands = !model.floats(tree), isPart = stands && !isTie;
      const double most = model.trees[tree].mass, w = weights.translation[body];
      const double mass = isPart           ? partOf(model, tree, held_[tree].all())
                          : w * most > 1.0 ? 1.0 / w
                                           : most;
      if (mass > own_[tree].mass) {
        Load& own = own_[tree] = {mass};
        if (turning) {
          const Vector3 c = kinematics.X_WB[body] * model.bodies[body].com - origin_;
          const double w_r = weights.rotation[body];
          own.moment = mass * c;
          own.turning = mass * c.squaredNorm() + (w_r > 0.0 && !isPart ? 1.0 / w_r : 0.0);
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
    if (model.floats(t)) own_[t].growTo(partOf(model, t, held_[t].all()));
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
void CarriedLoad::findLayers() {
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
void CarriedLoad::passDown(const Model& model) {
  passed_ = own_;
  for (std::size_t i = order_.size(); i-- > 0;) {
    const int tree = order_[i];
    const auto below = [&](const Link& link) { return layer_[link.other] == layer_[tree] - 1; };
    int shares = 0;
    for (int l = head_[tree]; l >= 0; l = links_[l].next) shares += below(links_[l]);
    Load all = passed_[tree];
    if (!model.isFree(model.trees[tree].rootBody)) {  // whose m_T is its mass
      Load whole = own_[tree];
      whole.growTo(model.trees[tree].mass);
      all.add(own_[tree], -1.0);
      all.add(whole, 1.0);
    }
    for (int l = head_[tree]; l >= 0; l = links_[l].next)
      if (below(links_[l])) passed_[links_[l].other].add(all, shares);
  }
}

CarriedLoad::Carried CarriedLoad::between(const Model& model, int bodyA, int bodyB) const {
  Carried carried;
  const int a = model.bodies[bodyA].tree, b = model.bodies[bodyB].tree;
  const int some = a >= 0 ? a : b;
  if (!any_ || some < 0) return carried;
  const Largest& largest = largest_[island_[some]];
  carried.lessOwn = a < 0 || b < 0 || a == b;
  if (carried.lessOwn) {
    carried.passing = some;
    carried.largest = massOf(some) == massOf(largest.first) ? largest.second : largest.first;
    return carried;
  }
  carried.largest = largest.first;
  carried.passing = layer_[a] < layer_[b] ? b : a;
  if (layer_[a] == layer_[b]) carried.other = b;
  return carried;
}

template <class F>
double CarriedLoad::mostOf(const Carried& c, F&& size) const {
  double most = c.largest < 0 ? 0.0 : size(own_[c.largest]);
  for (const int tree : {c.passing, c.other}) {
    if (tree < 0) continue;
    Load passed = passed_[tree];
    if (c.lessOwn) passed.add(own_[tree], -1.0);
    most = std::max(most, size(passed));
  }
  return most;
}

double CarriedLoad::mass(const Model& model, int bodyA, int bodyB) const {
  return mostOf(between(model, bodyA, bodyB), [](const Load& load) { return load.mass; });
}

double CarriedLoad::inertia(const Model& model, int bodyA, int bodyB, const Vector3& p_W) const {
  const Vector3 p = p_W - origin_;
  return mostOf(between(model, bodyA, bodyB), [&](const Load& load) { return load.about(p); });
}

}  // namespace softgauss
