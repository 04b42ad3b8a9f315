// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/detail/equalities.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "softgauss/engine/model/detail/spec_checks.hpp"

namespace softgauss::detail {
namespace {

/// Frames by name, the first of each.
class Frames {
 public:
  explicit Frames(const Model& model) {
    for (const Frame& frame : model.frames) frames_.emplace(frame.name, &frame);
  }

  /// The frame of a link, or of the world.
  Frame at(const std::string& link, const SourceLocation& where, const std::string& element) const {
    const auto found = frames_.find(link);
    if (found != frames_.end()) return *found->second;
    if (link != "world")
      throw ModelError(where, element, "is on link '" + link + "', which does not exist");
    return {link, 0, Transform{}};
  }

 private:
  std::unordered_map<std::string_view, const Frame*> frames_;
};

void checkPair(const Frame& a, const Frame& b, const SourceLocation& where,
               const std::string& element) {
  if (a.body == b.body)
    throw ModelError(where, element,
                     "joins two links that cannot move against each other; expected links on "
                     "different sides of a joint");
}

void checkPose(const Transform& X, const SourceLocation& where, const std::string& element) {
  if (!X.R.allFinite() || !X.p.allFinite()) throw ModelError(where, element, "pose is not finite");
}

/// The body that a joint of one degree of freedom carries.
int scalarJoint(const Model& model, const std::string& name, const SourceLocation& where,
                const std::string& element, const char* verb) {
  const int body = model.findJoint(name);
  if (body < 0)
    throw ModelError(where, element,
                     std::string(verb) + " '" + name + "', which is not a moving joint");
  if (model.bodies[static_cast<std::size_t>(body)].dofs != 1)
    throw ModelError(where, element,
                     std::string(verb) + " '" + name +
                         "', which has more than one degree of freedom; expected a revolute, "
                         "continuous or prismatic joint");
  return body;
}

/// The coupling by which a body's joint follows, or null.
const JointCoupling* couplingOf(const Model& model, int follower) {
  const auto it = std::find_if(model.couplings.begin(), model.couplings.end(),
                               [&](const JointCoupling& c) { return c.follower == follower; });
  return it == model.couplings.end() ? nullptr : &*it;
}

/// Adds a coupling. A follower may lead another, but follow only one, and not, by some detour,
/// itself.
void addCoupling(Model& model, const JointCoupling& coupling, const SourceLocation& where,
                 const std::string& element) {
  for (const double c : coupling.polynomial)
    if (!std::isfinite(c)) throw ModelError(where, element, "coefficient is not finite");
  checkImpedance(coupling.impedance, where, element);
  if (couplingOf(model, coupling.follower) != nullptr)
    throw ModelError(where, element, "follows two joints, expected one");
  for (int body = coupling.leader; body != 0;) {
    if (body == coupling.follower)
      throw ModelError(where, element,
                       "mimics itself by way of other joints; expected a leader that follows none "
                       "of its followers");
    const JointCoupling* next = couplingOf(model, body);
    body = next ? next->leader : 0;
  }
  model.couplings.push_back(coupling);
}

TieCenters centersOf(const Model& model, const Frame& a, const std::optional<Vector3>& comA,
                     const Frame& b, const std::optional<Vector3>& comB) {
  const auto center = [&](const Frame& frame, const std::optional<Vector3>& com) -> Vector3 {
    if (com) return frame.X_BF * *com;
    return model.bodies[static_cast<std::size_t>(frame.body)].com;
  };
  return {center(a, comA), center(b, comB)};
}

}  // namespace

void addConnections(Model& model, const std::vector<ConnectSpec>& specs) {
  if (specs.empty()) return;
  const Frames frames(model);
  for (const ConnectSpec& spec : specs) {
    const std::string element = "connection '" + spec.linkA + "' - '" + spec.linkB + "'";
    const Frame a = frames.at(spec.linkA, spec.where, element);
    const Frame b = frames.at(spec.linkB, spec.where, element);
    checkPair(a, b, spec.where, element);
    checkPose({Matrix3::Identity(), spec.p_LAP}, spec.where, element);
    checkPose({Matrix3::Identity(), spec.p_LBP}, spec.where, element);
    checkImpedance(spec.impedance, spec.where, element);
    model.connections.push_back({a.body, b.body, a.X_BF * spec.p_LAP, b.X_BF * spec.p_LBP,
                                 spec.impedance, centersOf(model, a, spec.comA, b, spec.comB)});
  }
}

void addWelds(Model& model, const std::vector<WeldSpec>& specs) {
  if (specs.empty()) return;
  const Frames frames(model);
  for (const WeldSpec& spec : specs) {
    const std::string element = "weld '" + spec.linkA + "' - '" + spec.linkB + "'";
    const Frame a = frames.at(spec.linkA, spec.where, element);
    const Frame b = frames.at(spec.linkB, spec.where, element);
    checkPair(a, b, spec.where, element);
    checkPose(spec.X_LAF, spec.where, element);
    checkPose(spec.X_LBF, spec.where, element);
    checkImpedance(spec.impedance, spec.where, element);
    if (!(spec.torqueScale > 0.0) || !std::isfinite(spec.torqueScale))
      throw ModelError(spec.where, element, "torque scale is not positive");
    model.welds.push_back({a.body, b.body, a.X_BF * spec.X_LAF, b.X_BF * spec.X_LBF,
                           spec.torqueScale, spec.impedance,
                           centersOf(model, a, spec.comA, b, spec.comB)});
  }
}

void addCouplings(Model& model, const std::vector<JointSpec>& joints,
                  const std::vector<CouplingSpec>& specs) {
  for (const JointSpec& joint : joints) {
    if (!joint.mimic) continue;
    const std::string element = "joint '" + joint.name + "'";
    JointCoupling coupling;
    coupling.follower = scalarJoint(model, joint.name, joint.where, element, "a mimic moves");
    coupling.leader = scalarJoint(model, joint.mimic->leader, joint.where, element, "mimics");
    coupling.polynomial = {joint.mimic->offset, joint.mimic->multiplier, 0.0, 0.0, 0.0};
    addCoupling(model, coupling, joint.where, element);
  }
  for (const CouplingSpec& spec : specs) {
    const std::string element = "coupling of joint '" + spec.follower + "'";
    JointCoupling coupling;
    coupling.follower = scalarJoint(model, spec.follower, spec.where, element, "moves");
    if (!spec.leader.empty())
      coupling.leader = scalarJoint(model, spec.leader, spec.where, element, "follows");
    coupling.polynomial = spec.polynomial;
    coupling.impedance = spec.impedance;
    addCoupling(model, coupling, spec.where, element);
  }
}

}  // namespace softgauss::detail
