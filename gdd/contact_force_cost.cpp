// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/contact_force_cost.hpp"

#include <type_traits>

namespace softgauss::gdd {
namespace {

Eigen::Map<const Vector6> asVector(const ContactBlocks::FrameVector& frame) {
  return Eigen::Map<const Vector6>(frame.data());
}

/// Σ_j w_j x_j·y_j over the residuals.
double weightedSum(const ContactForceCost& cost, const std::vector<Vector3>& x,
                   const std::vector<Vector3>& y) {
  double sum = 0.0;
  for (std::size_t j = 0; j < x.size(); ++j) sum += cost.residuals()[j].weight * x[j].dot(y[j]);
  return sum;
}

/// tau ← tau − J_iᵀ H_i y for a vector y in the frame of contact i.
template <class Contacts>
void subtractThroughContact(const Contacts& contacts, int i, const Vector6& y, VectorX& tau) {
  double H[36];
  const int dim = contacts.frameCurvature(i, H);
  double force[6];
  bool any = false;
  for (int k = 0; k < dim; ++k) {
    force[k] = 0.0;
    for (int l = 0; l < dim; ++l) force[k] -= H[k * dim + l] * y[l];
    any |= force[k] != 0.0;
  }
  if (any) contacts.jacobian().addTransposed(i, force, tau);
}

}  // namespace

/// Calls f with every part of the cost and the contacts of its kind.
template <class F>
void ContactForceTerms::visitParts(const Constraints& rows, F&& f) const {
  rows.visitContacts([&](const auto& contacts) {
    for (const ContactForceCost::Part& part : cost_->parts())
      if (part.cone == contacts.kCone) f(part, contacts);
  });
}

void ContactForceTerms::setCost(const ContactForceCost& cost) {
  cost_ = cost.empty() ? nullptr : &cost;
  if (!cost_) return;
  error_.resize(cost.residuals().size());
  rate_.resize(cost.residuals().size());
}

void ContactForceTerms::evaluate(const Constraints& rows) {
  if (!cost_) return;
  for (std::size_t j = 0; j < error_.size(); ++j) error_[j] = -cost_->residuals()[j].target;
  visitParts(rows, [&](const ContactForceCost::Part& part, const auto& contacts) {
    error_[part.residual] += part.map * asVector(contacts.frameForce(part.contact));
  });
}

double ContactForceTerms::value() const {
  return cost_ ? 0.5 * weightedSum(*cost_, error_, error_) : 0.0;
}

void ContactForceTerms::addGradient(const Constraints& rows, VectorX& g) const {
  if (!cost_) return;
  visitParts(rows, [&](const ContactForceCost::Part& part, const auto& contacts) {
    const double w = cost_->residuals()[part.residual].weight;
    const Vector6 pull = w * (part.map.transpose() * error_[part.residual]);
    subtractThroughContact(contacts, part.contact, pull, g);
  });
}

double ContactForceTerms::pull(Breakpoint breakpoint, const Constraints& rows) const {
  double sum = 0.0;
  if (!cost_) return sum;
  rows.visitContactsOf(breakpoint.row, [&](const auto& contacts) {
    const int contact = contacts.contactOfRow(breakpoint.row.row);
    const auto row = contacts.breakpointInFrame(breakpoint.row.row, breakpoint.index);
    for (const ContactForceCost::Part& part : cost_->parts())
      if (part.cone == contacts.kCone && part.contact == contact)
        sum += cost_->residuals()[part.residual].weight *
               error_[part.residual].dot(part.map * asVector(row));
  });
  return sum;
}

void ContactForceTerms::setRate(const Constraints& rows) {
  if (!cost_) return;
  for (Vector3& rate : rate_) rate.setZero();
  visitParts(rows, [&](const ContactForceCost::Part& part, const auto& contacts) {
    rate_[part.residual] += part.map * asVector(contacts.frameForceRate(part.contact));
  });
}

double ContactForceTerms::slope() const { return cost_ ? weightedSum(*cost_, error_, rate_) : 0.0; }

double ContactForceTerms::curvature() const {
  return cost_ ? weightedSum(*cost_, rate_, rate_) : 0.0;
}

void ContactForceTerms::advance(double length) {
  if (!cost_) return;
  for (std::size_t j = 0; j < error_.size(); ++j) error_[j] += length * rate_[j];
}

void ContactForceTerms::cross(const Crossing& crossing, const Constraints& rows) {
  if (!cost_) return;
  const RowId row = crossing.breakpoint.row;
  rows.visitContactsOf(row, [&](const auto& contacts) {
    const int contact = contacts.contactOfRow(row.row);
    const auto edge = contacts.breakpointInFrame(row.row, crossing.breakpoint.index);
    for (const ContactForceCost::Part& part : cost_->parts())
      if (part.cone == contacts.kCone && part.contact == contact)
        rate_[part.residual] -=
            crossing.curvatureJump * crossing.rate * (part.map * asVector(edge));
  });
}

void ContactForceTerms::setJacobian(const Constraints& rows, int dofs) {
  if (!cost_) return;
  while (jacobian_.size() < 3 * error_.size()) jacobian_.emplace_back();
  for (std::size_t r = 0; r < 3 * error_.size(); ++r) jacobian_[r].setZero(dofs);
  visitParts(rows, [&](const ContactForceCost::Part& part, const auto& contacts) {
    for (int k = 0; k < 3; ++k) {
      const Vector6 row = part.map.row(k);
      subtractThroughContact(contacts, part.contact, row, jacobian_[3 * part.residual + k]);
    }
  });
}

void ContactForceTerms::addCurvature(TreeMatrix& H) const {
  if (!cost_) return;
  for (std::size_t r = 0; r < 3 * error_.size(); ++r) {
    const VectorX& G = jacobian_[r];
    for (Eigen::Index i = 0; i < G.size(); ++i) {
      const double scale = cost_->residuals()[r / 3].weight * G[i];
      if (scale == 0.0) continue;
      double* row = H.row(static_cast<int>(i));
      for (Eigen::Index j = 0; j <= i; ++j) row[j] += scale * G[j];
    }
  }
}

void ContactForceTerms::addReducedCurvature(const RowMajorMatrixX& S, MatrixX& K) {
  if (!cost_) return;
  reduced_.resize(S.cols());
  for (std::size_t r = 0; r < 3 * error_.size(); ++r) {
    const VectorX& G = jacobian_[r];
    reduced_.setZero();
    for (Eigen::Index i = 0; i < G.size(); ++i)
      if (G[i] != 0.0) reduced_ += G[i] * S.row(i).transpose();
    K.selfadjointView<Eigen::Lower>().rankUpdate(reduced_, cost_->residuals()[r / 3].weight);
  }
}

}  // namespace softgauss::gdd
