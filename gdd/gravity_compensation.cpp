// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/gravity_compensation.hpp"

#include "softgauss/engine/core/segment_vectors.hpp"

namespace softgauss::gdd {

GravityCompensation::GravityCompensation(const Model& model)
    : factor_(model), motions_(model.bodies.size()) {}

/// force ← c(q, 0).
void GravityCompensation::setStatics(const Model& model, const State& state, const Data& data) {
  const SmoothForces& smooth = data.forces;
  for (VectorX* x : {&force_, &x_, &Px_})
    if (x->size() != model.nv) x->setZero(model.nv);
  for (const Segment s : data.active.dofs()) {
    part(force_, s) = part(smooth.c, s) - part(smooth.bias, s);
    if (data.plan.hasDamping())
      part(force_, s) -= part(data.plan.damping, s).cwiseProduct(part(state.v, s));
  }
  if (!data.plan.gravity) return;
  const Vector3 up = -model.options.gravity;
  for (const Segment s : data.active.bodies())
    for (int b = s.begin; b < s.end; ++b) {
      const Body& body = model.bodies[b];
      const Inertia& all = data.inertia.composite[b];
      const Force weight{all.h.cross(up), all.mass * up};
      for (int i = body.v; i < body.v + body.dofs; ++i)
        force_[i] += dot(data.kinematics.S[i], weight);
    }
}

/// Whether there is a z.
bool GravityCompensation::findFree(const Model& model, const ControlLimits& limits, Segments dofs) {
  free_.resize(static_cast<std::size_t>(force_.size()));
  bool any = false;
  for (const Segment s : dofs)
    for (int i = s.begin; i < s.end; ++i) {
      const bool pulled = limits.transmission && limits.transmission->pulls(i);
      free_[i] = !pulled && (!model.dofs[i].actuated || limits.lower[i] == limits.upper[i]);
      any |= free_[i] != 0;
    }
  return any;
}

/// x ← the free fall of what floats, joints at rest.
void GravityCompensation::setFall(const Model& model, const Data& data) {
  setZero(data.active.dofs(), x_);
  if (!data.plan.gravity) return;
  for (const Segment s : data.active.bodies())
    for (int b = s.begin; b < s.end; ++b) {
      const Body& body = model.bodies[b];
      if (body.joint != JointKind::floating) continue;
      for (int i = body.v; i < body.v + 3; ++i)
        if (free_[i]) x_[i] = data.kinematics.S[i].linear.dot(model.options.gravity);
    }
}

/// force ← force + P x, x the acceleration of z.
void GravityCompensation::stand(const Model& model, const ControlLimits& limits, Data& data) {
  constexpr double kStiffer = 1e4;  // κ: rows at rest have carried the weight that this leaves over
  Constraints& rows = data.constraints;
  const Segments dofs = data.active.dofs();
  const int island = rows.selected();
  pairs_.clear();
  rows.appendPairs(pairs_);
  if (island < 0) {
    factor_.couple(pairs_);
    factor_.begin(model, data.inertia, kStiffer);
  } else {
    factor_.couple(pairs_, data.bodies.islands);
    factor_.begin(model, data.inertia, data.bodies.islands, island, kStiffer);
  }
  const bool any = rows.selectedRows() > 0;
  if (any) {
    bool changed = false;
    setFall(model, data);
    rows.setResidual(x_);
    rows.evaluate(changed);
    rows.addCurvature(factor_);
  }
  setZero(dofs, x_);
  for (const Segment s : dofs)
    for (int i = s.begin; i < s.end; ++i)
      if (free_[i])
        x_[i] = (limits.lower[i] == limits.upper[i] ? limits.lower[i] : 0.0) - force_[i];
      else
        factor_.lock(i);
  if (!factor_.factor(model, data.kinematics)) return;  // not finite: the solver will say so
  factor_.solve(model, data.kinematics, x_, motions_);

  setZero(dofs, Px_);
  if (any) {
    rows.setRay(x_);
    rows.addForceRate(Px_);  // −G x
  }
  for (const Segment s : dofs) part(force_, s) -= kStiffer * part(Px_, s);
  data.inertia.hat().multiply(dofs, x_, Px_);
  for (const Segment s : dofs) part(force_, s) += part(Px_, s);
}

const VectorX& GravityCompensation::compute(const Model& model, const State& state,
                                            const ControlLimits& limits, Data& data) {
  setStatics(model, state, data);
  if (findFree(model, limits, data.active.dofs())) stand(model, limits, data);
  return force_;
}

}  // namespace softgauss::gdd
