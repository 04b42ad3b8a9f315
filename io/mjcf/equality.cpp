// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/equality.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::mjcf {
namespace {

/// A frame of a body.
struct Anchor {
  const Body* body = nullptr;
  Transform X_BF;
};

class EqualityReader {
 public:
  EqualityReader(const std::vector<Body>& bodies, ModelBuilder& builder)
      : bodies_(bodies), builder_(builder) {
    for (const Body& body : bodies) {
      X_WB_.push_back(body.parent < 0 ? Transform{}
                                      : X_WB_[static_cast<std::size_t>(body.parent)] * body.X_PB);
    }
  }

  void connect(const Element& e, const Impedance& impedance) {
    e.expectAttributes({"name", "class", "active", "solref", "solimp", "body1", "body2", "anchor",
                        "site1", "site2"});
    const auto [a, b] = ends(e, {"anchor"});
    Vector3 anchor = a.X_BF.p;
    const bool bySites = e.has("site1");
    if (!bySites && !e.read("anchor", anchor)) e.fail("has no attribute 'anchor'");
    ConnectSpec spec;
    spec.linkA = a.body->name;
    spec.linkB = b.body->name;
    spec.p_LAP = anchor;
    spec.p_LBP = bySites ? b.X_BF.p : Vector3(poseOf(b).inverse() * (poseOf(a) * anchor));
    spec.impedance = impedance;
    spec.where = e.where;
    spec.comA = a.body->link.com;
    spec.comB = b.body->link.com;
    builder_.connect(spec);
  }

  void weld(const Element& e, const Impedance& impedance) {
    e.expectAttributes({"name", "class", "active", "solref", "solimp", "body1", "body2", "relpose",
                        "anchor", "site1", "site2", "torquescale"});
    const auto [a, b] = ends(e, {"anchor", "relpose"});
    WeldSpec spec;
    spec.linkA = a.body->name;
    spec.linkB = b.body->name;
    if (e.has("site1")) {
      spec.X_LAF = a.X_BF;
      spec.X_LBF = b.X_BF;
    } else {
      e.read("anchor", spec.X_LBF.p);
      std::array<double, 7> pose{};
      const bool isGiven = e.readAll("relpose", pose);
      if (isGiven && (pose[3] != 0.0 || pose[4] != 0.0 || pose[5] != 0.0 || pose[6] != 0.0))
        // The place of the anchor, not of body 2, in body 1.
        spec.X_LAF = {
            Quaternion(pose[3], pose[4], pose[5], pose[6]).normalized().toRotationMatrix(),
            {pose[0], pose[1], pose[2]}};
      else
        spec.X_LAF = poseOf(a).inverse() * poseOf(b) * spec.X_LBF;
    }
    e.read("torquescale", spec.torqueScale);
    if (spec.torqueScale == 0.0) {  // no moment: a connection
      builder_.connect({spec.linkA, spec.linkB, spec.X_LAF.p, spec.X_LBF.p, impedance, e.where,
                        a.body->link.com, b.body->link.com});
      return;
    }
    spec.impedance = impedance;
    spec.where = e.where;
    spec.comA = a.body->link.com;
    spec.comB = b.body->link.com;
    builder_.weld(spec);
  }

  /// q₁ − ref₁ = Σ a_k (q₂ − ref₂)^k, in powers of q₂.
  void couple(const Element& e, const Impedance& impedance) {
    e.expectAttributes(
        {"name", "class", "active", "solref", "solimp", "joint1", "joint2", "polycoef"});
    const Joint& follower = joint(e, "joint1");
    std::array<double, 5> given{0, 1, 0, 0, 0};
    e.read("polycoef", given, 1);
    CouplingSpec spec;
    spec.follower = follower.name;
    spec.polynomial = {given[0], 0, 0, 0, 0};
    if (e.has("joint2")) {
      const Joint& leader = joint(e, "joint2");
      spec.leader = leader.name;
      std::array<double, 5> power{1, 0, 0, 0, 0};  // (q − ref)^k
      for (std::size_t k = 1; k < 5; ++k) {
        for (std::size_t i = 4; i > 0; --i) power[i] = power[i - 1] - leader.reference * power[i];
        power[0] *= -leader.reference;
        for (std::size_t i = 0; i < 5; ++i) spec.polynomial[i] += given[k] * power[i];
      }
    }
    spec.polynomial[0] += follower.reference;
    spec.impedance = impedance;
    spec.where = e.where;
    builder_.couple(spec);
  }

 private:
  /// body1 and body2, the world where there is none, or site1 and site2.
  std::pair<Anchor, Anchor> ends(const Element& e,
                                 std::initializer_list<const char*> ofBodies) const {
    if (!e.has("site1") && !e.has("site2"))
      return {{&body(e, e.requiredText("body1")), {}},
              {e.has("body2") ? &body(e, e.requiredText("body2")) : bodies_.data(), {}}};
    for (const char* name : {"body1", "body2"})
      if (e.has(name)) e.fail(fmt::format("has sites and {}, expected one of them", name));
    for (const char* name : ofBodies)
      if (e.has(name)) e.fail(fmt::format("has sites and {}, expected one of them", name));
    return {site(e, e.requiredText("site1")), site(e, e.requiredText("site2"))};
  }

  const Body& body(const Element& e, const std::string& name) const {
    std::vector<std::string> names;
    for (const Body& body : bodies_) {
      if (body.name == name) return body;
      names.push_back(body.name);
    }
    e.fail(fmt::format("body {} does not exist{}", detail::quotedText(name),
                       detail::offered(name, names)));
  }

  Anchor site(const Element& e, const std::string& name) const {
    std::vector<std::string> names;
    for (const Body& body : bodies_)
      for (const Site& site : body.sites) {
        if (site.name == name) return {&body, site.X_BS};
        names.push_back(site.name);
      }
    e.fail(fmt::format("site {} does not exist{}", detail::quotedText(name),
                       detail::offered(name, names)));
  }

  const Joint& joint(const Element& e, const char* attribute) const {
    const std::string name = e.requiredText(attribute);
    std::vector<std::string> names;
    for (const Body& body : bodies_)
      for (const Joint& joint : body.joints) {
        if (joint.name == name && joint.isScalar()) return joint;
        if (joint.isScalar()) names.push_back(joint.name);
      }
    e.fail(fmt::format("{} {} is no hinge and no slide{}", attribute, detail::quotedText(name),
                       detail::offered(name, names)));
  }

  const Transform& poseOf(const Anchor& anchor) const {
    return X_WB_[static_cast<std::size_t>(anchor.body - bodies_.data())];
  }

  const std::vector<Body>& bodies_;
  ModelBuilder& builder_;
  std::vector<Transform> X_WB_;  ///< with all joints at their references
};

}  // namespace

int readEqualities(const Element& element, const Defaults& defaults,
                   const std::vector<Body>& bodies, ModelBuilder& builder) {
  EqualityReader reader(bodies, builder);
  int inactive = 0;
  for (const Element& e : element.children) {
    bool active = true;
    e.read("active", active);
    if (!active) {
      ++inactive;
      continue;
    }
    Softness softness = defaults.of(e, defaults.top()).equality;
    softness.read(e, "solref", "solimp");
    e.expectChildren({});
    if (e.tag == "connect")
      reader.connect(e, softness.impedance(e));
    else if (e.tag == "weld")
      reader.weld(e, softness.impedance(e));
    else if (e.tag == "joint")
      reader.couple(e, softness.impedance(e));
    else
      e.fail("is an equality that is not simulated; expected connect, weld or joint");
  }
  return inactive;
}

}  // namespace softgauss::io::mjcf
