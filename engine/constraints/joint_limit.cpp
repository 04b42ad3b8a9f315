// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/joint_limit.hpp"

#include <cmath>

#include "softgauss/engine/constraints/carried_inertia.hpp"
#include "softgauss/engine/constraints/contact_softness.hpp"
#include "softgauss/engine/constraints/law/row_law.hpp"
#include "softgauss/engine/constraints/supported_mass.hpp"

namespace softgauss {
namespace {

/// M_ii of the joint of a body, and that of all joints which follow it, by the slopes of their
/// couplings.
double borneInertia(const Assembly& in, int body) {
  const Model& model = in.model;
  double inertia = supportedInertia(in, body);
  if (!model.options.effects.has(Effect::equality)) return inertia;
  const double q = in.state.q[model.bodies[body].q];
  for (const JointCoupling& c : model.couplings)
    if (c.leader == body) inertia += std::pow(c.slope(q), 2.0) * borneInertia(in, c.follower);
  return inertia;
}

/// Harder where the joint carries far more than it feels (5.4).
Softness limitSoftness(const Assembly& in, const JointRange& range, double r) {
  constexpr double kOfCarried = 0.2;
  const Options& options = in.model.options;
  const Impedance& p = range.impedance;
  const double weight = in.weights.dof[in.model.bodies[range.body].v];
  if (options.hasRowLaw())
    if (const auto bounces = bouncingSoftness(p, weight, options)) return *bounces;
  const double A = options.uses(Mechanism::supportedMass)
                       ? cappedInverseMass(weight, kOfCarried * borneInertia(in, range.body))
                       : weight;
  in.count(Mechanism::supportedMass, A < weight);
  in.count(Mechanism::nearRigid, options.hasRowLaw());
  if (options.hasRowLaw())
    return r < 0.0 ? rowLaw(p, r, A, options) : beginning(rowLaw(p, 0.0, A, options), options);
  return softnessAt(p, r, A, options.rowTimestep());
}

}  // namespace

void JointLimit::assemble(const Assembly& in) {
  const Model& model = in.model;
  clear();
  if (model.options.effects.has(Effect::jointLimit)) {
    for (const JointRange& range : model.ranges) {
      if (!in.takesPart(range.body)) continue;
      const Body& body = model.bodies[range.body];
      for (const double sign : {1.0, -1.0}) {
        const double bound = sign > 0.0 ? range.lower : range.upper;
        const double r = sign * (in.state.q[body.q] - bound) - range.margin;
        const double rate = sign * in.state.v[body.v];
        if (!(r < 0.0) && !(model.options.hasRowLaw() && begins(r, rate, model.options) &&
                            !underdampedReference(range.impedance, model.options)))
          continue;
        const Softness soft = limitSoftness(in, range, r);
        push(body.v, sign, soft, soft.referenceAcceleration(rate, r));
      }
    }
  }
  finish();
}

}  // namespace softgauss
