// SPDX-License-Identifier: Apache-2.0
/// The coordinates of force (8.3), and what is refused when actuators and metrics are set.

#include "softgauss/gdd/transmission.hpp"

#include "softgauss/gdd/control_cost_term.hpp"
#include "softgauss/gdd/problem.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/random.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

using gdd::Actuator;
using gdd::Transmission;

/// The message of the ModelError that `make` throws; empty if it throws none.
template <class F>
std::string refusal(F&& make) {
  try {
    make();
  } catch (const ModelError& error) {
    return error.what();
  }
  return {};
}

std::vector<Actuator> three(double last) {
  return {{.name = "up", .pulls = {{1, 1.0}, {2, 2.0}}},
          {.name = "alone", .pulls = {{4, 3.0}}},
          {.name = "down", .pulls = {{1, 2.0}, {2, last}}}};
}

// Dependence is one of directions: what a coefficient's square does to a double is not asked.
TEST(Transmission, RankDoesNotDependOnTheSizeOfColumns) {
  for (const double size : {1e-300, 1e-155, 1e-12, 1.0, 1e12, 1e155, 1e300}) {
    const Transmission apart(2, {{.name = "a", .pulls = {{0, size}, {1, size}}},
                                 {.name = "b", .pulls = {{0, 1.0}, {1, -1.0}}}});
    EXPECT_SMALL((apart.T() * apart.C() - MatrixX::Identity(2, 2)).cwiseAbs().maxCoeff(), 1e-15)
        << size;
    const std::string dependent = refusal([&] {
      Transmission(2, {{.name = "a", .pulls = {{0, size}, {1, size}}},
                       {.name = "b", .pulls = {{0, 1.0}, {1, 1.0}}}});
    });
    EXPECT_NE(dependent.find("combination of 'a'"), std::string::npos) << size << dependent;
  }
}

TEST(Transmission, CoordinatesAreCommandsAndTheirOrthogonalComplement) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    // Two blocks of dofs, of 4 with 1 to 4 actuators and of 2 with 1, and free dofs between.
    std::vector<Actuator> actuators;
    const int blocks[2][4] = {{0, 2, 3, 6}, {5, 8, -1, -1}};
    const int counts[2] = {1 + trial % 4, 1};
    for (int b = 0; b < 2; ++b) {
      for (int k = 0; k < counts[b]; ++k) {
        Actuator& actuator = actuators.emplace_back();
        actuator.name = std::to_string(actuators.size());
        for (const int dof : blocks[b])
          if (dof >= 0) actuator.pulls.push_back({dof, random.uniform(0.1, 2.0) - 2.0 * (dof % 2)});
      }
    }
    const Transmission t(10, actuators);
    EXPECT_SMALL((t.T() * t.C() - MatrixX::Identity(10, 10)).cwiseAbs().maxCoeff(), 1e-11);
    MatrixX B = MatrixX::Zero(10, static_cast<Eigen::Index>(actuators.size())), Z(10, 0);
    for (std::size_t k = 0; k < actuators.size(); ++k) {
      for (const Actuator::Pull& pull : actuators[k].pulls)
        B(pull.dof, static_cast<Eigen::Index>(k)) = pull.coefficient;
      EXPECT_EQ(t.T().col(t.coordinateOf(static_cast<int>(k))),
                B.col(static_cast<Eigen::Index>(k)));
    }
    for (int i = 0; i < 10; ++i) {
      const bool alone = i == 1 || i == 4 || i == 7 || i == 9;
      EXPECT_EQ(t.isPlain(i), alone);
      EXPECT_EQ(t.pulls(i), !alone);
      if (!t.isRootForce(i)) continue;
      Z.conservativeResize(Eigen::NoChange, Z.cols() + 1);
      Z.col(Z.cols() - 1) = t.C().row(i).transpose();
    }
    EXPECT_EQ(Z.cols(), 6 - B.cols());
    if (Z.cols() == 0) continue;
    EXPECT_SMALL((Z.transpose() * B).cwiseAbs().maxCoeff(), 1e-14 * B.norm());
    EXPECT_SMALL((Z.transpose() * Z - MatrixX::Identity(Z.cols(), Z.cols())).norm(), 1e-14);
  }
}

TEST(Transmission, DependentActuatorsAreNamed) {
  EXPECT_EQ(refusal([] { Transmission(5, three(-1.0)); }), "");
  const std::string message = refusal([] { Transmission(5, three(4.0)); });
  EXPECT_NE(message.find("'down'"), std::string::npos) << message;
  EXPECT_NE(message.find("'up'"), std::string::npos) << message;
  EXPECT_EQ(message.find("alone"), std::string::npos) << message;
  // Nearly dependent is refused as well, far from it is not.
  EXPECT_NE(refusal([] { Transmission(5, three(4.0 + 1e-11)); }), "");
  EXPECT_EQ(refusal([] { Transmission(5, three(4.0 + 1e-6)); }), "");
  // More actuators than dofs.
  std::vector<Actuator> many = three(-1.0);
  many.push_back({.name = "extra", .pulls = {{2, 1.0}}});
  const std::string extra = refusal([&] { Transmission(5, many); });
  EXPECT_NE(extra.find("'extra': pulls as a combination of 'up', 'down'"), std::string::npos)
      << extra;
}

