// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/model_builder.hpp"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/model/capsule_recognition.hpp"
#include "softgauss/engine/model/detail/contact_pairs.hpp"
#include "softgauss/engine/model/detail/equalities.hpp"
#include "softgauss/engine/model/detail/follower_ranges.hpp"
#include "softgauss/engine/model/detail/kinematic_tree.hpp"
#include "softgauss/engine/model/detail/leader_inertia.hpp"
#include "softgauss/engine/model/detail/spec_checks.hpp"
#include "softgauss/engine/model/followers.hpp"

namespace softgauss {

ModelBuilder& ModelBuilder::link(LinkSpec spec) {
  links_.push_back(std::move(spec));
  return *this;
}
ModelBuilder& ModelBuilder::joint(JointSpec spec) {
  joints_.push_back(std::move(spec));
  return *this;
}
ModelBuilder& ModelBuilder::geometry(GeometrySpec spec) {
  geometries_.push_back(std::move(spec));
  return *this;
}
ModelBuilder& ModelBuilder::pair(PairSpec spec) {
  pairs_.push_back(std::move(spec));
  return *this;
}

ModelBuilder& ModelBuilder::keepApart(std::string linkA, std::string linkB) {
  apart_.emplace_back(std::move(linkA), std::move(linkB));
  return *this;
}
ModelBuilder& ModelBuilder::connect(ConnectSpec spec) {
  connections_.push_back(std::move(spec));
  return *this;
}
ModelBuilder& ModelBuilder::weld(WeldSpec spec) {
  welds_.push_back(std::move(spec));
  return *this;
}
ModelBuilder& ModelBuilder::couple(CouplingSpec spec) {
  couplings_.push_back(std::move(spec));
  return *this;
}
ModelBuilder& ModelBuilder::visual(VisualSpec spec) {
  visuals_.push_back(std::move(spec));
  return *this;
}
ModelBuilder& ModelBuilder::warning(std::string text) {
  warnings_.push_back(std::move(text));
  return *this;
}

namespace {

bool isWorld(const LinkSpec& link) { return link.name == "world"; }

/// Where a link ended up: a pose in a body.
struct Placement {
  int body = 0;
  Transform X_BL;
  int base = -1;  ///< Geometry::base of its geometries
};

/// Turns checked specs into a Model, link by link, parents first.
class Assembler {
 public:
  Assembler(Model& model, const std::vector<LinkSpec>& links, const std::vector<JointSpec>& joints)
      : model_(model), links_(links), joints_(joints), placement_(links.size()) {
    Body world;
    world.subtreeEnd = 1;
    model_.bodies.push_back(world);
    model_.bodyNames.emplace_back("world");
    model_.jointNames.emplace_back();
    merged_.emplace_back();
  }

  /// A root link: the world itself, a part of it that has a name (standsForWorld), welded to the
  /// world, or free.
  void addRoot(int link, BaseKind base, const Transform& X_WRoot, bool standsForWorld) {
    const LinkSpec& spec = links_[static_cast<std::size_t>(link)];
    robot_ = robots_++;
    const bool floats =
        base == BaseKind::floating || (base == BaseKind::automatic && !isWorld(spec));
    if (isWorld(spec)) {
      const bool carriesWhatFloats =
          std::any_of(joints_.begin(), joints_.end(), [&](const JointSpec& joint) {
            return joint.type == JointType::floating && joint.parent == spec.name;
          });
      if (base == BaseKind::floating && !carriesWhatFloats)
        throw ModelError(spec.where, "link 'world'",
                         "is the root and stands for the world, which cannot float as the base is "
                         "asked to; expected a fixed base, or another name for the link");
      place(link, {0, Transform{}});
    } else if (!floats) {
      place(link, {0, X_WRoot, standsForWorld ? -1 : bases_++});
    } else {
      const int body = addBody(JointKind::floating, 0, X_WRoot, Vector3::UnitZ(), spec.name, link);
      place(link, {body, Transform{}});
    }
  }

