// SPDX-License-Identifier: Apache-2.0
/// Bullet in the study, the build with doubles. Trees are a btMultiBody (trees=constraints: rigid
/// bodies with constraints), all else rigid bodies. preset=pybullet: the solver settings that
/// PyBullet has; erp2=number: of contacts; solver=dantzig: the direct solver; integrator=rk4: of
/// btMultiBody; free=multibody: free bodies are trees too.
///
/// Friction and restitution of a pair are products, so that each has the root. Bullet's own damping
/// of multibodies, 0.04/s, and its limit of 100 rad/s are switched off, and so is sleep.

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <btBulletDynamicsCommon.h>

#include "apps/rivals/engine.hpp"

namespace rivals {
namespace {

btVector3 toBt(const Vector3d& v) { return {v[0], v[1], v[2]}; }
btQuaternion toBt(const Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }
btTransform toBt(const Isometry3d& X) {
  return btTransform(toBt(Quaterniond(X.linear())), toBt(Vector3d(X.translation())));
}
Vector3d fromBt(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
Quaterniond fromBt(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

constexpr int kGround = 1, kBody = 2;  // groups of collision

class Bullet final : public Engine {
 public:
  Bullet(const Scene& scene, double h, Settings& settings)
      : scene_(scene), h_(h), dispatcher_(&configuration_), bodies_(scene.bodies.size()) {
    if (settings.word("solver", "sequential") == "dantzig")
      solver_ = std::make_unique<btMultiBodyMLCPConstraintSolver>(&dantzig_);
    else
      solver_ = std::make_unique<btMultiBodyConstraintSolver>();
    world_ = std::make_unique<btMultiBodyDynamicsWorld>(&dispatcher_, &broadphase_, solver_.get(),
                                                        &configuration_);
    world_->setGravity(toBt(scene.gravity));
    btContactSolverInfo& info = world_->getSolverInfo();
    if (settings.word("preset", "library") == "pybullet") {
      info.m_numIterations = 50;
      info.m_erp2 = 0.08;
      info.m_frictionERP = 0.2;
      info.m_linearSlop = 1e-5;
      info.m_leastSquaresResidualThreshold = 1e-7;
    }
    info.m_erp2 = settings.number("erp2", info.m_erp2);
    useTrees_ = settings.word("trees", "multibody") == "multibody";
    rungeKutta_ = settings.word("integrator", "euler") == "rk4";
    const bool freeTrees = settings.word("free", "rigid") == "multibody";
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const bool carries =
          std::any_of(scene.joints.begin(), scene.joints.end(), [&](const Joint& j) {
            return j.parent == static_cast<int>(i) && j.kind != JointKind::tie;
          });
      const Joint* carrier = scene.carrier(static_cast<int>(i));
      if (!useTrees_ || (!carrier && !carries && !freeTrees))
        addRigid(static_cast<int>(i));
      else if (!carrier || carrier->parent < 0)
        addTree(static_cast<int>(i));
    }
    for (const Joint& j : scene.joints)
      if (!useTrees_ || j.kind == JointKind::tie) addConstraint(j);
    if (scene.ground) addGround();
  }

  ~Bullet() override {
    for (auto& c : constraints_) world_->removeConstraint(c.get());
    for (auto& c : limits_) world_->removeMultiBodyConstraint(c.get());
    for (auto& m : trees_) world_->removeMultiBody(m.get());
    for (int i = world_->getNumCollisionObjects() - 1; i >= 0; --i)
      world_->removeCollisionObject(world_->getCollisionObjectArray()[i]);
  }

  bool step(int count) override {
    for (int k = 0; k < count; ++k) {
      for (const auto& [tree, link, joint] : forces_)
        tree->addJointTorque(link, joint->forceAt(steps_ * h_));
      for (std::size_t i = 0; i < bodies_.size(); ++i)
        if (bodies_[i].rigid) bodies_[i].rigid->applyCentralForce(toBt(scene_.bodies[i].force));
      world_->stepSimulation(h_, 0);
      ++steps_;
    }
    return true;
  }

  std::vector<BodyState> state() override {
    std::vector<BodyState> out;
    for (const Place& p : bodies_) {
      if (p.rigid) {
        const btTransform& X = p.rigid->getWorldTransform();
        out.push_back({fromBt(X.getOrigin()), fromBt(X.getRotation()),
                       fromBt(p.rigid->getLinearVelocity()),
                       fromBt(p.rigid->getAngularVelocity())});
        continue;
      }
      std::vector<btVector3> w(static_cast<std::size_t>(p.tree->getNumLinks() + 1)), v = w;
      btAlignedObjectArray<btQuaternion> rotations;
      btAlignedObjectArray<btVector3> origins;
      p.tree->forwardKinematics(rotations, origins);
      p.tree->compTreeLinkVelocities(w.data(), v.data());
      const btTransform X = p.link < 0 ? p.tree->getBaseWorldTransform()
                                       : p.tree->getLink(p.link).m_cachedWorldTransform;
      const auto k = static_cast<std::size_t>(p.link + 1);
      out.push_back({fromBt(X.getOrigin()), fromBt(X.getRotation()), fromBt(X.getBasis() * v[k]),
                     fromBt(X.getBasis() * w[k])});
    }
    return out;
  }

  double mass() override {
    double sum = 0.0;
    for (const Place& p : bodies_)
      sum += p.rigid      ? p.rigid->getMass()
             : p.link < 0 ? p.tree->getBaseMass()
                          : p.tree->getLink(p.link).m_mass;
    return sum;
  }
  std::optional<double> kineticEnergy() override {
    double sum = 0.0;
    const std::vector<BodyState> states = state();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Place& p = bodies_[i];
      const Vector3d I = fromBt(p.rigid      ? p.rigid->getLocalInertia()
                                : p.link < 0 ? p.tree->getBaseInertia()
                                             : p.tree->getLink(p.link).m_inertiaLocal);
      const double m = p.rigid      ? p.rigid->getMass()
                       : p.link < 0 ? p.tree->getBaseMass()
                                    : p.tree->getLink(p.link).m_mass;
      const Vector3d w = states[i].orientation.conjugate() * states[i].angularVelocity;
      sum += 0.5 * (m * states[i].velocity.squaredNorm() + w.dot(I.cwiseProduct(w)));
    }
    return sum;
  }

 private:
  struct Place {
    btRigidBody* rigid = nullptr;
    btMultiBody* tree = nullptr;
    int link = -1;
  };

  template <class T, class... A>
  T* keep(A&&... a) {
    auto made = std::make_shared<T>(std::forward<A>(a)...);
    kept_.push_back(made);
    return made.get();
  }

  const Body& body(int i) const { return scene_.bodies[static_cast<std::size_t>(i)]; }

  btCollisionShape* shapeOf(const Body& b) {
    const auto one = [&](const Shape& s) -> btCollisionShape* {
      if (s.kind == ShapeKind::box) return keep<btBoxShape>(toBt(s.size));
      if (s.kind == ShapeKind::sphere) return keep<btSphereShape>(s.size[0]);
      return keep<btCapsuleShapeZ>(s.size[0], 2 * s.size[1]);
    };
    if (b.shapes.empty()) return keep<btEmptyShape>();
    if (b.shapes.size() == 1 && b.shapes[0].pose.isApprox(Isometry3d::Identity()))
      return one(b.shapes[0]);
    auto* compound = keep<btCompoundShape>();
    for (const Shape& s : b.shapes) compound->addChildShape(toBt(s.pose), one(s));
    return compound;
  }

  void finish(btCollisionObject& object, const Body& b) {
    object.setFriction(std::sqrt(scene_.friction));
    object.setRestitution(std::sqrt(scene_.restitution));
    object.setActivationState(DISABLE_DEACTIVATION);
    if (b.shapes.empty())
      object.setCollisionFlags(object.getCollisionFlags() |
                               btCollisionObject::CF_NO_CONTACT_RESPONSE);
  }
  int mask(const Body& b) const {
    return b.shapes.empty() ? 0 : scene_.collide ? kGround | kBody : kGround;
  }

  void addRigid(int i) {
    const Body& b = body(i);
    btRigidBody::btRigidBodyConstructionInfo info(b.mass, nullptr, shapeOf(b), toBt(b.inertia));
    info.m_startWorldTransform = toBt(b.start.pose());
    auto* rigid = keep<btRigidBody>(info);
    rigid->setLinearVelocity(toBt(b.start.velocity));
    rigid->setAngularVelocity(toBt(b.start.angularVelocity));
    rigid->setDamping(0.0, 0.0);
    finish(*rigid, b);
    world_->addRigidBody(rigid, kBody, mask(b));
    bodies_[static_cast<std::size_t>(i)].rigid = rigid;
  }

  /// The tree of which a body is the first: a base that floats, or the first link on a fixed one.
  void addTree(int root) {
    const bool floats = !scene_.carrier(root);
    std::vector<int> links;  // bodies, a parent before its children
    const auto linkOf = [&](int b) {
      const auto found = std::find(links.begin(), links.end(), b);
      return found == links.end() ? -1 : static_cast<int>(found - links.begin());
    };
    for (int b = root; b < static_cast<int>(scene_.bodies.size()); ++b) {
      const Joint* j = scene_.carrier(b);
      if (j && (b == root || j->parent == root || linkOf(j->parent) >= 0)) links.push_back(b);
    }
    const Body& first = body(root);
    trees_.push_back(std::make_unique<btMultiBody>(
        static_cast<int>(links.size()), floats ? first.mass : 0.0,
        toBt(floats ? first.inertia : Vector3d::Zero().eval()), !floats, false));
    btMultiBody& tree = *trees_.back();
    tree.setHasSelfCollision(false);
    tree.setLinearDamping(0.0);
    tree.setAngularDamping(0.0);
    tree.setMaxCoordinateVelocity(1e6);
    tree.useRK4Integration(rungeKutta_);
    for (std::size_t k = 0; k < links.size(); ++k)
      addLink(tree, static_cast<int>(k), links[k], linkOf);
    tree.finalizeMultiDof();
    world_->addMultiBody(&tree);
    tree.setBaseWorldTransform(floats ? toBt(first.start.pose()) : btTransform::getIdentity());
    if (floats) {
      tree.setBaseVel(toBt(first.start.velocity));
      tree.setBaseOmega(toBt(first.start.angularVelocity));
      bodies_[static_cast<std::size_t>(root)] = {nullptr, &tree, -1};
    }
    for (std::size_t k = 0; k < links.size(); ++k) startLink(tree, static_cast<int>(k), links[k]);
    addColliders(tree);
  }

  template <class LinkOf>
  void addLink(btMultiBody& tree, int k, int b, const LinkOf& linkOf) {
    const Joint& j = *scene_.carrier(b);
    const Body& child = body(b);
    const Isometry3d X_WP = scene_.startOf(j.parent), X_WC = child.start.pose();
    const btQuaternion parentToChild =
        toBt(Quaterniond((X_WC.linear().transpose() * X_WP.linear()).eval()));
    const btVector3 axis = toBt(Vector3d(X_WC.linear().transpose() * j.axis));
    const btVector3 pivot = toBt(Vector3d(X_WP.inverse() * j.anchor)),
                    centre = toBt(Vector3d(-(X_WC.inverse() * j.anchor)));
    const int parent = j.parent < 0 ? -1 : linkOf(j.parent);
    const btVector3 inertia = toBt(child.inertia);
    if (j.kind == JointKind::hinge)
      tree.setupRevolute(k, child.mass, inertia, parent, parentToChild, axis, pivot, centre, true);
    else if (j.kind == JointKind::slider)
      tree.setupPrismatic(k, child.mass, inertia, parent, parentToChild, axis, pivot, centre, true);
    else
      tree.setupSpherical(k, child.mass, inertia, parent, parentToChild, pivot, centre, true);
    bodies_[static_cast<std::size_t>(b)] = {nullptr, &tree, k};
  }

  void startLink(btMultiBody& tree, int k, int b) {
    const Joint& j = *scene_.carrier(b);
    if (j.kind == JointKind::ball) {
      const Vector3d w = body(b).start.orientation.conjugate() * body(b).start.angularVelocity;
      btScalar speed[3] = {w[0], w[1], w[2]};
      tree.setJointVelMultiDof(k, speed);
      return;
    }
    tree.setJointVel(k, scene_.jointSpeed(j));
    if (j.isDriven()) forces_.push_back({&tree, k, &j});
    if (j.range) {
      limits_.push_back(std::make_unique<btMultiBodyJointLimitConstraint>(&tree, k, j.range->first,
                                                                          j.range->second));
      world_->addMultiBodyConstraint(limits_.back().get());
    }
  }

  void addColliders(btMultiBody& tree) {
    btAlignedObjectArray<btQuaternion> rotations;
    btAlignedObjectArray<btVector3> origins;
    tree.forwardKinematics(rotations, origins);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Body& b = scene_.bodies[i];
      if (bodies_[i].tree != &tree || b.shapes.empty()) continue;
      const int link = bodies_[i].link;
      auto* collider = keep<btMultiBodyLinkCollider>(&tree, link);
      collider->setCollisionShape(shapeOf(b));
      finish(*collider, b);
      world_->addCollisionObject(collider, kBody, mask(b));
      if (link < 0)
        tree.setBaseCollider(collider);
      else
        tree.getLink(link).m_collider = collider;
    }
    tree.updateCollisionObjectWorldTransforms(rotations, origins);
  }

