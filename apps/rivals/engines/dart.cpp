// SPDX-License-Identifier: Apache-2.0
/// DART in the study. detector=ode (as Gazebo has it, the default here) or dart; DART's own
/// default, fcl, takes shapes for meshes. solver=pgs in place of Dantzig's. Friction is a pyramid.
/// The restitution of a pair is a product, so that each has the root.

#include <dart/collision/ode/ode.hpp>
#include <dart/dart.hpp>

#include "apps/rivals/engine.hpp"

namespace rivals {
namespace {

namespace dd = dart::dynamics;

class Dart final : public Engine {
 public:
  Dart(const Scene& scene, double h, Settings& settings)
      : scene_(scene), world_(dart::simulation::World::create()) {
    world_->setTimeStep(h);
    world_->setGravity(scene.gravity);
    auto* solver = world_->getConstraintSolver();
    const std::string detector = settings.word("detector", "ode");
    if (detector == "ode")
      solver->setCollisionDetector(dart::collision::OdeCollisionDetector::create());
    if (detector == "dart")
      solver->setCollisionDetector(dart::collision::DARTCollisionDetector::create());
    if (settings.word("solver", "dantzig") == "pgs")
      dynamic_cast<dart::constraint::BoxedLcpConstraintSolver&>(*solver).setBoxedLcpSolver(
          std::make_shared<dart::constraint::PgsBoxedLcpSolver>());
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) addBody(static_cast<int>(i));
    for (const Joint& j : scene.joints)
      if (j.kind == JointKind::tie) addTie(j);
    if (scene.ground) addGround();
  }

  bool step(int count) override {
    for (int k = 0; k < count; ++k) {
      for (const auto& [dof, joint] : forces_) dof->setForce(joint->forceAt(world_->getTime()));
      for (std::size_t i = 0; i < nodes_.size(); ++i)
        if (!scene_.bodies[i].force.isZero()) nodes_[i]->addExtForce(scene_.bodies[i].force);
      world_->step();
    }
    return true;
  }

  std::vector<BodyState> state() override {
    std::vector<BodyState> out;
    for (const dd::BodyNode* n : nodes_)
      out.push_back({n->getCOM(), Quaterniond(Matrix3d(n->getWorldTransform().linear())),
                     n->getCOMLinearVelocity(), n->getAngularVelocity()});
    return out;
  }

  double mass() override {
    double sum = 0.0;
    for (const dd::BodyNode* n : nodes_) sum += n->getMass();
    return sum;
  }
  std::optional<double> kineticEnergy() override {
    double sum = 0.0;
    for (std::size_t i = 0; i < world_->getNumSkeletons(); ++i)
      sum += world_->getSkeleton(i)->computeKineticEnergy();
    return sum;
  }
  Eigen::MatrixXd massMatrix() override { return nodes_[0]->getSkeleton()->getMassMatrix(); }

 private:
  void addBody(int i) {
    const Body& b = scene_.bodies[static_cast<std::size_t>(i)];
    const Joint* j = scene_.carrier(i);
    dd::BodyNode* parent =
        j && j->parent >= 0 ? nodes_[static_cast<std::size_t>(j->parent)] : nullptr;
    const dd::SkeletonPtr skeleton = parent ? parent->getSkeleton() : dd::Skeleton::create(b.name);
    dd::BodyNode::Properties properties;
    properties.mName = b.name;
    properties.mInertia = dd::Inertia(b.mass, Vector3d::Zero(), b.inertia.asDiagonal());
    nodes_.push_back(makeNode(*skeleton, parent, properties, b, j));
    for (const Shape& s : b.shapes) {
      dd::ShapePtr shape;
      if (s.kind == ShapeKind::box) shape = std::make_shared<dd::BoxShape>(2 * s.size);
      if (s.kind == ShapeKind::sphere) shape = std::make_shared<dd::SphereShape>(s.size[0]);
      if (s.kind == ShapeKind::capsule)
        shape = std::make_shared<dd::CapsuleShape>(s.size[0], 2 * s.size[1]);
      auto* node =
          nodes_.back()->createShapeNodeWith<dd::CollisionAspect, dd::DynamicsAspect>(shape);
      node->setRelativeTransform(s.pose);
      node->getDynamicsAspect()->setFrictionCoeff(scene_.friction);
      node->getDynamicsAspect()->setRestitutionCoeff(std::sqrt(scene_.restitution));
    }
    if (!parent) world_->addSkeleton(skeleton);
    if (!scene_.collide) skeleton->disableSelfCollisionCheck();
  }

