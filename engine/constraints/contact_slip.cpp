// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/contact_slip.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace softgauss {
namespace {

/// Where the centre of mass cannot move, a wheel's on its stand, a push moves p by turning the body
/// alone: this share of that counts at least, or the row's mass would be without bound.
constexpr double kTurned = 1e-4;

/// V (5.11): by how much a slip [m/s] is faster than what friction stops within the row's horizon,
/// where its contact `presses` by so much [m/s²], or by its weight.
double slipNumber(const Options& options, const Touch& touch, double slip, double presses) {
  const double horizon = std::max(options.timestep, 1.0 / touch.softness.damping);
  const double load = gainOf(options, touch, touch.softness) * std::max(0.0, presses);
  const double stopped = touch.mu() * horizon * std::max(touch.gravity, load);
  return stopped > 0.0 ? slip / stopped : (slip > 0.0 ? kInfinity : 0.0);
}

/// m (5.12): what friction changes this slip by, over what it changes a slide by.
double mobilityOf(const Assembly& in, const Contact& c, const Touch& touch,
                  const std::array<double, 5>& direction) {
  if (touch.frictionDim <= 2) return 1.0;
  const double turns = in.weights.rotation[c.bodyA] + in.weights.rotation[c.bodyB];
  double m = 0.0;
  for (int k = 0; k < touch.frictionDim; ++k)
    m += std::pow(direction[k] * touch.friction[k] / touch.mu(), 2.0) *
         (k < 2 ? 1.0 : turns / touch.inverseMass);
  return m;
}

/// β (5.8): how much of s friction meets for each m/s² that the normal force adds to ẏ_n. A slide
/// of what is round turns it too, about a lever that stays; other levers change as bodies tip, and
/// are left out.
double brakesPerPush(const Assembly& in, const Contact& c, const Touch& touch, const Slip& slip,
                     double mobility) {
  double turns = 0.0;
  for (const auto& [body, geometry] : {std::pair(c.bodyA, c.geometryA), {c.bodyB, c.geometryB}}) {
    const Shape& shape = in.model.geometries[geometry].shape;
    if (shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::capsule)
      turns += in.weights.rotation[body] * shape.radius * shape.radius;
  }
  turns /= in.weights.translation[c.bodyA] + in.weights.translation[c.bodyB];
  double slides = 0.0;
  for (int k = 0; k < 2; ++k) slides += std::pow(slip.direction[k] * touch.friction[k], 2.0);
  return touch.mu() * touch.mu() * mobility + slides * turns;
}

/// Whether slip may push the bodies of a contact apart: nothing glides whose centre of mass cannot
/// move.
bool mayGlide(const Assembly& in, const Contact& c, const Touch& touch) {
  return in.weights.translation[c.bodyA] + in.weights.translation[c.bodyB] >
         kTurned * touch.turnedWeight;
}

}  // namespace

double weightAt(const Assembly& in, int body, double turned) {
  const double ofCentre = in.weights.translation[body];
  if (in.model.options.constraintModel == ConstraintModel::mujoco) return ofCentre;
  return std::max(ofCentre, kTurned * turned);
}

double gainOf(const Options& options, const Touch& touch, const Softness& soft) {
  const bool edges = options.cone == Cone::pyramidal && touch.frictionDim > 0;
  return (edges ? 2 * touch.frictionDim : 1) * touch.inverseMass / soft.R;
}

double slipNumber(const Assembly& in, const Contact& contact, const Touch& touch,
                  const std::array<double, 6>& velocity) {
  double squares = 0.0;
  std::array<double, 5> direction{};
  for (int k = 0; k < touch.frictionDim; ++k) {
    direction[k] = touch.friction[k] * velocity[k + 1];
    squares += direction[k] * direction[k];
  }
  const double speed = std::sqrt(squares);
  if (!(speed > 0.0)) return 0.0;
  for (double& d : direction) d /= speed;
  return slipNumber(in.model.options, touch,
                    speed / (mobilityOf(in, contact, touch, direction) * touch.mu()),
                    -touch.softness.stiffness * touch.distance);
}

