// SPDX-License-Identifier: Apache-2.0
/// Up to 12 rows: what a solver finds, beside the least that there is in any cell.

#include <cstdlib>
#include <iostream>

#include "tests/gdd/cell_minimum.hpp"
#include "tests/gdd/gdd_scene.hpp"
#include "tests/gdd/solvers.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

constexpr int kMostRows = 12;
constexpr double kWeights[] = {1.0, 100.0, 1000.0};

/// What a solver is held to. Local minima are in the nature of the problem, so not all that are
/// found are global; which one is, depends on the way.
template <class Solver>
struct Bounds {
  /// Share of global minima at any weight. Of the 1,500 problems of the long test solver 2 finds it
  /// in 98 % at weight 1, in 92 % at 100 and in 94 % at 1,000.
  static constexpr double globalShare = 0.92;
  /// The same with goals of contact forces: 95.0 % of the 900 of their long test.
  static constexpr double forceShare = 0.95;
  /// The slope, as a share of the value over the size of a, that a certified point may have. A
  /// point with a way down has slopes about 1 and more; one that is exact, those of rounding.
  static constexpr double slope = 1e-5;
};

/// Of the 1,500 problems of the long test it finds the global minimum in 96 % at weight 1, in 94 %
/// at 100 and at 1,000. It ends on rounding, up to 2e-7 of the value too high: that looks like a
/// slope of 0.2 in the ball below.
template <>
struct Bounds<gdd::AugmentedLagrangian> {
  static constexpr double globalShare = 0.936;
  static constexpr double forceShare = 0.911;  ///< 91.1 % of 900
  static constexpr double slope = 0.3;
};

/// A chain on a fixed base with frictional contacts at its links; its last joint is passive in
/// every other scene.
GddScene chainScene(std::uint64_t seed, int contacts) {
  Random random(seed + 300000);
  ModelBuilder builder = chain(5);
  builder.geometry(groundSpec(0.5));
  for (int i = 0; i < 5; ++i)
    builder.geometry(geometrySpec("link" + std::to_string(i), Shape::sphere(0.05), 0.7));
  Scene scene(builder.build());
  scene.state = randomState(scene.model, random);
  FixedContacts source;
  for (int i = 0; i < contacts; ++i) {
    Contact c;
    c.geometryB = 1 + random.index(5);
    c.bodyB = scene.model.geometries[c.geometryB].body;
    c.p_WC = random.vector3(0.5);
    c.n_W = random.direction();
    c.distance = -random.uniform(0.0, 0.002);
    source.points.push_back(c);
  }
  scene.contacts = std::make_shared<FixedContacts>(source);
  scene.stages();
  GddScene s(std::move(scene));
  if (seed % 2 == 0) s.limits.lower[4] = s.limits.upper[4] = 0.0;
  s.dense.lower = s.limits.lower;
  s.dense.upper = s.limits.upper;
  return s;
}

/// A small floating tree with joints of any kind, ranges, dry friction and a contact or two.
GddScene treeScene(std::uint64_t seed) {
  RandomTreeOptions options;
  options.trees = 1;
  options.links = 3;
  options.dryFriction = true;
  return GddScene(randomScene(seed + 400000, 1 + static_cast<int>(seed % 2), options));
}

/// What the value of a problem is a share of: F is a sum of squares but for this constant.
double missingConstant(const DenseGdd& d) {
  return d.metric == 0.0 ? 0.0 : 0.5 * d.offset.dot(d.M * d.offset) / d.metric;
}

struct PatternTally {
  int problems = 0, global = 0, local = 0, claimed = 0, kinks = 0;
  int patterns = 0, programs = 0;
  double worstGap = 0.0, steepest = 0.0;

  PatternTally& operator+=(const PatternTally& t) {
    problems += t.problems, global += t.global, local += t.local, claimed += t.claimed;
    kinks += t.kinks, patterns += t.patterns, programs += t.programs;
    worstGap = std::max(worstGap, t.worstGap);
    steepest = std::max(steepest, t.steepest);
    return *this;
  }
  double globalShare() const { return static_cast<double>(global) / problems; }
};

