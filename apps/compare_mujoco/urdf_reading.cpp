// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/urdf_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "apps/compare_mujoco/mujoco_load.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/engine.hpp"

namespace softgauss::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kStates = 20;
constexpr double kSameShape = 1e-6;  ///< [m] a shape is found where nothing differs by more
constexpr double kRange = 1e-9;      ///< two ranges are the same

Vector3 vectorAt(const mjtNum* x, int i) { return Eigen::Map<const Vector3>(x + 3 * i); }
Matrix3 rotationAt(const mjtNum* q, int i) {
  return Quaternion(q[4 * i], q[4 * i + 1], q[4 * i + 2], q[4 * i + 3]).toRotationMatrix();
}

/// MuJoCo's name of a joint of ours: a planar joint is three in both.
std::string theirJoint(const std::string& name) {
  for (const auto& [ours, theirs] : {std::pair{".x", "_TX"}, {".y", "_TY"}, {".rz", "_RZ"}})
    if (name.size() > std::string(ours).size() && name.ends_with(ours))
      return name.substr(0, name.size() - std::string(ours).size()) + theirs;
  return name;
}

class Reading {
 public:
  Reading(const Model& model, const mjModel& theirs)
      : model_(model), theirs_(theirs), bodies_(model.bodies.size(), -1), dofs_(idx(model.nv)) {}

  Json compare(mjData& data) {
    if (!match()) return result_;
    compareBodies();
    compareJoints();
    compareShapes();
    compareDynamics(data);
    result_["bodies"] = theirs_.nbody - 1;
    for (const auto& [name, value] : largest_) result_[name] = value;
    return result_;
  }

 private:
  void differs(const std::string& text) { result_["differs"].push_back(text); }
  void atLeast(const std::string& name, double value) {
    const auto at = std::find_if(largest_.begin(), largest_.end(),
                                 [&](const auto& entry) { return entry.first == name; });
    if (at == largest_.end())
      largest_.emplace_back(name, value);
    else if (!(value <= at->second))  // NaN stays
      at->second = value;
  }

  /// Finds every body and joint of ours among theirs.
  bool match() {
    result_["differs"] = Json::array();
    if (theirs_.nv != model_.nv || theirs_.nq != model_.nq)
      differs(
          fmt::format("MuJoCo reads {} degrees of freedom, ours has {}", theirs_.nv, model_.nv));
    for (int b = 1; b < model_.bodyCount(); ++b) {
      const Body& body = model_.bodies[idx(b)];
      const std::string& name = model_.bodyNames[idx(b)];
      bodies_[idx(b)] = mj_name2id(&theirs_, mjOBJ_BODY, name.c_str());
      int joint = mj_name2id(&theirs_, mjOBJ_JOINT, theirJoint(model_.jointNames[idx(b)]).c_str());
      if (body.joint == JointKind::floating && bodies_[idx(b)] >= 0)
        joint = theirs_.body_jntadr[bodies_[idx(b)]];
      if (joint < 0) differs(fmt::format("MuJoCo has no joint '{}'", model_.jointNames[idx(b)]));
      if (bodies_[idx(b)] < 0 && !body.massless)
        differs(fmt::format("MuJoCo has no body '{}'", name));
      joints_.push_back(joint);
      for (int k = 0; joint >= 0 && k < body.dofs; ++k)
        dofs_[idx(body.v + k)] = theirs_.jnt_dofadr[joint] + k;
    }
    return result_["differs"].empty();
  }

  void compareBodies() {
    double mass = 0.0;
    for (int b = 1; b < theirs_.nbody; ++b) mass += theirs_.body_mass[b];
    atLeast("total_mass", std::abs(mass - model_.totalMass()) / model_.totalMass());
    for (int b = 1; b < model_.bodyCount(); ++b) {
      const Body& body = model_.bodies[idx(b)];
      const int other = bodies_[idx(b)];
      if (other < 0) continue;
      if (body.joint != JointKind::floating) {
        atLeast("body_position_m",
                (vectorAt(theirs_.body_pos, other) - body.X_PB.p).cwiseAbs().maxCoeff());
        atLeast("body_rotation",
                (rotationAt(theirs_.body_quat, other) - body.X_PB.R).cwiseAbs().maxCoeff());
      }
      if (body.massless) {
        atLeast("body_mass", std::max(0.0, theirs_.body_mass[other] - kLeastInertia));
        continue;
      }
      atLeast("body_mass", std::abs(theirs_.body_mass[other] - body.mass) / body.mass);
      atLeast("centre_of_mass_m",
              (vectorAt(theirs_.body_ipos, other) - body.com).cwiseAbs().maxCoeff());
      const Matrix3 R = rotationAt(theirs_.body_iquat, other), I = body.I_Bcm.matrix();
      const Matrix3 J = R * vectorAt(theirs_.body_inertia, other).asDiagonal() * R.transpose();
      atLeast("inertia", (J - I).cwiseAbs().maxCoeff() / I.cwiseAbs().maxCoeff());
    }
  }

