// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/joint.hpp"

#include <fmt/format.h>

namespace softgauss::io::mjcf {
namespace {

constexpr double kSmallestJointAxis = 1e-14;

void expectLinear(const Element& element, const char* name, const std::array<double, 3>& x) {
  if (x[1] != 0.0 || x[2] != 0.0)
    element.fail(
        fmt::format("{} is a polynomial, of which only the first coefficient is simulated; "
                    "expected one number",
                    name));
  if (!(x[0] >= 0.0)) element.fail(fmt::format("{} is {:g}, expected 0 or more", name, x[0]));
}

}  // namespace

void Joint::read(const Element& e) {
  e.expectAttributes({"name",
                      "class",
                      "type",
                      "group",
                      "pos",
                      "axis",
                      "springdamper",
                      "limited",
                      "actuatorfrclimited",
                      "solreflimit",
                      "solimplimit",
                      "solreffriction",
                      "solimpfriction",
                      "stiffness",
                      "range",
                      "actuatorfrcrange",
                      "actuatorgravcomp",
                      "margin",
                      "ref",
                      "springref",
                      "armature",
                      "damping",
                      "frictionloss",
                      "user"});
  e.expectChildren({});
  element = e;
  e.read("name", name);
  if (const auto word = e.word("type", {"free", "ball", "slide", "hinge"}))
    type = static_cast<Type>(*word);
  e.read("pos", pos);
  e.read("axis", axis);
  e.readAll("range", range);
  e.readAll("actuatorfrcrange", forceRange);
  e.readAll("springdamper", springDamper);
  readChoice(e, "limited", limited);
  readChoice(e, "actuatorfrclimited", forceLimited);
  limit.read(e, "solreflimit", "solimplimit");
  friction.read(e, "solreffriction", "solimpfriction");
  e.read("stiffness", stiffness, 1);
  e.read("damping", damping, 1);
  e.read("margin", margin);
  e.read("ref", reference);
  e.read("springref", springReference);
  e.read("armature", armature);
  e.read("frictionloss", frictionLoss);
  e.read("actuatorgravcomp", gravityByActuator);
}

void Joint::readFree(const Element& e) {
  e.expectAttributes({"name", "class", "group", "align"});
  e.expectChildren({});
  element = e;
  type = Type::free;
  e.read("name", name);
  Choice align = Choice::no;
  readChoice(e, "align", align);
  if (align == Choice::yes)
    e.fail(
        "align moves the frame of the body, which is not read; expected false, and the body "
        "written about its centre of mass");
}

void Joint::compile(const Compiler& compiler, const Transform& X_BF) {
  if (type == Type::ball)
    element.fail(
        "is a ball joint, which is not simulated; expected hinge, slide or free. Three hinges "
        "about axes at right angles, in this body, move alike away from a middle angle of 90°");
  if (type == Type::free) {
    for (const auto& [what, value] : {std::pair("damping", damping[0]),
                                      {"armature", armature},
                                      {"frictionloss", frictionLoss},
                                      {"stiffness", stiffness[0]}})
      if (value != 0.0)
        element.fail(
            fmt::format("is free and has {} {:g}, from its class perhaps, which is for "
                        "hinges and slides here; expected <freejoint/>",
                        what, value));
    return;
  }
  if (springDamper[0] != 0.0 || springDamper[1] != 0.0)
    element.fail(
        "has a springdamper, which is not read; expected stiffness and damping in numbers (MuJoCo "
        "prints what it makes of it in the XML that it saves)");
  if (gravityByActuator)
    element.fail("has actuatorgravcomp, which is not simulated; expected false");
  expectLinear(element, "stiffness", stiffness);
  expectLinear(element, "damping", damping);
  for (const auto& [what, value] :
       {std::pair("armature", armature), {"frictionloss", frictionLoss}})
    if (!(value >= 0.0)) element.fail(fmt::format("{} is {:g}, expected 0 or more", what, value));
  if (!(axis.norm() > kSmallestJointAxis))
    element.fail("axis has no direction, expected one of some length");
  axis = (X_BF.R * axis).normalized();
  pos = X_BF * pos;
  if (type == Type::hinge) {
    reference = compiler.radians(reference);
    springReference = compiler.radians(springReference);
    for (double& end : range) end = compiler.radians(end);
  }
}

JointSpec Joint::spec(const Compiler& compiler) const {
  JointSpec spec;
  spec.where = element.where;
  if (type == Type::free) {
    spec.type = JointType::floating;
    return spec;
  }
  spec.axis = axis;
  spec.type = type == Type::slide ? JointType::prismatic : JointType::continuous;
  if (isLimited(element, "limited", limited, range, compiler.autolimits)) {
    if (!(range[0] < range[1]))
      element.fail(fmt::format("range is {:g} {:g}, expected a lower end and a higher one",
                               range[0], range[1]));
    if (type == Type::hinge) spec.type = JointType::revolute;
    spec.lower = range[0];
    spec.upper = range[1];
    spec.limitMargin = margin;
    spec.limitImpedance = limit.impedance(element);
  }
  spec.stiffness = stiffness[0];
  spec.springReference = springReference;
  spec.damping = damping[0];
  spec.armature = armature;
  spec.dryFriction = frictionLoss;
  if (frictionLoss > 0.0) spec.frictionImpedance = friction.impedance(element);
  spec.reference = reference;
  spec.actuated = false;
  return spec;
}

}  // namespace softgauss::io::mjcf
