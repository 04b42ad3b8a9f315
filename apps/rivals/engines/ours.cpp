// SPDX-License-Identifier: Apache-2.0
/// softgauss in the study, built by ModelBuilder: no file of ours is read. Settings are those of
/// Options by the names of simulate_gdd.

#include <cmath>
#include <numbers>

#include "apps/rivals/engine.hpp"
#include "apps/rivals/engines/bounce.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/dynamics/energy.hpp"
#include "softgauss/engine/dynamics/inertia.hpp"
#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/engine/step/step.hpp"

namespace rivals {
namespace {

namespace sg = softgauss;

sg::Transform transform(const Isometry3d& X) {
  sg::Transform t;
  t.R = X.linear();
  t.p = X.translation();
  return t;
}

void apply(Settings& settings, double h, sg::Options& o) {
  o.timestep = h;
  const std::string integrator = settings.word("integrator", "leapfrog");
  const auto found = sg::integratorFromName(integrator);
  if (!found) throw std::invalid_argument("integrator=" + integrator + ": there is none");
  o.integrator = *found;
  o.integrationTolerance = settings.number("integration_tolerance", o.integrationTolerance);
  o.cone = settings.word("cone", "pyramidal") == "elliptic" ? sg::Cone::elliptic : o.cone;
  o.impedanceRatio = settings.number("impedance_ratio", o.impedanceRatio);
  if (settings.word("compatibility", "") == "mujoco") o.useMujocoModel();
}

/// The recipe of docs/guide/contact.md for a body that is to bounce: an impact lasts thirty steps,
/// and gravity and the step take from the damping ratio, which is none where they take it all. A
/// box that lies flat has four contacts, each a quarter of the spring.
sg::ContactSpring bouncy(const Scene& scene, const Body& body, double h) {
  const double omega = std::numbers::pi / (30.0 * h);
  const double zeta = std::max(dampingOfBounce(scene, omega) - 0.25 * omega * h, 0.0);
  const double share = body.mass / (body.shapes[0].kind == ShapeKind::box ? 4.0 : 1.0);
  sg::ContactSpring spring;
  spring.stiffness = share * omega * omega;
  spring.damping = 2.0 * zeta * share * omega;
  return spring;
}

class Ours final : public Engine {
 public:
  Ours(const Scene& scene, double h, Settings& settings)
      : scene_(scene),
        h_(h),
        nothingTouches_(!scene.ground && !scene.collide),
        model_(build(scene, h, settings)),
        state_(model_),
        data_(model_),
        kinematics_(model_) {
    place();
    contacts_.emplace(model_);
    sg::computeKinematics(model_, state_, kinematics_);
  }

  bool step(int count) override {
    for (int i = 0; i < count; ++i) {
      for (const auto& [v, joint] : forces_) input_.tau[v] = joint->forceAt(steps_ * h_);
      ++steps_;
      const sg::SolveStatus status =
          sg::step(model_, input_, state_, data_, nothingTouches_ ? nullptr : &*contacts_);
      if (sg::isRefused(status)) return false;
    }
    return true;
  }

  std::vector<BodyState> state() override {
    sg::computeKinematics(model_, state_, kinematics_);
    std::vector<BodyState> out;
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const auto body = static_cast<std::size_t>(bodies_[i]);
      const sg::Transform& X = kinematics_.X_WB[body];
      const sg::Motion& V = kinematics_.V[body];
      const Vector3d centre = X.p + X.R * centres_[i];
      const Vector3d O = kinematics_.p_WO[static_cast<std::size_t>(model_.bodies[body].tree)];
      out.push_back(
          {centre, Quaterniond(Matrix3d(X.R)), V.linear + V.angular.cross(centre - O), V.angular});
    }
    return out;
  }

  double mass() override { return model_.totalMass(); }
  std::optional<double> kineticEnergy() override {
    return sg::computeEnergy(model_, kinematics_, state_.q, state_.v).kinetic;
  }
  Eigen::MatrixXd massMatrix() override {
    sg::MassMatrix stage(model_);
    sg::computeMassMatrix(model_, kinematics_, stage);
    return stage.M.dense();
  }

