// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/detail/spec_checks.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "softgauss/engine/core/index.hpp"

namespace softgauss::detail {
namespace {

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

Vector3 principalMoments(const Matrix3& I) {
  return Eigen::SelfAdjointEigenSolver<Matrix3>(I, Eigen::EigenvaluesOnly).eigenvalues();
}

std::string momentsText(const Vector3& m) {
  return "(" + number(m[0]) + ", " + number(m[1]) + ", " + number(m[2]) + ") kg m²";
}

/// Eigenvalues below this share of the largest are zero up to rounding.
constexpr double kZeroMoment = 1e-12;

}  // namespace

void checkLink(const LinkSpec& link) {
  const std::string element = "link '" + link.name + "'";
  const auto fail = [&](const std::string& text) { throw ModelError(link.where, element, text); };
  if (link.name.empty()) fail("has no name");
  if (!std::isfinite(link.mass)) fail("mass is " + number(link.mass) + ", expected a number");
  if (link.mass < 0.0) fail("mass is " + number(link.mass) + " kg, expected 0 or more");
  if (!link.com.allFinite()) fail("centre of mass is not finite");
  if (!link.I_Lcm.allFinite()) fail("inertia is not finite");
  if (!link.I_Lcm.isApprox(link.I_Lcm.transpose(), 1e-9)) fail("inertia is not symmetric");
}

bool hasNegativeMoment(const LinkSpec& link) {
  const Vector3 moments = principalMoments(link.I_Lcm);
  return moments.minCoeff() < -kZeroMoment * moments.cwiseAbs().maxCoeff();
}

void checkImpedance(const Impedance& p, const SourceLocation& where, const std::string& element) {
  const auto positive = [&](double x, const char* what) {
    if (!(x > 0.0) || !std::isfinite(x))
      throw ModelError(where, element,
                       std::string(what) + " is " + number(x) + ", expected more than 0");
  };
  const auto notNegative = [&](double x, const char* what) {
    if (!(x >= 0.0) || !std::isfinite(x))
      throw ModelError(where, element,
                       std::string(what) + " is " + number(x) + ", expected 0 or more");
  };
  if (p.direct) {
    notNegative(p.direct->stiffness, "reference stiffness");
    notNegative(p.direct->damping, "reference damping");
  } else {
    positive(p.timeConstant, "time constant");
    positive(p.dampingRatio, "damping ratio");
  }
  for (const double d : {p.dMin, p.dMax, p.midpoint})
    if (!(d >= 0.0 && d <= 1.0))
      throw ModelError(
          where, element,
          "impedance has " + number(d) + ", expected dMin, dMax and midpoint in [0, 1]");
  notNegative(p.width, "impedance width");
  if (!(p.power >= 1.0) || !std::isfinite(p.power))
    throw ModelError(where, element,
                     "impedance power is " + number(p.power) + ", expected 1 or more");
}

namespace {

template <class Fail>
void checkServo(const Servo& servo, bool mayHaveOne, const Fail& fail) {
  for (const auto& [gain, what] : {std::pair(servo.kp, "kp"), std::pair(servo.kd, "kd")})
    if (!(gain >= 0.0) || !std::isfinite(gain))
      fail("servo's " + std::string(what) + " is " + number(gain) + ", expected 0 or more");
  if (servo.exists() && !mayHaveOne)
    fail("has a servo, which only a revolute, continuous or prismatic joint that mimics none has");
  if (!(servo.effort > 0.0))
    fail("servo's effort is " + number(servo.effort) + ", expected more than 0");
  if (!std::isfinite(servo.setPoint) || !std::isfinite(servo.setPointRate))
    fail("servo's set point is not finite");
}

}  // namespace

void checkJoint(const JointSpec& joint) {
  const std::string element = "joint '" + joint.name + "'";
  const auto fail = [&](const std::string& text) { throw ModelError(joint.where, element, text); };
  if (joint.name.empty()) fail("has no name");
  if (!joint.X_PC.R.allFinite() || !joint.X_PC.p.allFinite()) fail("origin is not finite");
  if (!joint.axis.allFinite() || joint.axis.norm() < 1e-9)
    fail("axis has length " + number(joint.axis.norm()) + ", expected a direction");
  if (joint.lower.has_value() != joint.upper.has_value())
    fail("has one end of a range; expected lower and upper, or neither");
  if (joint.lower) {
    if (std::isnan(*joint.lower) || std::isnan(*joint.upper)) fail("range is not a number");
    if (*joint.lower > *joint.upper)
      fail("lower " + number(*joint.lower) + " > upper " + number(*joint.upper) +
           ", expected lower <= upper");
  }
  const auto notNegative = [&](double x, const char* what) {
    if (!(x >= 0.0) || !std::isfinite(x))
      fail(std::string(what) + " is " + number(x) + ", expected 0 or more");
  };
  notNegative(joint.damping, "damping");
  notNegative(joint.dryFriction, "friction");
  checkImpedance(joint.frictionImpedance, joint.where, element + " friction");
  checkImpedance(joint.limitImpedance, joint.where, element + " limit");
  if (!std::isfinite(joint.limitMargin)) fail("margin of its limit is not finite");
  if (!std::isfinite(joint.reference)) fail("reference is not finite");
  notNegative(joint.armature, "armature");
  notNegative(joint.stiffness, "stiffness");
  if (!std::isfinite(joint.springReference)) fail("spring reference is not finite");
  const bool scalar = joint.type == JointType::revolute || joint.type == JointType::continuous ||
                      joint.type == JointType::prismatic;
  if (joint.stiffness != 0.0 && !scalar)
    fail("has a spring, which only a revolute, continuous or prismatic joint may have");
  checkServo(joint.servo, scalar && !joint.mimic, fail);
  if (joint.effort) notNegative(*joint.effort, "effort");
  if (joint.velocity) notNegative(*joint.velocity, "velocity");
  if (joint.mimic &&
      !(std::isfinite(joint.mimic->multiplier) && std::isfinite(joint.mimic->offset)))
    fail("mimic multiplier or offset is not finite");
}

void checkSpring(const ContactSpring& s, const Options& options, const SourceLocation& where,
                 const std::string& element) {
  const auto fail = [&](const std::string& text) { throw ModelError(where, element, text); };
  for (const auto& [x, what] : {std::pair(s.stiffness, "stiffness"),
                                {s.restDepth, "rest depth"},
                                {s.damping, "damping"},
                                {s.dampingRatio, "damping ratio"}})
    if (!(x >= 0.0) || !std::isfinite(x))
      fail(std::string("contact ") + what + " is " + number(x) + ", expected 0 or more");
  if ((s.stiffness > 0.0) == (s.restDepth > 0.0))
    fail("contact stiffness is " + number(s.stiffness) + " and rest depth " + number(s.restDepth) +
         ", expected one of them above 0");
  if (s.damping > 0.0 && s.dampingRatio > 0.0)
    fail("has a contact damping and a damping ratio, expected one of them");
  if (s.restDepth > 0.0 && options.gravity.isZero(0.0))
    fail(
        "has a rest depth, which is that under gravity, and gravity is zero; expected a stiffness");
}

void checkMaterial(const Material& m, const Options& options, const SourceLocation& where,
                   const std::string& element) {
  const auto fail = [&](const std::string& text) { throw ModelError(where, element, text); };
  if (!(m.slidingFriction >= 0.0)) fail("friction is negative, expected 0 or more");
  if (!(m.torsionalFriction >= 0.0) || !(m.rollingFriction >= 0.0))
    fail("torsional or rolling friction is negative, expected 0 or more");
  if (m.condim != 1 && m.condim != 3 && m.condim != 4 && m.condim != 6)
    fail("condim is not 1, 3, 4 or 6");
  if (!std::isfinite(m.margin)) fail("margin is not finite");
  if (!(m.mixWeight >= 0.0) || !std::isfinite(m.mixWeight)) fail("mixWeight is not a number >= 0");
  checkImpedance(m.impedance, where, element);
  if (m.spring) checkSpring(*m.spring, options, where, element);
}

void checkGeometry(const GeometrySpec& g, const Options& options) {
  const std::string element = "geometry '" + g.name + "'";
  const auto fail = [&](const std::string& text) { throw ModelError(g.where, element, text); };
  const auto positive = [&](double x, const char* what) {
    constexpr double kLargest = 1e12;  // as of numbers in files: their products do not overflow
    if (!(x > 0.0) || !(x <= kLargest))
      fail(std::string(what) + " is " + number(x) + " m, expected more than 0 and at most " +
           number(kLargest));
  };
  if (!g.X_LG.R.allFinite() || !g.X_LG.p.allFinite()) fail("pose is not finite");
  switch (g.shape.kind) {
    case ShapeKind::plane:
      break;
    case ShapeKind::sphere:
      positive(g.shape.radius, "radius");
      break;
    case ShapeKind::capsule:
    case ShapeKind::cylinder:
      positive(g.shape.radius, "radius");
      positive(g.shape.halfLength, "half length");
      break;
    case ShapeKind::ellipsoid:
      positive(g.shape.halfExtents.minCoeff(), "smallest radius");
      positive(g.shape.halfExtents.maxCoeff(), "largest radius");
      break;
    case ShapeKind::box:
      positive(g.shape.halfExtents.minCoeff(), "smallest half extent");
      positive(g.shape.halfExtents.maxCoeff(), "largest half extent");
      break;
    case ShapeKind::mesh:
      if (!g.shape.mesh || g.shape.mesh->vertices.empty()) fail("mesh has no vertices");
      break;
    case ShapeKind::triangles:
      if (!g.shape.mesh || g.shape.mesh->triangles.empty()) fail("mesh has no triangles");
      break;
  }
  checkMaterial(g.material, options, g.where, element);
}

void checkOptions(const Options& options) {
  const auto fail = [](const std::string& text) { throw ModelError({}, "options", text); };
  if (!(options.timestep > 0.0) || !std::isfinite(options.timestep))
    fail("timestep is " + number(options.timestep) + " s, expected more than 0");
  if (!options.gravity.allFinite()) fail("gravity is not finite");
  if (!(options.impedanceRatio > 0.0) || !std::isfinite(options.impedanceRatio))
    fail("impedance ratio is " + number(options.impedanceRatio) + ", expected more than 0");
  if (!(options.tolerance >= 0.0) || !std::isfinite(options.tolerance))
    fail("tolerance is " + number(options.tolerance) + ", expected 0 or more");
  if (options.maxIterations < 1) fail("maximum iterations is less than 1");
}

void checkMovingInertias(const Model& model, const std::vector<MergedBody>& merged) {
  std::vector<bool> carriesMass(model.bodies.size());
  for (int b = model.bodyCount() - 1; b > 0; --b) {
    if (model.bodies[idx(b)].mass > 0.0) carriesMass[idx(b)] = true;
    if (carriesMass[idx(b)]) carriesMass[idx(model.bodies[idx(b)].parent)] = true;
  }
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[idx(b)];
    const MergedBody& from = merged[idx(b)];
    const auto fail = [&](const std::string& text) {
      throw ModelError(from.link ? from.link->where : SourceLocation{},
                       "link '" + model.bodyNames[idx(b)] + "'", text);
    };
    const double armature = body.dofs == 1 ? model.dofs[idx(body.v)].armature : 0.0;
    if (!carriesMass[idx(b)] && armature == 0.0)
      fail("moves on joint '" + model.jointNames[idx(b)] +
           "' but neither it nor anything that hangs from it has mass; the mass matrix would be "
           "singular; expected an <inertial> in one of them, or --infer-inertia");
    if (body.massless) continue;
    const Vector3 moments = principalMoments(body.I_Bcm.matrix());
    if (!std::isfinite(body.mass) || !body.com.allFinite() || !moments.allFinite())
      fail("moves, and its mass or inertia with all links fixed to it overflows");
    if (moments.minCoeff() > kZeroMoment * moments.cwiseAbs().maxCoeff()) continue;
    if (from.negative)
      throw ModelError(from.negative->where, "link '" + from.negative->name + "'",
                       "inertia has a negative principal moment " +
                           momentsText(principalMoments(from.negative->I_Lcm)) +
                           ", and so has the body that it is part of; expected none");
    fail("moves, and its inertia with all links fixed to it has principal moments " +
         momentsText(moments) +
         ", expected all positive; --infer-inertia takes it from shapes where it is missing");
  }
}

}  // namespace softgauss::detail