  void addJoint(const detail::TreeEdge& edge, bool zeroEffortIsUnlimited) {
    const JointSpec& joint = joints_[static_cast<std::size_t>(edge.joint)];
    const Placement parent = placement_[static_cast<std::size_t>(edge.parent)];
    const Transform X_BC = parent.X_BL * joint.X_PC;
    const Vector3 axis = joint.axis.normalized();
    switch (joint.type) {
      case JointType::fixed: {
        // What is fixed to the world itself is a base, or scenery: what hangs from it shows.
        const bool startsBase = parent.body == 0 && parent.base < 0;
        place(edge.child, {parent.body, X_BC, startsBase ? bases_++ : parent.base});
        return;
      }
      case JointType::floating: {
        if (parent.body != 0)
          throw ModelError(joint.where, "joint '" + joint.name + "'",
                           "a floating joint hangs from '" + joint.parent +
                               "', which moves; expected the world or a link fixed to it");
        place(edge.child,
              {addBody(JointKind::floating, 0, X_BC, axis, joint.name, edge.child), {}});
        return;
      }
      case JointType::planar: {
        // Two slides along the plane, then a hinge about its normal, as three bodies.
        const Matrix3 R = Quaternion::FromTwoVectors(Vector3::UnitZ(), axis).toRotationMatrix();
        int body = addBody(JointKind::prismatic, parent.body, X_BC, R.col(0),
                           joint.name + detail::kPlanarParts[0], -1);
        addDofData(body, joint, false);
        body = addBody(JointKind::prismatic, body, {}, R.col(1),
                       joint.name + detail::kPlanarParts[1], -1);
        addDofData(body, joint, false);
        body = addBody(JointKind::revolute, body, {}, axis, joint.name + detail::kPlanarParts[2],
                       edge.child);
        addDofData(body, joint, false);
        place(edge.child, {body, {}, parent.base});
        return;
      }
      case JointType::revolute:
      case JointType::continuous:
      case JointType::prismatic: {
        const JointKind kind =
            joint.type == JointType::prismatic ? JointKind::prismatic : JointKind::revolute;
        const int body = addBody(kind, parent.body, X_BC, axis, joint.name, edge.child);
        const bool powerless = joint.effort && *joint.effort == 0.0 && !zeroEffortIsUnlimited;
        if (powerless && !joint.mimic && joint.actuated) powerless_.push_back(joint.name);
        addDofData(body, joint, joint.actuated && !powerless && !joint.mimic);
        model_.bodies[idx(body)].reference = joint.reference;
        place(edge.child, {body, {}, parent.base});
        if (joint.type != JointType::continuous && joint.lower && joint.upper) {
          JointRange range;
          range.body = body;
          range.lower = *joint.lower;
          range.upper = *joint.upper;
          range.margin = joint.limitMargin;
          range.impedance = joint.limitImpedance;
          model_.ranges.push_back(range);
        }
        return;
      }
    }
  }

  const Placement& placement(int link) const { return placement_[static_cast<std::size_t>(link)]; }

  /// Trees, subtrees, ancestor dofs and the checks that need the merged bodies.
  void finish() {
    for (int b = model_.bodyCount() - 1; b > 0; --b) {
      Body& parent = model_.bodies[static_cast<std::size_t>(model_.bodies[idx(b)].parent)];
      parent.subtreeEnd = std::max(parent.subtreeEnd, model_.bodies[idx(b)].subtreeEnd);
    }
    for (int b = 1; b < model_.bodyCount(); ++b) {
      const Body& body = model_.bodies[idx(b)];
      if (body.parent != 0) continue;
      const Body& last = model_.bodies[idx(body.subtreeEnd - 1)];
      Tree tree{b, body.subtreeEnd, body.v, last.v + last.dofs};
      for (int i = b; i < body.subtreeEnd; ++i) {
        model_.bodies[idx(i)].tree = static_cast<int>(model_.trees.size());
        tree.mass += model_.bodies[idx(i)].mass;
      }
      for (int i = tree.firstDof; i < tree.dofEnd; ++i)
        tree.actuated = tree.actuated || model_.dofs[idx(i)].actuated;
      model_.trees.push_back(tree);
    }
    detail::addLeaderArmature(model_);
    detail::checkMovingInertias(model_, merged_);
    if (!negative_.empty())
      model_.warnings.push_back(
          "inertia with a negative principal moment, used as written, as the bodies that these "
          "links are part of are sound:" +
          negative_);
    if (!powerless_.empty()) {
      std::string text = "effort 0: not actuated (--zero-effort unlimited changes this):";
      for (const std::string& name : powerless_) text += " " + name;
      model_.warnings.push_back(text);
    }
  }

