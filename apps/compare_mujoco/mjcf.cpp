// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/mjcf.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <map>
#include <set>

#include "softgauss/engine/constraints/contact.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"

namespace softgauss::app {
namespace {

std::string text(double x) { return fmt::format("{:.17g}", x); }
std::string text(const Vector3& x) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", x.x(), x.y(), x.z());
}

std::string pose(const Transform& X) {
  const Quaternion q(X.R);
  return fmt::format("pos=\"{}\" quat=\"{:.17g} {:.17g} {:.17g} {:.17g}\"", text(X.p), q.w(), q.x(),
                     q.y(), q.z());
}

/// Points of a connection that are nearer than this coincide [m].
constexpr double kTogether = 1e-9;

/// A reference that is given directly is a solref of two negative numbers.
std::string softness(const Impedance& i, const char* suffix = "") {
  return fmt::format(
      "solref{0}=\"{1:.17g} {2:.17g}\" solimp{0}=\"{3:.17g} {4:.17g} {5:.17g} {6:.17g} {7:.17g}\"",
      suffix, i.direct ? -i.direct->stiffness : i.timeConstant,
      i.direct ? -i.direct->damping : i.dampingRatio, i.dMin, i.dMax, i.width, i.midpoint, i.power);
}

/// Writes a model, its bodies depth first.
class Writer {
 public:
  Writer(const Model& model, const collision::PairFilter& filter)
      : model_(model),
        filter_(filter),
        children_(model.bodies.size()),
        geometries_(model.bodies.size()) {
    for (int b = 1; b < model.bodyCount(); ++b)
      children_[idx(model.bodies[idx(b)].parent)].push_back(b);
    for (int g = 0; g < static_cast<int>(model.geometries.size()); ++g)
      geometries_[idx(model.geometries[idx(g)].body)].push_back(g);
    listsPairs_ = !excludeByBody();
  }

  std::string write() {
    if (!model_.welds.empty())
      throw ModelError({}, "model '" + model_.name + "'", "has welds, expected none");
    const Options& o = model_.options;
    const bool gravity = o.effects.has(Effect::gravity);
    line("<mujoco model=\"comparison\">");
    line("<compiler angle=\"radian\" boundmass=\"0\"/>");
    line("<option timestep=\"{}\" gravity=\"{}\" cone=\"{}\" impratio=\"{}\"/>", text(o.timestep),
         text(gravity ? o.gravity : Vector3(Vector3::Zero())),
         o.cone == Cone::elliptic ? "elliptic" : "pyramidal", text(o.impedanceRatio));
    line("<size njmax=\"5000\" nconmax=\"1000\"/>");
    writeMeshes();
    line("<worldbody>");
    for (const int g : geometries_[0]) writeGeometry(g);
    for (const int b : children_[0]) writeBody(b, {}, {});
    line("</worldbody>");
    line("<contact>");
    for (const auto& [a, b] : excluded_)
      line("<exclude body1=\"{}\" body2=\"b{}\"/>", bodyName(a), b);
    if (listsPairs_)
      for (const collision::GeometryPair& pair : filter_.pairs) writePair(pair);
    line("</contact>");
    line("<equality>");
    if (o.effects.has(Effect::equality))
      for (const JointCoupling& coupling : model_.couplings) writeCoupling(coupling);
    if (o.effects.has(Effect::equality))
      for (const Connection& connection : model_.connections) writeConnection(connection);
    line("</equality>");
    line("</mujoco>");
    return std::move(out_);
  }

 private:
  template <class... T>
  void line(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<T>(values)...);
    out_ += '\n';
  }

  /// Whether leaving out pairs of bodies leaves out exactly what our filter does.
  bool excludeByBody() {
    std::map<std::pair<int, int>, int> all, tested;
    const auto bodies = [&](int a, int b) {
      return std::minmax({model_.geometries[idx(a)].body, model_.geometries[idx(b)].body});
    };
    const int count = static_cast<int>(model_.geometries.size());
    for (int a = 0; a < count; ++a)
      for (int b = a + 1; b < count; ++b)
        if (bodies(a, b).first != bodies(a, b).second) ++all[bodies(a, b)];
    for (const collision::GeometryPair& pair : filter_.pairs) ++tested[bodies(pair.a, pair.b)];
    for (const auto& [pair, number] : all) {
      const auto found = tested.find(pair);
      if (found == tested.end()) {
        excluded_.insert(pair);
      } else if (found->second != number) {
        excluded_.clear();
        return false;
      }
    }
    return true;
  }

