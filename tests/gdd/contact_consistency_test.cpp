// SPDX-License-Identifier: Apache-2.0
/// The contact forces that a controller assumes, and those that act when its control is applied.

#include <cstdlib>
#include <iomanip>
#include <iostream>
#include <map>

#include "tests/gdd/convex_controller.hpp"
#include "tests/gdd/robot_scene.hpp"
#include "tests/gdd/solvers.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// Sum of the contact forces on each link of the robot, world [N].
using LinkForces = std::map<std::string, Vector3>;

/// Of the rows' present forces.
LinkForces linkForces(const Model& model, const Data& data) {
  LinkForces sum;
  const PyramidalContact& contacts = data.constraints.contact;
  for (int i = 0; i < static_cast<int>(contacts.contactsWithRows().size()); ++i) {
    const Contact& c = data.contacts.contacts[contacts.contactsWithRows()[i].contact];
    const auto add = [&](int geometry, const Vector3& f) {
      const Geometry& g = model.geometries[geometry];
      const std::string link = g.name.substr(0, g.name.find('/'));
      if (g.body != 0) sum.try_emplace(link, Vector3::Zero()).first->second += f;
    };
    add(c.geometryB, contacts.force(i));
    add(c.geometryA, -contacts.force(i));
  }
  return sum;
}

/// Of the rows of contacts, forces `f` of all rows.
LinkForces linkForces(const Model& model, Data& data, const VectorX& f) {
  std::vector<double>& edges = data.constraints.contact.f;
  const std::vector<double> before = edges;
  for (std::size_t i = 0; i < edges.size(); ++i)
    edges[i] = f[f.size() - static_cast<Eigen::Index>(edges.size() - i)];
  LinkForces sum = linkForces(model, data);
  edges = before;
  return sum;
}

struct Outcome {
  LinkForces assumed, acting;

  /// The largest difference on a link [N].
  double mismatch() const {
    double worst = 0.0;
    for (const auto& [link, f] : acting) worst = std::max(worst, (f - assumed.at(link)).norm());
    return worst;
  }
};

/// A robot at an instant: the same goals, the same control cost, for every controller.
class Instant {
 public:
  explicit Instant(RobotScene& r) : r_(r), cost_(r.model.nv) {
    // Rows as the controller sees them.
    r.controller.markControlled(r.model, r.input.controlled);
    EXPECT_NE(computeStages(r.model, r.input, r.state, r.data, &r.contacts),
              SolveStatus::notFinite);
    for (const auto& goal : r.controller.goals) goal->addCost({r.model, r.state, r.data}, cost_);
  }

  template <class Solver>
  Outcome goalDirected() {
    Outcome out;
    Solver solver(r_.model);
    const gdd::GddReport report =
        solver.solve(r_.model, cost_, r_.controller.limits, r_.data, r_.state.warmstart);
    EXPECT_TRUE(report.status == gdd::GddStatus::converged ||
                report.status == gdd::GddStatus::nonsmoothMinimum);
    VectorX g;
    inverseDynamics(r_.model, solver.acceleration(), r_.data, g);
    out.assumed = linkForces(r_.model, r_.data);
    apply(r_.controller.limits.clamp(solver.force()), out);
    return out;
  }

  ConvexControl convexOnly(bool stance) const {
    return convexControl(r_.data, cost_, r_.controller.limits, stance);
  }

  Outcome convex(bool stance) {
    const ConvexControl control = convexOnly(stance);
    Outcome out;
    out.assumed = linkForces(r_.model, r_.data, control.f);
    apply(control.u, out);
    return out;
  }

 private:
  void apply(const VectorX& u, Outcome& out) {
    setAppliedForce(u, r_.data.forces);
    EXPECT_EQ(forwardDynamics(r_.model, nullptr, r_.data), SolveStatus::converged);
    out.acting = linkForces(r_.model, r_.data);
  }

  RobotScene& r_;
  gdd::GoalCost cost_;
};

void tell(const std::string& instant, const std::string& controller, const Outcome& out) {
  if (!std::getenv("SOFTGAUSS_TABLES")) return;
  std::cout << instant << ", " << controller << ": largest difference " << out.mismatch() << " N\n";
  for (const auto& [link, f] : out.acting)
    std::cout << std::fixed << std::setprecision(1) << "  " << std::setw(12) << link << "  assumed"
              << std::setw(7) << out.assumed.at(link).transpose() << "   acting" << std::setw(7)
              << f.transpose() << '\n'
              << std::defaultfloat;
}

struct Comparison {
  Outcome goalDirected, convex, stance;
};

template <class Solver>
Comparison compare(const std::string& instant, RobotScene& r) {
  Instant now(r);
  Comparison c{now.goalDirected<Solver>(), now.convex(false), now.convex(true)};
  tell(instant, "goal directed dynamics", c.goalDirected);
  tell(instant, "convex program", c.convex);
  tell(instant, "convex program that holds its contacts", c.stance);
  return c;
}