 private:
  int addBody(JointKind kind, int parent, const Transform& X_PB, const Vector3& axis,
              const std::string& jointName, int link) {
    Body body;
    body.joint = kind;
    body.parent = parent;
    // The limbs of a fixed base are one robot, though each is a tree; what floats is one of its
    // own.
    body.robot = parent != 0                   ? model_.bodies[idx(parent)].robot
                 : kind == JointKind::floating ? robots_++
                                               : robot_;
    body.q = model_.nq;
    body.v = model_.nv;
    body.dofs = kind == JointKind::floating ? 6 : 1;
    body.X_PB = X_PB;
    body.axis = axis;
    const int index = model_.bodyCount();
    body.subtreeEnd = index + 1;
    model_.bodies.push_back(body);
    model_.bodyNames.push_back(link < 0 ? jointName : links_[idx(link)].name);
    model_.jointNames.push_back(jointName);
    merged_.push_back({link < 0 ? nullptr : &links_[idx(link)], nullptr});
    const Body& up = model_.bodies[idx(parent)];
    for (int k = 0; k < body.dofs; ++k) {
      Dof dof;
      dof.body = index;
      dof.parent = k > 0 ? model_.nv + k - 1 : (up.dofs > 0 ? up.v + up.dofs - 1 : -1);
      model_.dofs.push_back(dof);
    }
    model_.nv += body.dofs;
    model_.nq += kind == JointKind::floating ? 7 : 1;
    return index;
  }

  void addDofData(int body, const JointSpec& joint, bool actuated) {
    Dof& dof = model_.dofs[idx(model_.bodies[idx(body)].v)];
    dof.damping = joint.damping;
    dof.dryFriction = joint.dryFriction;
    dof.frictionImpedance = joint.frictionImpedance;
    dof.armature = joint.armature;
    dof.stiffness = joint.stiffness;
    dof.springReference = joint.springReference;
    dof.actuated = actuated;
    dof.servo = joint.servo;
    if (joint.effort && *joint.effort > 0.0)
      dof.servo.effort = std::min(dof.servo.effort, *joint.effort);
    if (joint.effort && *joint.effort > 0.0) {
      dof.effortLower = -*joint.effort;
      dof.effortUpper = *joint.effort;
    }
    if (joint.velocity && *joint.velocity > 0.0) dof.velocityLimit = *joint.velocity;
  }

  /// Fixes a link to a body: a frame keeps its name, the body gains its inertia.
  void place(int link, const Placement& where) {
    placement_[idx(link)] = where;
    const LinkSpec& spec = links_[idx(link)];
    model_.frames.push_back({spec.name, where.body, where.X_BL});
    Body& body = model_.bodies[idx(where.body)];
    if (detail::hasNegativeMoment(spec)) {
      negative_ += " " + spec.name;
      if (!merged_[idx(where.body)].negative) merged_[idx(where.body)].negative = &spec;
    }
    if (where.body == 0 || (spec.mass == 0.0 && spec.I_Lcm.isZero(0.0))) return;

    // Parallel axes about the combined centre of mass.
    const Vector3 com = where.X_BL * spec.com;
    const Symmetric3 I = rotated(where.X_BL.R, Symmetric3::fromMatrix(spec.I_Lcm));
    const double mass = body.mass + spec.mass;
    Symmetric3 sum = body.I_Bcm;
    sum += I;
    if (mass > 0.0) {
      const Vector3 d = com - body.com;
      const double reduced = body.mass * spec.mass / mass;
      sum += Inertia::fromCentral(reduced, d, {}).I_O;
      body.com = (body.mass * body.com + spec.mass * com) / mass;
    }
    body.mass = mass;
    body.I_Bcm = sum;
    body.massless = false;
    if (const double borne = spec.gravityCompensation * spec.mass; borne != 0.0) {
      const double all = body.borneMass + borne;
      if (all != 0.0) body.borneCom = (body.borneMass * body.borneCom + borne * com) / all;
      body.borneMass = all;
    }
  }