  void addConstraint(const Joint& j) {
    const auto local = [&](int b, const Vector3d& p) {
      return toBt(Vector3d(scene_.startOf(b).inverse() * p));
    };
    const auto turned = [&](int b) {
      return toBt(Vector3d(scene_.startOf(b).linear().transpose() * j.axis));
    };
    btRigidBody& child = *bodies_[static_cast<std::size_t>(j.child)].rigid;
    btRigidBody* parent =
        j.parent < 0 ? nullptr : bodies_[static_cast<std::size_t>(j.parent)].rigid;
    if (j.kind == JointKind::hinge) {
      std::unique_ptr<btHingeConstraint> hinge;
      if (parent)
        hinge = std::make_unique<btHingeConstraint>(child, *parent, local(j.child, j.anchor),
                                                    local(j.parent, j.anchor), turned(j.child),
                                                    turned(j.parent));
      else
        hinge =
            std::make_unique<btHingeConstraint>(child, local(j.child, j.anchor), turned(j.child));
      if (j.range) hinge->setLimit(j.range->first, j.range->second);
      constraints_.push_back(std::move(hinge));
    } else if (j.kind == JointKind::slider) {
      throw CannotExpress("sliders of rigid bodies are left out here");
    } else if (parent) {
      constraints_.push_back(std::make_unique<btPoint2PointConstraint>(
          child, *parent, local(j.child, j.anchor), local(j.parent, j.anchor)));
    } else {
      constraints_.push_back(
          std::make_unique<btPoint2PointConstraint>(child, local(j.child, j.anchor)));
    }
    world_->addConstraint(constraints_.back().get(), true);
  }

