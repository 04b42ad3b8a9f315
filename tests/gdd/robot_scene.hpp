// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The robots of data/robots with a controller, as simulate_gdd sets them up.

#include <cmath>
#include <memory>

#include "softgauss/collision/lowest_point.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/urdf.hpp"

namespace softgauss::test {

inline constexpr double kWeight = 400.0;  ///< of the humanoid [N]

/// A cart that slides along x, without gravity. `slide`: its range and effort; the rest is set.
inline Model slidingCart(double mass, JointSpec slide = {}) {
  ModelBuilder builder;
  LinkSpec world, cart;
  world.name = "world";
  cart.name = "cart";
  cart.mass = mass;
  cart.I_Lcm = Matrix3::Identity();
  slide.name = "slide";
  slide.type = JointType::prismatic;
  slide.parent = "world";
  slide.child = "cart";
  Model model = builder.link(world).link(cart).joint(slide).build();
  model.options.gravity.setZero();
  return model;
}

struct RobotScene {
  Model model;
  State state;
  Data data;
  collision::SceneContacts contacts;
  gdd::GoalDirectedController controller;
  Input input;

  /// A floating robot stands or lies on the ground. `fixtures` belong to the world.
  explicit RobotScene(const std::string& robot, const std::vector<GeometrySpec>& fixtures = {})
      : model(load(robot, fixtures)),
        state(model),
        data(model),
        contacts(model),
        controller(model) {
    Kinematics k(model);
    computeKinematics(model, state, k);
    const Body& root = model.bodies[model.trees[0].rootBody];
    if (root.joint == JointKind::floating)
      state.q[root.q + 2] -= collision::lowestPoint(model, k, 0);
  }

  gdd::Reach& addReach(const std::string& link, const Vector3& target) {
    auto goal = std::make_unique<gdd::Reach>(model, link, target);
    gdd::Reach& reach = *goal;
    controller.goals.push_back(std::move(goal));
    return reach;
  }
  gdd::VirtualDamping& addDamping() {
    auto goal = std::make_unique<gdd::VirtualDamping>();
    gdd::VirtualDamping& damping = *goal;
    controller.goals.push_back(std::move(goal));
    return damping;
  }
  gdd::Posture& addPosture() {
    auto goal = std::make_unique<gdd::Posture>(state.q);
    gdd::Posture& posture = *goal;
    controller.goals.push_back(std::move(goal));
    return posture;
  }

  /// Where a test has changed the model: data for the new one.
  void renew() {
    if (data.plan.fits(model)) return;
    std::destroy_at(&data);
    std::construct_at(&data, model);
  }
  SolveStatus step() {
    renew();
    return controller.step(model, input, state, data, &contacts);
  }

  Vector3 position(const std::string& link) {
    Kinematics k(model);
    computeKinematics(model, state, k);
    return framePose(model, k, model.findFrame(link)).p;
  }

  /// Every control inside its box, exactly, and none on a dof that has no actuator.
  bool controlsAllowed() const {
    bool allowed = true;
    for (int i = 0; i < model.nv; ++i) {
      const Dof& dof = model.dofs[i];
      const double u = controller.control[i];
      allowed &= dof.actuated ? u >= dof.effortLower && u <= dof.effortUpper : u == 0.0;
      allowed &= u == data.forces.tau[i];
    }
    return allowed;
  }

 private:
  static Model load(const std::string& robot, const std::vector<GeometrySpec>& fixtures) {
    ModelBuilder builder =
        io::readUrdf(std::string(SOFTGAUSS_SOURCE_DIR) + "/data/robots/" + robot + ".urdf");
    for (const GeometrySpec& fixture : fixtures) builder.geometry(fixture);
    if (robot == "arm") return builder.build();
    GeometrySpec plane;
    plane.name = "ground";
    plane.link = "world";
    plane.shape = Shape::plane();
    return builder.geometry(plane).build();
  }
};

}  // namespace softgauss::test