/// Solves, and follows with forward dynamics of the clamped control: what would be simulated.
template <class Solver>
void addTo(PatternTally& tally, GddScene& s, const CellMinimum& least) {
  const DenseGdd& d = s.dense;
  Solver solver(s.model());
  const gdd::GddReport report =
      solver.solve(s.model(), s.cost, s.limits, s.data(), s.scene.state.warmstart);
  setAppliedForce(s.limits.clamp(solver.force()), s.data().forces);
  ASSERT_EQ(forwardDynamics(s.model(), &solver.acceleration(), s.data()), SolveStatus::converged);
  const VectorX a = s.data().forward.a;

  const double value = d.objective(a), scale = least.value + missingConstant(d);
  const double gap = (value - least.value) / scale;
  // Nothing that can be done costs less. a is exact to some 1e-12 of the largest force, which the
  // slope of F and the conditioning of P make 1e-8 of the value at worst.
  EXPECT_GE(gap, -1e-8) << "below the global minimum";
  ++tally.problems;
  tally.global += gap < 1e-6;
  tally.worstGap = std::max(tally.worstGap, gap);
  tally.patterns += least.patterns;
  tally.programs += least.programs;

  if (report.status != gdd::GddStatus::converged &&
      report.status != gdd::GddStatus::nonsmoothMinimum)
    return;
  ++tally.claimed;
  tally.kinks += report.status == gdd::GddStatus::nonsmoothMinimum;
  // The ball is so small that another minimum is hardly in it: within 1e-4 of a, two of 1,500
  // minima have a better one beside them. What is less there, over what is gone, is the slope. A
  // way down leads to the ball's edge, or to a kink on the way; what is less within a thousandth of
  // the ball already is the point itself, beside a steep kink by the rounding of a.
  constexpr double kRadius = 1e-6, kPoint = 1e-3;
  const VectorX radius = VectorX::Constant(d.dofs(), kRadius * a.cwiseAbs().maxCoeff());
  const auto slopeFrom = [&](double from) {
    return (from - minimumNear(d, a, radius).value) / scale / kRadius;
  };
  double slope = slopeFrom(value);
  if (slope > Bounds<Solver>::slope) slope = slopeFrom(minimumNear(d, a, kPoint * radius).value);
  tally.steepest = std::max(tally.steepest, slope);
  tally.local += slope <= Bounds<Solver>::slope;
}

void tell(const std::string& what, double weight, const PatternTally& t) {
  if (!std::getenv("SOFTGAUSS_TABLES")) return;
  std::cout << what << "  weight " << weight << "  problems " << t.problems << "  global "
            << t.global << "  worst gap " << t.worstGap << "  certified " << t.claimed << "  local "
            << t.local << "  steepest " << t.steepest << "  kinks " << t.kinks << "  patterns "
            << t.patterns << "  programs " << t.programs << '\n';
}

template <class Solver>
class GlobalMinimum : public testing::Test {
 protected:
  /// Chains with 4 to 4 · `contacts` rows; `forces`: with goals of contact forces.
  void chains(int contacts, int count, bool boxed, bool forces = false) {
    const auto prepare = [&](GddScene& s, Random& random) {
      if (boxed) s.addRandomBox(random, 0.6, 5.0);
      if (forces) s.addRandomForces(random);
    };
    family((boxed ? "boxed chain, rows " : "chain, rows ") + std::to_string(4 * contacts) +
               (forces ? ", goals of forces" : ""),
           contacts, count, prepare,
           forces ? std::min(Bounds<Solver>::forceShare, Bounds<Solver>::globalShare)
                  : Bounds<Solver>::globalShare);
  }

  /// The same with gears, differentials and tendons in the place of single joints.
  void coupledChains(int contacts, int count) {
    const auto prepare = [](GddScene& s, Random& random) {
      s.addRandomActuators(random, true, 5.0);
    };
    family("coupled chain, rows " + std::to_string(4 * contacts), contacts, count, prepare,
           Bounds<Solver>::globalShare);
  }

  void trees(int count, bool boxed) {
    for (const double weight : kWeights) {
      PatternTally tally;
      for (int seed = 0; tally.problems < count; ++seed) {
        GddScene s = treeScene(seed);
        if (s.dense.rows() == 0 || s.dense.rows() > kMostRows || patternCount(s.dense) > 3000.0)
          continue;
        addGoal(s, seed, weight);
        Random random(seed + 17);
        if (boxed) s.addRandomBox(random, 0.6, 5.0);
        addTo<Solver>(tally, s, globalMinimum(s.dense));
      }
      finish(boxed ? "boxed tree" : "tree", weight, tally, Bounds<Solver>::globalShare);
    }
  }

 private:
  /// `count` chains at each weight; `prepare` adds to a scene what the family is about.
  template <class Prepare>
  void family(const std::string& what, int contacts, int count, Prepare&& prepare, double share) {
    for (const double weight : kWeights) {
      PatternTally tally;
      for (int seed = 0; seed < count; ++seed) {
        GddScene s = chainScene(seed, contacts);
        addGoal(s, seed, weight);
        Random random(seed + 17);
        prepare(s, random);
        ASSERT_LE(s.dense.rows(), kMostRows);
        addTo<Solver>(tally, s, globalMinimum(s.dense));
      }
      finish(what, weight, tally, share);
    }
  }

  static void addGoal(GddScene& s, int seed, double weight) {
    Random random(seed + 29);
    const int body = s.model().bodyCount() - 1;
    s.addPoint(body, s.data().kinematics.X_WB[body].p + random.vector3(0.2), weight,
               random.vector3(20.0));
    s.addMetric(0.1, -10.0 * s.scene.state.v);
  }

