// SPDX-License-Identifier: Apache-2.0
/// ODE in the study. step=quick: QuickStep with 50 iterations, ERP 0.2, a surface layer of 1 mm, as
/// Gazebo Classic has it; else dWorldStep with ODE's own defaults. Contacts are Coulomb's by
/// dContactApprox1, without which mu is a force.

#include <ode/ode.h>

#include <cstring>

#include "apps/rivals/engine.hpp"

namespace rivals {
namespace {

constexpr int kMostContacts = 8;  // of a pair

void setRotation(const Matrix3d& R, dMatrix3 out) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[4 * i + j] = R(i, j);
  out[3] = out[7] = out[11] = 0.0;
}

class Ode final : public Engine {
 public:
  Ode(const Scene& scene, double h, Settings& settings)
      : scene_(scene), h_(h), quick_(settings.word("step", "world") == "quick") {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    dSetMessageHandler([](int, const char*, va_list) {});
    dRandSetSeed(0);  // of QuickStep's order of rows
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, scene.gravity[0], scene.gravity[1], scene.gravity[2]);
    if (quick_) {
      dWorldSetQuickStepNumIterations(world_, static_cast<int>(settings.number("iterations", 50)));
      dWorldSetCFM(world_, 0.0);
      dWorldSetERP(world_, 0.2);
      dWorldSetContactMaxCorrectingVel(world_, 100.0);
      dWorldSetContactSurfaceLayer(world_, 0.001);
    }
    for (const Body& b : scene.bodies) addBody(b);
    for (const Joint& j : scene_.joints) addJoint(j);
    if (scene.ground) dCreatePlane(space_, 0, 0, 1, 0);
  }
  ~Ode() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  bool step(int count) override {
    for (int k = 0; k < count; ++k) {
      if (scene_.ground || scene_.collide)
        dSpaceCollide(space_, this, [](void* self, dGeomID a, dGeomID b) {
          static_cast<Ode*>(self)->touch(a, b);
        });
      for (const auto& [slider, joint] : forces_)
        dJointAddSliderForce(slider, joint->forceAt(steps_ * h_));
      for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Vector3d& f = scene_.bodies[i].force;
        dBodyAddForce(bodies_[i], f[0], f[1], f[2]);
      }
      ++steps_;
      const int ok = quick_ ? dWorldQuickStep(world_, h_) : dWorldStep(world_, h_);
      dJointGroupEmpty(contacts_);
      if (!ok) return false;
    }
    return true;
  }

  std::vector<BodyState> state() override {
    std::vector<BodyState> out;
    for (const dBodyID b : bodies_) {
      const dReal *p = dBodyGetPosition(b), *q = dBodyGetQuaternion(b), *v = dBodyGetLinearVel(b),
                  *w = dBodyGetAngularVel(b);
      out.push_back(
          {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}, {v[0], v[1], v[2]}, {w[0], w[1], w[2]}});
    }
    return out;
  }

  double mass() override {
    double sum = 0.0;
    for (const dBodyID b : bodies_) sum += massOf(b).mass;
    return sum;
  }
  std::optional<double> kineticEnergy() override {
    double sum = 0.0;
    const std::vector<BodyState> states = state();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const dMass m = massOf(bodies_[i]);
      const Vector3d w = states[i].orientation.conjugate() * states[i].angularVelocity;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) sum += 0.5 * w[r] * m.I[4 * r + c] * w[c];
      sum += 0.5 * m.mass * states[i].velocity.squaredNorm();
    }
    return sum;
  }

 private:
  static dMass massOf(dBodyID b) {
    dMass m;
    dBodyGetMass(b, &m);
    return m;
  }

  void touch(dGeomID a, dGeomID b) {
    const dBodyID x = dGeomGetBody(a), y = dGeomGetBody(b);
    if (x == y || (x && y && !scene_.collide)) return;
    dContact found[kMostContacts];
    const int count = dCollide(a, b, kMostContacts, &found[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
      std::memset(&found[i].surface, 0, sizeof found[i].surface);
      found[i].surface.mode = dContactApprox1;
      found[i].surface.mu = x && y ? scene_.friction : scene_.frictionOnGround();
      if (scene_.restitution > 0.0) {
        found[i].surface.mode |= dContactBounce;
        found[i].surface.bounce = scene_.restitution;
      }
      dJointAttach(dJointCreateContact(world_, contacts_, &found[i]), x, y);
    }
  }

  void addBody(const Body& body) {
    const dBodyID b = dBodyCreate(world_);
    dMass m;
    dMassSetParameters(&m, body.mass, 0, 0, 0, body.inertia[0], body.inertia[1], body.inertia[2], 0,
                       0, 0);
    dBodySetMass(b, &m);
    const Vector3d &p = body.start.position, &v = body.start.velocity,
                   &w = body.start.angularVelocity;
    const Quaterniond& q = body.start.orientation;
    const dQuaternion orientation = {q.w(), q.x(), q.y(), q.z()};
    dBodySetPosition(b, p[0], p[1], p[2]);
    dBodySetQuaternion(b, orientation);
    dBodySetLinearVel(b, v[0], v[1], v[2]);
    dBodySetAngularVel(b, w[0], w[1], w[2]);
    for (const Shape& s : body.shapes) {
      const dGeomID g =
          s.kind == ShapeKind::box ? dCreateBox(space_, 2 * s.size[0], 2 * s.size[1], 2 * s.size[2])
          : s.kind == ShapeKind::sphere ? dCreateSphere(space_, s.size[0])
                                        : dCreateCapsule(space_, s.size[0], 2 * s.size[1]);
      dGeomSetBody(g, b);
      const Vector3d at = s.pose.translation();
      dGeomSetOffsetPosition(g, at[0], at[1], at[2]);
      dMatrix3 R;
      setRotation(s.pose.linear(), R);
      dGeomSetOffsetRotation(g, R);
    }
    bodies_.push_back(b);
  }

  void addJoint(const Joint& j) {
    const dBodyID child = bodies_[static_cast<std::size_t>(j.child)];
    const dBodyID parent = j.parent < 0 ? nullptr : bodies_[static_cast<std::size_t>(j.parent)];
    const Vector3d &at = j.anchor, &a = j.axis;
    if (j.kind == JointKind::hinge) {
      const dJointID id = dJointCreateHinge(world_, nullptr);
      dJointAttach(id, child, parent);
      dJointSetHingeAnchor(id, at[0], at[1], at[2]);
      dJointSetHingeAxis(id, a[0], a[1], a[2]);
      if (j.range) {
        dJointSetHingeParam(id, dParamLoStop, j.range->first);
        dJointSetHingeParam(id, dParamHiStop, j.range->second);
      }
    } else if (j.kind == JointKind::slider) {
      const dJointID id = dJointCreateSlider(world_, nullptr);
      dJointAttach(id, child, parent);
      dJointSetSliderAxis(id, a[0], a[1], a[2]);
      if (j.isDriven()) forces_.push_back({id, &j});
    } else {
      const dJointID id = dJointCreateBall(world_, nullptr);
      dJointAttach(id, child, parent);
      dJointSetBallAnchor(id, at[0], at[1], at[2]);
    }
  }

  const Scene scene_;
  double h_;
  int steps_ = 0;
  bool quick_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> bodies_;
  std::vector<std::pair<dJointID, const Joint*>> forces_;
};

}  // namespace

std::string engineVersion() { return "ODE " RIVALS_VERSION; }

std::unique_ptr<Engine> makeEngine(const Scene& scene, double h, Settings& settings) {
  return std::make_unique<Ode>(scene, h, settings);
}

}  // namespace rivals