 private:
  /// Links have the axes of bodies; their origin is on the joint that carries them.
  sg::Model build(const Scene& scene, double h, Settings& settings) {
    sg::ModelBuilder builder("scene");
    const bool hasWorld = scene.ground || !scene.joints.empty();
    if (hasWorld) {
      sg::LinkSpec world;
      world.name = "world";
      builder.link(world);
    }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      addBody(scene, static_cast<int>(i), builder);
    for (const Joint& j : scene.joints)
      if (j.kind == JointKind::tie) {
        sg::ConnectSpec tie;
        tie.linkA = nameOf(j.parent), tie.linkB = nameOf(j.child);
        tie.p_LAP = linkPose(scene, j.parent).inverse() * j.anchor;
        tie.p_LBP = linkPose(scene, j.child).inverse() * j.anchor;
        builder.connect(tie);
      }
    if (scene.ground) {
      sg::GeometrySpec ground;
      ground.name = "ground", ground.link = "world", ground.shape = sg::Shape::plane();
      ground.material.slidingFriction = scene.frictionOnGround();
      ground.material.priority = scene.groundFriction ? 1 : 0;
      builder.geometry(ground);
    }
    builder.options.gravity = scene.gravity;
    if (!scene.collide) builder.options.effects.remove(sg::Effect::selfCollision);
    apply(settings, h, builder.options);
    return builder.build();
  }

  std::string nameOf(int body) const {
    return body < 0 ? "world" : scene_.bodies[static_cast<std::size_t>(body)].name;
  }

  static Isometry3d linkPose(const Scene& scene, int body) {
    Isometry3d X = scene.startOf(body);
    if (const Joint* j = body < 0 ? nullptr : scene.carrier(body)) X.translation() = j->anchor;
    return X;
  }

  void addBody(const Scene& scene, int index, sg::ModelBuilder& builder) {
    const Body& body = scene.bodies[static_cast<std::size_t>(index)];
    const Isometry3d X_WL = linkPose(scene, index);
    const Joint* carrier = scene.carrier(index);
    sg::ModelBuilder floating("floating");  // its own description, for a base has a pose of its own
    floating.base = sg::BaseKind::floating;
    floating.X_WRoot = transform(X_WL);
    sg::ModelBuilder& into = carrier ? builder : floating;

    sg::LinkSpec link;
    link.name = body.name, link.mass = body.mass;
    link.com = X_WL.inverse() * body.start.position;
    link.I_Lcm = body.inertia.asDiagonal();
    centres_.push_back(link.com);
    into.link(link);
    for (std::size_t k = 0; k < body.shapes.size(); ++k) {
      const Shape& s = body.shapes[k];
      sg::GeometrySpec g;
      g.name = body.name + "/" + std::to_string(k), g.link = body.name;
      g.X_LG = transform(X_WL.inverse() * body.start.pose() * s.pose);
      g.shape = s.kind == ShapeKind::box      ? sg::Shape::box(s.size)
                : s.kind == ShapeKind::sphere ? sg::Shape::sphere(s.size[0])
                                              : sg::Shape::capsule(s.size[0], s.size[1]);
      g.material.slidingFriction = scene.friction;
      if (scene.restitution > 0.0) g.material.spring = bouncy(scene, body, h_);
      into.geometry(g);
    }
    if (carrier)
      addJoint(scene, *carrier, body, builder);
    else
      builder.add(floating, "");
  }