  // A family of `problems` may miss the share by three standard deviations of its count.
  void finish(const std::string& what, double weight, const PatternTally& t, double share) {
    tell(what, weight, t);
    total_ += t;
    const double deviation = std::sqrt(share * (1.0 - share) / t.problems);
    EXPECT_GE(t.globalShare(), share - 3.0 * deviation) << what << ", weight " << weight;
    EXPECT_EQ(t.local, t.claimed) << "certified, yet a cell next to it has less: " << what;
    EXPECT_GE(t.claimed, 0.95 * t.problems) << what << ", weight " << weight;
  }

 protected:
  PatternTally total_;
};

TYPED_TEST_SUITE(GlobalMinimum, GddSolvers);

TYPED_TEST(GlobalMinimum, IsMostlyFoundWithFourRows) { this->chains(1, 40, false); }
TYPED_TEST(GlobalMinimum, IsMostlyFoundWithFourRowsAndABox) { this->chains(1, 40, true); }
TYPED_TEST(GlobalMinimum, IsMostlyFoundWithEightRows) { this->chains(2, 15, false); }
TYPED_TEST(GlobalMinimum, IsMostlyFoundWithTwelveRows) { this->chains(3, 4, false); }
TYPED_TEST(GlobalMinimum, IsMostlyFoundWithGoalsOfForces) {
  this->chains(1, 40, false, true);
  this->chains(2, 40, true, true);
}
TYPED_TEST(GlobalMinimum, IsMostlyFoundOnTrees) { this->trees(15, false); }
TYPED_TEST(GlobalMinimum, IsMostlyFoundOnTreesWithABox) { this->trees(15, true); }

TYPED_TEST(GlobalMinimum, IsMostlyFoundWithCoupledActuators) { this->coupledChains(1, 40); }

// Not with 12 rows: in one of these problems rounding keeps the oracle from an end.
TYPED_TEST(GlobalMinimum, LongIsMostlyFoundWithGoalsOfForces) {
  this->chains(1, 100, true, true);
  this->chains(2, 100, true, true);
  this->chains(2, 100, false, true);
  tell("all", 0.0, this->total_);
  // Families differ, from 88 to 100 %; all of them together have the share of forceShare.
  const double share = Bounds<TypeParam>::forceShare;
  const double deviation = std::sqrt(share * (1.0 - share) / this->total_.problems);
  EXPECT_GE(this->total_.globalShare(), share - 3.0 * deviation);
}

TYPED_TEST(GlobalMinimum, LongIsMostlyFound) {
  this->chains(2, 100, true);
  this->chains(2, 100, false);
  this->chains(3, 50, true);
  this->chains(3, 50, false);
  this->trees(100, true);
  this->trees(100, false);
  tell("all", 0.0, this->total_);
  constexpr double kThreeDeviations = 0.019;  // of 1,500
  EXPECT_GE(this->total_.globalShare(), Bounds<TypeParam>::globalShare - kThreeDeviations);
}

// The oracle by a cruder one: no control that is drawn at random does better.
TEST(CellMinimum, NoSampleIsBelow) {
  for (int seed = 0; seed < 6; ++seed) {
    GddScene s = chainScene(seed, 1 + seed % 2);
    Random random(seed + 51);
    s.addRandomGoals(random);
    s.addRandomBox(random, 1.0, 5.0);
    const CellMinimum least = globalMinimum(s.dense);
    ASSERT_TRUE(least.a.allFinite());
    EXPECT_SMALL(s.dense.violation(least.a), 1e-9 * s.dense.c.cwiseAbs().maxCoeff());
    for (int sample = 0; sample < 300; ++sample) {
      VectorX u(s.dofs());
      for (int i = 0; i < s.dofs(); ++i) {
        const double lower = std::max(s.limits.lower[i], -10.0),
                     upper = std::min(s.limits.upper[i], 10.0);
        u[i] = random.uniform(lower, upper);
        if (random.chance(0.2)) u[i] = random.chance(0.5) ? lower : upper;
      }
      setAppliedForce(u, s.data().forces);
      ASSERT_EQ(forwardDynamics(s.model(), nullptr, s.data()), SolveStatus::converged);
      EXPECT_GE(s.dense.objective(s.data().forward.a), least.value * (1.0 - 1e-9));
    }
  }
}

// The certificate tells: a point a hundredth off the minimum is none.
TEST(CellMinimum, NearAnotherPointThereIsLess) {
  for (int seed = 0; seed < 10; ++seed) {
    GddScene s = chainScene(2 * seed + 1, 2);  // no passive joint: any point is feasible
    Random random(seed + 51);
    s.addPoint(5, random.vector3(0.3), 100.0, random.vector3(20.0));
    const CellMinimum least = globalMinimum(s.dense);
    const double size = least.a.cwiseAbs().maxCoeff();
    const VectorX off = least.a + random.vector(s.dofs(), 0.01 * size);
    const VectorX radius = VectorX::Constant(s.dofs(), 1e-4 * size);
    EXPECT_GT(s.dense.objective(off) - minimumNear(s.dense, off, radius).value, 1e-6 * least.value);
    EXPECT_SMALL((least.value - minimumNear(s.dense, least.a, radius).value) / least.value, 1e-9);
  }
}

}  // namespace
}  // namespace softgauss::test
