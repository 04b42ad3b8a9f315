// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/plan_cost.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/dynamics/jacobian.hpp"
#include "softgauss/engine/dynamics/motion_derivative.hpp"

namespace softgauss::planning {
namespace {

/// J_r⁻¹(φ): how the logarithm of a rotation φ changes as the rotation turns on in its own axes.
Matrix3 logDerivative(const Vector3& phi) {
  Matrix3 J;
  for (int i = 0; i < 3; ++i) J.col(i) = rotationRate(phi, Vector3::Unit(i));
  return J;
}

int frameCalled(const Model& model, const std::string& name) {
  const int frame = model.findFrame(name);
  if (frame < 0)
    throw ModelError({}, "plan cost",
                     "no link is called \"" + name + "\", expected one of the model");
  return frame;
}

}  // namespace

StateCost::StateCost(const Model& model, const VectorX& at)
    : positionWeight(VectorX::Zero(model.nv)),
      velocityWeight(VectorX::Zero(model.nv)),
      q{at},
      v{VectorX::Zero(model.nv)},
      e_(VectorX::Zero(2 * model.nv)),
      difference_(VectorX::Zero(model.nv)) {}

void StateCost::setError(const KnotView& at) {
  const auto of = [&](const std::vector<VectorX>& x) -> const VectorX& {
    return x[std::min(x.size() - 1, static_cast<std::size_t>(at.knot))];
  };
  const Eigen::Index n = at.v.size();
  positionDifference(at.model, of(q), at.q, difference_);
  e_.head(n) = difference_;
  e_.tail(n) = at.v - of(v);
}

double StateCost::value(const KnotView& at) {
  setError(at);
  const Eigen::Index n = at.v.size();
  return 0.5 * positionWeight.dot(e_.head(n).cwiseAbs2()) +
         0.5 * velocityWeight.dot(e_.tail(n).cwiseAbs2());
}

double StateCost::expand(const KnotView& at, double scale, VectorX& slope, MatrixX& curvature) {
  const double cost = value(at);
  const Eigen::Index n = at.v.size();
  const auto rotates = [&](const Body& body) { return body.joint == JointKind::floating; };
  for (const Body& body : at.model.bodies) {
    const int plain = rotates(body) ? 3 : body.dofs;
    for (int i = body.v; i < body.v + plain; ++i) {
      slope[i] += scale * positionWeight[i] * e_[i];
      curvature(i, i) += scale * positionWeight[i];
    }
    if (!rotates(body)) continue;
    const int i = body.v + 3;
    const Matrix3 J = logDerivative(e_.segment<3>(i)),
                  WJ = scale * positionWeight.segment<3>(i).asDiagonal() * J;
    slope.segment<3>(i) += WJ.transpose() * e_.segment<3>(i);
    curvature.block<3, 3>(i, i) += J.transpose() * WJ;
  }
  slope.tail(n) += scale * velocityWeight.cwiseProduct(e_.tail(n));
  curvature.diagonal().tail(n) += scale * velocityWeight;
  return cost;
}

double ResidualCost::value(const KnotView& at) {
  evaluate(at, r_, nullptr);
  return 0.5 * weight_.dot(r_.cwiseAbs2());
}

double ResidualCost::expand(const KnotView& at, double scale, VectorX& slope, MatrixX& curvature) {
  J_.resize(weight_.size(), 2 * at.v.size());
  J_.setZero();
  evaluate(at, r_, &J_);
  WJ_.noalias() = (scale * weight_).asDiagonal() * J_;
  slope.noalias() += WJ_.transpose() * r_;
  curvature.triangularView<Eigen::Lower>() += J_.transpose() * WJ_;
  return 0.5 * weight_.dot(r_.cwiseAbs2());
}

PointCost::PointCost(const Model& model, const std::string& frame, const Vector3& p_FP,
                     const Vector3& target_W, double weight, double velocityWeight)
    : frame_(frameCalled(model, frame)), p_FP_(p_FP), target_(target_W) {
  weight_.resize(6);
  weight_ << Vector3::Constant(weight), Vector3::Constant(velocityWeight);
}

void PointCost::evaluate(const KnotView& at, VectorX& r, MatrixX* J) {
  const Model& model = at.model;
  const Kinematics& k = *at.kinematics;
  const int body = model.frames[idx(frame_)].body;
  const Vector3 p = framePose(model, k, frame_) * p_FP_;
  r.resize(6);
  r << p - target_, pointVelocity(model, k, body, p);
  if (!J || body == 0) return;
  const Eigen::Index n = at.v.size();
  const Vector3 lever = p - k.p_WO[idx(model.bodies[idx(body)].tree)];
  const Motion& V = k.V[idx(body)];
  for (int j = model.lastDof(body); j >= 0; j = model.dofs[idx(j)].parent) {
    const Motion& S = k.S[idx(j)];
    const Vector3 moves = dofPointVelocity(S, lever);
    const Motion change = cross(S, V - motionAgainst(model, j, k.V, {}, at.v));
    J->col(j).head<3>() = moves;
    J->col(j).tail<3>() = dofPointVelocity(change, lever) + V.angular.cross(moves);
    J->col(n + j).tail<3>() = moves;
  }
}

OrientationCost::OrientationCost(const Model& model, const std::string& frame,
                                 const Matrix3& target, double weight)
    : frame_(frameCalled(model, frame)), target_(target) {
  weight_ = VectorX::Constant(3, weight);
}

void OrientationCost::evaluate(const KnotView& at, VectorX& r, MatrixX* J) {
  const Model& model = at.model;
  const Kinematics& k = *at.kinematics;
  const Matrix3 R = framePose(model, k, frame_).R;
  const Vector3 phi = quaternionLog(Quaternion(Matrix3(target_.transpose() * R)));
  r = phi;
  if (!J) return;
  const Matrix3 log = logDerivative(phi) * R.transpose();
  const int body = model.frames[idx(frame_)].body;
  for (int j = model.lastDof(body); j >= 0; j = model.dofs[idx(j)].parent)
    J->col(j) = log * k.S[idx(j)].angular;
}

CentroidalCost::CentroidalCost(const Model& model)
    : mass_(model.totalMass()), inertia_(model.bodies.size()), h_(model.bodies.size()) {
  weight_ = VectorX::Zero(9);
}

void CentroidalCost::centre(const Vector3& target, double weight) {
  centre_ = target;
  weight_.head<3>().setConstant(weight);
}

void CentroidalCost::momentum(const Vector3& target, double weight) {
  momentum_ = target;
  weight_.segment<3>(3).setConstant(weight);
}

void CentroidalCost::angularMomentum(double weight) { weight_.tail<3>().setConstant(weight); }

/// Per dof j of body b, about a point that stays: the momentum of its subtree changes with v_j by
/// I^c S_j, and with q_j by S_j ×* h^c − I^c (S_j × V_λ), for I V is carried along but for V_λ.
void CentroidalCost::addColumns(const KnotView& at, const Vector3& c, const Vector3& p,
                                MatrixX& J) {
  const Model& model = at.model;
  const Kinematics& k = *at.kinematics;
  const Eigen::Index n = at.v.size();
  for (int j = 0; j < model.nv; ++j) {
    const int b = model.dofs[idx(j)].body;
    const Motion& S = k.S[idx(j)];
    const Vector3 origin = k.p_WO[idx(model.bodies[idx(b)].tree)] - c;
    const Force byVelocity = inertia_[idx(b)] * S;
    const Force byPosition = crossForce(S, h_[idx(b)]) -
                             inertia_[idx(b)] * cross(S, motionAgainst(model, j, k.V, {}, at.v));
    const Vector3 dc = byVelocity.force / mass_;
    J.col(j).head<3>() = dc;
    J.col(j).segment<3>(3) = byPosition.force;
    J.col(j).tail<3>() = byPosition.moment + origin.cross(byPosition.force) - dc.cross(p);
    J.col(n + j).segment<3>(3) = byVelocity.force;
    J.col(n + j).tail<3>() = byVelocity.moment + origin.cross(byVelocity.force);
  }
}

void CentroidalCost::evaluate(const KnotView& at, VectorX& r, MatrixX* J) {
  const Model& model = at.model;
  const Kinematics& k = *at.kinematics;
  Vector3 first = Vector3::Zero(), p = Vector3::Zero(), L = Vector3::Zero();
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    inertia_[b] = {};
    h_[b] = {};
    if (body.massless) continue;
    const Vector3 O = k.p_WO[idx(body.tree)], com = k.X_WB[b] * body.com;
    inertia_[b] = Inertia::fromCentral(body.mass, com - O, rotated(k.X_WB[b].R, body.I_Bcm));
    h_[b] = inertia_[b] * k.V[b];
    first += body.mass * com;
    p += h_[b].force;
    L += h_[b].moment + O.cross(h_[b].force);
  }
  const Vector3 c = first / mass_;
  L -= c.cross(p);
  r.resize(9);
  r << c - centre_, p - momentum_, L;
  if (!J) return;
  for (std::size_t b = model.bodies.size() - 1; b > 0; --b) {
    const auto parent = idx(model.bodies[b].parent);
    if (parent == 0) continue;
    inertia_[parent] += inertia_[b];
    h_[parent] += h_[b];
  }
  addColumns(at, c, p, *J);
}

}  // namespace softgauss::planning
