// SPDX-License-Identifier: Apache-2.0
/// J̇ v of contacts (4.10) against differences along the motion, with contacts found anew.

#include "softgauss/engine/constraints/contact_motion.hpp"

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "tests/support/finite_difference.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/random.hpp"
#include "tests/support/sample_models.hpp"
#include "tests/support/sample_surfaces.hpp"

namespace softgauss::test {
namespace {

/// A flat shape and one that lies on its +z face, as deep as this [m].
struct Pair {
  Shape flat, other;
  double depth;
  bool flatFirst;  ///< the flat one is geometry A
};

/// What is deeper does not come free within the differences [m].
constexpr double kDeep = 3e-3;

const Shape kBlock = Shape::box({0.5, 0.4, 0.3});

const Pair kPairs[] = {
    {Shape::plane(), Shape::sphere(0.1), 0.01, true},
    {Shape::plane(), Shape::sphere(0.1), 0.01, false},
    {Shape::plane(), Shape::capsule(0.05, 0.1), 0.01, true},
    {Shape::plane(), Shape::cylinder(0.1, 0.03), 0.01, true},
    {Shape::plane(), Shape::cylinder(0.1, 0.03), 0.01, false},
    {Shape::plane(), Shape::box({0.1, 0.07, 0.05}), 0.01, true},
    {Shape::plane(), Shape::hull(boxSurface({0.1, 0.07, 0.05})), 0.01, true},
    {Shape::plane(), Shape::ellipsoid({0.1, 0.07, 0.05}), 0.01, true},
    {kBlock, Shape::sphere(0.1), 0.01, true},
    {kBlock, Shape::ellipsoid({0.05, 0.1, 0.08}), 0.01, false},
    {kBlock, Shape::capsule(0.05, 0.1), 0.01, false},
    {kBlock, Shape::cylinder(0.1, 0.03), 0.01, true},
};

/// How far a shape reaches along n of its own axes.
double reachOf(const Shape& shape, const Vector3& n) {
  switch (shape.kind) {
    case ShapeKind::box:
      return shape.halfExtents.dot(n.cwiseAbs());
    case ShapeKind::ellipsoid:
      return shape.halfExtents.cwiseProduct(n).norm();
    case ShapeKind::capsule:
      return shape.radius + shape.halfLength * std::abs(n.z());
    case ShapeKind::cylinder:
      return shape.radius * n.head<2>().norm() + shape.halfLength * std::abs(n.z());
    case ShapeKind::mesh: {
      double reach = 0.0;
      for (const Vector3& p : shape.mesh->vertices) reach = std::max(reach, n.dot(p));
      return reach;
    }
    default:
      return shape.radius;
  }
}

/// Two free bodies of these shapes; of the two bodies, `flat` has the flat one.
struct TwoBodies {
  explicit TwoBodies(const Pair& pair)
      : flat(pair.flatFirst ? 1 : 2), model(build(pair)), scene(model), k(model) {
    model.options.timestep = 1e-4;
  }

  static Model build(const Pair& pair) {
    ModelBuilder builder("pair");
    for (const bool flat : {pair.flatFirst, !pair.flatFirst}) {
      const std::string name = flat ? "flat" : "other";
      ModelBuilder one(name);
      one.base = BaseKind::floating;
      one.link(boxLink(name, 1.0, {0.1, 0.1, 0.1}));
      one.geometry(geometrySpec(name, flat ? pair.flat : pair.other, 1.0));
      builder.add(one, "");
    }
    return builder.build();
  }