TEST(Transmission, WhatCannotPullIsRefused) {
  const auto message = [](Actuator actuator) {
    actuator.name = "motor";
    return refusal([&] { Transmission(3, {actuator}); });
  };
  EXPECT_NE(message({}).find("'motor': pulls nothing"), std::string::npos);
  EXPECT_NE(message({.pulls = {{3, 1.0}}}).find("dof 3, expected one of 0 to 2"),
            std::string::npos);
  EXPECT_NE(message({.pulls = {{0, 0.0}}}).find("other than 0"), std::string::npos);
  EXPECT_NE(message({.pulls = {{0, kNaN}}}).find("other than 0"), std::string::npos);
  EXPECT_NE(message({.pulls = {{1, 1.0}, {1, 2.0}}}).find("twice"), std::string::npos);
  EXPECT_NE(message({.pulls = {{1, 1.0}}, .lower = 1.0, .upper = -1.0}).find("lower ≤ upper"),
            std::string::npos);
}

TEST(ForceMetric, WhatIsNotPositiveDefiniteIsRefused) {
  const auto dense = [](const MatrixX& R) { return refusal([&] { gdd::ForceMetric::dense(R); }); };
  MatrixX R(2, 2);
  R << 2.0, 1.0, 1.0, 3.0;
  EXPECT_EQ(dense(R), "");
  R(0, 1) = 1.1;
  EXPECT_NE(dense(R).find("(1, 0)"), std::string::npos) << dense(R);
  R << 1.0, 2.0, 2.0, 1.0;
  EXPECT_NE(dense(R).find("not positive definite"), std::string::npos);
  R(0, 0) = kInfinity;
  EXPECT_NE(dense(R).find("not finite"), std::string::npos);
  EXPECT_NE(dense(MatrixX::Ones(2, 3)).find("2 × 3"), std::string::npos);
  const auto diagonal = [](const VectorX& r) {
    return refusal([&] { gdd::ForceMetric::diagonal(r); });
  };
  EXPECT_EQ(diagonal(Vector3(1.0, 2.0, 3.0)), "");
  EXPECT_NE(diagonal(Vector3(1.0, 0.0, 3.0)).find("entry 1"), std::string::npos);
  EXPECT_NE(diagonal(Vector3(1.0, 2.0, kNaN)).find("entry 2"), std::string::npos);
}

// A dof that no actuator of the list pulls keeps its own; one that is pulled has theirs alone.
TEST(ControlLimits, UnnamedDofsKeepTheirOwnActuators) {
  const Model model = chain(4).build();
  const gdd::ControlLimits plain(model);
  const gdd::ControlLimits limits(
      model, {{.name = "tendon", .pulls = {{1, 1.0}, {2, 0.5}}, .lower = -3.0, .upper = 4.0}});
  for (const int i : {0, 3}) {
    EXPECT_EQ(limits.lower[i], plain.lower[i]);
    EXPECT_EQ(limits.upper[i], plain.upper[i]);
    EXPECT_FALSE(limits.isRootForce(model, i));
  }
  EXPECT_EQ(limits.lower[1], -3.0);
  EXPECT_EQ(limits.upper[1], 4.0);
  EXPECT_TRUE(limits.isRootForce(model, 2));
  EXPECT_EQ(limits.lower[2], 0.0);
  EXPECT_EQ(limits.upper[2], 0.0);
  // What is clamped is the force nearest in the tendon's coordinates, and reported as force.
  VectorX tau, y, u;
  const VectorX pull = (VectorX(4) << 7.0, 10.0, 5.0, -2.0).finished();
  EXPECT_SMALL(limits.violation(pull) - 6.0, 1e-14);
  limits.clamp(pull, tau, y);
  limits.commands(y, u);
  EXPECT_EQ(u.size(), 1);
  EXPECT_EQ(u[0], 4.0);
  EXPECT_SMALL((tau - (VectorX(4) << 7.0, 4.0, 2.0, -2.0).finished()).norm(), 1e-14);
  // A force that a tendon cannot make.
  EXPECT_SMALL(limits.violation((VectorX(4) << 0.0, -1.0, 2.0, 0.0).finished()) - 2.0, 1e-14);
}

}  // namespace
}  // namespace softgauss::test
