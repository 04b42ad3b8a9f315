// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/contact.hpp"

#include <algorithm>

#include "engine/constraints/impedance.hpp"
#include "engine/core/rotation.hpp"

namespace softgauss {
namespace {

/// Below this coefficient the pyramid degenerates: the contact is frictionless.
constexpr double kSmallestFriction = 1e-5;

/// A wished tangent is followed as long as rounding does not decide where it points: this sine of
/// the angle between it and the normal.
constexpr double kSmallestSine = 1e-6;

Matrix3 contactFrame(const Contact& c) {
  Vector3 t = c.tangent_W - c.n_W * c.n_W.dot(c.tangent_W);
  const double length = t.norm();
  if (!(length > kSmallestSine * c.tangent_W.norm())) return frameFromNormal(c.n_W);
  t /= length;
  Matrix3 R;
  R << c.n_W, t, c.n_W.cross(t);
  return R;
}

/// Values on the edges from those in the contact frame: e = y_n ± μ y_k.
void toEdges(const double* y, double mu, double* e) {
  e[0] = y[0] + mu * y[1];
  e[1] = y[0] - mu * y[1];
  e[2] = y[0] + mu * y[2];
  e[3] = y[0] - mu * y[2];
}

}  // namespace

Material mixMaterials(const Material& a, const Material& b) {
  Material m;
  m.slidingFriction = std::max(a.slidingFriction, b.slidingFriction);
  m.torsionalFriction = std::max(a.torsionalFriction, b.torsionalFriction);
  m.rollingFriction = std::max(a.rollingFriction, b.rollingFriction);
  m.condim = std::max(a.condim, b.condim);
  m.margin = a.margin + b.margin;
  const Impedance &p = a.impedance, &q = b.impedance;
  m.impedance = {0.5 * (p.timeConstant + q.timeConstant),
                 0.5 * (p.dampingRatio + q.dampingRatio),
                 0.5 * (p.dMin + q.dMin),
                 0.5 * (p.dMax + q.dMax),
                 0.5 * (p.width + q.width),
                 0.5 * (p.midpoint + q.midpoint),
                 0.5 * (p.power + q.power)};
  return m;
}

void PyramidalContact::assemble(const Assembly& in) {
  const Model& model = in.model;
  jacobian_.clear();
  made_.clear();
  clearRows();
  for (int i = 0; i < in.contacts.size(); ++i) {
    const Contact& c = in.contacts.contacts[i];
    if (model.bodies[c.bodyA].dofs == 0 && model.bodies[c.bodyB].dofs == 0) continue;
    const Material material = mixMaterials(model.geometries[c.geometryA].material,
                                           model.geometries[c.geometryB].material);
    const double r = c.distance - material.margin;
    if (r >= 0.0) continue;  // NaN makes rows, so that the solve reports it

    const bool frictional = material.condim > 1 && material.slidingFriction >= kSmallestFriction;
    const double mu = frictional ? material.slidingFriction : 0.0;
    ContactRows made{i, static_cast<int>(reference.size()), mu, contactFrame(c)};
    RelativeMotion motion;
    motion.bodyA = c.bodyA;
    motion.bodyB = c.bodyB;
    motion.p_WA = motion.p_WB = c.p_WC;
    motion.linear = made.R_WC;
    motion.linearDim = frictional ? 3 : 1;
    jacobian_.add(model, in.kinematics, in.tree, motion);
    made_.push_back(made);

    const double weight =
        (in.weights.translation[c.bodyA] + in.weights.translation[c.bodyB]) * (1.0 + mu * mu);
    const Softness soft = softnessAt(material.impedance, r, weight, model.options.timestep);
    const Vector3 ydot =
        made.R_WC.transpose() * (pointVelocity(model, in.kinematics, c.bodyB, c.p_WC) -
                                 pointVelocity(model, in.kinematics, c.bodyA, c.p_WC));
    if (!frictional) {
      reference.push_back(soft.referenceAcceleration(ydot[0], r));
      D.push_back(1.0 / soft.R);
      continue;
    }
    double edgeVelocity[4];
    toEdges(ydot.data(), mu, edgeVelocity);
    const double R = 2.0 * mu * mu / model.options.impedanceRatio * soft.R;
    for (const double velocity : edgeVelocity) {
      reference.push_back(soft.referenceAcceleration(velocity, r));
      D.push_back(1.0 / R);
    }
  }
  resizeRows(reference.size());
  contactOfRow_.resize(reference.size());
  for (std::size_t i = 0; i < made_.size(); ++i) {
    const std::size_t end = i + 1 < made_.size() ? made_[i + 1].row : reference.size();
    for (std::size_t row = made_[i].row; row < end; ++row) contactOfRow_[row] = static_cast<int>(i);
  }
}

void PyramidalContact::multiply(const VectorX& a, std::vector<double>& y) const {
  for (std::size_t i = 0; i < made_.size(); ++i) {
    double frame[3];
    jacobian_.multiply(static_cast<int>(i), a, frame);
    double* rows = y.data() + made_[i].row;
    if (made_[i].friction > 0.0)
      toEdges(frame, made_[i].friction, rows);
    else
      rows[0] = frame[0];
  }
}

void PyramidalContact::addForce(VectorX& tau) const {
  for (std::size_t i = 0; i < made_.size(); ++i) {
    const double* e = f.data() + made_[i].row;
    const double mu = made_[i].friction;
    const double frame[3] = {mu > 0.0 ? e[0] + e[1] + e[2] + e[3] : e[0],
                             mu > 0.0 ? mu * (e[0] - e[1]) : 0.0,
                             mu > 0.0 ? mu * (e[2] - e[3]) : 0.0};
    if (frame[0] != 0.0) jacobian_.addTransposed(static_cast<int>(i), frame, tau);
  }
}

void PyramidalContact::addCurvature(TreeMatrix& P) {
  for (std::size_t i = 0; i < made_.size(); ++i) {
    const double* e = h.data() + made_[i].row;
    const double mu = made_[i].friction;
    if (mu > 0.0) {
      // Σ over edges of D (1, ±μ eₖ)(1, ±μ eₖ)ᵀ.
      const double normal = e[0] + e[1] + e[2] + e[3];
      if (normal == 0.0) continue;
      const double n1 = mu * (e[0] - e[1]), n2 = mu * (e[2] - e[3]);
      const double t1 = mu * mu * (e[0] + e[1]), t2 = mu * mu * (e[2] + e[3]);
      const double H[9] = {normal, n1, n2, n1, t1, 0.0, n2, 0.0, t2};
      jacobian_.addCurvature(static_cast<int>(i), H, P);
    } else if (e[0] != 0.0) {
      jacobian_.addCurvature(static_cast<int>(i), e, P);
    }
  }
}

void PyramidalContact::addRow(int row, double scale, VectorX& y) const {
  const int i = contactOfRow_[row], edge = row - made_[i].row;
  const double mu = edge % 2 == 0 ? made_[i].friction : -made_[i].friction;
  const double frame[3] = {scale, edge < 2 ? scale * mu : 0.0, edge < 2 ? 0.0 : scale * mu};
  jacobian_.addTransposed(i, frame, y);
}

Vector3 PyramidalContact::force(int i) const {
  const double* e = f.data() + made_[i].row;
  const double mu = made_[i].friction;
  if (mu == 0.0) return e[0] * made_[i].R_WC.col(0);
  return made_[i].R_WC * Vector3(e[0] + e[1] + e[2] + e[3], mu * (e[0] - e[1]), mu * (e[2] - e[3]));
}

}  // namespace softgauss