  void writeMeshes() {
    line("<asset>");
    std::set<const Mesh*> written;
    for (const Geometry& g : model_.geometries) {
      if (!g.shape.isMesh() || !written.insert(g.shape.mesh.get()).second) continue;
      meshNames_[g.shape.mesh.get()] = fmt::format("m{}", written.size());
      std::string vertices;
      for (const Vector3& v : g.shape.mesh->vertices) vertices += text(v) + " ";
      line("<mesh name=\"m{}\" vertex=\"{}\"/>", written.size(), vertices);
    }
    line("</asset>");
  }

  std::string surface(const Material& m) const {
    if (m.spring)
      throw ModelError({}, "model '" + model_.name + "'",
                       "has a contact of N/m, expected the impedance that MuJoCo has");
    return fmt::format("condim=\"{}\" friction=\"{} {} {}\" margin=\"{}\" {}", m.condim,
                       text(m.slidingFriction), text(m.torsionalFriction), text(m.rollingFriction),
                       text(m.margin), softness(m.impedance));
  }

  /// MuJoCo counts the leader from its reference, which is zero here.
  void writeCoupling(const JointCoupling& c) {
    const auto& p = c.polynomial;
    const std::string leader = c.leader == 0 ? "" : fmt::format("joint2=\"j{}\"", c.leader);
    line("<joint joint1=\"j{}\" {} polycoef=\"{} {} {} {} {}\" {}/>", c.follower, leader,
         text(p[0]), text(p[1]), text(p[2]), text(p[3]), text(p[4]), softness(c.impedance));
  }

  /// MuJoCo finds the point of the second body itself, where the first one's is with all joints at
  /// zero; so the two must meet there.
  void writeConnection(const Connection& c) {
    State zero(model_);
    for (const Body& body : model_.bodies)
      if (body.dofs == 1) zero.q[body.q] = 0.0;
    Kinematics k(model_);
    computeKinematics(model_, zero, k);
    const double apart = (k.X_WB[idx(c.bodyA)] * c.p_AP - k.X_WB[idx(c.bodyB)] * c.p_BP).norm();
    if (!(apart < kTogether))
      throw ModelError({}, "model '" + model_.name + "'",
                       fmt::format("has a connection whose points are {:.3g} m apart with all "
                                   "joints at zero, expected less than {:g} m",
                                   apart, kTogether));
    line("<connect body1=\"{}\" body2=\"{}\" anchor=\"{}\" {}/>", bodyName(c.bodyA),
         bodyName(c.bodyB), text(c.p_AP), softness(c.impedance));
  }
  static std::string bodyName(int b) { return b == 0 ? "world" : fmt::format("b{}", b); }

  void writeGeometry(int g) {
    const Geometry& geometry = model_.geometries[idx(g)];
    const Shape& s = geometry.shape;
    std::string shape;
    switch (s.kind) {
      case ShapeKind::plane:
        shape = "type=\"plane\" size=\"0 0 1\"";
        break;
      case ShapeKind::sphere:
        shape = fmt::format("type=\"sphere\" size=\"{}\"", text(s.radius));
        break;
      case ShapeKind::capsule:
      case ShapeKind::cylinder:
        shape = fmt::format("type=\"{}\" size=\"{} {}\"",
                            s.kind == ShapeKind::capsule ? "capsule" : "cylinder", text(s.radius),
                            text(s.halfLength));
        break;
      case ShapeKind::box:
        shape = fmt::format("type=\"box\" size=\"{}\"", text(s.halfExtents));
        break;
      case ShapeKind::ellipsoid:
        shape = fmt::format("type=\"ellipsoid\" size=\"{}\"", text(s.halfExtents));
        break;
      case ShapeKind::mesh:
      case ShapeKind::triangles:  // MuJoCo takes the hull of either
        shape = fmt::format("type=\"mesh\" mesh=\"{}\"", meshNames_.at(s.mesh.get()));
        break;
    }
    const int bits = listsPairs_ ? 0 : 1;
    line("<geom name=\"g{}\" {} {} {} mass=\"0\" contype=\"{}\" conaffinity=\"{}\"/>", g, shape,
         pose(geometry.X_BG), surface(geometry.material), bits, bits);
  }

