// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/tree_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/memory.hpp"
#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/core/spatial_matrix.hpp"
#include "softgauss/engine/step/integrators/tableau.hpp"

namespace softgauss {
namespace {

Quaternion quaternionAt(const VectorX& q, int i) { return {q[i], q[i + 1], q[i + 2], q[i + 3]}; }

}  // namespace

const double TreeMotion::kTolerance = 2e-8;
const int TreeMotion::kMaxSubsteps = 4000;

TreeMotion::TreeMotion(const Model& model)
    : q_(model.q0),
      v_(VectorX::Zero(model.nv)),
      u_(VectorX::Zero(model.nv)),
      w_(VectorX::Zero(model.nv)),
      du_(VectorX::Zero(model.nv)),
      dv_(VectorX::Zero(model.nv)) {
  for (int i = 0; i < kDormandPrince.stages; ++i) Ku_[i] = Kv_[i] = VectorX::Zero(model.nv);
  int largest = 0;
  for (const Tree& tree : model.trees) largest = std::max(largest, tree.bodyEnd - tree.rootBody);
  nodes_.resize(static_cast<std::size_t>(largest));
}

std::size_t TreeMotion::bytes() const {
  std::size_t sum = bytesOfAll(q_, v_, u_, w_, du_, dv_, nodes_);
  for (int i = 0; i < kDormandPrince.stages; ++i) sum += bytesOfAll(Ku_[i], Kv_[i]);
  return sum;
}

/// Poses about O and velocities at q₀ ⊕ u with the velocity w; u̇ too.
void TreeMotion::poses(const Model& model, const Tree& tree, bool coriolis) {
  for (int b = tree.rootBody; b < tree.bodyEnd; ++b) {
    const Body& body = model.bodies[b];
    Node& n = nodes_[b - tree.rootBody];
    if (body.joint == JointKind::floating) {
      const int i = body.v;
      const Vector3 phi = u_.segment<3>(i + 3), omega = w_.segment<3>(i + 3);
      n.R = (quaternionAt(q_, body.q + 3) * quaternionExp(phi)).toRotationMatrix();
      n.r.setZero();
      n.V = {n.R * omega, w_.segment<3>(i)};
      n.c = coriolis ? Motion{Vector3::Zero(), n.V.linear.cross(n.V.angular)} : Motion{};
      du_.segment<3>(i) = w_.segment<3>(i);
      du_.segment<3>(i + 3) = rotationRate(phi, omega);
      continue;
    }
    const bool isRoot = b == tree.rootBody;
    const Node* parent = isRoot ? nullptr : &nodes_[body.parent - tree.rootBody];
    const double q = q_[body.q] + u_[body.v], w = w_[body.v];
    du_[body.v] = w;
    const Matrix3 R_WJ = isRoot ? body.X_PB.R : Matrix3(parent->R * body.X_PB.R);
    const Vector3 axis = R_WJ * body.axis;
    n.r = isRoot ? Vector3(Vector3::Zero()) : Vector3(parent->r + parent->R * body.X_PB.p);
    if (body.joint == JointKind::revolute) {
      n.R.noalias() = R_WJ * axisRotation(body.axis, q);
      n.S = {axis, n.r.cross(axis)};
    } else {
      n.R = R_WJ;
      n.r += q * axis;
      n.S = {Vector3::Zero(), axis};
    }
    const Motion Sw = n.S * w;
    n.V = isRoot ? Sw : parent->V + Sw;
    n.c = coriolis && !isRoot ? cross(parent->V, Sw) : Motion{};
  }
}

/// The root's six accelerations at once.
void TreeMotion::root(const Model& model, const Body& body) {
  Node& n = nodes_[0];
  Matrix6 S = Matrix6::Zero();
  S.topRightCorner<3, 3>() = n.R;
  S.bottomLeftCorner<3, 3>().setIdentity();
  Matrix6 D = S.transpose() * n.IA * S;
  Vector6 force = held_->segment<6>(body.v);
  force.tail<3>() += n.R.transpose() * heldInWorld_;
  force -= S.transpose() * (n.pA + n.IA * n.A);
  if (model.options.effects.has(Effect::armature))
    for (int i = 0; i < 6; ++i) D(i, i) += model.dofs[body.v + i].armature;
  const Vector6 vdot = D.llt().solve(force);
  dv_.segment<6>(body.v) = vdot;
  n.A += S * vdot;
}

void TreeMotion::derivative(const Model& model, const Plan& plan, const Tree& tree) {
  const bool coriolis = plan.coriolis;
  const bool armature = model.options.effects.has(Effect::armature);
  poses(model, tree, coriolis);
  const int first = tree.rootBody;
  for (int b = first; b < tree.bodyEnd; ++b) {
    const Body& body = model.bodies[b];
    Node& n = nodes_[b - first];
    if (body.massless) {
      n.IA.setZero();
      n.pA.setZero();
      continue;
    }
    const Inertia I =
        Inertia::fromCentral(body.mass, n.R * body.com + n.r, rotated(n.R, body.I_Bcm));
    n.IA = spatialMatrix(I);
    if (coriolis)
      n.pA = stacked(crossForce(n.V, I * n.V));
    else
      n.pA.setZero();
  }
  for (int i = tree.firstDof; i < tree.dofEnd; ++i) dv_[i] = (*held_)[i];
  if (plan.hasDamping())
    for (int i = tree.firstDof; i < tree.dofEnd; ++i) dv_[i] -= plan.damping[i] * w_[i];
  for (const Plan::Spring& s : plan.springs)
    if (s.dof >= tree.firstDof && s.dof < tree.dofEnd)
      dv_[s.dof] -= s.stiffness * (q_[s.q] + u_[s.dof] - s.reference);
  for (int b = tree.bodyEnd - 1; b >= first; --b) {
    const Body& body = model.bodies[b];
    if (body.joint == JointKind::floating) break;  // the root
    Node& n = nodes_[b - first];
    const Vector6 S = stacked(n.S);
    n.U.noalias() = n.IA * S;
    n.inverse = 1.0 / (S.dot(n.U) + (armature ? model.dofs[body.v].armature : 0.0));
    n.u = dv_[body.v] - S.dot(n.pA);
    if (b == first) break;
    Node& parent = nodes_[body.parent - first];
    n.IA.noalias() -= (n.inverse * n.U) * n.U.transpose();
    parent.IA += n.IA;
    parent.pA += n.pA + n.U * (n.inverse * n.u);
    if (coriolis) parent.pA.noalias() += n.IA * stacked(n.c);
  }
  const Vector3 g = plan.gravity ? model.options.gravity : Vector3::Zero();
  for (int b = first; b < tree.bodyEnd; ++b) {
    const Body& body = model.bodies[b];
    Node& n = nodes_[b - first];
    if (b == first)
      n.A << Vector3::Zero(), -g;
    else
      n.A = nodes_[body.parent - first].A;
    n.A += stacked(n.c);
    if (body.joint == JointKind::floating) {
      root(model, body);
      continue;
    }
    const double vdot = n.inverse * (n.u - n.U.dot(n.A));
    dv_[body.v] = vdot;
    n.A += vdot * stacked(n.S);
  }
}

/// q₀ ← q₀ ⊕ u, v ← w: the next sub-step begins here.
void TreeMotion::rebase(const Model& model, const Tree& tree) {
  for (int b = tree.rootBody; b < tree.bodyEnd; ++b) {
    const Body& body = model.bodies[b];
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

void TreeMotion::acceleration(const Model& model, const Plan& plan, const Tree& tree,
                              const State& at, const VectorX& held, VectorX& vdot) {
  q_ = at.q;
  u_.setZero();
  w_ = at.v;
  held_ = &held;
  heldInWorld_.setZero();
  derivative(model, plan, tree);
  const int n = tree.dofEnd - tree.firstDof;
  vdot.segment(tree.firstDof, n) = dv_.segment(tree.firstDof, n);
}

void TreeMotion::start(const Model& model, const State& state, const Tree& tree) {
  const int n = tree.dofEnd - tree.firstDof;
  const Body& root = model.bodies[tree.rootBody];
  const int coordinates = root.joint == JointKind::floating ? n + 1 : n;
  q_.segment(root.q, coordinates) = state.q.segment(root.q, coordinates);
  v_.segment(tree.firstDof, n) = state.v.segment(tree.firstDof, n);
}

double TreeMotion::speed(const Model& model, const Plan& plan, const Tree& tree,
                         const VectorX& held, const Vector3& heldInWorld, const VectorX& scale,
                         double duration) {
  const int f = tree.firstDof, n = tree.dofEnd - tree.firstDof;
  held_ = &held;
  heldInWorld_ = heldInWorld;
  u_.segment(f, n).setZero();
  w_.segment(f, n).setZero();
  derivative(model, plan, tree);
  const double fromRest =
      duration * dv_.segment(f, n).cwiseQuotient(scale.segment(f, n)).cwiseAbs().maxCoeff();
  w_.segment(f, n) = v_.segment(f, n);
  poses(model, tree, false);
  double twiceKinetic = 0.0;
  const bool armature = model.options.effects.has(Effect::armature);
  for (int b = tree.rootBody; b < tree.bodyEnd; ++b) {
    const Body& body = model.bodies[b];
    const Node& node = nodes_[b - tree.rootBody];
    if (!body.massless)
      twiceKinetic += dot(node.V, Inertia::fromCentral(body.mass, node.R * body.com + node.r,
                                                       rotated(node.R, body.I_Bcm)) *
                                      node.V);
    for (int i = body.v; armature && i < body.v + body.dofs; ++i)
      twiceKinetic += model.dofs[i].armature * v_[i] * v_[i];
  }
  return std::sqrt(std::max(0.0, twiceKinetic)) + fromRest;
}

TreeMotion::Outcome TreeMotion::run(const Model& model, const Plan& plan, const Tree& tree,
                                    const VectorX& held, const Vector3& heldInWorld,
                                    const VectorX& scale, double speed, double duration,
                                    double firstStep) {
  const Tableau& DP = kDormandPrince;
  const int f = tree.firstDof, n = tree.dofEnd - tree.firstDof;
  const auto part = [&](VectorX& x) { return x.segment(f, n); };
  held_ = &held;
  heldInWorld_ = heldInWorld;
  substeps_ = 0;

  const auto evaluate = [&](int stage) {
    derivative(model, plan, tree);
    part(Ku_[stage]) = part(du_);
    part(Kv_[stage]) = part(dv_);
  };
  part(u_).setZero();
  part(w_) = part(v_);
  evaluate(0);

  double left = duration, k = std::min(firstStep, duration);
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
    double error = 0.0;
    for (int i = f; i < f + n; ++i) {
      double eu = 0.0, ev = 0.0;
      for (int j = 0; j < DP.stages; ++j) {
        eu += DP.e[j] * Ku_[j][i];
        ev += DP.e[j] * Kv_[j][i];
      }
      // A displacement counts by the speed that makes it in the whole duration.
      const double e = k * std::max(std::abs(ev), std::abs(eu) / duration) / scale[i];
      if (!(e <= error)) error = e;  // NaN stays
    }
    if (!std::isfinite(error) && k < 1e-9 * duration) return Outcome::notFinite;
    const double ratio = error / (kTolerance * speed);
    if (ratio <= 1.0) {
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
