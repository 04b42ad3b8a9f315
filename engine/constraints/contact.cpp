// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/contact.hpp"

#include <algorithm>
#include <utility>

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

/// condim of the effects that are switched on. Rolling friction comes with torsional friction.
int simulatedCondim(const EffectSet& effects, int condim) {
  if (!effects.has(Effect::rollingFriction)) condim = std::min(condim, 4);
  if (!effects.has(Effect::torsionalFriction)) condim = std::min(condim, 3);
  return condim;
}

/// Values on the edges from those in the contact frame: e = y_n ± μ_k y_k.
void toEdges(const double* y, const ContactRows& made, double* e) {
  for (int k = 0; k < made.pairs; ++k) {
    e[2 * k] = y[0] + made.frictions[k] * y[k + 1];
    e[2 * k + 1] = y[0] - made.frictions[k] * y[k + 1];
  }
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

Material pairMaterial(const Model& model, int geometryA, int geometryB) {
  if (!model.contactPairs.empty()) {
    const auto [a, b] = std::minmax(geometryA, geometryB);
    const auto at = std::lower_bound(
        model.contactPairs.begin(), model.contactPairs.end(), std::pair<int, int>(a, b),
        [](const ContactPair& p, auto key) { return std::pair(p.geometryA, p.geometryB) < key; });
    if (at != model.contactPairs.end() && at->geometryA == a && at->geometryB == b)
      return at->material;
  }
  return mixMaterials(model.geometries[geometryA].material, model.geometries[geometryB].material);
}

void PyramidalContact::assemble(const Assembly& in) {
  const Model& model = in.model;
  jacobian_.clear();
  made_.clear();
  clearRows();
  for (int i = 0; i < in.contacts.size(); ++i) {
    const Contact& c = in.contacts.contacts[i];
    if (model.bodies[c.bodyA].dofs == 0 && model.bodies[c.bodyB].dofs == 0) continue;
    const Material material = pairMaterial(model, c.geometryA, c.geometryB);
    const double r = c.distance - material.margin;
    if (r >= 0.0) continue;  // NaN makes rows, so that the solve reports it

    const int condim = simulatedCondim(model.options.effects, material.condim);
    const bool frictional = condim > 1 && material.slidingFriction >= kSmallestFriction;
    const double mu = frictional ? material.slidingFriction : 0.0;
    ContactRows made{i, static_cast<int>(reference.size()), mu, contactFrame(c)};
    if (frictional) {
      made.pairs = condim - 1;
      const double spin = std::max(material.torsionalFriction, kSmallestFriction);
      const double roll = std::max(material.rollingFriction, kSmallestFriction);
      made.frictions = {mu, mu, spin, roll, roll};
    }
    RelativeMotion motion;
    motion.bodyA = c.bodyA;
    motion.bodyB = c.bodyB;
    motion.p_WA = motion.p_WB = c.p_WC;
    motion.linear = motion.angular = made.R_WC;
    motion.linearDim = frictional ? 3 : 1;
    motion.angularDim = std::max(0, made.pairs - 2);
    jacobian_.add(model, in.kinematics, in.tree, motion);
    made_.push_back(made);

    const double weight =
        (in.weights.translation[c.bodyA] + in.weights.translation[c.bodyB]) * (1.0 + mu * mu);
    const Softness soft = softnessAt(material.impedance, r, weight, model.options.timestep);
    double ydot[6];
    Eigen::Map<Vector3>(ydot).noalias() =
        made.R_WC.transpose() * (pointVelocity(model, in.kinematics, c.bodyB, c.p_WC) -
                                 pointVelocity(model, in.kinematics, c.bodyA, c.p_WC));
    if (motion.angularDim > 0)
      Eigen::Map<Vector3>(ydot + 3).noalias() =
          made.R_WC.transpose() *
          (in.kinematics.V[c.bodyB].angular - in.kinematics.V[c.bodyA].angular);
    if (!frictional) {
      reference.push_back(soft.referenceAcceleration(ydot[0], r));
      D.push_back(1.0 / soft.R);
      continue;
    }
    double edgeVelocity[10];
    toEdges(ydot, made, edgeVelocity);
    const double R = 2.0 * mu * mu / model.options.impedanceRatio * soft.R;
    for (int edge = 0; edge < 2 * made.pairs; ++edge) {
      reference.push_back(soft.referenceAcceleration(edgeVelocity[edge], r));
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
    double frame[6];
    jacobian_.multiply(static_cast<int>(i), a, frame);
    double* rows = y.data() + made_[i].row;
    if (made_[i].pairs > 0)
      toEdges(frame, made_[i], rows);
    else
      rows[0] = frame[0];
  }
}

void PyramidalContact::frameForce(int i, double* frame) const {
  const double* e = f.data() + made_[i].row;
  const ContactRows& made = made_[i];
  frame[0] = made.pairs > 0 ? 0.0 : e[0];
  for (int k = 0; k < made.pairs; ++k) {
    frame[0] = frame[0] + e[2 * k] + e[2 * k + 1];
    frame[k + 1] = made.frictions[k] * (e[2 * k] - e[2 * k + 1]);
  }
}

void PyramidalContact::addForce(VectorX& tau) const {
  for (int i = 0; i < static_cast<int>(made_.size()); ++i) {
    double frame[6];
    frameForce(i, frame);
    if (frame[0] != 0.0) jacobian_.addTransposed(i, frame, tau);
  }
}

void PyramidalContact::addCurvature(TreeMatrix& P) {
  for (std::size_t i = 0; i < made_.size(); ++i) {
    const double* e = h.data() + made_[i].row;
    const int pairs = made_[i].pairs, dim = pairs + 1;
    if (pairs == 0) {
      if (e[0] != 0.0) jacobian_.addCurvature(static_cast<int>(i), e, P);
      continue;
    }
    // Σ over edges of D (1, ±μ_k e_k)(1, ±μ_k e_k)ᵀ.
    double H[36];
    std::fill_n(H, dim * dim, 0.0);
    for (int k = 0; k < pairs; ++k) {
      const double mu = made_[i].frictions[k], sum = e[2 * k] + e[2 * k + 1];
      H[0] = H[0] + e[2 * k] + e[2 * k + 1];
      H[k + 1] = H[(k + 1) * dim] = mu * (e[2 * k] - e[2 * k + 1]);
      H[(k + 1) * dim + k + 1] = mu * mu * sum;
    }
    if (H[0] != 0.0) jacobian_.addCurvature(static_cast<int>(i), H, P);
  }
}

void PyramidalContact::addRow(int row, double scale, VectorX& y) const {
  const int i = contactOfRow_[row], edge = row - made_[i].row;
  double frame[6] = {scale, 0.0, 0.0, 0.0, 0.0, 0.0};
  if (made_[i].pairs > 0)
    frame[1 + edge / 2] = scale * (edge % 2 == 0 ? 1.0 : -1.0) * made_[i].frictions[edge / 2];
  jacobian_.addTransposed(i, frame, y);
}

Vector3 PyramidalContact::force(int i) const {
  double frame[6] = {};
  frameForce(i, frame);
  return made_[i].R_WC * Vector3(frame[0], frame[1], frame[2]);
}

Vector3 PyramidalContact::moment(int i) const {
  double frame[6] = {};
  frameForce(i, frame);
  return made_[i].R_WC * Vector3(frame[3], frame[4], frame[5]);
}

}  // namespace softgauss
