// SPDX-License-Identifier: Apache-2.0
/// Contact and friction with physical answers: rest, load, creep, sliding, rolling.

#include <array>

#include "softgauss/engine/constraints/impedance.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"
#include "tests/validation/shared.hpp"

namespace softgauss::test {
namespace {

/// Impedance that does not depend on depth, so that rest states have closed forms.
void flatten(Model& model, double d = 0.9) {
  for (Geometry& g : model.geometries) g.material.impedance.dMin = g.material.impedance.dMax = d;
}

/// e of n edges (3.17).
double shareOfEdge(double mu, int n, double ratio = 1.0) {
  return std::max(1.0 / n, ratio / (2 * std::pow(std::max(mu, 0.3), 2)));
}

/// D_e of the four edges of a contact of the inverse mass A, of what flatten() gives: of the spring
/// K = k d/R and the damper b/R at the step's end, D = h (½ h K + b/R) (3.14).
double edgeOfGiven(double mu, double A, double h) {
  const double d = 0.9, tc = 0.02, R = (1 - d) / d * A;
  const double K = d / std::pow(d * tc, 2) / R, B = 2 / (d * tc) / R;
  return shareOfEdge(mu, 4) * h * (0.5 * h * K + B);
}

Scene onPlane(const ModelBuilder& builder, bool flat = true) {
  Model model = builder.build();
  if (flat) flatten(model);
  return Scene(std::move(model), std::make_shared<SampleContacts>());
}

/// A slope of angle θ about y: downhill is +x of the slope, which is a tangent of its pyramids.
Matrix3 slope(double theta) {
  return Eigen::AngleAxisd(theta, Vector3::UnitY()).toRotationMatrix();
}

// ---- Rest
// ----------------------------------------------------------------------------------------

// One contact with 4 edges carries f = 4 e D k d r (3.17), so
//   r = g (1 − d)/(K d²) · 1/(4 e),   K = 1/(d tc)²,
// the elliptic depth times the pyramid's factor; frictionless the elliptic depth itself. MuJoCo's
// edges make that factor μ²(1 + μ²)/(2 impratio).
TEST(RestDepth, IsThePredictedOne) {
  const double d = 0.9, K = 1 / std::pow(d * 0.02, 2);
  const double elliptic = kGravity * (1 - d) / (K * d * d);
  EXPECT_SMALL(elliptic - 392.4e-6, 1e-9);  // recorded from the reference engine
  for (const double mu : {0.0, 0.1, 0.5, 1.0, 2.0})
    for (const auto& [ratio, ours] :
         {std::pair{1.0, true}, {10.0, true}, {1.0, false}, {10.0, false}}) {
      ModelBuilder builder = sphereOnPlane(0.1, 3.0, mu);
      builder.options.impedanceRatio = ratio;
      builder.options.constraintModel = ours ? ConstraintModel::softgauss : ConstraintModel::mujoco;
      Scene s = onPlane(builder);
      s.steps(3000);
      const double mujoco = mu * mu * (1 + mu * mu) / (2 * ratio);
      const double factor = mu == 0.0 ? 1.0
                            : ours    ? 1.0 / (4.0 * shareOfEdge(mu, 4, ratio))
                                      : mujoco;
      EXPECT_SMALL((0.1 - s.state.q[2]) / (elliptic * factor) - 1.0, 1e-8)
          << "mu " << mu << ", impratio " << ratio << (ours ? "" : ", MuJoCo's");
      EXPECT_SMALL(s.state.v.cwiseAbs().maxCoeff(), 1e-12);
    }
}

// n equal contacts share the load: each carries m g/n, and the depth falls as 1/n.
TEST(StaticLoad, IsSharedByNContacts) {
  double single = 0.0;
  for (const int n : {1, 2, 3, 4, 7}) {
    ModelBuilder builder("block");
    builder.link(emptyLink("world")).link(boxLink("block", 2.0, {0.3, 0.3, 0.1}));
    // A vertical guide: no question of how a block of n legs tilts.
    builder.joint(jointSpec("guide", JointType::prismatic, "world", "block",
                            {Matrix3::Identity(), Vector3(0, 0, 0.1)}));
    builder.geometry(groundSpec(0.8));
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * M_PI * i / n;
      builder.geometry(geometrySpec(
          "block", Shape::sphere(0.05), 0.8,
          {Matrix3::Identity(), Vector3(0.2 * std::cos(angle), 0.2 * std::sin(angle), -0.05)}));
    }
    Scene s = onPlane(builder);
    s.steps(3000);
    const PyramidalContact& contact = s.data->constraints.contact;
    ASSERT_EQ(contact.contactsWithRows().size(), static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i)
      EXPECT_APPROX(contact.force(i), Vector3(0, 0, 2.0 * kGravity / n), 1e-9);
    const double depth = -s.state.q[0];
    if (n == 1) single = depth;
    EXPECT_SMALL(depth * n / single - 1.0, 1e-8) << n;
  }
}

TEST(RestingBox, RestsOnFourContactsAndDoesNotCreepOrSpin) {
  Scene s = onPlane(boxOnPlane({0.1, 0.15, 0.05}, 2.0, 0.8), false);
  s.state.q[2] = 0.0498;
  s.steps(1500);  // 0.2 mm deep, it comes up with the time constant n e τ = 0.125 s (3.17)
  const State settled = s.state;
  s.steps(3500);  // until 10 s
  EXPECT_EQ(s.data->stats.contacts, 4);
  EXPECT_EQ(s.data->stats.rows, 16);
  const VectorX moved = positionDifference(s.model, settled.q, s.state.q);
  // Nothing drives it: rounding only, over 7 s.
  EXPECT_SMALL(moved.cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_SMALL(s.state.v.cwiseAbs().maxCoeff(), 1e-10);
  for (int i = 0; i < 4; ++i)
    EXPECT_APPROX(s.data->constraints.contact.force(i), Vector3(0, 0, 0.5 * kGravity), 1e-8);
  EXPECT_SMALL(s.data->stats.maxPenetration, 1e-3);
  // At rest the warm start is the answer.
  s.step();
  EXPECT_LE(s.data->stats.iterations, 1);
}

// Put down with a jolt, it comes to rest all the same.
TEST(RestingBox, StopsAfterAPush) {
  Scene s = onPlane(boxOnPlane({0.1, 0.15, 0.05}, 2.0, 0.8), false);
  s.state.v << 0.3, -0.2, -0.1, 0.1, 0.2, 0.5;
  s.steps(2000);
  EXPECT_SMALL(s.state.v.cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(s.data->stats.contacts, 4);
}

// ---- Incline
// -------------------------------------------------------------------------------------

/// Speed down the slope.
double downhillSpeed(const Scene& s, double theta) {
  return slope(theta).col(0).dot(s.state.v.head<3>());
}

// Friction of soft contacts is a damper: with every edge pressed, f_t = 2 μ² D_e v/h per contact,
// as two edges make it. n contacts of one block share the same v, so m g sin θ = n 2 μ² D_e v/h.
TEST(Incline, BelowFrictionCreepsAtThePredictedSpeed) {
  for (const double theta : {0.05, 0.1, 0.2}) {
    const double mu = 0.8, mass = 2.0;
    ASSERT_LT(std::tan(theta), 0.5 * mu);  // both edges stay pressed
    Scene s = onPlane(boxOnPlane({0.1, 0.1, 0.02}, mass, mu, slope(theta)));
    s.steps(2500);
    ASSERT_EQ(s.data->stats.contacts, 4);
    const double h = s.model.options.timestep;
    const double predicted =
        mass * kGravity * std::sin(theta) / 4 * h / (2 * mu * mu * edgeOfGiven(mu, 1 / mass, h));
    EXPECT_SMALL(downhillSpeed(s, theta) / predicted - 1.0, 1e-10) << "theta " << theta;
    // It neither turns nor drifts sideways nor lifts.
    EXPECT_SMALL(s.state.v.tail(3).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_SMALL(s.state.v[1], 1e-12);
    EXPECT_SMALL(slope(theta).col(2).dot(s.state.v.head<3>()), 1e-9);
    // And that speed is small.
    EXPECT_LT(predicted, 5e-3);
  }
}

/// Force of a pyramid that creeps by `slip` [m/s] under the push p [m/s²] (5.9), per D_e: along the
/// normal and down the slope. What its edges ask for is levelled by min(1, 30 V) of λ.
std::array<double, 2> levelled(double slip, double p, double mu, double h, double gain) {
  const double s = mu * slip / h;
  const double lambda = std::max(0.0, (s - p) / 3);  // Σ max(0, p ± s − λ, p − λ) = 4 p
  const double V = slip / (mu * h * gain * p), share = std::min(1.0, 30 * V);
  const double lead = p + s - share * lambda, side = p - share * lambda;
  const double trail = std::max(0.0, p - s - share * lambda);
  return {lead + 2 * side + trail, mu * (lead - trail)};
}

// Nearer to μ the uphill edges let go, and what the others ask for is levelled. The slip at which
// that bears the load, found by bisection, is the creep. One contact, so that the load needs no
// sharing: a mass on two slides, down and into the slope.
TEST(Incline, NearFrictionCreepsAtThePredictedSpeed) {
  const double mu = 0.8, mass = 2.0;
  for (const double ratio : {0.4, 0.6, 0.8, 0.95}) {
    const double theta = std::atan(ratio * mu);
    ModelBuilder builder("slider");
    builder.link(emptyLink("world")).link(emptyLink("rail")).link(sphereLink("body", mass, 0.1));
    builder.joint(jointSpec("along", JointType::prismatic, "world", "rail",
                            {slope(theta), 0.1 * slope(theta).col(2)}, Vector3::UnitX()));
    builder.joint(jointSpec("into", JointType::prismatic, "rail", "body"));
    builder.geometry(groundSpec(mu, slope(theta)));
    builder.geometry(geometrySpec("body", Shape::sphere(0.1), mu));
    Scene s = onPlane(builder);
    s.steps(6000);
    const double A = s.data->weights.translation.back();
    const double h = s.model.options.timestep, D = edgeOfGiven(mu, A, h);
    const double fn = mass * kGravity * std::cos(theta), ft = mass * kGravity * std::sin(theta);
    double slow = 0.0, fast = 1.0;
    for (int i = 0; i < 200; ++i) {
      const double slip = 0.5 * (slow + fast);
      const auto [along, down] = levelled(slip, fn / (4 * D), mu, h, 4 * D * A);
      (down / along < ft / fn ? slow : fast) = slip;
    }
    EXPECT_SMALL(s.state.v[0] / slow - 1.0, 1e-8) << "tan theta / mu = " << ratio;
    EXPECT_SMALL(s.data->constraints.contact.force(0).dot(slope(theta).col(2)) / fn - 1.0, 1e-8);
  }
}

// Sliding, only the edge that resists is pressed and f_t = μ f_n exactly, so what the slope gives
// and friction takes obeys  Δv_t = (g sin θ) T − μ (g cos θ T + Δv_n)  to rounding, hops included.
TEST(Incline, AboveFrictionAcceleratesAtGSinMinusMuGCos) {
  for (const double mu : {0.2, 0.5}) {
    const double theta = std::atan(mu) + 0.2;
    ModelBuilder builder = boxOnPlane({0.1, 0.1, 0.02}, 2.0, mu, slope(theta));
    builder.options.timestep = 0.0005;  // hops are as high as the step is long
    Scene s = onPlane(builder, false);
    s.state.v.head<3>() = 0.5 * slope(theta).col(0);
    s.steps(500);  // well into sliding
    const Vector3 t = slope(theta).col(0), n = slope(theta).col(2);
    const Vector3 v0 = s.state.v.head<3>();
    const int steps = 2000;
    s.steps(steps);
    const Vector3 dv = s.state.v.head<3>() - v0;
    const double T = steps * s.model.options.timestep;
    const double downhill = kGravity * std::sin(theta) * T;
    const double pressed = kGravity * std::cos(theta) * T + n.dot(dv);
    EXPECT_SMALL((t.dot(dv) - (downhill - mu * pressed)) / downhill, 1e-9) << "mu " << mu;
    // Over 1 s the hops average out.
    const double predicted = kGravity * (std::sin(theta) - mu * std::cos(theta));
    EXPECT_SMALL(t.dot(dv) / T / predicted - 1.0, 0.02) << "mu " << mu;
  }
}

// The verdict flips at tan θ = μ, its creep aside.
TEST(Incline, SticksIffTheSlopeIsBelowFriction) {
  const double mu = 0.5;
  for (const double excess : {-0.05, 0.05}) {
    const double theta = std::atan(mu * (1 + excess));
    Scene s = onPlane(boxOnPlane({0.1, 0.1, 0.01}, 2.0, mu, slope(theta)));
    s.steps(1000);
    const double first = downhillSpeed(s, theta);
    s.steps(1000);
    const double growth = downhillSpeed(s, theta) - first;
    if (excess < 0)
      EXPECT_SMALL(growth, 1e-4);
    else
      EXPECT_GT(growth, 0.2);
  }
}

// ---- Rolling
// -------------------------------------------------------------------------------------

// Once its slip is the steady creep, a sphere rolls down at g sin θ/(1 + I/(m l²)), l the distance
// of the contact point from the centre: 5/7 g sin θ but for the half of the penetration in l.
TEST(RollingSphere, AcceleratesAtFiveSeventhsGSin) {
  const double theta = 0.2, radius = 0.1;
  Scene s = onPlane(sphereOnPlane(radius, 3.0, 1.0, slope(theta)));
  s.steps(500);
  const double v0 = downhillSpeed(s, theta);
  const int steps = 500;
  s.steps(steps);
  const double T = steps * s.model.options.timestep;
  const double acceleration = (downhillSpeed(s, theta) - v0) / T;
  EXPECT_SMALL(acceleration / (5.0 / 7.0 * kGravity * std::sin(theta)) - 1.0, 2e-3);
  const double l = radius + 0.5 * s.data->contacts.contacts[0].distance;
  const double exact = kGravity * std::sin(theta) / (1 + 0.4 * radius * radius / (l * l));
  EXPECT_SMALL(acceleration / exact - 1.0, 1e-10);
  // Friction is 2/7 of the downhill force, and the slip is what it takes: f_t h/(2 μ² D_e).
  const double spin = s.state.v[4] * l, slip = downhillSpeed(s, theta) - spin;
  const double mass = 3.0, ft = mass * (kGravity * std::sin(theta) - exact);
  const double h = s.model.options.timestep;
  EXPECT_SMALL(slip / (ft * h / (2 * edgeOfGiven(1.0, 1 / mass, h))) - 1.0, 1e-9);
}

}  // namespace
}  // namespace softgauss::test
