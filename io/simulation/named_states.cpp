// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/named_states.hpp"

#include <cmath>

#include "softgauss/collision/lowest_point.hpp"

namespace softgauss {
namespace {

/// The kinematic tree that floats and holds joints that a state names; −1: none does.
int floatingTreeOf(const Model& model, const io::RobotSrdf& robot, const std::string& state) {
  for (const auto& [joint, value] : robot.srdf.positions(state)) {
    const int body = model.findJoint(robot.prefix + joint);
    if (body < 0) continue;
    const int tree = model.bodies[idx(body)].tree;
    if (tree >= 0 && model.floats(tree)) return tree;
  }
  return -1;
}

double lowestPointAt(const Model& model, int tree, const VectorX& q) {
  State state(model);
  state.q = q;
  Kinematics k(model);
  computeKinematics(model, state, k);
  return collision::lowestPoint(model, k, tree);
}

}  // namespace

std::vector<std::pair<std::string, VectorX>> namedStates(const Scene& scene) {
  const Model& model = scene.model;
  std::vector<std::pair<std::string, VectorX>> states;
  for (const io::RobotSrdf& robot : scene.srdfs)
    for (const std::string& name : robot.srdf.stateNames()) {
      VectorX q = scene.initial.q;
      io::placeState(model, robot.srdf, name, robot.prefix, q);
      if (const int tree = floatingTreeOf(model, robot, name); tree >= 0) {
        const double raise =
            lowestPointAt(model, tree, scene.initial.q) - lowestPointAt(model, tree, q);
        if (std::isfinite(raise))
          q[model.bodies[idx(model.trees[idx(tree)].rootBody)].q + 2] += raise;
      }
      states.emplace_back(robot.prefix + name, std::move(q));
    }
  return states;
}

}  // namespace softgauss