  /// The joint's frames are at the anchor, with the axes of the child.
  dd::BodyNode* makeNode(dd::Skeleton& skeleton, dd::BodyNode* parent,
                         const dd::BodyNode::Properties& properties, const Body& b,
                         const Joint* j) {
    if (!j) {
      auto [joint, node] = skeleton.createJointAndBodyNodePair<dd::FreeJoint>(
          nullptr, dd::FreeJoint::Properties(), properties);
      joint->setPositions(dd::FreeJoint::convertToPositions(b.start.pose()));
      joint->setLinearVelocity(b.start.velocity);
      joint->setAngularVelocity(b.start.angularVelocity);
      return node;
    }
    Isometry3d X_WJ = b.start.pose();
    X_WJ.translation() = j->anchor;
    const auto place = [&](auto p) {
      p.mName = b.name + "_joint";
      p.mT_ParentBodyToJoint = scene_.startOf(j->parent).inverse() * X_WJ;
      p.mT_ChildBodyToJoint = b.start.pose().inverse() * X_WJ;
      return p;
    };
    if (j->kind == JointKind::ball) {
      auto [joint, node] = skeleton.createJointAndBodyNodePair<dd::BallJoint>(
          parent, place(dd::BallJoint::Properties()), properties);
      joint->setVelocities(b.start.orientation.conjugate() * b.start.angularVelocity);
      return node;
    }
    const auto single = [&](auto p) {
      p = place(p);
      p.mAxis = b.start.orientation.conjugate() * j->axis;
      if (j->range) {
        p.mPositionLowerLimits[0] = j->range->first;
        p.mPositionUpperLimits[0] = j->range->second;
        p.mIsPositionLimitEnforced = true;
      }
      return p;
    };
    dd::Joint* joint;
    dd::BodyNode* node;
    if (j->kind == JointKind::hinge)
      std::tie(joint, node) = skeleton.createJointAndBodyNodePair<dd::RevoluteJoint>(
          parent, single(dd::RevoluteJoint::Properties()), properties);
    else
      std::tie(joint, node) = skeleton.createJointAndBodyNodePair<dd::PrismaticJoint>(
          parent, single(dd::PrismaticJoint::Properties()), properties);
    joint->setVelocity(0, scene_.jointSpeed(*j));
    if (j->isDriven()) forces_.push_back({joint->getDof(0), j});
    return node;
  }

  void addTie(const Joint& j) {
    auto* child = nodes_[static_cast<std::size_t>(j.child)];
    std::shared_ptr<dart::constraint::BallJointConstraint> tie;
    if (j.parent < 0)
      tie = std::make_shared<dart::constraint::BallJointConstraint>(child, j.anchor);
    else
      tie = std::make_shared<dart::constraint::BallJointConstraint>(
          child, nodes_[static_cast<std::size_t>(j.parent)], j.anchor);
    world_->getConstraintSolver()->addConstraint(tie);
  }

  void addGround() {
    const dd::SkeletonPtr ground = dd::Skeleton::create("ground");
    auto* body = ground->createJointAndBodyNodePair<dd::WeldJoint>().second;
    auto* node = body->createShapeNodeWith<dd::CollisionAspect, dd::DynamicsAspect>(
        std::make_shared<dd::PlaneShape>(Vector3d::UnitZ(), 0.0));
    node->getDynamicsAspect()->setFrictionCoeff(scene_.frictionOnGround());
    node->getDynamicsAspect()->setRestitutionCoeff(std::sqrt(scene_.restitution));
    world_->addSkeleton(ground);
    if (scene_.collide) return;
    // Bodies that do not touch one another: of their pairs, the ground's alone are looked at.
    auto filter = std::dynamic_pointer_cast<dart::collision::BodyNodeCollisionFilter>(
        world_->getConstraintSolver()->getCollisionOption().collisionFilter);
    for (std::size_t a = 0; filter && a < nodes_.size(); ++a)
      for (std::size_t b = a + 1; b < nodes_.size(); ++b)
        filter->addBodyNodePairToBlackList(nodes_[a], nodes_[b]);
  }

  const Scene scene_;
  dart::simulation::WorldPtr world_;
  std::vector<dd::BodyNode*> nodes_;
  std::vector<std::pair<dd::DegreeOfFreedom*, const Joint*>> forces_;
};

}  // namespace

std::string engineVersion() { return "DART " DART_VERSION; }

std::unique_ptr<Engine> makeEngine(const Scene& scene, double h, Settings& settings) {
  return std::make_unique<Dart>(scene, h, settings);
}

}  // namespace rivals