bool holdsWeight(const Assembly& in, const Contact& contact, const Touch& touch) {
  if (touch.frictionDim == 0 || in.controlled(contact.bodyA, contact.bodyB)) return false;
  if (in.load && in.load->isTied(in.model, contact.bodyA, contact.bodyB)) return false;
  // Between its tangents a pyramid has 0.7 of what it has along them.
  constexpr double kShare = 0.5;
  const Vector3& g = in.model.options.gravity;
  return contact.n_W.cross(g).norm() >
         kShare * touch.mu() / touch.frictionDim * std::abs(contact.n_W.dot(g));
}

WishedTangent tangentOf(const Assembly& in, const Contact& contact, const Touch& touch,
                        const Motion& slips_W) {
  constexpr double kTurnsStably = 0.5;
  const Options& options = in.model.options;
  if (touch.frictionDim == 0 || options.cone != Cone::pyramidal || !options.correctsSlip() ||
      !mayGlide(in, contact, touch))
    return {contact.tangent_W};
  const Softness& s = touch.softness;
  const double normal = contact.n_W.dot(slips_W.linear);
  const double presses =
      std::max(0.0, -s.stiffness * touch.distance) +
      std::max(0.0, -s.damping * normal) /
          (1.0 + gainOf(options, touch, touch.softness) * options.timestep * s.damping);
  const auto turnsStably = [&](double slip) {
    return slipNumber(options, touch, slip, presses) > kTurnsStably;
  };
  if (turnsStably((slips_W.linear - normal * contact.n_W).norm())) return {slips_W.linear};
  if (touch.frictionDim >= 4) {
    const Vector3 roll = slips_W.angular - contact.n_W * contact.n_W.dot(slips_W.angular);
    const double turns = in.weights.rotation[contact.bodyA] + in.weights.rotation[contact.bodyB];
    const double slides = touch.friction[3] * turns / (touch.mu() * touch.inverseMass);
    if (turnsStably(roll.norm() / slides)) return {roll};
  }
  if (touch.holdsWeight) return {options.gravity, true};
  return {contact.tangent_W};
}

Slip ContactBlocks::slipOf(const Assembly& in, const Touch& touch, const Softness& soft,
                           const BlockMotion& moves) const {
  constexpr double kSure = 30.0;
  const Options& options = in.model.options;
  Slip slip;
  slip.dim = touch.frictionDim;
  slip.damping = options.timestep * soft.damping;
  slip.asked = soft.damping * slipSpeed(touch, moves.velocity);
  if (!(slip.asked > 0.0)) return slip;
  const Contact& contact = in.contacts.contacts[contactsWithRows_.back().contact];
  if (!mayGlide(in, contact, touch)) return slip;
  for (int k = 0; k < slip.dim; ++k)
    slip.direction[k] = -touch.friction[k] * soft.damping * moves.velocity[k + 1] / slip.asked;
  const double m = mobilityOf(in, contact, touch, slip.direction);
  slip.asksFor = std::clamp(1.0 / m, 1.0, 2.0 * slip.dim);
  slip.share =
      std::min(1.0, kSure * slipNumber(options, touch, slip.asked / (m * soft.damping * touch.mu()),
                                       -soft.stiffness * touch.distance));
  in.count(Mechanism::slipCorrection, slip.share == 1.0);
  const double brakes = brakesPerPush(in, contact, touch, slip, m);
  slip.met = metLast(in, moves, slip, brakes);
  const double gain = gainOf(options, touch, soft);
  const double push = soft.referenceAcceleration(moves.velocity[0], touch.distance);
  const double load = std::max(touch.gravity, slip.met / brakes);
  slip.met += brakes * std::max(0.0, (gain * push - load) / (1.0 + gain));
  slip.met = std::clamp(slip.met, -slip.asked, slip.asked);
  return slip;
}

double ContactBlocks::metLast(const Assembly& in, const BlockMotion& moves, const Slip& slip,
                              double brakes) const {
  if (!in.state.hasAcceleration) return 0.0;
  double last[6];
  const int block = jacobian_.size() - 1;
  if (in.lastMotion)
    jacobian_.multiply(block, BodyMotion{in.state.a, *in.lastMotion}, last);
  else
    jacobian_.multiply(block, in.state.a, last);
  double met = 0.0;
  for (int k = 0; k < slip.dim; ++k)
    met += slip.direction[k] * contactsWithRows_.back().friction[k] *
           (last[k + 1] + moves.bias[k + 1]);
  const double leaves = last[0] + moves.bias[0];
  return met > 0.0 && leaves > 0.0 ? std::max(0.0, met - brakes * leaves) : met;
}

}  // namespace softgauss
