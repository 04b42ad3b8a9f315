// SPDX-License-Identifier: Apache-2.0
/// Every description that cannot be simulated is refused, with a message that names file, line,
/// element and what was expected.

#include <functional>

#include "softgauss/engine/constraints/inverse_weight.hpp"
#include "softgauss/engine/model/model_builder.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

/// base —hinge→ arm —slide→ hand, each element with its line, before a mistake is made.
struct Description {
  LinkSpec base = boxLink("base", 1.0, {0.1, 0.1, 0.1});
  LinkSpec arm = boxLink("arm", 1.0, {0.1, 0.1, 0.1});
  LinkSpec hand = boxLink("hand", 1.0, {0.1, 0.1, 0.1});
  JointSpec hinge = jointSpec("hinge", JointType::revolute, "base", "arm");
  JointSpec slide = jointSpec("slide", JointType::prismatic, "arm", "hand");
  GeometrySpec ball = geometrySpec("hand", Shape::sphere(0.1));
  Options options;
  std::vector<LinkSpec> moreLinks;
  std::vector<JointSpec> moreJoints;
  PairSpec pair;
  ConnectSpec connect;  ///< of links, where they have names
  WeldSpec weld;
  CouplingSpec coupling;

  Description() {
    base.where = {"robot.urdf", 2};
    arm.where = {"robot.urdf", 3};
    hand.where = {"robot.urdf", 4};
    hinge.where = {"robot.urdf", 5};
    slide.where = {"robot.urdf", 6};
    ball.where = {"robot.urdf", 7};
    pair.where = connect.where = weld.where = coupling.where = {"scene", 8};
  }
  Model build() const {
    ModelBuilder builder("robot");
    builder.options = options;
    builder.link(base).link(arm).link(hand);
    builder.joint(hinge).joint(slide).geometry(ball);
    for (const LinkSpec& link : moreLinks) builder.link(link);
    for (const JointSpec& joint : moreJoints) builder.joint(joint);
    if (!pair.geometryA.empty()) builder.pair(pair);
    if (!connect.linkA.empty()) builder.connect(connect);
    if (!weld.linkA.empty()) builder.weld(weld);
    if (!coupling.follower.empty()) builder.couple(coupling);
    return builder.build();
  }
};

struct Mistake {
  const char* name;
  std::function<void(Description&)> make;
  std::vector<const char*> words;  ///< the message contains each
};
void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

JointSpec another(const std::string& name, const std::string& parent, const std::string& child) {
  JointSpec joint = jointSpec(name, JointType::revolute, parent, child);
  joint.where = {"robot.urdf", 9};
  return joint;
}

