// SPDX-License-Identifier: Apache-2.0
#include "tests/gdd/cell_minimum.hpp"

#include <vector>

namespace softgauss::test {
namespace {

enum class Piece { below, stiff, above };  ///< of the row's breakpoints; at the two ends it is free

class Search {
 public:
  Search(const DenseGdd& d, const VectorX* center, const VectorX* radius)
      : d_(d), center_(center), radius_(radius), pieces_(d.rows()) {
    goalHessian_ = d.goalHessian();
    DenseGdd plain = d;  // contact forces are affine in a cell only
    plain.B.resize(0, d.rows());
    goalSlope_ = plain.goalGradient(VectorX::Zero(d.dofs()));
    goalConstant_ = plain.goalCost(VectorX::Zero(d.dofs()));
  }

  CellMinimum run() {
    branch(0, d_.Mhat, d_.c);
    return best_;
  }

 private:
  /// Gives row i each piece that it may have; P and offset (g = P a + offset) count those before.
  void branch(int i, const MatrixX& P, const VectorX& offset) {
    if (i == d_.rows()) {
      solveCell(P, offset);
      return;
    }
    const VectorX J = d_.J.row(i);
    for (const Piece piece : {Piece::below, Piece::stiff, Piece::above}) {
      if (!possible(i, piece)) continue;
      pieces_[i] = piece;
      if (piece == Piece::stiff)
        branch(i + 1, P + d_.D[i] * J * J.transpose(), offset - d_.D[i] * d_.aRef[i] * J);
      else
        branch(i + 1, P,
               offset - (piece == Piece::above ? d_.forceLower[i] : d_.forceUpper[i]) * J);
    }
  }

  bool possible(int i, Piece piece) const {
    const double lower = d_.lowerKnot(i), upper = d_.upperKnot(i);
    if (piece == Piece::below && !std::isfinite(lower)) return false;
    if (piece == Piece::above && !std::isfinite(upper)) return false;
    if (!center_) return true;
    const double x = d_.J.row(i).dot(*center_) - d_.aRef[i];
    const double reach = d_.J.row(i).cwiseAbs().dot(*radius_);
    if (piece == Piece::below) return x - reach <= lower;
    if (piece == Piece::above) return x + reach >= upper;
    return x - reach <= upper && x + reach >= lower;
  }

  void solveCell(const MatrixX& P, const VectorX& offset) {
    ++best_.patterns;
    const int n = d_.dofs();
    ConvexQp qp;
    const MatrixX PMinv = P * d_.Minv;
    qp.H = PMinv * P + goalHessian_;
    qp.s = PMinv * offset + goalSlope_;
    // The coordinates on which the bounds are: y = D a + e.
    const MatrixX D = d_.C.size() == 0 ? P : MatrixX(d_.C * P);
    const VectorX e = d_.coordinates(offset);
    double constant = 0.5 * offset.dot(d_.Minv * offset) + goalConstant_;
    if (d_.B.rows() > 0) constant += addForces(qp);

    std::vector<std::pair<VectorX, double>> inequalities;  // row · a ≥ bound
    int equalities = 0;
    for (int i = 0; i < n; ++i) equalities += d_.lower[i] == d_.upper[i];
    qp.E.resize(equalities, n);
    qp.e.resize(equalities);
    equalities = 0;
    for (int i = 0; i < n; ++i) {
      if (d_.lower[i] == d_.upper[i]) {
        qp.E.row(equalities) = D.row(i);
        qp.e[equalities++] = d_.lower[i] - e[i];
        continue;
      }
      if (std::isfinite(d_.lower[i])) inequalities.emplace_back(D.row(i), d_.lower[i] - e[i]);
      if (std::isfinite(d_.upper[i])) inequalities.emplace_back(-D.row(i), e[i] - d_.upper[i]);
    }
    for (int i = 0; i < d_.rows(); ++i) {
      const VectorX J = d_.J.row(i);
      const double lower = d_.aRef[i] + d_.lowerKnot(i), upper = d_.aRef[i] + d_.upperKnot(i);
      if (pieces_[i] == Piece::below) inequalities.emplace_back(-J, -lower);
      if (pieces_[i] == Piece::above) inequalities.emplace_back(J, upper);
      if (pieces_[i] != Piece::stiff) continue;
      if (std::isfinite(lower)) inequalities.emplace_back(J, lower);
      if (std::isfinite(upper)) inequalities.emplace_back(-J, -upper);
    }
    for (int i = 0; center_ && i < n; ++i) {
      inequalities.emplace_back(VectorX::Unit(n, i), (*center_)[i] - (*radius_)[i]);
      inequalities.emplace_back(-VectorX::Unit(n, i), -(*center_)[i] - (*radius_)[i]);
    }
    qp.C.resize(static_cast<Eigen::Index>(inequalities.size()), n);
    qp.b.resize(qp.C.rows());
    for (std::size_t i = 0; i < inequalities.size(); ++i) {
      qp.C.row(i) = inequalities[i].first;
      qp.b[i] = inequalities[i].second;
    }
    const std::optional<VectorX> a = qp.solve(best_.value - constant);
    if (!a) return;
    ++best_.programs;
    const double value = d_.objective(*a);
    if (value >= best_.value) return;
    best_.value = value;
    best_.a = *a;
  }

  /// ℓ_f = ½ |G a + e₀|² by its weights in the present pattern; returns its value at a = 0.
  double addForces(ConvexQp& qp) const {
    std::vector<bool> stiff;
    VectorX f(d_.rows());
    for (int i = 0; i < d_.rows(); ++i) {
      stiff.push_back(pieces_[i] == Piece::stiff);
      f[i] = stiff[i]                     ? d_.D[i] * d_.aRef[i]
             : pieces_[i] == Piece::above ? d_.forceLower[i]
                                          : d_.forceUpper[i];
    }
    const MatrixX G = d_.forceJacobian(stiff);
    const VectorX e = d_.B * f - d_.yf;
    qp.H += G.transpose() * d_.wf.asDiagonal() * G;
    qp.s += G.transpose() * d_.wf.cwiseProduct(e);
    return 0.5 * e.dot(d_.wf.cwiseProduct(e));
  }

  const DenseGdd& d_;
  const VectorX* center_;
  const VectorX* radius_;
  std::vector<Piece> pieces_;
  MatrixX goalHessian_;
  VectorX goalSlope_;
  double goalConstant_ = 0.0;
  CellMinimum best_;
};

}  // namespace

double patternCount(const DenseGdd& d) {
  double count = 1.0;
  for (int i = 0; i < d.rows(); ++i)
    count *= 1.0 + std::isfinite(d.lowerKnot(i)) + std::isfinite(d.upperKnot(i));
  return count;
}

CellMinimum globalMinimum(const DenseGdd& d) { return Search(d, nullptr, nullptr).run(); }

CellMinimum minimumNear(const DenseGdd& d, const VectorX& center, const VectorX& radius) {
  return Search(d, &center, &radius).run();
}

}  // namespace softgauss::test
