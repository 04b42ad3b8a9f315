// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "softgauss/engine/constraints/contact_motion.hpp"
#include "softgauss/engine/constraints/contact_rotation.hpp"
#include "softgauss/engine/constraints/contact_slip.hpp"
#include "softgauss/engine/constraints/contact_softness.hpp"
#include "softgauss/engine/constraints/law/row_law.hpp"
#include "softgauss/engine/constraints/stiction.hpp"
#include "softgauss/engine/core/rotation.hpp"

namespace softgauss {
namespace {

/// Share of the first of two weights; half where both vanish.
double shareOf(double a, double b) {
  constexpr double kSmallest = 1e-15;
  if (a < kSmallest && b < kSmallest) return 0.5;
  if (a < kSmallest) return 0.0;
  return b < kSmallest ? 1.0 : a / (a + b);
}

/// A wished tangent is followed as long as rounding does not decide where it points: this sine of
/// the angle between it and the normal.
constexpr double kSmallestSine = 1e-6;

/// Columns n, t₁, t₂, with t₁ along what is `wished` of the plane.
Matrix3 contactFrame(const Vector3& n_W, const Vector3& wished) {
  Vector3 t = wished - n_W * n_W.dot(wished);
  const double length = t.norm();
  if (!(length > kSmallestSine * wished.norm())) return frameFromNormal(n_W);
  t /= length;
  Matrix3 R;
  R << n_W, t, n_W.cross(t);
  return R;
}

/// World vectors in the frame of a contact; turning only where its friction has moments.
ContactBlocks::FrameVector inFrame(const Matrix3& R_WC, int frictionDim, const Motion& y) {
  ContactBlocks::FrameVector frame{};
  Eigen::Map<Vector3>(frame.data()).noalias() = R_WC.transpose() * y.linear;
  if (frictionDim > 2)
    Eigen::Map<Vector3>(frame.data() + 3).noalias() = R_WC.transpose() * y.angular;
  return frame;
}

/// J̇ v of its rows: that along the tangents by its share.
ContactBlocks::FrameVector biasInFrame(const ContactRows& contact, const Motion& bias) {
  ContactBlocks::FrameVector y = inFrame(contact.R_WC, contact.frictionDim, bias);
  for (std::size_t k = 1; k < y.size(); ++k) y[k] *= contact.share;
  return y;
}

/// Residual of a row that holds its body at rest under `acceleration` [m/s²].
double residualUnder(double acceleration, const Options& options, const Touch& touch) {
  return acceleration / gainOf(options, touch, touch.softness);
}

/// Speed at which it creeps under its weight [m/s].
double creepUnderWeight(const Options& options, const Touch& touch) {
  return residualUnder(touch.gravity, options, touch) / touch.softness.damping;
}

/// What presses by the weight and by J̇ v [m/s²].
double presses(const Touch& touch, const Vector3& n_W, const ContactBias& bias) {
  return touch.gravity + std::max(0.0, -n_W.dot(bias.rate.linear));
}

/// Whether J̇ v counts as deep as the contact lies: as deep as that says, and deeper where it lies
/// at most half as deep again as its weight and J̇ v press it at rest. So deep it goes in and out as
/// on a spring (4.12). What came in deeper, by a fall, they would push out by more than what it
/// came in against, and it would gain.
bool isWithinBiasDepth(const Options& options, const Touch& touch, double load,
                       const ContactBias& bias) {
  const double atRest = residualUnder(load, options, touch) / touch.softness.stiffness;
  return -touch.distance < std::min(bias.loadedBiasDepth, std::max(bias.biasDepth, 1.5 * atRest));
}

/// (x/most)⁻² where x > most, else 1.
double fallsOff(double x, double most) { return x > most ? std::pow(most / x, 2.0) : 1.0; }

/// Share of J̇ v that friction answers: all where the contact may stick, none where it slides, for
/// what slides is held back along its slip, however that turns. It may stick up to 300 times the
/// speed at which it creeps under its weight, and as long as friction of thrice what presses holds
/// J̇ v.
double stickingShare(const Options& options, const Touch& touch, double load,
                     const ContactBlocks::FrameVector& velocity, const Vector3& alongTangents) {
  constexpr double kCreeps = 300.0, kHeld = 3.0;
  if (touch.frictionDim == 0) return 1.0;
  const double slip = touch.mu() * std::hypot(velocity[1], velocity[2]);
  return fallsOff(slip, kCreeps * creepUnderWeight(options, touch)) *
         fallsOff(alongTangents.norm(), kHeld * touch.mu() * load);
}

}  // namespace

Material mixMaterials(const Material& a, const Material& b) {
  if (a.priority != b.priority) {
    Material m = a.priority > b.priority ? a : b;
    m.margin = a.margin + b.margin;
    return m;
  }
  Material m;
  m.slidingFriction = std::max(a.slidingFriction, b.slidingFriction);
  m.torsionalFriction = std::max(a.torsionalFriction, b.torsionalFriction);
  m.rollingFriction = std::max(a.rollingFriction, b.rollingFriction);
  m.condim = std::max(a.condim, b.condim);
  m.margin = a.margin + b.margin;
  m.impedance = mixImpedances(a.impedance, b.impedance, shareOf(a.mixWeight, b.mixWeight));
  m.spring = a.spring && b.spring ? inSeries(*a.spring, *b.spring) : a.spring ? a.spring : b.spring;
  return m;
}

Material pairMaterial(const Model& model, int geometryA, int geometryB) {
  const Geometry &first = model.geometries[geometryA], &second = model.geometries[geometryB];
  const auto inUse = [&](Material m) {
    if (m.spring)
      m.spring = inNewtons(*m.spring, restingMass(model, first.body, second.body),
                           model.options.gravity.norm());
    return m;
  };
  if (!model.contactPairs.empty()) {
    const auto [a, b] = std::minmax(geometryA, geometryB);
    const auto at = std::lower_bound(
        model.contactPairs.begin(), model.contactPairs.end(), std::pair<int, int>(a, b),
        [](const ContactPair& p, auto key) { return std::pair(p.geometryA, p.geometryB) < key; });
    if (at != model.contactPairs.end() && at->geometryA == a && at->geometryB == b)
      return inUse(at->material);
  }
  if (!first.material.spring && !second.material.spring)
    return mixMaterials(first.material, second.material);
  return mixMaterials(inUse(first.material), inUse(second.material));
}

namespace {

/// Whether joints may press at a contact, and not weights alone.
bool jointsPress(const Model& model, const Contact& c) {
  const auto isJointed = [&](int body) {
    const int tree = model.bodies[body].tree;
    return tree >= 0 && !model.isFree(model.trees[tree].rootBody);
  };
  return isJointed(c.bodyA) || isJointed(c.bodyB);
}

/// Whether bodies that are apart touch by the end of the step.
bool beginsNow(const Assembly& in, const Contact& c, double distance) {
  if (!in.model.options.hasRowLaw()) return false;
  const double rate = c.n_W.dot(pointVelocity(in.model, in.kinematics, c.bodyB, c.p_WC) -
                                pointVelocity(in.model, in.kinematics, c.bodyA, c.p_WC));
  return begins(distance, rate, in.model.options);
}

/// pair ← that of the contact, where it is not so already.
void findPair(const Assembly& in, const Contact& c, PairSurface& pair) {
  if (pair.geometryA == c.geometryA && pair.geometryB == c.geometryB) return;
  const Model& model = in.model;
  const Material surface = pairMaterial(model, c.geometryA, c.geometryB);
  pair.geometryA = c.geometryA, pair.geometryB = c.geometryB;
  pair.material = effectiveMaterial(surface, reducedMass(model, c.bodyA, c.bodyB), model.options);
  pair.nearRigid =
      model.options.hasRowLaw() && !pair.material.spring && pair.material.impedance == Impedance{};
  pair.frictionDim = frictionDim(pair.material, model.options.effects);
  pair.comA = in.kinematics.X_WB[c.bodyA] * model.bodies[c.bodyA].com;
  pair.comB = in.kinematics.X_WB[c.bodyB] * model.bodies[c.bodyB].com;
  pair.poses = posesOf(model, in.kinematics, c);
  pair.load = in.load ? in.load->mass(model, c.bodyA, c.bodyB) : 0.0;
  pair.leastLoad = in.load ? in.load->contactShare(model, c.bodyA, c.bodyB) : 0.0;
  pair.gravity = model.options.gravity.norm();
}

}  // namespace

std::optional<Touch> touchAt(const Assembly& in, int i, PairSurface& pair) {
  const Model& model = in.model;
  const Contact& c = in.contacts.contacts[i];
  if (model.bodies[c.bodyA].dofs == 0 && model.bodies[c.bodyB].dofs == 0) return std::nullopt;
  if (!in.takesPart(c.bodyA, c.bodyB)) return std::nullopt;
  findPair(in, c, pair);
  const Material& material = pair.material;
  Touch touch;
  touch.distance = c.distance - material.margin;
  // NaN makes rows, so that the solve reports it.
  const bool apart = touch.distance >= touchingWithin(model.options, c.p_WC);
  if (apart && (material.spring || !beginsNow(in, c, touch.distance))) return std::nullopt;
  touch.frictionDim = pair.frictionDim;
  const double turnedA = in.weights.rotation[c.bodyA] * (c.p_WC - pair.comA).squaredNorm();
  const double turnedB = in.weights.rotation[c.bodyB] * (c.p_WC - pair.comB).squaredNorm();
  touch.turnedWeight = turnedA + turnedB;
  double weight = weightAt(in, c.bodyA, turnedA) + weightAt(in, c.bodyB, turnedB);
  double load = pair.load;
  touch.gravity = pair.gravity;
  touch.nearRigid = pair.nearRigid;
  touch.supportsOthers =
      load > 0.0 && !material.spring;  // springs keep their penetration at rest and bounce
  load = std::max(load, pair.leastLoad);
  if (!material.spring) touch.loadStiffening = std::max(1.0, load * weight);
  in.count(Mechanism::supportedMass, load * weight > 1.0);
  weight = cappedInverseMass(weight, load);
  touch.inverseMass = weight;
  touch.softness =
      contactSoftness(material, touch.frictionDim, touch.distance, weight, model.options);
  if (apart) touch.softness = beginning(touch.softness, model.options);
  in.count(Mechanism::nearRigid, model.options.hasRowLaw() && !material.spring);
  if (touch.frictionDim > 0) {
    const double mu = material.slidingFriction;
    const double spin = std::max(material.torsionalFriction, kSmallestFriction);
    const double roll = std::max(material.rollingFriction, kSmallestFriction);
    touch.friction = {mu, mu, spin, roll, roll};
    touch.holdsWeight = holdsWeight(in, c, touch);
  }
  return touch;
}

ContactBlocks::BlockMotion ContactBlocks::addBlock(const Assembly& in, int i,
                                                   const PairSurface& pair, const Touch& touch,
                                                   int row) {
  const Model& model = in.model;
  const Contact& c = in.contacts.contacts[i];
  const Kinematics& k = in.kinematics;
  const Motion slips{
      k.V[c.bodyB].angular - k.V[c.bodyA].angular,
      pointVelocity(model, k, c.bodyB, c.p_WC) - pointVelocity(model, k, c.bodyA, c.p_WC)};
  const WishedTangent wished = tangentOf(in, c, touch, slips);
  const Matrix3 R_WC = contactFrame(c.n_W, wished.t_W);
  // The contacts of a pair are neighbours in the set.
  const std::vector<Contact>& all = in.contacts.contacts;
  int place = 0;
  while (place < i && all[i - place - 1].geometryA == c.geometryA &&
         all[i - place - 1].geometryB == c.geometryB)
    ++place;
  contactsWithRows_.push_back({i, c.geometryA, c.geometryB, c.bodyA, c.bodyB, place, row, R_WC,
                               touch.frictionDim, touch.friction, touch.loadStiffening, 1.0, 1.0,
                               wished.ofGravity});

  RelativeMotion motion;
  motion.bodyA = c.bodyA;
  motion.bodyB = c.bodyB;
  motion.p_WA = motion.p_WB = c.p_WC;
  motion.linear = motion.angular = R_WC;
  motion.linearDim = touch.frictionDim > 0 ? 3 : 1;
  motion.angularDim = std::max(0, touch.frictionDim - 2);
  jacobian_.add(model, in.kinematics, in.tree, motion, in.columns);

  BlockMotion moves;
  moves.velocity = inFrame(R_WC, touch.frictionDim, slips);
  if (!model.options.uses(Mechanism::contactBiasAcceleration)) return moves;
  if (const std::optional<ContactBias> bias = contactBias(model, k, pair.poses, c)) {
    const Vector3 tangents = bias->rate.linear - c.n_W * c.n_W.dot(bias->rate.linear);
    const double load = presses(touch, c.n_W, *bias);
    if (isWithinBiasDepth(model.options, touch, load, *bias)) {
      contactsWithRows_.back().share =
          stickingShare(model.options, touch, load, moves.velocity, tangents);
      moves.bias = biasInFrame(contactsWithRows_.back(), bias->rate);
      in.count(Mechanism::contactBiasAcceleration, true);
      for (std::size_t axis = 0; axis < moves.bias.size(); ++axis)
        moves.velocity[axis] -= in.velocityLag() * moves.bias[axis];
    }
  }
  return moves;
}

double ContactBlocks::slipSpeed(const Touch& touch, const FrameVector& velocity) {
  double squares = 0.0;
  for (int k = 0; k < touch.frictionDim; ++k)
    squares += std::pow(touch.friction[k] * velocity[k + 1], 2.0);
  return std::sqrt(squares);
}

Softness ContactBlocks::soften(const Assembly& in, const Touch& touch,
                               const FrameVector& velocity) {
  const Softness& soft = touch.softness;
  const Contact& contact = in.contacts.contacts[contactsWithRows_.back().contact];
  const std::uint8_t controlled = in.controlled(contact.bodyA, contact.bodyB);
  // What stands alone on a softness that is given creeps as that says.
  if (!(touch.nearRigid || touch.supportsOthers) || touch.distance >= 0.0 ||
      touch.frictionDim == 0 || !in.model.options.uses(Mechanism::stiction) ||
      controlled == kControlledSoft)
    return soft;
  if (!(soft.damping * soft.damping >= 4.0 * soft.stiffness)) return soft;  // it bounces
  ContactSpeeds speeds{slipSpeed(touch, velocity), std::abs(velocity[0])};
  speeds.weight = creepUnderWeight(in.model.options, touch);
  speeds.creep = speeds.weight - soft.stiffness * touch.distance / soft.damping;
  // Of free bodies that rest on one another friction stays softer: with a, heaps would take a third
  // more time.
  const bool maySqueeze = !touch.supportsOthers || jointsPress(in.model, contact);
  if (maySqueeze && touch.holdsWeight) {
    speeds.sticks = std::max(0.0, 1.0 - slipNumber(in, contact, touch, velocity));
    if (in.model.options.cone == Cone::elliptic)
      speeds.slidesFrom = coneCreep(touch.mu() / std::sqrt(in.model.options.impedanceRatio));
  }
  Hardening most = touch.supportsOthers ? kCarries : kAlone;
  if (controlled) most.least = kLeastUnderGoals;
  contactsWithRows_.back().regularisationScale = speeds.regularisationScale(most);
  in.count(Mechanism::stiction, contactsWithRows_.back().regularisationScale < 1.0);
  return stiffened(soft, contactsWithRows_.back().regularisationScale);
}

void ContactBlocks::indexRows(std::size_t rows) {
  contactOfRow_.resize(rows);
  for (std::size_t i = 0; i < contactsWithRows_.size(); ++i) {
    const std::size_t end = i + 1 < contactsWithRows_.size() ? contactsWithRows_[i + 1].row : rows;
    for (std::size_t row = contactsWithRows_[i].row; row < end; ++row)
      contactOfRow_[row] = static_cast<int>(i);
  }
}

}  // namespace softgauss