  /// A ball joint is three hinges about x, y, z of the parent, with links without mass between
  /// them.
  void addJoint(const Scene& scene, const Joint& j, const Body& body, sg::ModelBuilder& builder) {
    const Isometry3d X_WP = linkPose(scene, j.parent), X_WL = linkPose(scene, j.child);
    sg::JointSpec spec;
    spec.name = body.name + "_joint", spec.parent = nameOf(j.parent), spec.child = body.name;
    spec.type = j.kind == JointKind::slider ? sg::JointType::prismatic
                : j.range                   ? sg::JointType::revolute
                                            : sg::JointType::continuous;
    if (j.range) spec.lower = j.range->first, spec.upper = j.range->second;
    if (j.kind != JointKind::ball) {
      spec.axis = X_WL.linear().transpose() * j.axis;
      spec.X_PC = transform(X_WP.inverse() * X_WL);
      builder.joint(spec);
      return;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const std::string child = axis == 2 ? body.name : body.name + "_" + "xy"[axis];
      if (axis < 2) {
        sg::LinkSpec stage;
        stage.name = child;
        builder.link(stage);
      }
      spec.name = child + "_joint", spec.child = child, spec.axis = Vector3d::Unit(axis);
      spec.X_PC = sg::Transform();
      if (axis == 0) spec.X_PC.p = X_WP.inverse() * j.anchor;
      builder.joint(spec);
      spec.parent = child;
    }
  }

  void place() {
    input_.tau = sg::VectorX::Zero(model_.nv);
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const BodyState& start = scene_.bodies[i].start;
      const int body =
          model_.frames[static_cast<std::size_t>(model_.findFrame(scene_.bodies[i].name))].body;
      bodies_.push_back(body);
      const sg::Body& b = model_.bodies[static_cast<std::size_t>(body)];
      const Joint* j = scene_.carrier(static_cast<int>(i));
      if (!j) {
        state_.v.segment<3>(b.v) = start.velocity;
        state_.v.segment<3>(b.v + 3) = start.orientation.conjugate() * start.angularVelocity;
        if (const Vector3d& f = scene_.bodies[i].force; !f.isZero())
          input_.wrenches.push_back({body, {Vector3d::Zero(), f}});
      } else if (j->kind == JointKind::ball) {
        placeBall(*j, start, b.q - 2, b.v - 2);
      } else {
        state_.v[b.v] = scene_.jointSpeed(*j);
        if (j->isDriven()) forces_.push_back({b.v, j});
      }
    }
    if (forces_.empty()) input_.tau.resize(0);
  }

  /// R = Rx Ry Rz of the three hinges, and ω = x̂ q̇₁ + Rx ŷ q̇₂ + Rx Ry ẑ q̇₃, in the parent.
  void placeBall(const Joint& j, const BodyState& start, int q, int v) {
    const Quaterniond parent(scene_.startOf(j.parent).linear());
    const Matrix3d R = (parent.conjugate() * start.orientation).toRotationMatrix();
    const Vector3d angles = R.eulerAngles(0, 1, 2);
    const Matrix3d Rx = Eigen::AngleAxisd(angles[0], Vector3d::UnitX()).toRotationMatrix();
    const Matrix3d Ry = Eigen::AngleAxisd(angles[1], Vector3d::UnitY()).toRotationMatrix();
    Matrix3d axes;
    axes << Vector3d::UnitX(), Rx * Vector3d::UnitY(), Rx * Ry * Vector3d::UnitZ();
    state_.q.segment<3>(q) = angles;
    state_.v.segment<3>(v) = axes.inverse() * (parent.conjugate() * start.angularVelocity);
  }

  const Scene scene_;
  double h_;
  bool nothingTouches_;
  std::vector<Vector3d> centres_;  // of mass, in the links
  sg::Model model_;
  sg::State state_;
  sg::Data data_;
  sg::Kinematics kinematics_;
  sg::Input input_;
  std::vector<int> bodies_;
  std::vector<std::pair<int, const Joint*>> forces_;  // of degrees of freedom
  int steps_ = 0;
  std::optional<sg::collision::SceneContacts> contacts_;
};

}  // namespace

std::string engineVersion() { return "softgauss " RIVALS_VERSION; }

std::unique_ptr<Engine> makeEngine(const Scene& scene, double h, Settings& settings) {
  return std::make_unique<Ours>(scene, h, settings);
}

}  // namespace rivals
