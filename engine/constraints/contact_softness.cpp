// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/contact_softness.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/constraints/law/row_law.hpp"

namespace softgauss {

double restingMass(const Model& model, int bodyA, int bodyB) {
  const int a = model.bodies[bodyA].tree, b = model.bodies[bodyB].tree;
  if (a < 0 && b < 0) return 0.0;
  if (a < 0) return model.trees[b].mass;
  if (b < 0) return model.trees[a].mass;
  return std::min(model.trees[a].mass, model.trees[b].mass);
}

ContactSpring inNewtons(const ContactSpring& spring, double mass, double gravity) {
  ContactSpring s;
  s.stiffness = spring.restDepth > 0.0 ? mass * gravity / spring.restDepth : spring.stiffness;
  s.damping = spring.damping + 2.0 * spring.dampingRatio * std::sqrt(s.stiffness * mass);
  return s;
}

ContactSpring inSeries(const ContactSpring& a, const ContactSpring& b) {
  ContactSpring s;
  const double shareA = b.stiffness / (a.stiffness + b.stiffness), shareB = 1.0 - shareA;
  s.stiffness = a.stiffness * shareA;
  s.damping = a.damping * shareA * shareA + b.damping * shareB * shareB;
  return s;
}

double reducedMass(const Model& model, int bodyA, int bodyB) {
  const int a = model.bodies[bodyA].tree, b = model.bodies[bodyB].tree;
  const double lighter = restingMass(model, bodyA, bodyB);
  if (a < 0 || b < 0) return lighter;
  const double heavier = std::max(model.trees[a].mass, model.trees[b].mass);
  return lighter * heavier / (lighter + heavier);
}

ReferenceSpring referenceOf(const Impedance& p, double timestep) {
  if (p.direct) return *p.direct;
  const double tc = std::max(p.timeConstant, 2.0 * timestep);
  return {1.0 / std::pow(tc * p.dampingRatio, 2.0), 2.0 / tc};
}

std::optional<ReferenceSpring> underdampedReference(const Impedance& p, const Options& options) {
  constexpr double kRounding = 1e-12;
  if (!p.direct && p.dampingRatio > 0.5 * (1.0 + kRounding)) return std::nullopt;
  const double h = options.rowTimestep();
  const auto [stiffness, B] = referenceOf(p, h);
  const double K = std::min(stiffness, kFastestBounce / (h * h));
  if (!(B * B <= K * (1.0 + kRounding))) return std::nullopt;
  return ReferenceSpring{K, std::max(B, h * h * K * std::sqrt(K) / 8.0)};
}

std::optional<Softness> bouncingSoftness(const Impedance& p, double inverseInertia,
                                         const Options& options) {
  const std::optional<ReferenceSpring> reference = underdampedReference(p, options);
  if (!reference) return std::nullopt;
  const double t = timeToStepEnd(options), K = reference->stiffness;
  const double B = std::max(0.0, reference->damping - t * K);
  return implicitSpringDamper(K / inverseInertia, B / inverseInertia, t, options);
}

Material effectiveMaterial(const Material& pair, double mass, const Options& options) {
  if (pair.spring || options.constraintModel == ConstraintModel::mujoco || !(mass > 0.0))
    return pair;
  const std::optional<ReferenceSpring> reference = underdampedReference(pair.impedance, options);
  if (!reference) return pair;
  const double K = reference->stiffness, B = reference->damping;
  Material springy = pair;
  ContactSpring& spring = springy.spring.emplace();
  spring.stiffness = mass * K;
  spring.damping = mass * std::max(0.0, B - timeToStepEnd(options) * K);
  return springy;
}

int frictionDim(const Material& pair, const EffectSet& effects) {
  int condim = pair.condim;
  if (!effects.has(Effect::rollingFriction)) condim = std::min(condim, 4);
  if (!effects.has(Effect::torsionalFriction)) condim = std::min(condim, 3);
  return pair.slidingFriction >= kSmallestFriction ? condim - 1 : 0;
}

Softness contactSoftness(const Material& pair, int frictionDim, double distance, double weight,
                         const Options& options) {
  const bool edges = frictionDim > 0 && options.cone == Cone::pyramidal;
  if (pair.spring) {
    Softness s = springLaw(pair.spring->stiffness, pair.spring->damping, weight, options);
    if (edges) s.R *= 2.0 * frictionDim;
    return s;
  }
  if (options.hasRowLaw()) {
    const Softness s = rowLaw(pair.impedance, distance, weight, options);
    return edges ? edgeOf(s, pair.impedance, frictionDim, pair.slidingFriction,
                          options.impedanceRatio)
                 : s;
  }
  const double mu = edges ? pair.slidingFriction : 0.0;
  Softness s =
      softnessAt(pair.impedance, distance, weight * (1.0 + mu * mu), options.rowTimestep());
  if (!edges) return s;
  double scale = 2.0 * mu * mu / options.impedanceRatio;
  // (4.9): a friction above 1 makes no contact softer than one of 1.
  if (options.uses(Mechanism::supportedMass) && mu > 1.0)
    scale *= 2.0 / (mu * mu * (1.0 + mu * mu));
  s.R *= scale;
  s.perInertia *= scale;
  return s;
}

ContactAtRest contactAtRest(const Material& pair, double weight, double load,
                            const Options& options) {
  const int dim = frictionDim(pair, options.effects);
  const bool edges = dim > 0 && options.cone == Cone::pyramidal;
  const int rows = edges ? 2 * dim : 1;
  const auto softness = [&](double depth) {
    return contactSoftness(pair, dim, -depth, weight, options);
  };
  const auto force = [&](double depth) {
    const Softness s = softness(depth);
    return rows * s.stiffness * depth / s.R;
  };
  // Deeper is harder: bisect between a depth that is too small and one that is not.
  ContactAtRest rest;
  double low = 0.0, high = 1e-12;
  while (force(high) < load && high < kInfinity) low = high, high *= 2.0;
  for (double middle = 0.5 * (low + high); low < middle && middle < high;
       middle = 0.5 * (low + high))
    (force(middle) < load ? low : high) = middle;
  rest.depth = high;
  const Softness s = softness(high);
  const double mu = pair.slidingFriction, ratio = options.impedanceRatio;
  rest.stiffness = load / high;
  rest.damping = rows * s.damping / s.R;
  // An elliptic cone holds in its bottom zone, whose end is μ f_n: there f_n is still that of D.
  if (edges) {
    rest.mobility = s.R / (2.0 * mu * mu * s.damping);
    rest.stickForce = mu * load / dim;
  } else if (dim > 0) {
    rest.mobility = s.R / (ratio * s.damping);
    rest.stickForce = mu * load;
  }
  // R = (1 − d)/d A, k d = K/d and b = B/d, solved for d, K and B.
  const double A = edges ? 2.0 * mu * mu / ratio * weight * (1.0 + mu * mu) : weight;
  const double d = A / (A + s.R);
  rest.equivalent.dMin = rest.equivalent.dMax = d;
  rest.equivalent.direct = {s.stiffness * d, s.damping * d};
  return rest;
}

}  // namespace softgauss