  Model& model_;
  const std::vector<LinkSpec>& links_;
  const std::vector<JointSpec>& joints_;
  std::vector<Placement> placement_;
  std::vector<detail::MergedBody> merged_;  ///< of each body
  std::string negative_;                    ///< names of links with a negative principal moment
  std::vector<std::string> powerless_;
  int robots_ = 0;  ///< so far
  int robot_ = -1;  ///< of the present root
  int bases_ = 0;   ///< so far
};

/// Configuration at the joints' references, zero unless they say otherwise, or at the middle of the
/// range where that lies outside it; a joint that follows another where its coupling wants it.
VectorX initialConfiguration(const Model& model) {
  VectorX q = VectorX::Zero(model.nq);
  for (const Body& body : model.bodies) {
    if (body.dofs == 1) q[body.q] = body.reference;
    if (body.joint != JointKind::floating) continue;
    q.segment<3>(body.q) = body.X_PB.p;
    const Quaternion r(body.X_PB.R);
    q.segment<4>(body.q + 3) << r.w(), r.x(), r.y(), r.z();
  }
  for (const JointRange& range : model.ranges) {
    const int i = model.bodies[static_cast<std::size_t>(range.body)].q;
    if (range.lower > q[i] || range.upper < q[i]) q[i] = 0.5 * (range.lower + range.upper);
  }
  placeFollowers(model, {}, q);
  return q;
}

}  // namespace

JointSpec* ModelBuilder::findJoint(const std::string& name) {
  const auto it = std::find_if(joints_.begin(), joints_.end(),
                               [&](const JointSpec& joint) { return joint.name == name; });
  return it == joints_.end() ? nullptr : &*it;
}

Model ModelBuilder::build() const {
  for (const LinkSpec& link : links_) detail::checkLink(link);
  for (const JointSpec& joint : joints_) detail::checkJoint(joint);
  detail::checkOptions(options);
  const detail::LinkOrder order = detail::orderLinks(name_, links_, joints_);

  Model model;
  model.name = name_;
  model.options = options;
  model.options.effects = options.effects & kBuiltEffects;
  model.warnings = warnings_;
  Assembler assembler(model, links_, joints_);
  std::unordered_map<std::string_view, const Root*> roots;
  for (const Root& root : roots_) roots.emplace(root.link, &root);
  for (const detail::TreeEdge& edge : order.visits) {
    if (edge.joint < 0) {
      const auto found = roots.find(links_[static_cast<std::size_t>(edge.child)].name);
      if (found == roots.end())
        assembler.addRoot(edge.child, base, X_WRoot, false);
      else
        assembler.addRoot(edge.child, found->second->base, found->second->X_WRoot,
                          found->second->isWorld);
    } else
      assembler.addJoint(edge, zeroEffortIsUnlimited);
  }

  const auto placementOf = [&](const std::string& link, const SourceLocation& where,
                               const std::string& element) {
    const int index = order.find(link);
    if (index >= 0) return assembler.placement(index);
    if (link == "world") return Placement{};
    throw ModelError(where, element, "is on link '" + link + "', which does not exist");
  };
  for (const GeometrySpec& spec : geometries_) detail::checkGeometry(spec, options);
  for (const GeometrySpec& spec : recogniseCapsules(geometries_)) {
    const Placement at = placementOf(spec.link, spec.where, "geometry '" + spec.name + "'");
    model.geometries.push_back({spec.name, spec.link, at.body, at.X_BL * spec.X_LG, spec.shape,
                                spec.material, at.base, spec.automaticMesh, spec.bits});
  }
  for (const VisualSpec& spec : visuals_) {
    const Placement at = placementOf(spec.link, {}, "visual");
    model.visuals.push_back({spec.link, at.body, at.X_BL * spec.X_LG, spec.shape, spec.rgba});
  }
  detail::addContactPairs(model, pairs_);
  model.apart = apart_;
  detail::addConnections(model, connections_);
  detail::addWelds(model, welds_);
  detail::addCouplings(model, joints_, couplings_);
  assembler.finish();
  model.q0 = initialConfiguration(model);
  detail::relaxFollowerRanges(model);
  return model;
}

}  // namespace softgauss
