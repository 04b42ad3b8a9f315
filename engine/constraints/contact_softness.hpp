// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How soft the rows of a contact are, by its impedance or by a spring and a damper of N/m and N
/// s/m, and what that comes to: how deep it sinks, how fast it creeps.
///
/// A spring: with r < 0 the distance less the margin, K the stiffness and B the damping, the normal
/// force is that of the end of the step, r⁺ = r + h ẏ + h² y and ẏ⁺ = ẏ + h y (3.8):
///   f = max(0, −K r⁺ − B ẏ⁺) = max(0, −D (y − a_ref)),   D = h (K h + B),   a_ref = −ẏ/h − (K/D) r
/// At rest f = −K r, whatever mass and friction are, and no stiffness makes the step unstable. The
/// edges of a friction pyramid share D alike; an elliptic cone has it along the normal.
///
/// What bounces, a reference of an impedance that is at most half damped, is such a spring too, of
/// the mass that the two trees have by themselves (3.11): a reference pushes whatever mass is
/// behind it, so that a light body that is pressed in as it bounces would throw up a heavy one.

#include <optional>

#include "softgauss/engine/constraints/impedance.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss {

/// The mass that rests on a contact between two bodies [kg]: that of the lighter of their trees.
/// The world rests on nothing; 0 where neither body moves.
double restingMass(const Model& model, int bodyA, int bodyB);

/// The same spring by its stiffness and damping alone (3.9): K = m g/restDepth and
/// B = 2 dampingRatio √(K m), with `mass` m [kg] and `gravity` g [m/s²] > 0.
ContactSpring inNewtons(const ContactSpring& spring, double mass, double gravity);

/// Two springs in newtons, one behind the other, pressed by the same force (3.10); the damping is
/// that of slow motion.
ContactSpring inSeries(const ContactSpring& a, const ContactSpring& b);

/// m_A m_B/(m_A + m_B) of the masses of their trees [kg]; the world's is infinite. 0 where neither
/// body moves.
double reducedMass(const Model& model, int bodyA, int bodyB);

/// K and B of an impedance, its time constant at least two steps (3.2).
ReferenceSpring referenceOf(const Impedance& p, double timestep);

/// h² K of the fastest spring that a step lets bounce (3.5): half a radian.
inline constexpr double kFastestBounce = 0.25;

/// K and B, as (3.5) lets them bounce, of a reference that is at most half damped, B² ≤ K;
/// else nothing.
std::optional<ReferenceSpring> underdampedReference(const Impedance& p, const Options& options);

/// The row (3.14) of that spring on what has the inverse inertia A.
std::optional<Softness> bouncingSoftness(const Impedance& p, double inverseInertia,
                                         const Options& options);

/// What a step takes for the surface of a pair of this reduced mass [kg]: itself or, where it
/// bounces, its spring (3.11).
Material effectiveMaterial(const Material& pair, double mass, const Options& options);

/// Directions of friction that a contact has with the effects that are switched on: condim − 1; 0
/// where it is frictionless. Rolling friction comes with torsional friction.
int frictionDim(const Material& pair, const EffectSet& effects);

/// R, k d and b of the row along the normal, or with pyramids of each of the 2 `frictionDim` edges
/// (4.7), (3.8). `pair` is the surface that is in force, its spring in newtons; `distance` is
/// measured from the margin, `weight` is w_A + w_B [1/kg].
Softness contactSoftness(const Material& pair, int frictionDim, double distance, double weight,
                         const Options& options);

/// One contact that holds still under a load along its normal.
struct ContactAtRest {
  double depth = 0.0;       ///< below the margin [m]
  double stiffness = 0.0;   ///< load/depth [N/m]
  double damping = 0.0;     ///< normal force per normal speed, at that depth [N s/m]
  double mobility = 0.0;    ///< creep: tangential speed per tangential force [m/(N s)]
  double stickForce = 0.0;  ///< tangential force up to which that holds [N]
  Impedance equivalent;     ///< impedance of constant d that has all this too, at this `weight`
};

/// Of the contact that contactSoftness() describes, under `load` > 0 [N] (3.12).
ContactAtRest contactAtRest(const Material& pair, double weight, double load,
                            const Options& options);

}  // namespace softgauss
