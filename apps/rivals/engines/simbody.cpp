// SPDX-License-Identifier: Apache-2.0
/// Simbody in the study: Runge–Kutta–Merson, error control. Settings: accuracy (1e-3, Simbody's
/// default), transition_velocity (0.01 m/s), stiffness (1e7 Pa), dissipation (1 s/m). Its step is
/// where it reports, not where it integrates. Boxes and capsules touch the ground and spheres only.
/// A restitution e is a dissipation of (1 − e)/v, for the speed v of the first impact: Simbody's e
/// falls with the speed.

#include <Simbody.h>

#include "apps/rivals/engine.hpp"

namespace rivals {
namespace {

SimTK::Vec3 toSim(const Vector3d& v) { return {v[0], v[1], v[2]}; }
SimTK::Rotation toSim(const Matrix3d& R) {
  SimTK::Mat33 m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = R(i, j);
  return SimTK::Rotation(m);
}
SimTK::Transform toSim(const Isometry3d& X) {
  return {toSim(Matrix3d(X.linear())), toSim(Vector3d(X.translation()))};
}
Vector3d fromSim(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

/// The force of a joint that is driven.
class Drive final : public SimTK::Force::Custom::Implementation {
 public:
  Drive(const SimTK::MobilizedBody& body, const Joint& joint) : body_(body), joint_(joint) {}
  void calcForce(const SimTK::State& s, SimTK::Vector_<SimTK::SpatialVec>&,
                 SimTK::Vector_<SimTK::Vec3>&, SimTK::Vector& mobilityForces) const override {
    body_.applyOneMobilityForce(s, 0, joint_.forceAt(s.getTime()), mobilityForces);
  }
  SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return 0.0; }

 private:
  SimTK::MobilizedBody body_;
  Joint joint_;
};

class Simbody final : public Engine {
 public:
  Simbody(const Scene& scene, double h, Settings& settings)
      : scene_(scene),
        h_(h),
        matter_(system_),
        forces_(system_),
        tracker_(system_),
        contact_(system_, tracker_) {
    if (scene.collide)
      throw CannotExpress("no contacts of box and box or capsule and capsule, but of meshes");
    if (scene.gravity.norm() > 0.0)
      SimTK::Force::UniformGravity(forces_, matter_, toSim(scene.gravity));
    contact_.setTransitionVelocity(settings.number("transition_velocity", 0.01));
    const double dissipation = scene.restitution > 0.0
                                   ? (1.0 - scene.restitution) / scene.fallSpeed()
                                   : settings.number("dissipation", 1.0);
    const SimTK::ContactMaterial material(settings.number("stiffness", 1e7), dissipation,
                                          scene.frictionOnGround(), scene.frictionOnGround(), 0.0);
    if (scene.ground) {
      const SimTK::Rotation up(SimTK::Pi / 2, SimTK::YAxis);  // the half space is x > 0
      matter_.Ground().updBody().addContactSurface(
          SimTK::Transform(up),
          SimTK::ContactSurface(SimTK::ContactGeometry::HalfSpace(), material));
    }
    const auto clique =
        SimTK::ContactSurface::createNewContactClique();  // bodies do not touch one another
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& b = scene.bodies[i];
      SimTK::Body::Rigid body(
          SimTK::MassProperties(b.mass, SimTK::Vec3(0), SimTK::Inertia(toSim(b.inertia))));
      for (const Shape& s : b.shapes) addShape(body, s, material, clique);
      mobilize(static_cast<int>(i), body);
      if (!b.force.isZero())
        SimTK::Force::ConstantForce(forces_, mobilized_.back(), SimTK::Vec3(0), toSim(b.force));
    }
    for (const Joint& j : scene.joints) {
      if (j.kind != JointKind::tie) continue;
      SimTK::MobilizedBody parent = mobilized(j.parent), child = mobilized(j.child);
      SimTK::Constraint::Ball(parent, toSim(Vector3d(scene.startOf(j.parent).inverse() * j.anchor)),
                              child, toSim(Vector3d(scene.startOf(j.child).inverse() * j.anchor)));
    }
    system_.realizeTopology();
    SimTK::State start = system_.getDefaultState();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) place(static_cast<int>(i), start);
    system_.realize(start, SimTK::Stage::Velocity);
    integrator_ = std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system_);
    integrator_->setAccuracy(settings.number("accuracy", 1e-3));
    integrator_->setConstraintTolerance(std::min(1e-4, settings.number("accuracy", 1e-3) / 10));
    integrator_->setAllowInterpolation(false);
    stepper_ = std::make_unique<SimTK::TimeStepper>(system_, *integrator_);
    stepper_->initialize(start);
  }

  bool step(int count) override {
    time_ += count * h_;
    try {
      stepper_->stepTo(time_);
    } catch (const std::exception&) {
      return false;
    }
    return true;
  }

  std::vector<BodyState> state() override {
    const SimTK::State& s = stepper_->getState();
    system_.realize(s, SimTK::Stage::Velocity);
    std::vector<BodyState> out;
    for (const auto& b : mobilized_) {
      const SimTK::Quaternion q = b.getBodyRotation(s).convertRotationToQuaternion();
      out.push_back({fromSim(b.getBodyOriginLocation(s)),
                     {q[0], q[1], q[2], q[3]},
                     fromSim(b.getBodyOriginVelocity(s)),
                     fromSim(b.getBodyAngularVelocity(s))});
    }
    return out;
  }

  double mass() override { return matter_.calcSystemMass(stepper_->getState()); }
  std::optional<double> kineticEnergy() override {
    system_.realize(stepper_->getState(), SimTK::Stage::Velocity);
    return matter_.calcKineticEnergy(stepper_->getState());
  }
  Eigen::MatrixXd massMatrix() override {
    SimTK::Matrix M;
    matter_.calcM(stepper_->getState(), M);
    Eigen::MatrixXd out(M.nrow(), M.ncol());
    for (int i = 0; i < M.nrow(); ++i)
      for (int j = 0; j < M.ncol(); ++j) out(i, j) = M(i, j);
    return out;
  }

 private:
  SimTK::MobilizedBody mobilized(int b) {
    return b < 0 ? SimTK::MobilizedBody(matter_.Ground()) : mobilized_[static_cast<std::size_t>(b)];
  }

  static void addShape(SimTK::Body& body, const Shape& s, const SimTK::ContactMaterial& material,
                       SimTK::ContactCliqueId clique) {
    const auto put = [&](const Isometry3d& X, const SimTK::ContactGeometry& g) {
      SimTK::ContactSurface surface(g, material);
      surface.joinClique(clique);
      body.addContactSurface(toSim(X), surface);
    };
    if (s.kind == ShapeKind::box) put(s.pose, SimTK::ContactGeometry::Brick(toSim(s.size)));
    if (s.kind == ShapeKind::sphere) put(s.pose, SimTK::ContactGeometry::Sphere(s.size[0]));
    if (s.kind == ShapeKind::capsule)  // on a plane its ends are all that touches
      for (const double end : {-1.0, 1.0})
        put(s.pose * Eigen::Translation3d(0, 0, end * s.size[1]),
            SimTK::ContactGeometry::Sphere(s.size[0]));
  }

  void mobilize(int i, const SimTK::Body& body) {
    const Joint* j = scene_.carrier(i);
    if (!j) {
      mobilized_.push_back(SimTK::MobilizedBody::Free(matter_.Ground(), SimTK::Transform(), body,
                                                      SimTK::Transform()));
      return;
    }
    // The joint's frame in the world: at the anchor, its z (a slider's x) along the axis.
    Isometry3d X_WJ = scene_.startOf(i);
    X_WJ.translation() = j->anchor;
    if (j->kind != JointKind::ball)
      X_WJ.linear() =
          Quaterniond::FromTwoVectors(
              j->kind == JointKind::slider ? Vector3d::UnitX() : Vector3d::UnitZ(), j->axis)
              .toRotationMatrix();
    const SimTK::Transform inParent = toSim(Isometry3d(scene_.startOf(j->parent).inverse() * X_WJ));
    const SimTK::Transform inChild = toSim(Isometry3d(scene_.startOf(i).inverse() * X_WJ));
    SimTK::MobilizedBody parent = mobilized(j->parent);
    if (j->kind == JointKind::hinge)
      mobilized_.push_back(SimTK::MobilizedBody::Pin(parent, inParent, body, inChild));
    else if (j->kind == JointKind::slider)
      mobilized_.push_back(SimTK::MobilizedBody::Slider(parent, inParent, body, inChild));
    else
      mobilized_.push_back(SimTK::MobilizedBody::Ball(parent, inParent, body, inChild));
    if (j->range)
      SimTK::Force::MobilityLinearStop(forces_, mobilized_.back(), SimTK::MobilizerQIndex(0),
                                       1000.0, 1.0, j->range->first, j->range->second);
    if (j->isDriven()) SimTK::Force::Custom(forces_, new Drive(mobilized_.back(), *j));
  }

  void place(int i, SimTK::State& start) {
    const BodyState& s = scene_.bodies[static_cast<std::size_t>(i)].start;
    const Joint* j = scene_.carrier(i);
    SimTK::MobilizedBody& b = mobilized_[static_cast<std::size_t>(i)];
    if (!j) {
      b.setQToFitTransform(start, toSim(s.pose()));
      b.setUToFitVelocity(start, SimTK::SpatialVec(toSim(s.angularVelocity), toSim(s.velocity)));
    } else if (j->kind == JointKind::ball) {
      b.setUToFitAngularVelocity(
          start, toSim(Vector3d(scene_.startOf(i).linear().transpose() * s.angularVelocity)));
    } else {
      b.setOneU(start, 0, scene_.jointSpeed(*j));
    }
  }

  const Scene scene_;
  double h_, time_ = 0.0;
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  SimTK::ContactTrackerSubsystem tracker_;
  SimTK::CompliantContactSubsystem contact_;
  std::vector<SimTK::MobilizedBody> mobilized_;
  std::unique_ptr<SimTK::Integrator> integrator_;
  std::unique_ptr<SimTK::TimeStepper> stepper_;
};

}  // namespace

std::string engineVersion() { return "Simbody " RIVALS_VERSION; }

std::unique_ptr<Engine> makeEngine(const Scene& scene, double h, Settings& settings) {
  return std::make_unique<Simbody>(scene, h, settings);
}

}  // namespace rivals