  void compareJoints() {
    for (int b = 1; b < model_.bodyCount(); ++b) {
      const Body& body = model_.bodies[idx(b)];
      const int joint = joints_[idx(b - 1)];
      const std::string& name = model_.jointNames[idx(b)];
      const int kind = body.joint == JointKind::floating    ? mjJNT_FREE
                       : body.joint == JointKind::prismatic ? mjJNT_SLIDE
                                                            : mjJNT_HINGE;
      if (theirs_.jnt_type[joint] != kind)
        differs(fmt::format("joint '{}' is of another kind", name));
      if (kind == mjJNT_FREE) continue;
      atLeast("joint_axis", (vectorAt(theirs_.jnt_axis, joint) - body.axis).cwiseAbs().maxCoeff());
      atLeast("joint_anchor_m", vectorAt(theirs_.jnt_pos, joint).cwiseAbs().maxCoeff());
      const Dof& dof = model_.dofs[idx(body.v)];
      const int v = theirs_.jnt_dofadr[joint];
      const auto relative = [](double x, double y) { return std::abs(x - y) / std::max(1.0, y); };
      atLeast("damping", relative(theirs_.dof_damping[v], dof.damping));
      atLeast("dry_friction", relative(theirs_.dof_frictionloss[v], dof.dryFriction));
      compareRange(b, joint, name);
    }
  }

  void compareRange(int body, int joint, const std::string& name) {
    const auto ours = std::find_if(model_.ranges.begin(), model_.ranges.end(),
                                   [&](const JointRange& r) { return r.body == body; });
    const bool limited = theirs_.jnt_limited[joint] != 0;
    const double lower = theirs_.jnt_range[2 * joint], upper = theirs_.jnt_range[2 * joint + 1];
    if ((ours != model_.ranges.end()) != limited)
      differs(limited ? fmt::format("joint '{}': MuJoCo reads a range {:.4g} .. {:.4g}, ours none",
                                    name, lower, upper)
                      : fmt::format("joint '{}': MuJoCo reads no range, ours {:.4g} .. {:.4g}",
                                    name, ours->lower, ours->upper));
    else if (limited)
      atLeast("joint_range",
              std::max(std::abs(lower - ours->lower), std::abs(upper - ours->upper)));
  }

  /// Shapes have no names in MuJoCo. A capsule of ours is a cylinder and two spheres there; a mesh
  /// is moved to its centre of mass and is only counted.
  void compareShapes() {
    int found = 0, meshes = 0, theirMeshes = 0;
    for (int g = 0; g < theirs_.ngeom; ++g) theirMeshes += theirs_.geom_type[g] == mjGEOM_MESH;
    int ours = 0;
    for (const Geometry& geometry : model_.geometries) {
      if (geometry.shape.kind == ShapeKind::plane) continue;
      ++ours;
      if (geometry.shape.isMesh())
        ++meshes;
      else
        found += hasShape(geometry) ? 1 : 0;
    }
    result_["shapes"] = found + std::min(meshes, theirMeshes);
    result_["shapes_ours"] = ours;
    if (found + std::min(meshes, theirMeshes) != ours)
      differs(
          fmt::format("{} of {} collision shapes are not found", ours - found - theirMeshes, ours));
  }

  bool hasShape(const Geometry& geometry) {
    const Shape& s = geometry.shape;
    const int body = geometry.body == 0 ? 0 : bodies_[idx(geometry.body)];
    const Vector3 up = geometry.X_BG.R.col(2) * s.halfLength;
    const auto has = [&](int kind, const Vector3& size, const Vector3& p, bool oriented) {
      double best = kSameShape;
      for (int g = 0; g < theirs_.ngeom; ++g) {
        if (theirs_.geom_bodyid[g] != body || theirs_.geom_type[g] != kind) continue;
        const Matrix3 R = rotationAt(theirs_.geom_quat, g);
        const Vector3 d = vectorAt(theirs_.geom_size, g) - size;
        double worst = std::max((vectorAt(theirs_.geom_pos, g) - p).cwiseAbs().maxCoeff(),
                                d.head(kind == mjGEOM_BOX        ? 3
                                       : kind == mjGEOM_CYLINDER ? 2
                                                                 : 1)
                                    .cwiseAbs()
                                    .maxCoeff());
        if (oriented) worst = std::max(worst, (R - geometry.X_BG.R).cwiseAbs().maxCoeff());
        best = std::min(best, worst);
      }
      if (best < kSameShape) atLeast("shape_m", best);
      return best < kSameShape;
    };
    const Vector3& p = geometry.X_BG.p;
    const Vector3 ball(s.radius, 0, 0), round(s.radius, s.halfLength, 0);
    switch (s.kind) {
      case ShapeKind::sphere:
        return has(mjGEOM_SPHERE, ball, p, false);
      case ShapeKind::box:
        return has(mjGEOM_BOX, s.halfExtents, p, true);
      case ShapeKind::cylinder:
        return has(mjGEOM_CYLINDER, round, p, true);
      case ShapeKind::capsule:
        return has(mjGEOM_CYLINDER, round, p, true) && has(mjGEOM_SPHERE, ball, p + up, false) &&
               has(mjGEOM_SPHERE, ball, p - up, false);
      default:
        return false;
    }
  }

