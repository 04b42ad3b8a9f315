// SPDX-License-Identifier: Apache-2.0
#include "tests/gdd/dense_gdd.hpp"

#include <algorithm>

namespace softgauss::test {

VectorX DenseGdd::force(const VectorX& a) const {
  VectorX force(rows());
  for (int i = 0; i < rows(); ++i)
    force[i] = std::clamp(D[i] * (aRef[i] - J.row(i).dot(a)), forceLower[i], forceUpper[i]);
  return force;
}

VectorX DenseGdd::g(const VectorX& a) const { return Mhat * a + c - J.transpose() * force(a); }

MatrixX DenseGdd::P(const VectorX& a) const {
  MatrixX sum = Mhat;
  for (int i = 0; i < rows(); ++i)
    if (stiff(i, J.row(i).dot(a) - aRef[i])) sum += D[i] * J.row(i).transpose() * J.row(i);
  return sum;
}

bool DenseGdd::stiff(int i, double x, double dx, double width) const {
  if (std::abs(x - upperKnot(i)) <= width) return dx < 0.0;
  if (std::abs(x - lowerKnot(i)) <= width) return dx > 0.0;
  return lowerKnot(i) < x && x < upperKnot(i);
}

double DenseGdd::goalCost(const VectorX& a) const {
  const VectorX error = A * a - y;
  double cost =
      0.5 * error.dot(w.cwiseProduct(error)) + 0.5 * metric * a.dot(M * a) + a.dot(M * offset);
  if (B.rows() > 0) {
    const VectorX forceError = B * force(a) - yf;
    cost += 0.5 * forceError.dot(wf.cwiseProduct(forceError));
  }
  return cost;
}

VectorX DenseGdd::goalGradient(const VectorX& a, const std::vector<bool>& stiff) const {
  VectorX gradient = A.transpose() * w.cwiseProduct(A * a - y) + M * (metric * a + offset);
  if (B.rows() > 0)
    gradient += forceJacobian(stiff).transpose() * wf.cwiseProduct(B * force(a) - yf);
  return gradient;
}

std::vector<bool> DenseGdd::stiffRows(const VectorX& a) const {
  std::vector<bool> all;
  for (int i = 0; i < rows(); ++i) all.push_back(stiff(i, J.row(i).dot(a) - aRef[i]));
  return all;
}

MatrixX DenseGdd::forceJacobian(const std::vector<bool>& stiff) const {
  MatrixX sum = MatrixX::Zero(B.rows(), dofs());
  for (int i = 0; i < rows(); ++i)
    if (stiff[i]) sum -= D[i] * B.col(i) * J.row(i);
  return sum;
}

MatrixX DenseGdd::forceHessian(const VectorX& a) const {
  if (B.rows() == 0) return MatrixX::Zero(dofs(), dofs());
  const MatrixX G = forceJacobian(stiffRows(a));
  return G.transpose() * wf.asDiagonal() * G;
}

MatrixX DenseGdd::goalHessian() const { return A.transpose() * w.asDiagonal() * A + metric * M; }

double DenseGdd::objective(const VectorX& a) const {
  const VectorX force = g(a);
  return 0.5 * force.dot(Minv * force) + goalCost(a);
}

VectorX DenseGdd::objectiveGradient(const VectorX& a) const {
  return P(a) * (Minv * g(a)) + goalGradient(a);
}

VectorX DenseGdd::penaltySlope(const VectorX& g) const {
  const VectorX slope = coordinateSlope(g);
  return C.size() == 0 ? slope : VectorX(C.transpose() * slope);
}

VectorX DenseGdd::coordinateSlope(const VectorX& g) const {
  VectorX slope(g.size());
  const VectorX place = coordinates(g);
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    const double t = place[i] + lambda[i] / rho[i];
    slope[i] = rho[i] * (t - std::clamp(t, lower[i], upper[i]));
  }
  return slope;
}

VectorX DenseGdd::penaltyCurvature(const VectorX& g) const {
  VectorX curvature(g.size());
  const VectorX place = coordinates(g);
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    const double t = place[i] + lambda[i] / rho[i];
    const bool inside = lower[i] < upper[i] && t >= lower[i] && t <= upper[i];
    curvature[i] = inside ? 0.0 : rho[i];
  }
  return curvature;
}

double DenseGdd::augmented(const VectorX& a) const {
  const VectorX slope = coordinateSlope(g(a));
  return objective(a) + 0.5 * slope.dot(slope.cwiseQuotient(rho));
}

VectorX DenseGdd::augmentedGradient(const VectorX& a) const {
  const VectorX force = g(a);
  return P(a) * (Minv * force + penaltySlope(force)) + goalGradient(a);
}

MatrixX DenseGdd::gaussNewtonHessian(const VectorX& a) const {
  const MatrixX slope = P(a);
  MatrixX weight = Minv;
  const VectorX curvature = penaltyCurvature(g(a));
  if (C.size() == 0)
    weight.diagonal() += curvature;
  else
    weight += C.transpose() * curvature.asDiagonal() * C;
  return slope * weight * slope + goalHessian() + forceHessian(a);
}

double DenseGdd::violation(const VectorX& a) const {
  const VectorX force = coordinates(g(a));
  return (force - force.cwiseMax(lower).cwiseMin(upper)).cwiseAbs().maxCoeff();
}

}  // namespace softgauss::test