const Mistake kMistakes[] = {
    {"DuplicateLink",
     [](Description& d) {
       d.moreLinks = {d.arm};
       d.moreLinks[0].where.line = 9;
     },
     {"robot.urdf:9", "link 'arm'", "twice", "line 3"}},
    {"DuplicateJoint",
     [](Description& d) {
       d.moreLinks = {boxLink("other", 1.0, {0.1, 0.1, 0.1})};
       d.moreJoints = {another("hinge", "base", "other")};
     },
     {"robot.urdf:9", "joint 'hinge'", "twice"}},
    {"TwoParents",
     [](Description& d) { d.moreJoints = {another("second", "base", "hand")}; },
     {"robot.urdf:9", "joint 'second'", "link 'hand' has two parents", "'slide'", "line 6"}},
    {"Cycle", [](Description& d) { d.hinge.parent = "hand"; }, {"robot.urdf:", "cycle"}},
    {"SelfLoop",
     [](Description& d) { d.hinge.parent = "arm"; },
     {"robot.urdf:5", "joint 'hinge'", "cycle"}},
    {"UnknownParent",
     [](Description& d) { d.hinge.parent = "ghost"; },
     {"robot.urdf:5", "joint 'hinge'", "parent link 'ghost' does not exist"}},
    {"UnknownChild",
     [](Description& d) { d.slide.child = "ghost"; },
     {"robot.urdf:6", "joint 'slide'", "child link 'ghost' does not exist"}},
    {"NamelessLink", [](Description& d) { d.arm.name = ""; }, {"robot.urdf:3", "no name"}},
    {"NamelessJoint", [](Description& d) { d.hinge.name = ""; }, {"robot.urdf:5", "no name"}},
    {"NegativeMass",
     [](Description& d) { d.arm.mass = -1.0; },
     {"robot.urdf:3", "link 'arm'", "mass is -1", "0 or more"}},
    {"NanMass", [](Description& d) { d.arm.mass = kNaN; }, {"robot.urdf:3", "mass is nan"}},
    {"InfiniteMass", [](Description& d) { d.arm.mass = kInfinity; }, {"robot.urdf:3", "mass"}},
    {"NanCenterOfMass",
     [](Description& d) { d.arm.com.y() = kNaN; },
     {"robot.urdf:3", "centre of mass"}},
    {"NanInertia",
     [](Description& d) { d.arm.I_Lcm(0, 1) = kNaN; },
     {"robot.urdf:3", "inertia is not finite"}},
    {"UnsymmetricInertia",
     [](Description& d) { d.arm.I_Lcm(0, 1) += 0.001; },
     {"robot.urdf:3", "not symmetric"}},
    {"NegativeMoment",
     [](Description& d) { d.arm.I_Lcm(1, 1) = -0.01; },
     {"robot.urdf:3", "negative principal moment", "-0.01"}},
    {"IndefiniteInertia",  // a positive diagonal is not enough
     [](Description& d) { d.arm.I_Lcm << 1, 2, 0, 2, 1, 0, 0, 0, 1; },
     {"robot.urdf:3", "negative principal moment"}},
    {"SingularInertiaOfAMovingBody",
     [](Description& d) { d.hand.I_Lcm = Vector3(0.1, 0.1, 0.0).asDiagonal(); },
     {"robot.urdf:4", "link 'hand'", "all positive"}},
    {"PointMassThatMoves",
     [](Description& d) { d.hand.I_Lcm.setZero(); },
     {"robot.urdf:4", "link 'hand'", "all positive"}},
    {"MasslessLeaf",
     [](Description& d) {
       d.hand.mass = 0.0;
       d.hand.I_Lcm.setZero();
     },
     {"robot.urdf:4", "link 'hand'", "joint 'slide'", "singular"}},
    {"LowerAboveUpper",
     [](Description& d) { d.hinge.lower = 1.0, d.hinge.upper = -1.0; },
     {"robot.urdf:5", "joint 'hinge'", "lower 1 > upper -1"}},
    {"OneEndOfARange", [](Description& d) { d.hinge.lower = 1.0; }, {"robot.urdf:5", "one end"}},
    {"NanRange",
     [](Description& d) { d.hinge.lower = -1.0, d.hinge.upper = kNaN; },
     {"robot.urdf:5", "not a number"}},
    {"ZeroAxis",
     [](Description& d) { d.hinge.axis.setZero(); },
     {"robot.urdf:5", "axis has length 0"}},
    {"NanAxis", [](Description& d) { d.hinge.axis.x() = kNaN; }, {"robot.urdf:5", "axis"}},
    {"NanOrigin", [](Description& d) { d.hinge.X_PC.p.x() = kNaN; }, {"robot.urdf:5", "origin"}},
    {"NegativeDamping", [](Description& d) { d.hinge.damping = -1; }, {"robot.urdf:5", "damping"}},
    {"NegativeFriction",
     [](Description& d) { d.hinge.dryFriction = -1; },
     {"robot.urdf:5", "friction"}},
    {"NegativeArmature",
     [](Description& d) { d.hinge.armature = -1; },
     {"robot.urdf:5", "armature"}},
    {"NegativeEffort", [](Description& d) { d.hinge.effort = -1; }, {"robot.urdf:5", "effort"}},
    {"NegativeVelocity",
     [](Description& d) { d.hinge.velocity = -1; },
     {"robot.urdf:5", "velocity"}},
    {"FloatingJointOnAMovingLink",
     [](Description& d) { d.slide.type = JointType::floating; },
     {"robot.urdf:6", "joint 'slide'", "floating", "'arm'"}},
    {"MimicOfNothing",
     [](Description& d) {
       d.slide.mimic = MimicSpec{"ghost", 1.0, 0.0};
     },
     {"robot.urdf:6", "joint 'slide'", "'ghost'"}},
    {"NanMimic",
     [](Description& d) {
       d.slide.mimic = MimicSpec{"hinge", kNaN, 0.0};
     },
     {"robot.urdf:6", "mimic"}},
    {"MimicOfItselfByADetour",
     [](Description& d) {
       d.hinge.mimic = MimicSpec{"slide", 1.0, 0.0};
       d.slide.mimic = MimicSpec{"hinge", 1.0, 0.0};
     },
     {"robot.urdf:6", "joint 'slide'", "mimics itself"}},
    {"FollowerOfTwo",
     [](Description& d) {
       d.slide.mimic = MimicSpec{"hinge", 1.0, 0.0};
       d.coupling.follower = "slide";
     },
     {"scene:8", "coupling of joint 'slide'", "two joints"}},
    {"CouplingOfNothing",
     [](Description& d) { d.coupling.follower = "ghost"; },
     {"scene:8", "coupling", "'ghost'", "not a moving joint"}},
    {"CouplingToAFloatingBase",
     [](Description& d) { d.coupling.follower = "slide", d.coupling.leader = "base"; },
     {"scene:8", "'base'", "more than one degree of freedom"}},
    {"NanPolynomial",
     [](Description& d) { d.coupling.follower = "slide", d.coupling.polynomial[3] = kNaN; },
     {"scene:8", "coupling", "coefficient"}},
    {"PairOfNothing",
     [](Description& d) { d.pair.geometryA = d.ball.name, d.pair.geometryB = "ghost"; },
     {"scene:8", "pair", "geometry 'ghost' does not exist"}},
    {"PairOfOne",
     [](Description& d) { d.pair.geometryA = d.pair.geometryB = d.ball.name; },
     {"scene:8", "pair", "one geometry, expected two"}},
    {"ConnectionToNothing",
     [](Description& d) { d.connect.linkA = "hand", d.connect.linkB = "ghost"; },
     {"scene:8", "connection 'hand' - 'ghost'", "link 'ghost'", "does not exist"}},
    {"ConnectionOfOneBody",
     [](Description& d) {
       d.moreLinks = {emptyLink("plate")};
       d.moreJoints = {jointSpec("glue", JointType::fixed, "hand", "plate")};
       d.connect.linkA = "hand", d.connect.linkB = "plate";
     },
     {"scene:8", "connection", "cannot move against each other"}},
    {"NanConnection",
     [](Description& d) {
       d.connect.linkA = "hand", d.connect.linkB = "world", d.connect.p_LBP.x() = kNaN;
     },
     {"scene:8", "connection", "not finite"}},
    {"ImpossibleImpedance",
     [](Description& d) {
       d.connect.linkA = "hand", d.connect.linkB = "world", d.connect.impedance.timeConstant = 0.0;
     },
     {"scene:8", "connection", "time constant is 0"}},
    {"NegativeReferenceStiffness",
     [](Description& d) {
       d.ball.material.impedance.direct = {-1.0, 1.0};
     },
     {"robot.urdf:7", "reference stiffness is -1", "0 or more"}},
    {"NegativeContactStiffness",
     [](Description& d) {
       d.ball.material.spring = {-1.0, 0.0, 0.0, 0.0};
     },
     {"robot.urdf:7", "contact stiffness is -1"}},
    {"ContactStiffnessAndRestDepth",
     [](Description& d) {
       d.ball.material.spring = {1.0, 1.0, 0.0, 0.0};
     },
     {"robot.urdf:7", "one of them above 0"}},
    {"NoContactStiffness",
     [](Description& d) {
       d.ball.material.spring = {0.0, 0.0, 1.0, 0.0};
     },
     {"robot.urdf:7", "one of them above 0"}},
    {"TwoContactDampings",
     [](Description& d) {
       d.ball.material.spring = {1.0, 0.0, 1.0, 1.0};
     },
     {"robot.urdf:7", "contact damping and a damping ratio"}},
    {"RestDepthWithoutWeight",
     [](Description& d) {
       d.ball.material.spring = {0.0, 1e-3, 0.0, 1.0}, d.options.gravity.setZero();
     },
     {"robot.urdf:7", "gravity is zero"}},
    {"NanReferenceDamping",
     [](Description& d) {
       d.ball.material.impedance.direct = {1.0, kNaN};
     },
     {"robot.urdf:7", "reference damping is"}},
    {"WeldOfTheWorldToItself",
     [](Description& d) { d.weld.linkA = "world", d.weld.linkB = "world"; },
     {"scene:8", "weld", "cannot move against each other"}},
    {"ZeroTorqueScale",
     [](Description& d) { d.weld.linkA = "hand", d.weld.linkB = "base", d.weld.torqueScale = 0.0; },
     {"scene:8", "weld 'hand' - 'base'", "torque scale"}},
    {"NegativeFrictionImpedance",
     [](Description& d) { d.hinge.frictionImpedance.dMin = -0.1; },
     {"robot.urdf:5", "joint 'hinge'", "-0.1"}},
    {"GeometryOnNothing",
     [](Description& d) { d.ball.link = "ghost"; },
     {"robot.urdf:7", "link 'ghost'", "does not exist"}},
    {"ZeroRadius",
     [](Description& d) { d.ball.shape.radius = 0.0; },
     {"robot.urdf:7", "radius is 0"}},
    {"NegativeBox",
     [](Description& d) {
       d.ball.shape = Shape::box({0.1, -0.1, 0.1});
     },
     {"robot.urdf:7", "half extent is -0.1"}},
    {"FlatCylinder",
     [](Description& d) { d.ball.shape = Shape::cylinder(0.1, 0.0); },
     {"robot.urdf:7", "half length is 0"}},
    {"NanPose", [](Description& d) { d.ball.X_LG.p.x() = kNaN; }, {"robot.urdf:7", "pose"}},
    {"NegativeSlidingFriction",
     [](Description& d) { d.ball.material.slidingFriction = -0.1; },
     {"robot.urdf:7", "friction is negative"}},
    {"NegativeRollingFriction",
     [](Description& d) { d.ball.material.rollingFriction = -0.1; },
     {"robot.urdf:7", "rolling friction is negative"}},
    {"SpringOfAPlanarJoint",
     [](Description& d) { d.hinge.type = JointType::planar, d.hinge.stiffness = 1.0; },
     {"robot.urdf:5", "joint 'hinge'", "spring"}},
    {"NegativeStiffness",
     [](Description& d) { d.hinge.stiffness = -1.0; },
     {"robot.urdf:5", "stiffness is -1"}},
    {"UnknownCondim",
     [](Description& d) { d.ball.material.condim = 2; },
     {"robot.urdf:7", "condim"}},
    {"ZeroTimestep", [](Description& d) { d.options.timestep = 0.0; }, {"options", "timestep"}},
    {"NanTimestep", [](Description& d) { d.options.timestep = kNaN; }, {"options", "timestep"}},
    {"NanGravity", [](Description& d) { d.options.gravity.z() = kNaN; }, {"options", "gravity"}},
    {"ZeroImpedanceRatio",
     [](Description& d) { d.options.impedanceRatio = 0.0; },
     {"options", "impedance ratio"}},
    {"NoIterations",
     [](Description& d) { d.options.maxIterations = 0; },
     {"options", "iterations"}},
};