  /// Any joint anywhere in its range, moving.
  State randomState(std::mt19937_64& random) const {
    const auto uniform = [&](double lower, double upper) {
      return lower + (upper - lower) * 0x1p-64 * static_cast<double>(random());
    };
    State state(model_);
    for (const Body& body : model_.bodies) {
      if (body.joint == JointKind::floating) {
        Eigen::Vector4d q;
        for (int i = 0; i < 4; ++i) q[i] = uniform(-1, 1);
        state.q.segment<4>(body.q + 3) = q.normalized();
      } else if (body.dofs == 1) {
        const double reach = body.joint == JointKind::revolute ? std::numbers::pi : 0.5;
        state.q[body.q] = uniform(-reach, reach);
      }
    }
    for (const JointRange& range : model_.ranges)
      state.q[model_.bodies[idx(range.body)].q] = uniform(range.lower, range.upper);
    for (int i = 0; i < model_.nv; ++i) state.v[i] = uniform(-3, 3);
    return state;
  }

  void compareDynamics(mjData& data) {
    Data ours(model_);
    const InverseWeights& weights = ours.weights;
    for (int b = 1; b < model_.bodyCount(); ++b) {
      const int other = bodies_[idx(b)];
      if (other < 0 || model_.bodies[idx(b)].massless) continue;
      for (const auto& [a, w] :
           {std::pair{0, weights.translation[idx(b)]}, {1, weights.rotation[idx(b)]}})
        atLeast("inverse_weight", std::abs(theirs_.body_invweight0[2 * other + a] - w) / w);
    }
    for (int i = 0; i < model_.nv; ++i)
      atLeast("inverse_weight",
              std::abs(theirs_.dof_invweight0[dofs_[idx(i)]] - weights.dof[idx(i)]) /
                  weights.dof[idx(i)]);
    std::mt19937_64 random(1);
    TreeFactor factor;
    MatrixX full(model_.nv, model_.nv);
    for (int n = 0; n < kStates; ++n) {
      const State state = randomState(random);
      computeStages(model_, {}, state, ours, nullptr);
      for (int b = 1; b < model_.bodyCount(); ++b) {
        const Body& body = model_.bodies[idx(b)];
        const int joint = joints_[idx(b - 1)];
        for (int k = 0; k < (body.dofs == 6 ? 7 : 1); ++k)
          data.qpos[theirs_.jnt_qposadr[joint] + k] = state.q[body.q + k];
      }
      for (int i = 0; i < model_.nv; ++i) data.qvel[dofs_[idx(i)]] = state.v[i];
      mj_forward(&theirs_, &data);
      for (int j = 0; j < model_.nv; ++j)
        mj_mulM(&theirs_, &data, full.col(j).data(), VectorX::Unit(model_.nv, j).eval().data());
      const MatrixX M = ours.inertia.M.dense();
      VectorX a = ours.forces.net, other(model_.nv);
      factor.compute(ours.inertia.M);
      factor.solve(a);
      for (int i = 0; i < model_.nv; ++i) {
        other[i] = data.qacc_smooth[dofs_[idx(i)]];
        for (int j = 0; j < model_.nv; ++j)
          atLeast("mass_matrix", std::abs(full(dofs_[idx(i)], dofs_[idx(j)]) - M(i, j)) /
                                     std::sqrt(M(i, i) * M(j, j)));
      }
      atLeast("smooth_acceleration", (other - a).cwiseAbs().maxCoeff() / a.cwiseAbs().maxCoeff());
    }
  }

  const Model& model_;
  const mjModel& theirs_;
  std::vector<int> bodies_;  ///< theirs of each of ours, −1: none
  std::vector<int> joints_;  ///< theirs of the joint of body i + 1
  std::vector<int> dofs_;
  std::vector<std::pair<std::string, double>> largest_;
  Json result_;
};

}  // namespace

Json compareReading(const Model& model, const UrdfCopy& copy) {
  Json result;
  try {
    const std::unique_ptr<mjModel, void (*)(mjModel*)> theirs(
        loadMujoco("robot.urdf", copy.urdf, copy.meshes), mj_deleteModel);
    theirs->opt.disableflags |= mjDSBL_CONSTRAINT;
    const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(theirs.get()), mj_deleteData);
    result = Reading(model, *theirs).compare(*data);
  } catch (const ModelError& error) {
    result["refused"] = error.what();
  }
  result["not_read"] = copy.notRead;
  return result;
}

}  // namespace softgauss::app
