// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/tree_motion.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/memory.hpp"
#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/step/integrators/tableau.hpp"

namespace softgauss {
namespace {

const Tableau& DP = kDormandPrince;

Quaternion quaternionAt(const VectorX& q, int i) { return {q[i], q[i + 1], q[i + 2], q[i + 3]}; }

}  // namespace

const double TreeMotion::kErrorRate = 1e-5;
const int TreeMotion::kMaxSubsteps = 4000;

TreeMotion::TreeMotion(const Model& model) : acceleration_(model), q_(model.q0) {
  for (VectorX* x : {&v_, &u_, &w_, &du_, &dv_, &angle_, &tau_}) *x = VectorX::Zero(model.nv);
  for (int i = 0; i < DP.stages; ++i) Ku_[i] = Kv_[i] = VectorX::Zero(model.nv);
}

std::size_t TreeMotion::bytes() const {
  std::size_t sum = bytesOfAll(q_, v_, u_, w_, du_, dv_, angle_, tau_) + acceleration_.bytes();
  for (int i = 0; i < DP.stages; ++i) sum += bytesOfAll(Ku_[i], Kv_[i]);
  return sum;
}

/// u̇ and ẇ at q₀ ⊕ u with the velocity w.
void TreeMotion::derivative(const Model& model, const Plan& plan, const Tree& tree) {
  const int f = tree.firstDof, n = tree.dofEnd - f;
  TreeAcceleration::At at{Matrix3::Identity(),
                          angle_.data(),
                          w_.data(),
                          tau_.data(),
                          plan.gravity ? model.options.gravity : Vector3::Zero(),
                          plan.coriolis};
  tau_.segment(f, n) = held_->segment(f, n);
  du_.segment(f, n) = w_.segment(f, n);
  int joints = tree.rootBody;
  const Body& root = model.bodies[idx(tree.rootBody)];
  if (root.joint == JointKind::floating) {
    const Vector3 phi = u_.segment<3>(f + 3), omega = w_.segment<3>(f + 3);
    at.R_root = (quaternionAt(q_, root.q + 3) * quaternionExp(phi)).toRotationMatrix();
    du_.segment<3>(f + 3) = rotationRate(phi, omega);
    tau_.segment<3>(f + 3) += at.R_root.transpose() * heldInWorld_;
    ++joints;
  }
  for (int b = joints; b < tree.bodyEnd; ++b) {
    const Body& body = model.bodies[idx(b)];
    angle_[body.v] = q_[body.q] + u_[body.v];
  }
  if (plan.hasDamping())
    tau_.segment(f, n) -= plan.damping.segment(f, n).cwiseProduct(w_.segment(f, n));
  for (const Plan::Spring& s : plan.springs)
    if (s.dof >= f && s.dof < tree.dofEnd)
      tau_[s.dof] -= s.stiffness * (angle_[s.dof] - s.reference);
  acceleration_.compute(at, dv_.data());
}

/// q₀ ← q₀ ⊕ u, v ← w: the next sub-step begins here.
void TreeMotion::rebase(const Model& model, const Tree& tree) {
  for (int b = tree.rootBody; b < tree.bodyEnd; ++b) {
    const Body& body = model.bodies[idx(b)];
    if (body.joint == JointKind::floating) {
      q_.segment<3>(body.q) += u_.segment<3>(body.v);
      const Quaternion r =
          (quaternionAt(q_, body.q + 3) * quaternionExp(Vector3(u_.segment<3>(body.v + 3))))
              .normalized();
      q_.segment<4>(body.q + 3) = Eigen::Vector4d(r.w(), r.x(), r.y(), r.z());
    } else {
      q_[body.q] += u_[body.v];
    }
  }
  v_.segment(tree.firstDof, tree.dofEnd - tree.firstDof) =
      w_.segment(tree.firstDof, tree.dofEnd - tree.firstDof);
}

void TreeMotion::start(const Model& model, const State& state, const Tree& tree,
                       const VectorX& held) {
  const int f = tree.firstDof, n = tree.dofEnd - f;
  const Body& root = model.bodies[idx(tree.rootBody)];
  const int coordinates = root.joint == JointKind::floating ? n + 1 : n;
  q_.segment(root.q, coordinates) = state.q.segment(root.q, coordinates);
  v_.segment(f, n) = state.v.segment(f, n);
  u_.segment(f, n).setZero();
  w_.segment(f, n) = v_.segment(f, n);
  held_ = &held;
  heldInWorld_.setZero();
  acceleration_.take(model, tree);
}

void TreeMotion::acceleration(const Model& model, const Plan& plan, const Tree& tree,
                              const State& at, const VectorX& held, VectorX& vdot) {
  const int f = tree.firstDof, n = tree.dofEnd - f;
  start(model, at, tree, held);
  derivative(model, plan, tree);
  vdot.segment(f, n) = dv_.segment(f, n);
}

/// √(2 K), and what weight and forces could give the tree in `duration` from rest: of weight no
/// more than free fall, for joints only take from that. Errors are judged by it.
double TreeMotion::speed(const Model& model, const Plan& plan, const Tree& tree,
                         const VectorX& scale, double duration) const {
  const int f = tree.firstDof, n = tree.dofEnd - f;
  const double fall = plan.gravity ? std::sqrt(tree.mass) * model.options.gravity.norm() : 0.0;
  const double pushed = tau_.segment(f, n).cwiseProduct(scale.segment(f, n)).cwiseAbs().maxCoeff();
  return std::sqrt(acceleration_.twiceKinetic(v_.data())) + duration * (fall + pushed);
}

/// Of a sub-step k, the largest of a velocity or, over the whole duration, a displacement.
double TreeMotion::errorOf(const Tree& tree, const VectorX& scale, double duration,
                           double k) const {
  double error = 0.0;
  for (int i = tree.firstDof; i < tree.dofEnd; ++i) {
    double eu = 0.0, ev = 0.0;
    for (int j = 0; j < DP.stages; ++j) {
      eu += DP.e[j] * Ku_[j][i];
      ev += DP.e[j] * Kv_[j][i];
    }
    const double e = k * std::max(std::abs(ev), std::abs(eu) / duration) / scale[i];
    if (!(e <= error)) error = e;  // NaN stays
  }
  return error;
}

TreeMotion::Outcome TreeMotion::run(const Model& model, const Plan& plan, const Tree& tree,
                                    const State& state, const VectorX& held,
                                    const Vector3& heldInWorld, const VectorX& scale,
                                    double duration) {
  constexpr double kFirst = 0.3;  // that a body turns by in the first sub-step [rad]
  const int f = tree.firstDof, n = tree.dofEnd - tree.firstDof;
  const auto part = [&](VectorX& x) { return x.segment(f, n); };
  const auto evaluate = [&](int stage) {
    derivative(model, plan, tree);
    part(Ku_[stage]) = part(du_);
    part(Kv_[stage]) = part(dv_);
  };
  start(model, state, tree, held);
  heldInWorld_ = heldInWorld;
  substeps_ = 0;
  evaluate(0);
  const double allowed = kErrorRate * duration * speed(model, plan, tree, scale, duration);
  double left = duration;
  double k = std::min(duration, kFirst / std::max(acceleration_.fastestTurn(), kFirst / duration));
  for (int tries = 0; tries < kMaxSubsteps; ++tries) {
    const bool last = k >= left * (1.0 - 1e-12);
    if (last) k = left;
    for (int i = 1; i < DP.stages; ++i) {
      part(u_).setZero();
      part(w_) = part(v_);
      for (int j = 0; j < i; ++j) {
        const double a = k * DP.a[i][j];
        if (a == 0.0) continue;
        part(u_) += a * part(Ku_[j]);
        part(w_) += a * part(Kv_[j]);
      }
      evaluate(i);
    }
    const double error = errorOf(tree, scale, duration, k);
    if (!std::isfinite(error) && k < 1e-9 * duration) return Outcome::notFinite;
    const double ratio = error / allowed;
    if (ratio <= 1.0 || error == 0.0) {
      ++substeps_;
      rebase(model, tree);
      if (last) return Outcome::done;
      left -= k;
      part(Ku_[0]) = part(v_);
      part(Kv_[0]) = part(Kv_[DP.stages - 1]);
    }
    k *= stepFactor(ratio, DP.order);
  }
  return Outcome::limit;
}

}  // namespace softgauss