class ModelErrors : public testing::TestWithParam<Mistake> {};

TEST_P(ModelErrors, NameFileLineAndElement) {
  Description d;
  ASSERT_NO_THROW(d.build());
  GetParam().make(d);
  try {
    d.build();
    FAIL() << "no error";
  } catch (const ModelError& e) {
    for (const char* word : GetParam().words)
      EXPECT_NE(std::string(e.what()).find(word), std::string::npos)
          << "'" << e.what() << "' does not say '" << word << "'";
  }
}

INSTANTIATE_TEST_SUITE_P(Every, ModelErrors, testing::ValuesIn(kMistakes),
                         [](const auto& mistake) { return mistake.param.name; });

TEST(ModelError, OfNoLinks) { EXPECT_THROW(ModelBuilder("void").build(), ModelError); }

// Right, although they look wrong: a link without mass from which something heavy hangs, and a
// negative moment up to rounding.
TEST(ModelError, IsNotRaisedByAMasslessIntermediate) {
  Description d;
  d.arm = emptyLink("arm");
  EXPECT_NO_THROW(d.build());
}

TEST(ModelError, IsNotRaisedByRoundingOfAnInertia) {
  Description d;
  d.moreLinks = {emptyLink("plate")};
  d.moreLinks[0].mass = 0.1;
  d.moreLinks[0].I_Lcm = Vector3(0.1, 0.1, -1e-18).asDiagonal();
  d.moreJoints = {jointSpec("glue", JointType::fixed, "hand", "plate")};
  EXPECT_NO_THROW(d.build());
}

// Two hinges about one axis with nothing between them: M is singular, which merging cannot see.
TEST(ModelError, OfASingularMassMatrixInTheInitialConfiguration) {
  ModelBuilder builder("parallel");
  builder.link(emptyLink("world")).link(emptyLink("cross")).link(boxLink("bob", 1.0, {1, 1, 1}));
  builder.joint(jointSpec("first", JointType::revolute, "world", "cross"))
      .joint(jointSpec("second", JointType::revolute, "cross", "bob"));
  const Model model = builder.build();
  EXPECT_THROW(InverseWeights{model}, ModelError);
}

}  // namespace
}  // namespace softgauss::test
