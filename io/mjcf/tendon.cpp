// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/tendon.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace softgauss::io::mjcf {
namespace {

/// What an element or its classes give that makes a force; empty where nothing does.
struct TendonForces {
  Choice limited = Choice::automatic;
  std::array<double, 2> range{};
  std::array<double, 3> stiffness{}, damping{};
  double frictionLoss = 0.0, armature = 0.0;

  void read(const Element& e) {
    readChoice(e, "limited", limited);
    e.readAll("range", range);
    e.read("stiffness", stiffness, 1);
    e.read("damping", damping, 1);
    e.read("frictionloss", frictionLoss);
    e.read("armature", armature);
    Choice forceLimited = Choice::automatic;
    std::array<double, 2> forces{};
    readChoice(e, "actuatorfrclimited", forceLimited);
    e.readAll("actuatorfrcrange", forces);
    if (forceLimited == Choice::yes || (forceLimited == Choice::automatic && forces[0] < forces[1]))
      e.fail("has an actuatorfrcrange, expected a forcerange in its actuator");
  }
  std::string first() const {
    if (limited == Choice::yes || (limited == Choice::automatic && range[0] < range[1]))
      return "range";
    if (stiffness != std::array<double, 3>{}) return "stiffness";
    if (damping != std::array<double, 3>{}) return "damping";
    if (frictionLoss != 0.0) return "frictionloss";
    return armature != 0.0 ? "armature" : "";
  }
};

}  // namespace

void Tendon::read(const Element& e, const std::vector<Element>& defaults) {
  element = e;
  name = e.text("name");
  if (e.tag != "fixed" && e.tag != "spatial") e.fail("is no tendon, expected <fixed> or <spatial>");
  TendonForces forces;
  for (const Element& of : defaults) forces.read(of);
  forces.read(e);
  if (const std::string force = forces.first(); !force.empty())
    e.fail(
        fmt::format("is a tendon with {}, which is not simulated; expected a <fixed> tendon "
                    "without forces of its own, that an actuator pulls",
                    force));
  if (e.tag == "spatial") return;
  e.expectChildren({"joint"});
  for (const Element& joint : e.children) {
    joint.expectAttributes({"joint", "coef"});
    double coefficient = 0.0;
    joint.read("coef", coefficient);
    joints.emplace_back(joint.requiredText("joint"), coefficient);
  }
  if (joints.empty()) e.fail("has no <joint>, expected at least one");
}

}  // namespace softgauss::io::mjcf
