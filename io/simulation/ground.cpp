// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/ground.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/collision/lowest_point.hpp"

namespace softgauss {

bool hasFloatingBase(const Model& model) {
  for (const Body& body : model.bodies)
    if (body.joint == JointKind::floating) return true;
  return false;
}

void addGround(ModelBuilder& builder, double height, const Material& material) {
  GeometrySpec plane;
  plane.name = "ground";
  plane.link = "world";
  plane.shape = Shape::plane();
  plane.X_LG.p.z() = height;
  plane.material = material;
  builder.geometry(plane);
}

void standOnGround(const Model& model, double ground, const std::vector<std::string>* links,
                   State& state) {
  Kinematics k(model);
  computeKinematics(model, state, k);
  for (int t = 0; t < static_cast<int>(model.trees.size()); ++t) {
    const Body& root = model.bodies[model.trees[t].rootBody];
    if (root.joint != JointKind::floating) continue;
    const std::string& link = model.bodyNames[model.trees[t].rootBody];
    if (links && std::find(links->begin(), links->end(), link) == links->end()) continue;
    const double lowest = collision::lowestPoint(model, k, t);
    if (std::isfinite(lowest)) state.q[root.q + 2] += ground - lowest;
  }
}

}  // namespace softgauss
