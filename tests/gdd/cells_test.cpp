// SPDX-License-Identifier: Apache-2.0
/// Small problems solved outright: every piece of every row, and every side of every box.
///
/// A minimum of (8.1) lies in the relative interior of a face of the piecewise quadratic: each row
/// stiff, free or at a breakpoint; each control free, at its lower or at its upper bound. On a face
/// it solves a linear system. All faces are solved, what is not feasible is dropped, and the lowest
/// F of the rest is the global minimum.

#include <Eigen/LU>

#include "tests/gdd/gdd_scene.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

class Enumeration {
 public:
  explicit Enumeration(const DenseGdd& d)
      : d_(d), force_(std::max(1.0, d.c.cwiseAbs().maxCoeff())) {
    for (int i = 0; i < d.dofs(); ++i) {
      const bool finite = std::isfinite(d.lower[i]);
      states_.push_back(d.lower[i] == d.upper[i] || !finite ? 1 : 3);
    }
  }

  double globalMinimum() {
    best_ = kInfinity;
    long rowFaces = 1, boxFaces = 1;
    for (int i = 0; i < d_.rows(); ++i) rowFaces *= facesOf(i);
    for (const int n : states_) boxFaces *= n;
    for (long r = 0; r < rowFaces; ++r) {
      setRows(r);
      for (long b = 0; b < boxFaces; ++b) solveFace(b);
    }
    return best_;
  }

 private:
  /// Stiff; free and at the breakpoint of a bound of the force, or of both.
  int facesOf(int i) const { return std::isfinite(d_.forceUpper[i]) ? 5 : 3; }

  /// P, the affine part of g and the breakpoints of a pattern.
  void setRows(long pattern) {
    P_ = d_.Mhat;
    offset_ = d_.c;
    breakpoints_.clear();
    for (int i = 0; i < d_.rows(); ++i) {
      const long face = pattern % facesOf(i);
      pattern /= facesOf(i);
      if (face > 0) {
        const bool above = face <= 2;
        offset_ -= (above ? d_.forceLower[i] : d_.forceUpper[i]) * d_.J.row(i).transpose();
        if (face % 2 == 0) breakpoints_.emplace_back(i, above ? d_.upperKnot(i) : d_.lowerKnot(i));
        continue;
      }
      P_ += d_.D[i] * d_.J.row(i).transpose() * d_.J.row(i);
      offset_ -= d_.D[i] * d_.aRef[i] * d_.J.row(i).transpose();
    }
    H_ = P_ * d_.Minv * P_ + d_.goalHessian();
    slope_ = P_ * d_.Minv * offset_ + d_.goalGradient(VectorX::Zero(d_.dofs()));
  }

  void solveFace(long sides) {
    const int n = d_.dofs();
    std::vector<std::pair<int, double>> fixed;
    for (int i = 0; i < n; ++i) {
      if (d_.lower[i] == d_.upper[i]) fixed.emplace_back(i, d_.lower[i]);
      if (states_[i] == 1) continue;
      if (sides % 3 == 1) fixed.emplace_back(i, d_.lower[i]);
      if (sides % 3 == 2) fixed.emplace_back(i, d_.upper[i]);
      sides /= 3;
    }
    const int m = static_cast<int>(breakpoints_.size() + fixed.size());
    if (m > n) return;  // more conditions than unknowns: also on a smaller face
    MatrixX K = MatrixX::Zero(n + m, n + m);
    VectorX b(n + m);
    K.topLeftCorner(n, n) = H_;
    b.head(n) = -slope_;
    int k = n;
    for (const auto& [i, x] : breakpoints_) {
      K.row(k).head(n) = d_.J.row(i);
      b[k++] = d_.aRef[i] + x;
    }
    for (const auto& [i, value] : fixed) {
      K.row(k).head(n) = P_.row(i);
      b[k++] = value - offset_[i];
    }
    K.topRightCorner(n, m) = K.bottomLeftCorner(m, n).transpose();
    const VectorX a = K.partialPivLu().solve(b).head(n);
    // A singular face gives nonsense, which is not feasible: its minimum is on another face too.
    if (!a.allFinite() || d_.violation(a) > 1e-7 * force_) return;
    best_ = std::min(best_, d_.objective(a));
  }

  const DenseGdd& d_;
  double force_, best_ = kInfinity;
  std::vector<int> states_;  ///< of each dof: 3 where it has a box of some width
  MatrixX P_, H_;
  VectorX offset_, slope_;
  std::vector<std::pair<int, double>> breakpoints_;  ///< rows, and their x there
};

/// A fixed chain with frictional contacts at its links and a point goal; its last joint is passive
/// in every other scene, its first two joints are boxed where `boxed`; as many as `dry` have dry
/// friction.
/// Where dry friction is about to slip: a step answers what the reference of 0.02 s answers of
/// 0.05 rad/s.
constexpr double kSlow = 0.05 * 0.002 * 2.0 / (0.95 * 0.02);