  void addGround() {
    auto* ground =
        keep<btRigidBody>(0.0, nullptr, keep<btStaticPlaneShape>(btVector3(0, 0, 1), 0.0));
    ground->setFriction(scene_.frictionOnGround() / std::sqrt(scene_.friction));
    ground->setRestitution(std::sqrt(scene_.restitution));
    world_->addRigidBody(ground, kGround, kBody);
  }

  const Scene scene_;
  double h_;
  int steps_ = 0;
  bool useTrees_ = true, rungeKutta_ = false;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btDantzigSolver dantzig_;
  std::vector<std::shared_ptr<void>> kept_;
  std::unique_ptr<btMultiBodyConstraintSolver> solver_;
  std::vector<std::unique_ptr<btMultiBody>> trees_;
  std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
  std::vector<std::unique_ptr<btMultiBodyJointLimitConstraint>> limits_;
  std::unique_ptr<btMultiBodyDynamicsWorld> world_;
  std::vector<Place> bodies_;
  struct Force {
    btMultiBody* tree;
    int link;
    const Joint* joint;
  };
  std::vector<Force> forces_;
};

}  // namespace

std::string engineVersion() { return "Bullet " RIVALS_VERSION; }

std::unique_ptr<Engine> makeEngine(const Scene& scene, double h, Settings& settings) {
  return std::make_unique<Bullet>(scene, h, settings);
}

}  // namespace rivals
