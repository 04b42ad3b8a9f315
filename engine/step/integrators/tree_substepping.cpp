// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/tree_substepping.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/memory.hpp"
#include "softgauss/engine/step/data.hpp"
#include "softgauss/engine/step/integrators/tree_rotation.hpp"

namespace softgauss {

TreeSubstepping::TreeSubstepping(const Model& model)
    : held_(VectorX::Zero(model.nv)), motion_(model) {}

std::size_t TreeSubstepping::bytes() const { return bytesOfAll(held_) + motion_.bytes(); }

bool TreeSubstepping::integrate(const Model& model, const SubstepSelection& substepSelection,
                                const State& start, Data& data, State& end) {
  const double h = model.options.timestep;
  const SmoothForces& forces = data.forces;
  held_ = forces.tau + forces.push;
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    if (!substepSelection.free[t]) continue;
    const Tree& tree = model.trees[t];
    const Body& root = model.bodies[tree.rootBody];
    const int first = tree.firstDof, dofs = tree.dofEnd - first;
    Vector3 inWorld = Vector3::Zero();
    int coordinates = dofs;
    if (root.joint == JointKind::floating) {  // wrenches keep their direction in the world
      inWorld = data.kinematics.X_WB[tree.rootBody].R * forces.push.segment<3>(root.v + 3);
      held_.segment<3>(root.v + 3) = forces.tau.segment<3>(root.v + 3);
      ++coordinates;
    }
    const TreeMotion::Outcome outcome =
        motion_.run(model, data.plan, tree, start, held_, inWorld, data.inertia.motionScale, h);
    data.stats.substeps += motion_.substeps();
    if (outcome == TreeMotion::Outcome::notFinite) return false;
    if (outcome == TreeMotion::Outcome::limit) {
      ++data.stats.abandonedTrees;
      continue;
    }
    ++data.stats.substeppedTrees;
    end.v.segment(first, dofs) = motion_.v().segment(first, dofs);
    end.q.segment(root.q, coordinates) = motion_.q().segment(root.q, coordinates);
    end.a.segment(first, dofs) = motion_.vdot().segment(first, dofs);
    data.acceleration.segment(first, dofs) =
        (end.v.segment(first, dofs) - start.v.segment(first, dofs)) / h;
  }
  return true;
}

}  // namespace softgauss