GddScene smallScene(std::uint64_t seed, int contacts, bool boxed, double weight, int dry) {
  Random random(seed + 100000);
  ModelBuilder builder = chain(4);
  builder.geometry(groundSpec(0.5));
  for (int i = 0; i < 4; ++i)
    builder.geometry(geometrySpec("link" + std::to_string(i), Shape::sphere(0.05), 0.7));
  Scene scene(builder.build());
  for (int i = 0; i < dry; ++i) scene.model.dofs[i].dryFriction = 2.0;
  scene.state = randomState(scene.model, random, dry > 0 ? kSlow : 2.0);
  FixedContacts source;
  for (int i = 0; i < contacts; ++i) {
    Contact c;
    c.geometryB = 1 + random.index(4);
    c.bodyB = scene.model.geometries[c.geometryB].body;
    c.p_WC = random.vector3(0.5);
    c.n_W = random.direction();
    c.distance = -random.uniform(0.0, 0.002);
    source.points.push_back(c);
  }
  scene.contacts = std::make_shared<FixedContacts>(source);
  scene.input.controlled = allTrees(scene.model);
  EXPECT_EQ(scene.stages(), SolveStatus::converged);
  GddScene s(std::move(scene));
  if (seed % 2 == 0) s.limits.lower[3] = s.limits.upper[3] = 0.0;
  for (int i = 0; boxed && i < 2; ++i) {
    s.limits.lower[i] = -random.uniform(0.5, 5.0);
    s.limits.upper[i] = random.uniform(0.5, 5.0);
  }
  s.dense.lower = s.limits.lower;
  s.dense.upper = s.limits.upper;
  const int body = 4;
  s.addPoint(body, s.data().kinematics.X_WB[body].p + random.vector3(0.2), weight,
             random.vector3(20.0));
  return s;
}

struct Tally {
  int problems = 0, global = 0, kinks = 0, unfinished = 0;
  double worstGap = 0.0;

  void add(GddScene& s) {
    const double least = Enumeration(s.dense).globalMinimum();
    const VectorX& a = s.solve();
    ++problems;
    kinks += s.report.status == gdd::GddStatus::nonsmoothMinimum;
    unfinished += s.report.status == gdd::GddStatus::iterationLimit;
    const VectorX g = s.dense.g(a);
    // ℓ ≥ 0 has no constant here: F is the sum of two squares, and a gap is a share of it.
    const double gap = (s.dense.objective(a) - least) / least;
    global += gap < 1e-6;
    worstGap = std::max(worstGap, gap);
    // The enumeration would be wrong if the solver found less.
    EXPECT_GT(gap, -1e-6);
  }
  double share() const { return static_cast<double>(global) / problems; }
};

Tally solveSmallProblems(int contacts, bool boxed, int count, int dry = 0) {
  Tally tally;
  for (const double weight : {1.0, 100.0, 1000.0})
    for (int seed = 0; seed < count; ++seed) {
      GddScene s = smallScene(seed, contacts, boxed, weight, dry);
      tally.add(s);
    }
  return tally;
}

// What is asserted is modest: local minima are in the nature of the problem, and a bad one may cost
// many times the best.
TEST(GddCells, MostSmallProblemsAreSolvedGlobally) {
  const Tally tally = solveSmallProblems(1, false, 60);
  EXPECT_SMALL(1.0 - tally.share(), 0.1);
  EXPECT_SMALL(tally.worstGap, 20.0);
  EXPECT_LE(tally.unfinished, 2);
}

TEST(GddCells, MostSmallProblemsWithABoxAreSolvedGlobally) {
  const Tally tally = solveSmallProblems(1, true, 60);
  EXPECT_SMALL(1.0 - tally.share(), 0.1);
  EXPECT_SMALL(tally.worstGap, 20.0);
  EXPECT_LE(tally.unfinished, 2);
}

TEST(GddCells, MostProblemsOfEightRowsAreSolvedGlobally) {
  const Tally tally = solveSmallProblems(2, false, 25);
  EXPECT_SMALL(1.0 - tally.share(), 0.15);
  EXPECT_SMALL(tally.worstGap, 20.0);
  EXPECT_LE(tally.unfinished, 2);
}

TEST(GddCells, MostSmallProblemsWithDryFrictionAreSolvedGlobally) {
  const Tally tally = solveSmallProblems(0, true, 60, 3);
  EXPECT_SMALL(1.0 - tally.share(), 0.1);
  EXPECT_SMALL(tally.worstGap, 20.0);
  EXPECT_LE(tally.unfinished, 2);
  EXPECT_GT(tally.kinks, 20);
}

}  // namespace
}  // namespace softgauss::test