  void writePair(const collision::GeometryPair& pair) {
    const Material m = pairMaterial(model_, pair.a, pair.b);
    line(
        "<pair geom1=\"g{}\" geom2=\"g{}\" condim=\"{}\" friction=\"{} {} {} {} {}\" margin=\"{}\" "
        "{}/>",
        pair.a, pair.b, m.condim, text(m.slidingFriction), text(m.slidingFriction),
        text(m.torsionalFriction), text(m.rollingFriction), text(m.rollingFriction), text(m.margin),
        softness(m.impedance));
  }

  /// `joints` are those of bodies without mass above this one, X_PB the way from the last body that
  /// was written to the joint's frame.
  void writeBody(int b, const Transform& X_PB, std::vector<std::pair<int, Transform>> joints) {
    const Body& body = model_.bodies[idx(b)];
    const Transform X_here = X_PB * (body.joint == JointKind::floating ? Transform{} : body.X_PB);
    joints.emplace_back(b, X_here);
    if (body.massless && geometries_[idx(b)].empty() && children_[idx(b)].size() == 1) {
      writeBody(children_[idx(b)].front(), X_here, std::move(joints));
      return;
    }
    if (body.massless)
      throw ModelError({}, "body '" + model_.bodyNames[idx(b)] + "'",
                       "has no mass, but shapes or several children; MuJoCo wants mass there");
    if (body.joint == JointKind::floating)
      line("<body name=\"b{}\" pos=\"{}\">", b, text(body.X_PB.p));
    else
      line("<body name=\"b{}\" {}>", b, pose(X_here));
    for (const auto& [joint, X] : joints) writeJoint(joint, X_here.inverse() * X);
    writeInertia(body);
    for (const int g : geometries_[idx(b)]) writeGeometry(g);
    for (const int child : children_[idx(b)]) writeBody(child, {}, {});
    line("</body>");
  }

  /// By principal axes: MuJoCo finds them to eight digits only.
  void writeInertia(const Body& body) {
    const Eigen::SelfAdjointEigenSolver<Matrix3> principal(body.I_Bcm.matrix());
    Transform X_BP{principal.eigenvectors(), body.com};
    if (X_BP.R.determinant() < 0.0) X_BP.R.col(0) *= -1.0;
    line("<inertial {} mass=\"{}\" diaginertia=\"{}\"/>", pose(X_BP), text(body.mass),
         text(Vector3(principal.eigenvalues())));
  }

  void writeJoint(int b, const Transform& X_BodyJoint) {
    const Body& body = model_.bodies[idx(b)];
    if (body.joint == JointKind::floating) {
      line("<joint name=\"j{}\" type=\"free\"/>", b);
      return;
    }
    const EffectSet& effects = model_.options.effects;
    const Dof& dof = model_.dofs[idx(body.v)];
    std::string limits = "limited=\"false\"";
    for (const JointRange& range : model_.ranges)
      if (range.body == b && effects.has(Effect::jointLimit))
        limits =
            fmt::format("limited=\"true\" range=\"{} {}\" margin=\"{}\" {}", text(range.lower),
                        text(range.upper), text(range.margin), softness(range.impedance, "limit"));
    line(
        "<joint name=\"j{}\" type=\"{}\" pos=\"{}\" axis=\"{}\" armature=\"{}\" damping=\"{}\" "
        "frictionloss=\"{}\" stiffness=\"{}\" springref=\"{}\" {} {}/>",
        b, body.joint == JointKind::revolute ? "hinge" : "slide", text(X_BodyJoint.p),
        text(X_BodyJoint.R * body.axis), text(effects.has(Effect::armature) ? dof.armature : 0.0),
        text(effects.has(Effect::damping) ? dof.damping : 0.0),
        text(effects.has(Effect::dryFriction) ? dof.dryFriction : 0.0),
        text(effects.has(Effect::spring) ? dof.stiffness : 0.0), text(dof.springReference),
        softness(dof.frictionImpedance, "friction"), limits);
  }

  const Model& model_;
  const collision::PairFilter& filter_;
  std::vector<std::vector<int>> children_, geometries_;
  std::set<std::pair<int, int>> excluded_;
  bool listsPairs_ = false;
  std::map<const Mesh*, std::string> meshNames_;
  std::string out_;
};

}  // namespace

std::string mjcfOf(const Model& model, const collision::PairFilter& filter) {
  return Writer(model, filter).write();
}

}  // namespace softgauss::app