  /// The flat one anywhere, the other anyhow upon its face; v of up to 3 m/s and rad/s.
  State place(const Pair& pair, Random& random) const {
    const Transform X_WF{random.rotation(), random.vector3(1.0)};
    Matrix3 R_FO = random.rotation();
    // The points of a capsule that lies on a box's face go along it as it levels out.
    const bool stands = pair.flat.kind == ShapeKind::box && pair.other.kind == ShapeKind::capsule;
    while (stands && std::abs(R_FO(2, 2)) < 0.5) R_FO = random.rotation();
    const double height = pair.flat.halfExtents.z() +
                          reachOf(pair.other, R_FO.transpose() * Vector3::UnitZ()) -
                          random.uniform(0.1, 1.0) * pair.depth;
    const Transform X_FO{R_FO, {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), height}};
    State state(model);
    const auto put = [&](int body, const Transform& X) {
      const Quaternion q(X.R);
      state.q.segment<7>(model.bodies[body].q) << X.p, q.w(), q.x(), q.y(), q.z();
    };
    put(flat, X_WF);
    put(3 - flat, X_WF * X_FO);
    state.v = random.vector(model.nv, 3.0);
    return state;
  }

  const std::vector<Contact>& contactsAt(const VectorX& q, const VectorX& v) {
    State there(model);
    there.q = q;
    there.v = v;
    computeKinematics(model, there, k);
    scene.detect(model, k, contacts);
    return contacts.contacts;
  }

  /// How body B moves against A at the contact nearest to p, turning and on its way, in axes that
  /// the flat one carries; then its distance.
  VectorX motionAt(const VectorX& q, const VectorX& v, const Vector3& p) {
    const std::vector<Contact>& found = contactsAt(q, v);
    const Contact c = *std::min_element(found.begin(), found.end(), [&](auto& a, auto& b) {
      return (a.p_WC - p).norm() < (b.p_WC - p).norm();
    });
    const Matrix3 R_FW = k.X_WB[flat].R.transpose();
    VectorX y(7);
    y << R_FW * (k.V[c.bodyB].angular - k.V[c.bodyA].angular),
        R_FW *
            (pointVelocity(model, k, c.bodyB, c.p_WC) - pointVelocity(model, k, c.bodyA, c.p_WC)),
        c.distance;
    return y;
  }