/// Stands with a hand that seeks `target`.
std::unique_ptr<RobotScene> standing(const std::vector<GeometrySpec>& fixtures,
                                     const Vector3& target, double weight) {
  auto r = std::make_unique<RobotScene>("humanoid", fixtures);
  r->addPosture();
  gdd::Reach& reach = r->addReach("right_hand", target);
  reach.weight = weight;
  reach.stiffness = 50.0;
  reach.damping = 15.0;
  return r;
}

/// A wall at x that faces the robot.
GeometrySpec wall(double x) {
  GeometrySpec g;
  g.name = "wall";
  g.link = "world";
  g.shape = Shape::plane();
  g.X_LG.p = Vector3(x, 0.0, 0.0);
  g.X_LG.R = Quaternion::FromTwoVectors(Vector3::UnitZ(), -Vector3::UnitX()).toRotationMatrix();
  return g;
}

void stepFor(RobotScene& r, double seconds) {
  for (int i = 0; i < seconds / r.model.options.timestep; ++i) {
    ASSERT_NE(r.step(), SolveStatus::notFinite);
  }
}

template <class Solver>
class ContactConsistency : public testing::Test {};

TYPED_TEST_SUITE(ContactConsistency, GddSolvers);

TYPED_TEST(ContactConsistency, StandingOnTwoFeet) {
  const auto r = standing({}, Vector3(0.45, -0.25, 1.10), 1e5);
  stepFor(*r, 1.0);
  const Comparison still = compare<TypeParam>("stands", *r);
  EXPECT_SMALL(still.goalDirected.mismatch() / kWeight, 1e-8);

  // The right foot is to leave the ground. To the convex program the ground lifts it; what helps is
  // to stand on the other.
  const Vector3 foot = r->position("right_foot");
  gdd::Reach& lift = r->addReach("right_foot", foot + Vector3(0.0, 0.0, 0.1));
  lift.weight = 1e5;
  lift.stiffness = 50.0;
  lift.damping = 15.0;
  const Comparison lifting = compare<TypeParam>("lifts a foot", *r);
  EXPECT_SMALL(lifting.goalDirected.mismatch() / kWeight, 1e-8);
  EXPECT_GT(lifting.convex.mismatch(), 0.1 * kWeight);
  EXPECT_LT(lifting.goalDirected.acting.at("right_foot").z(), 0.25 * kWeight);
}

TYPED_TEST(ContactConsistency, PushingAWall) {
  const auto r = standing({wall(0.30)}, Vector3(0.30, -0.25, 1.10), 3000.0);
  stepFor(*r, 0.6);
  const Comparison pushing = compare<TypeParam>("pushes", *r);
  EXPECT_SMALL(pushing.goalDirected.mismatch() / kWeight, 1e-8);
  EXPECT_LT(pushing.goalDirected.acting.at("right_hand").x(), -1.0) << "it is to push";

  // Now it is to push hard: the place it seeks is 0.3 m behind the wall. To the convex program the
  // hand goes there through the wall, which answers with nothing.
  r->controller.goals.pop_back();
  gdd::Reach& deep = r->addReach("right_hand", Vector3(0.60, -0.25, 1.10));
  deep.weight = 1e5;
  deep.stiffness = 50.0;
  deep.damping = 15.0;
  const Comparison hard = compare<TypeParam>("pushes hard", *r);
  EXPECT_SMALL(hard.goalDirected.mismatch() / kWeight, 1e-8);
  EXPECT_GT(hard.convex.assumed.at("right_hand").x(), -1.0);
  EXPECT_LT(hard.convex.acting.at("right_hand").x(), -20.0);
  // It pushes with what is over from moving the arm. Who knows the wall pushes with the body.
  EXPECT_LT(hard.goalDirected.acting.at("right_hand").x(), -100.0);
}

// The reference is what it says: forces in their cones, controls in their box, Newton's law.
TEST(ConvexController, ObeysItsConstraints) {
  const auto r = standing({}, Vector3(0.45, -0.25, 1.10), 1e5);
  stepFor(*r, 0.1);
  Instant now(*r);
  for (const bool stance : {false, true}) {
    const ConvexControl c = now.convexOnly(stance);
    const VectorX balance = r->data.inertia.hat().dense() * c.a + r->data.forces.c - c.u -
                            r->data.constraints.denseJacobian().transpose() * c.f;
    EXPECT_SMALL(balance.cwiseAbs().maxCoeff() / kWeight, 1e-9);
    EXPECT_SMALL(std::min(0.0, c.f.minCoeff()) / kWeight, 1e-9);
    EXPECT_SMALL(r->controller.limits.violation(c.u), 1e-9);
  }
}

}  // namespace
}  // namespace softgauss::test
