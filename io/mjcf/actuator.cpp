// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/actuator.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace softgauss::io::mjcf {
namespace {

/// What general gives by itself; the others set the same by names of their own.
void readGeneral(const Element& e, Actuator& a) {
  if (const auto word =
          e.word("gaintype", {"fixed", "affine", "muscle", "dcmotor", "so3", "pid", "user"}))
    a.gain = *word < 2 ? static_cast<Actuator::Gain>(*word) : Actuator::Gain::other;
  if (const auto word = e.word("biastype", {"none", "affine", "muscle", "dcmotor", "so3", "user"}))
    a.bias = *word < 2 ? static_cast<Actuator::Bias>(*word) : Actuator::Bias::other;
  if (const auto word = e.word("dyntype", {"none", "integrator", "filter", "filterexact", "muscle",
                                           "dcmotor", "pid", "user"}))
    a.isDynamic = *word != 0;
  e.read("gainprm", a.gainParameters, 1);
  e.read("biasprm", a.biasParameters, 1);
}

void readServo(const Element& e, Actuator& a) {
  e.read("kp", a.gainParameters[0]);
  a.biasParameters[1] = -a.gainParameters[0];
  double value = 0.0;
  if (e.read("kv", value)) a.biasParameters[2] = -value;
  if (e.read("dampratio", value)) a.biasParameters[2] = value;
  if (e.read("timeconst", value)) a.isDynamic = value != 0.0;
  e.read("inheritrange", a.inheritRange);
  a.gain = Actuator::Gain::fixed;
  a.bias = Actuator::Bias::affine;
}

void readVelocityServo(const Element& e, Actuator& a) {
  e.read("kv", a.gainParameters[0]);
  a.biasParameters = {};
  a.biasParameters[2] = -a.gainParameters[0];
  a.isDynamic = false;
  a.gain = Actuator::Gain::fixed;
  a.bias = Actuator::Bias::affine;
}

}  // namespace

bool isReadActuator(const std::string& tag) {
  return tag == "general" || tag == "motor" || tag == "position" || tag == "velocity";
}

void Actuator::read(const Element& e) {
  if (isReadActuator(e.tag))
    e.expectAttributes({"name",       "class",       "group",       "nsample",     "interp",
                        "delay",      "ctrlrange",   "user",        "ctrllimited", "forcelimited",
                        "actlimited", "forcerange",  "actrange",    "lengthrange", "gear",
                        "damping",    "armature",    "cranklength", "joint",       "jointinparent",
                        "tendon",     "slidersite",  "cranksite",   "site",        "refsite",
                        "body",       "actdim",      "input",       "velrange",    "ffrange",
                        "dyntype",    "gaintype",    "biastype",    "dynprm",      "gainprm",
                        "biasprm",    "actearly",    "kp",          "kv",          "dampratio",
                        "timeconst",  "inheritrange"});
  element = e;
  e.read("name", name);
  readChoice(e, "ctrllimited", ctrlLimited);
  readChoice(e, "forcelimited", forceLimited);
  e.readAll("ctrlrange", ctrlRange);
  e.readAll("forcerange", forceRange);
  e.read("gear", gear, 1);
  e.read("damping", damping, 1);
  e.read("armature", armature);
  double delay = 0.0;
  if (e.read("delay", delay) && delay != 0.0)
    e.fail("has a delay, which is not simulated; expected none");
  if (e.has("joint")) joint = e.requiredText("joint");
  if (e.has("jointinparent")) joint = e.requiredText("jointinparent");
  if (e.has("tendon")) tendon = e.requiredText("tendon");
  for (const char* other : {"cranksite", "site", "body"})
    if (e.has(other)) otherTarget = other;
  if (e.tag == "general") {
    readGeneral(e, *this);
  } else if (e.tag == "motor") {
    gainParameters[0] = 1.0;
    gain = Gain::fixed;
    bias = Bias::none;
    isDynamic = false;
  } else if (e.tag == "position") {
    readServo(e, *this);
  } else if (e.tag == "velocity") {
    readVelocityServo(e, *this);
  } else {
    // Of a kind that is not simulated: what is of its class is not either.
    gain = Gain::other;
    isDynamic = true;
  }
}

void Actuator::check() const {
  if (!isReadActuator(element.tag))
    element.fail(
        "is an actuator that is not simulated; expected general, motor, position or velocity");
  if (!otherTarget.empty())
    element.fail(
        fmt::format("acts by {}, which is not simulated; expected joint, or tendon of a "
                    "<fixed> tendon",
                    otherTarget));
  if (joint.empty() == tendon.empty())
    element.fail("expected one of the attributes joint and tendon");
  if (gain != Gain::fixed || bias == Bias::other)
    element.fail(
        "has a gaintype or a biastype that is not simulated; expected gaintype fixed and "
        "biastype none or affine");
  if (isDynamic)
    element.fail(
        "has an activation state (dyntype, or timeconst), which is not simulated; expected "
        "dyntype none and no timeconst");
  if (damping != std::array<double, 3>{} || armature != 0.0)
    element.fail("has a damping or an armature, expected them in the joint");
  if (gear[0] == 0.0) element.fail("gear is 0, expected another number");
  for (std::size_t i = 1; i < gear.size(); ++i)
    if (gear[i] != 0.0)
      element.fail("gear has several numbers, for a ball or free joint; expected one");
}

std::pair<double, double> Actuator::forces(bool autolimits) const {
  const auto ordered = [&](const std::array<double, 2>& range, const char* what) {
    if (!(range[0] < range[1]))
      element.fail(fmt::format("{} is {:g} {:g}, expected a lower end and a higher one", what,
                               range[0], range[1]));
    return std::pair(range[0], range[1]);
  };
  std::pair<double, double> bounds{-kInfinity, kInfinity};
  if (isLimited(element, "ctrllimited", ctrlLimited, ctrlRange, autolimits) && !isServo()) {
    const auto [low, high] = ordered(ctrlRange, "ctrlrange");
    bounds = std::minmax({gainParameters[0] * low, gainParameters[0] * high});
  }
  if (isLimited(element, "forcelimited", forceLimited, forceRange, autolimits)) {
    const auto [low, high] = ordered(forceRange, "forcerange");
    bounds = {std::clamp(bounds.first, low, high), std::clamp(bounds.second, low, high)};
  }
  return bounds;
}

}  // namespace softgauss::io::mjcf