  const int flat;
  Model model;
  collision::SceneContacts scene;
  Kinematics k;
  ContactSet contacts;
};

std::string nameOf(const Pair& pair) {
  const char* kNames[] = {"Plane", "Sphere", "Capsule", "Cylinder", "Box", "Ellipsoid", "Hull"};
  const std::string flat = kNames[static_cast<int>(pair.flat.kind)],
                    other = kNames[static_cast<int>(pair.other.kind)];
  return pair.flatFirst ? other + "On" + flat : flat + "Under" + other;
}

void PrintTo(const Pair& pair, std::ostream* out) { *out << nameOf(pair); }

class ContactMotion : public testing::TestWithParam<Pair> {};

TEST_P(ContactMotion, IsTheRateOfTheVelocityThatIsCompared) {
  const Pair& pair = GetParam();
  TwoBodies bodies(pair);
  const Model& model = bodies.model;
  double worst = 0.0, worstAlong = 0.0, largest = 0.0;
  int compared = 0;
  for (int seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const State s = bodies.place(pair, random);
    for (const Contact& c : std::vector<Contact>(bodies.contactsAt(s.q, s.v))) {
      bodies.contactsAt(s.q, s.v);
      const std::optional<ContactBias> bias = contactBias(model, bodies.k, c);
      if (!bias || c.distance > -kDeep) continue;
      // The place on a rim that lies deeper than that runs far within the differences.
      if (pair.other.kind == ShapeKind::cylinder && bias->biasDepth < -c.distance) continue;
      ++compared;
      const auto motion = [&](const VectorX& q) { return bodies.motionAt(q, s.v, c.p_WC); };
      const Matrix3 R_WF = bodies.k.X_WB[bodies.flat].R;
      const VectorX rate = alongMotion(model, s.q, s.v, motion, 1e-5);
      Vector3 off = bias->rate.linear - R_WF * rate.segment<3>(3);
      // Of meshes along the tangents alone.
      const bool whole = pair.other.kind != ShapeKind::mesh;
      if (!whole) off -= c.n_W * c.n_W.dot(off);
      worst = std::max(
          {worst, (R_WF.transpose() * bias->rate.angular - rate.head<3>()).norm(), off.norm()});
      largest = std::max(largest, bias->rate.linear.norm());
      if (!whole) continue;
      // ẏ_n is how the distance changes, and n · J̇ v how that does.
      const auto approach = [&](const VectorX& q) {
        return alongMotion(model, q, s.v, motion, 1e-4)[6];
      };
      const double bends = alongMotion(model, s.q, s.v, approach, 1e-4);
      worstAlong = std::max(worstAlong, std::abs(bends - c.n_W.dot(bias->rate.linear)));
    }
  }
  // Differences of velocities of 5 m/s over 1e-5 s: rounding 1e-10, (1e-5)² of third derivatives
  // up to 10³ and more where a rim is nearly level. Second differences over 1e-4 s of distances of
  // 1 m: rounding 1e-8, and the same truncation of 1e-8 of fourth derivatives.
  EXPECT_SMALL(worst, 1e-6);
  EXPECT_SMALL(worstAlong, 1e-4);
  EXPECT_GT(largest, 1.0);
  EXPECT_GT(compared, 100);
}

// Two faces that lie on each other and move as one body: which of them has the corner does not
// matter, and what each point of contact has of J̇ v is what carries one around the other.
TEST(ContactMotionOfFaces, IsThatOfOneRigidBody) {
  int compared = 0;
  for (const Shape& flat : {Shape::plane(), kBlock})
    for (const bool flatFirst : {true, false}) {
      const Pair pair{flat, Shape::box({0.1, 0.07, 0.05}), 0.01, flatFirst};
      TwoBodies bodies(pair);
      for (int seed = 0; seed < 20; ++seed) {
        Random random(seed);
        State s = bodies.place(pair, random);
        const int other = 3 - bodies.flat;
        const auto q = [&](int body) { return bodies.model.bodies[body].q; };
        const auto v = [&](int body) { return bodies.model.bodies[body].v; };
        // Face upon face, turned about their normal by a quarter of a turn or not at all.
        const Quaternion upright(s.q[q(bodies.flat) + 3], s.q[q(bodies.flat) + 4],
                                 s.q[q(bodies.flat) + 5], s.q[q(bodies.flat) + 6]);
        const double quarter = seed % 2 * M_PI / 2.0;
        const Quaternion turned =
            upright * Quaternion(Eigen::AngleAxisd(quarter, Vector3::UnitZ()));
        const Matrix3 R = upright.toRotationMatrix();
        const Vector3 from = R * Vector3(0.05, -0.03, flat.halfExtents.z() + 0.05 - 1e-4);
        s.q.segment<3>(q(other)) = s.q.segment<3>(q(bodies.flat)) + from;
        s.q.segment<4>(q(other) + 3) << turned.w(), turned.x(), turned.y(), turned.z();
        // Angular velocities are in the axes of each body.
        const Vector3 omega = random.vector3(3.0);
        s.v.segment<3>(v(bodies.flat) + 3) = R.transpose() * omega;
        s.v.segment<3>(v(other) + 3) = turned.toRotationMatrix().transpose() * omega;
        s.v.segment<3>(v(other)) = s.v.segment<3>(v(bodies.flat)) + omega.cross(from);
        // v̇ = 0: both fly on straight, and the points of the other one come from ω × (ω × from).
        const Vector3 carried = -omega.cross(omega.cross(from));
        for (const Contact& c : std::vector<Contact>(bodies.contactsAt(s.q, s.v))) {
          bodies.contactsAt(s.q, s.v);
          const std::optional<ContactBias> bias = contactBias(bodies.model, bodies.k, c);
          ASSERT_TRUE(bias);
          const double sign = c.bodyB == other ? 1.0 : -1.0;
          EXPECT_SMALL((bias->rate.linear - sign * carried).norm(), 1e-11);
          ++compared;
        }
      }
    }
  EXPECT_GT(compared, 200);
}

INSTANTIATE_TEST_SUITE_P(Pairs, ContactMotion, testing::ValuesIn(kPairs),
                         [](const auto& named) { return nameOf(named.param); });

}  // namespace
}  // namespace softgauss::test
