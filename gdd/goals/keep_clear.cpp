// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/keep_clear.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/dynamics/jacobian.hpp"

namespace softgauss::gdd {
namespace {

/// The nearest ancestor that is no step of a joint of several degrees of freedom; −1 of what
/// floats, which hangs from nothing.
int solidParent(const Model& model, int body) {
  while (body != 0) {
    if (model.bodies[idx(body)].joint == JointKind::floating) return -1;
    body = model.bodies[idx(body)].parent;
    if (body == 0 || !model.bodies[idx(body)].massless) return body;
  }
  return -1;
}

/// Whether two geometries always touch, or never move against each other.
bool areJoined(const Model& model, const Geometry& a, const Geometry& b) {
  if (a.body == b.body) return true;
  const bool hangs = solidParent(model, a.body) == b.body || solidParent(model, b.body) == a.body;
  // From the world hangs what hangs from its own base.
  return hangs && ((a.body != 0 && b.body != 0) || (a.base >= 0 && a.base == b.base));
}

/// c of (9.22): what d̈ has besides n·(p̈_B − p̈_A) because edges and faces turn. `u` is the velocity
/// of p_B against p_A. Where both have as many as there are, the less of what they say.
double turning(const NearPoints& x, const Vector3& u, const Vector3& spinA, const Vector3& spinB) {
  const auto from = [&](const std::array<Vector3, 2>& first, const Vector3& spinOfFirst,
                        const std::array<Vector3, 2>& second, const Vector3& spinOfSecond) {
    std::array<Vector3, 2> basis;
    std::array<double, 2> turn{};  // n·(ω × t) of each
    std::size_t count = 0;
    const auto take = [&](const std::array<Vector3, 2>& along, const Vector3& spin) {
      for (const Vector3& t : along) {
        Vector3 e = t;
        double rate = x.n_W.dot(spin.cross(t));
        for (std::size_t i = 0; i < count; ++i) {
          const double share = basis[i].dot(t);
          e -= share * basis[i];
          rate -= share * turn[i];
        }
        const double length = e.norm();
        if (count == 2 || length < 1e-6) continue;
        basis[count] = e / length;
        turn[count++] = rate / length;
      }
    };
    take(first, spinOfFirst);
    take(second, spinOfSecond);
    double c = 0.0;
    for (std::size_t i = 0; i < count; ++i)
      c -= turn[i] * (2.0 * basis[i].dot(u) + x.distance * turn[i]);
    return c;
  };
  return std::min(from(x.alongA, spinA, x.alongB, spinB), from(x.alongB, spinB, x.alongA, spinA));
}

Transform poseOf(const GoalContext& context, int geometry) {
  const Geometry& g = context.model.geometries[idx(geometry)];
  return context.data.kinematics.X_WB[idx(g.body)] * g.X_BG;
}

}  // namespace

std::vector<KeepClear::Pair> KeepClear::pairsOf(const Model& model, const std::string& link,
                                                const std::string& from) {
  std::vector<Pair> pairs;
  const int count = static_cast<int>(model.geometries.size());
  for (int a = 0; a < count; ++a) {
    const Geometry& shape = model.geometries[idx(a)];
    if (shape.link != link) continue;
    for (int b = 0; b < count; ++b) {
      const Geometry& other = model.geometries[idx(b)];
      const bool isMeant = from == "world" ? other.body == 0 : other.link == from;
      if (isMeant && !areJoined(model, shape, other)) pairs.push_back({a, b});
    }
  }
  return pairs;
}

KeepClear::KeepClear(const Model& model, const std::string& linkName, const std::string& fromName,
                     double least, std::shared_ptr<ShapeDistances> source)
    : link(linkName),
      from(fromName),
      pairs(pairsOf(model, linkName, fromName)),
      distance(least),
      weight(kClearWeightPerMass * referenceMass(model, model.findFrame(linkName))),
      defaultWeight(weight),
      shapes(std::move(source)) {
  const auto fail = [&](const std::string& problem) {
    throw ModelError({}, "goal '" + name() + "'", problem);
  };
  if (model.findFrame(link) < 0) fail("the model has no link '" + link + "'");
  if (from != "world" && model.findFrame(from) < 0) fail("the model has no link '" + from + "'");
  if (pairs.empty()) fail("no two shapes of the two can move against each other");
  if (!(distance >= 0.0 && std::isfinite(distance))) fail("the distance is no number >= 0");
  if (!shapes) fail("there is no source of shape distances");
}

template <class Visit>
void KeepClear::forPairs(const GoalContext& context, Visit&& visit) const {
  for (const Pair& pair : pairs)
    visit(pair, shapes->between(pair.a, poseOf(context, pair.a), pair.b, poseOf(context, pair.b)));
}

std::optional<double> KeepClear::clearance(const GoalContext& context) const {
  std::optional<double> least;
  forPairs(context, [&](const Pair&, std::span<const NearPoints> points) {
    if (!points.empty()) least = std::min(least.value_or(kInfinity), points.front().distance);
  });
  return least;
}

void KeepClear::addCost(const GoalContext& context, GoalCost& cost) const {
  const Model& model = context.model;
  const Kinematics& k = context.data.kinematics;
  GoalWorkspace& work = cost.workspace();
  forPairs(context, [&](const Pair& pair, std::span<const NearPoints> points) {
    for (const NearPoints& x : points) {
      double bias = 0.0;
      Vector3 velocity = Vector3::Zero();  // of p_B against p_A
      work.dofs.setZero();
      const auto add = [&](int geometry, const Vector3& p, double sign) {
        const int body = model.geometries[idx(geometry)].body;
        if (model.bodies[idx(body)].dofs == 0) return;  // fixed to the world
        pointJacobian(model, k, body, p, work.J.topRows<3>());
        for (Eigen::Index i = 0; i < work.dofs.size(); ++i)
          work.dofs[i] += sign * x.n_W.dot(work.J.col(i).head<3>());
        velocity += sign * pointVelocity(model, k, body, p);
        bias += sign * x.n_W.dot(pointBiasAcceleration(model, k, body, p));
      };
      add(pair.a, x.p_WA, -1.0);
      add(pair.b, x.p_WB, 1.0);
      const auto spin = [&](int geometry) -> const Vector3& {
        return k.V[idx(model.geometries[idx(geometry)].body)].angular;
      };
      bias += turning(x, velocity, spin(pair.a), spin(pair.b));
      cost.addOneSided(work.dofs, weight,
                       -stiffness * (x.distance - distance) - damping * x.n_W.dot(velocity) - bias);
    }
  });
}

bool KeepClear::concerns(const Model& model, int tree) const {
  const auto isOf = [&](int geometry) {
    return model.bodies[idx(model.geometries[idx(geometry)].body)].tree == tree;
  };
  return std::ranges::any_of(pairs, [&](const Pair& p) { return isOf(p.a) || isOf(p.b); });
}

}  // namespace softgauss::gdd
