// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/robot.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/collision/lowest_point.hpp"
#include "softgauss/io/urdf.hpp"

namespace softgauss::app {

Model loadRobot(const RobotFile& robot, bool likeMujoco) {
  io::UrdfOptions options;
  options.packagePaths = robot.packagePaths;
  options.base = robot.base == "fixed"      ? BaseKind::fixed
                 : robot.base == "floating" ? BaseKind::floating
                                            : BaseKind::automatic;
  ModelBuilder builder = io::readUrdf(robot.file, options);
  builder.options.timestep = robot.timestep;
  builder.options.useMujocoModel(likeMujoco);
  Model model = builder.build();
  const auto floats = [](const Body& body) { return body.joint == JointKind::floating; };
  if (std::none_of(model.bodies.begin(), model.bodies.end(), floats)) return model;
  GeometrySpec plane;
  plane.name = "ground";
  plane.link = "world";
  plane.shape = Shape::plane();
  return builder.geometry(plane).build();
}

State standingState(const Model& model) {
  State state(model);
  Kinematics k(model);
  computeKinematics(model, state, k);
  for (int t = 0; t < static_cast<int>(model.trees.size()); ++t) {
    const Body& root = model.bodies[model.trees[t].rootBody];
    const double lowest = collision::lowestPoint(model, k, t);
    if (root.joint == JointKind::floating && std::isfinite(lowest)) state.q[root.q + 2] -= lowest;
  }
  return state;
}

VectorX swingingControl(const Model& model, double time) {
  constexpr double kShare = 0.05;      // of the effort limit
  constexpr double kUnlimited = 10.0;  // [N m or N], where there is none
  VectorX tau = VectorX::Zero(model.nv);
  for (int i = 0; i < model.nv; ++i) {
    const Dof& dof = model.dofs[static_cast<std::size_t>(i)];
    if (!dof.actuated) continue;
    const double effort = std::isfinite(dof.effortUpper) ? dof.effortUpper : kUnlimited;
    tau[i] = kShare * effort * std::sin((3.0 + 0.7 * (i % 7)) * time + i);
  }
  return tau;
}

}  // namespace softgauss::app
