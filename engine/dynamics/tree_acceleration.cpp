// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/tree_acceleration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/memory.hpp"
#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/core/vector_clones.hpp"

namespace softgauss {
namespace {

[[gnu::always_inline]] inline void setColumns(const Matrix3& R, Four* columns) {
  for (int k = 0; k < 3; ++k) columns[k] = Four{R(0, k), R(1, k), R(2, k), 0.0};
}

/// y ← Σ x_k columns_k.
[[gnu::always_inline]] inline void combine(const Four* columns, double x0, double x1, double x2,
                                           Four& y) {
  y = x0 * columns[0] + x1 * columns[1] + x2 * columns[2];
}

[[gnu::always_inline]] inline Vector3 rotated(const Four* R, const Vector3& x) {
  Four y;
  combine(R, x.x(), x.y(), x.z(), y);
  return {y[0], y[1], y[2]};
}

/// R S Rᵀ.
[[gnu::always_inline]] inline Symmetric3 rotatedInertia(const Four* R, const Symmetric3& S) {
  Four RS[3], turned[3];  // turned = (R S) Rᵀ, symmetric
  combine(R, S.xx, S.xy, S.xz, RS[0]);
  combine(R, S.xy, S.yy, S.yz, RS[1]);
  combine(R, S.xz, S.yz, S.zz, RS[2]);
  for (int k = 0; k < 3; ++k) combine(RS, R[0][k], R[1][k], R[2][k], turned[k]);
  return {turned[0][0], turned[1][1], turned[2][2], turned[0][1], turned[0][2], turned[1][2]};
}

}  // namespace

TreeAcceleration::TreeAcceleration(const Model& model) : armature_(idx(model.nv), 0.0) {
  int largest = 0;
  for (const Tree& tree : model.trees) largest = std::max(largest, tree.bodyEnd - tree.rootBody);
  links_.reserve(idx(largest));
  nodes_.resize(idx(largest));
  if (model.options.effects.has(Effect::armature))
    for (int i = 0; i < model.nv; ++i) armature_[idx(i)] = model.dofs[idx(i)].armature;
}

std::size_t TreeAcceleration::bytes() const {
  return links_.capacity() * sizeof(Link) + bytesOfAll(nodes_, armature_);
}

void TreeAcceleration::take(const Model& model, const Tree& tree) {
  links_.clear();
  first_ = tree.firstDof, end_ = tree.dofEnd;
  for (int b = tree.rootBody; b < tree.bodyEnd; ++b) {
    const Body& body = model.bodies[idx(b)];
    const Matrix3& R = body.X_PB.R;
    const Matrix3 turn = skew(body.axis);
    Link link;
    link.joint = body.joint;
    link.massless = body.massless;
    link.parent = b == tree.rootBody ? -1 : body.parent - tree.rootBody;
    link.v = body.v;
    setColumns(R, link.fixed);
    setColumns(R * turn, link.sine);
    setColumns(R * turn * turn, link.versine);
    link.axis = R * body.axis;
    link.place = body.X_PB.p;
    link.com = body.com;
    link.I_Bcm = body.I_Bcm;
    link.mass = body.mass;
    links_.push_back(link);
  }
}

[[gnu::always_inline]] inline void TreeAcceleration::placeRoot(const Link& link, const At& at,
                                                               Node& n) {
  setColumns(at.R_root, n.R);
  n.r.setZero();
  const double* v = at.v + link.v;
  n.V = {rotated(n.R, {v[3], v[4], v[5]}), {v[0], v[1], v[2]}};
  n.A = {Vector3::Zero(), -at.gravity};
  // Ṡ v: the rotation axes are carried along with the body's origin.
  if (at.coriolis) n.A.linear += n.V.linear.cross(n.V.angular);
}

[[gnu::always_inline]] inline void TreeAcceleration::place(const Link& link, const Node* parent,
                                                           const At& at, Node& n) {
  const double q = at.q[link.v], v = at.v[link.v];
  Four local[3] = {link.fixed[0], link.fixed[1], link.fixed[2]};
  if (link.joint == JointKind::revolute) {
    const double s = std::sin(q), t = 1.0 - std::cos(q);
    for (int k = 0; k < 3; ++k) local[k] += s * link.sine[k] + t * link.versine[k];
  }
  for (int k = 0; k < 3; ++k) {
    n.R[k] = local[k];
    if (parent) combine(parent->R, local[k][0], local[k][1], local[k][2], n.R[k]);
  }
  const Vector3 axis = parent ? rotated(parent->R, link.axis) : link.axis;
  n.r = parent ? Vector3(parent->r + rotated(parent->R, link.place)) : Vector3(Vector3::Zero());
  if (link.joint == JointKind::revolute) {
    n.S = {axis, n.r.cross(axis)};
  } else {
    n.r += q * axis;
    n.S = {Vector3::Zero(), axis};
  }
  const Motion Sv = n.S * v;
  n.V = parent ? parent->V + Sv : Sv;
  n.A = parent ? parent->A : Motion{Vector3::Zero(), -at.gravity};
  if (!at.coriolis || !parent) return;
  // Ṡ = V_P × S, as S × S = 0
  const double *V = numbers(parent->V), *joint = numbers(Sv);
  double c[9];
  crossThree(V, joint, c);
  crossThree(V, joint + 3, c + 3);
  crossThree(V + 3, joint, c + 6);
  for (int k = 0; k < 3; ++k) c[3 + k] += c[6 + k];
  addSix(1.0, c, numbers(n.A));
}

[[gnu::always_inline]] inline void TreeAcceleration::takeInertia(const Link& link, bool coriolis,
                                                                 Node& n) {
  n.twiceKinetic = 0.0;
  n.f = {};
  if (link.massless) {
    for (double& x : n.I) x = 0.0;
    return;
  }
  const Inertia I = Inertia::fromCentral(link.mass, n.r + rotated(n.R, link.com),
                                         rotatedInertia(n.R, link.I_Bcm));
  setInertia(I, n.I);
  double momentum[kSixRow], force[kSixRow], turned[3];
  combineRows(numbers(n.V), n.I, momentum);
  combineRows(numbers(n.A), n.I, force);
  n.twiceKinetic = dotSix(numbers(n.V), momentum);
  if (coriolis) {  // V ×* (I V)
    const double *omega = numbers(n.V), *v = omega + 3;
    crossThree(omega, momentum, turned);
    for (int k = 0; k < 3; ++k) force[k] += turned[k];
    crossThree(v, momentum + 3, turned);
    for (int k = 0; k < 3; ++k) force[k] += turned[k];
    crossThree(omega, momentum + 3, turned);
    for (int k = 0; k < 3; ++k) force[3 + k] += turned[k];
  }
  for (int k = 0; k < 6; ++k) numbers(n.f)[k] = force[k];
}

SOFTGAUSS_VECTOR_CLONES void TreeAcceleration::sweepOut(const Link* links, int count, const At& at,
                                                        Node* nodes) {
  for (int b = 0; b < count; ++b) {
    const Link& link = links[b];
    if (link.joint == JointKind::floating)
      placeRoot(link, at, nodes[b]);
    else
      place(link, link.parent < 0 ? nullptr : nodes + link.parent, at, nodes[b]);
    takeInertia(link, at.coriolis, nodes[b]);
  }
}

SOFTGAUSS_VECTOR_CLONES void TreeAcceleration::sweepIn(const Link* links, int count,
                                                       const double* armature, const double* tau,
                                                       Node* nodes) {
  for (int b = count - 1; b >= 0; --b) {
    const Link& link = links[b];
    if (link.joint == JointKind::floating) continue;
    Node& n = nodes[b];
    const double* S = numbers(n.S);
    combineRows(S, n.I, n.U);
    n.inversePivot = 1.0 / (dotSix(S, n.U) + armature[link.v]);
    n.u = n.inversePivot * (tau[link.v] - dotSix(S, numbers(n.f)));
    if (link.parent < 0) continue;
    Node& parent = nodes[link.parent];
    addUpdated(n.I, -n.inversePivot, n.U, parent.I);
    addSix(1.0, numbers(n.f), numbers(parent.f));
    addSix(n.u, n.U, numbers(parent.f));
  }
}

SOFTGAUSS_VECTOR_CLONES void TreeAcceleration::accelerate(const Link* links, int count, Node* nodes,
                                                          double* vdot) {
  for (int b = 0; b < count; ++b) {
    const Link& link = links[b];
    if (link.joint == JointKind::floating) continue;
    Node& n = nodes[b];
    n.added = link.parent < 0 ? Motion{} : nodes[link.parent].added;
    vdot[link.v] = n.u - n.inversePivot * dotSix(n.U, numbers(n.added));
    addSix(vdot[link.v], numbers(n.S), numbers(n.added));
  }
}

/// The six accelerations of a floating root at once: D = Sᵀ I S + armature.
void TreeAcceleration::solveRoot(const At& at, double* vdot) {
  using SixRows = Eigen::Matrix<double, 6, kSixRow, Eigen::RowMajor>;
  const Link& root = links_[0];
  Node& n = nodes_[0];
  const auto I = Eigen::Map<const SixRows>(n.I).leftCols<6>();
  const Matrix3& R = at.R_root;
  Matrix6 D;
  D.topLeftCorner<3, 3>() = I.bottomRightCorner<3, 3>();
  D.bottomLeftCorner<3, 3>().noalias() = R.transpose() * I.topRightCorner<3, 3>();
  const Matrix3 IR = I.topLeftCorner<3, 3>() * R;
  D.bottomRightCorner<3, 3>().noalias() = R.transpose() * IR;
  for (int i = 0; i < 6; ++i) D(i, i) += armature_[idx(root.v + i)];
  Vector6 x = Eigen::Map<const Vector6>(at.tau + root.v);
  x.head<3>() -= n.f.force;
  x.tail<3>() -= R.transpose() * n.f.moment;
  D.llt().solveInPlace(x);  // reads the lower half
  Eigen::Map<Vector6>(vdot + root.v) = x;
  n.added = {R * x.tail<3>(), x.head<3>()};
}

void TreeAcceleration::compute(const At& at, double* vdot) {
  const int count = static_cast<int>(links_.size());
  sweepOut(links_.data(), count, at, nodes_.data());
  sweepIn(links_.data(), count, armature_.data(), at.tau, nodes_.data());
  if (links_[0].joint == JointKind::floating) solveRoot(at, vdot);
  accelerate(links_.data(), count, nodes_.data(), vdot);
}

double TreeAcceleration::twiceKinetic(const double* v) const {
  double sum = 0.0;
  for (std::size_t b = 0; b < links_.size(); ++b) sum += nodes_[b].twiceKinetic;
  for (int i = first_; i < end_; ++i) sum += armature_[idx(i)] * v[i] * v[i];
  return sum;
}

double TreeAcceleration::fastestTurn() const {
  double fastest = 0.0;
  for (std::size_t b = 0; b < links_.size(); ++b)
    fastest = std::max(fastest, nodes_[b].V.angular.squaredNorm());
  return std::sqrt(fastest);
}

}  // namespace softgauss
