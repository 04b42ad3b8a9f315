// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "softgauss/engine/model/followers.hpp"
#include "softgauss/gdd/goals/reach.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/names.hpp"
#include "softgauss/io/simulation/simulation_goals.hpp"

namespace softgauss {
namespace {

using Kind = Parameter::Kind;

enum class Least { any, notNegative, positive };

struct KindName {
  Kind kind;
  const char* name;
  Least least;
  bool ofModel;
};

constexpr KindName kKinds[] = {
    {Kind::mass, "mass", Least::positive, true},
    {Kind::inertia, "inertia", Least::positive, true},
    {Kind::friction, "friction", Least::notNegative, true},
    {Kind::damping, "damping", Least::notNegative, true},
    {Kind::armature, "armature", Least::notNegative, true},
    {Kind::dryFriction, "dry_friction", Least::notNegative, true},
    {Kind::effort, "effort", Least::positive, true},
    {Kind::lower, "lower", Least::any, true},
    {Kind::upper, "upper", Least::any, true},
    {Kind::gravity, "gravity", Least::any, true},
    {Kind::timestep, "timestep", Least::positive, true},
    {Kind::q, "q", Least::any, false},
    {Kind::v, "v", Least::any, false},
    {Kind::reach, "reach", Least::any, false},
};

const KindName& kindName(Kind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

constexpr const char* kAll = "*";

Symmetric3 scaled(const Symmetric3& I, double f) {
  return {f * I.xx, f * I.yy, f * I.zz, f * I.xy, f * I.xz, f * I.yz};
}

void setMass(double mass, int index, Model& model) {
  Body& body = model.bodies[static_cast<std::size_t>(index)];
  body.I_Bcm = scaled(body.I_Bcm, mass / body.mass);
  body.mass = mass;
  Tree& tree = model.trees[static_cast<std::size_t>(body.tree)];
  tree.mass = 0.0;
  for (int b = tree.rootBody; b < tree.bodyEnd; ++b)
    tree.mass += model.bodies[static_cast<std::size_t>(b)].mass;
}

}  // namespace

std::vector<std::string> parameterKinds() {
  std::vector<std::string> names;
  for (const KindName& k : kKinds) names.emplace_back(k.name);
  return names;
}

void Parameter::fail(const std::string& problem) const {
  throw NameError(fmt::format("parameter '{}': {}", name_, problem));
}

Parameter::Parameter(const Model& model, const std::string& name) : name_(name) {
  const std::size_t colon = name.find(':');
  const std::string kind = name.substr(0, colon);
  const auto known = std::find_if(std::begin(kKinds), std::end(kKinds),
                                  [&](const KindName& k) { return kind == k.name; });
  if (known == std::end(kKinds))
    fail(fmt::format("found the kind {}, expected a parameter{}", io::detail::quotedText(kind),
                     io::detail::offered(kind, parameterKinds())));
  kind_ = known->kind;
  const std::string target = colon == std::string::npos ? "" : name.substr(colon + 1);
  if ((kind_ == Kind::timestep) != target.empty())
    fail(kind_ == Kind::timestep ? "expected timestep alone"
                                 : "expected KIND:NAME, as in mass:ball or damping:elbow");
  std::string stem;
  switch (kind_) {
    case Kind::timestep:
      break;
    case Kind::mass:
    case Kind::inertia:
      findLink(model, target);
      break;
    case Kind::friction:
      findShapes(model, target);
      break;
    case Kind::gravity:
      indices_ = {splitAxis("." + target, {"x", "y", "z"}, stem)};
      break;
    case Kind::q:
    case Kind::v:
      findCoordinate(model, target);
      break;
    case Kind::reach:
      indices_ = {splitAxis(target, {"x", "y", "z"}, link_)};
      if (const std::string problem = io::linkProblem(model, link_); !problem.empty())
        fail(problem);
      break;
    default:
      findJoints(model, target);
  }
}

int Parameter::splitAxis(const std::string& target, const std::vector<std::string>& axes,
                         std::string& stem) {
  const std::size_t dot = target.rfind('.');
  const std::string axis = dot == std::string::npos ? "" : target.substr(dot + 1);
  const auto place = std::find(axes.begin(), axes.end(), axis);
  if (place == axes.end())
    fail(fmt::format("expected one of {} at its end", io::detail::listed(axes)));
  stem = target.substr(0, dot);
  return static_cast<int>(place - axes.begin());
}

void Parameter::findLink(const Model& model, const std::string& target) {
  if (const std::string problem = io::linkProblem(model, target); !problem.empty()) fail(problem);
  const int body = model.frames[static_cast<std::size_t>(model.findFrame(target))].body;
  if (!(model.bodies[body].mass > 0.0))
    fail("found a link without mass, expected one whose mass can be changed");
  indices_ = {body};
}

void Parameter::findShapes(const Model& model, const std::string& target) {
  std::vector<std::string> names;
  for (int g = 0; g < static_cast<int>(model.geometries.size()); ++g) {
    const Geometry& geometry = model.geometries[static_cast<std::size_t>(g)];
    if (target == kAll || geometry.link == target || geometry.name == target) indices_.push_back(g);
    for (const std::string& known : {geometry.link, geometry.name})
      if (std::find(names.begin(), names.end(), known) == names.end()) names.push_back(known);
  }
  if (indices_.empty())
    fail(fmt::format("found {}, expected a shape, or a link that has shapes{}",
                     io::detail::quotedText(target), io::detail::offered(target, names)));
  for (int p = 0; p < static_cast<int>(model.contactPairs.size()); ++p) {
    const ContactPair& pair = model.contactPairs[static_cast<std::size_t>(p)];
    for (const int geometry : indices_)
      if (geometry == pair.geometryA || geometry == pair.geometryB) {
        pairs_.push_back(p);
        break;
      }
  }
}

void Parameter::findJoints(const Model& model, const std::string& target) {
  std::vector<int> bodies;
  if (target == kAll) {
    for (int b = 1; b < model.bodyCount(); ++b)
      if (model.bodies[b].dofs == 1) bodies.push_back(b);
  } else {
    if (const std::string problem = io::jointProblem(model, target); !problem.empty())
      fail(problem);
    bodies = {model.findJoint(target)};
  }
  const bool ofRange = kind_ == Kind::lower || kind_ == Kind::upper;
  for (const int body : bodies) {
    if (ofRange) {
      for (int r = 0; r < static_cast<int>(model.ranges.size()); ++r)
        if (model.ranges[static_cast<std::size_t>(r)].body == body) indices_.push_back(r);
    } else if (kind_ != Kind::effort || model.dofs[model.bodies[body].v].actuated) {
      indices_.push_back(model.bodies[body].v);
    }
  }
  if (indices_.empty())
    fail(ofRange ? "found a joint without a range, expected one that has limits"
                 : "found a joint that is not actuated, expected one that is");
}

void Parameter::findCoordinate(const Model& model, const std::string& target) {
  const bool ofVelocity = kind_ == Kind::v;
  const std::size_t dot = target.rfind('.');
  const int base = dot == std::string::npos ? -1 : model.findJoint(target.substr(0, dot));
  if (base > 0 && model.bodies[base].joint == JointKind::floating) {
    std::string stem;
    const std::vector<std::string> axes =
        ofVelocity ? std::vector<std::string>{"vx", "vy", "vz", "wx", "wy", "wz"}
                   : std::vector<std::string>{"x", "y", "z"};
    const int axis = splitAxis(target, axes, stem);
    indices_ = {(ofVelocity ? model.bodies[base].v : model.bodies[base].q) + axis};
    return;
  }
  if (const std::string problem = io::jointProblem(model, target); !problem.empty()) fail(problem);
  body_ = model.findJoint(target);
  const Body& body = model.bodies[body_];
  indices_ = {ofVelocity ? body.v : body.q};
}

std::string Parameter::problem(double value) const {
  const Least least = kindName(kind_).least;
  const bool fits =
      std::isfinite(value) && std::abs(value) <= io::detail::kLargestNumber &&
      (least == Least::any || value > 0.0 || (least == Least::notNegative && value == 0.0));
  if (fits) return {};
  return fmt::format("found {}, expected a number{}", value,
                     least == Least::positive      ? " above 0"
                     : least == Least::notNegative ? " of at least 0"
                                                   : "");
}

std::string Parameter::startProblem(double value, const std::vector<JointRange>& ranges) const {
  if (kind_ != Kind::q || body_ == 0) return {};
  for (const JointRange& range : ranges)
    if (range.body == body_ && (value < range.lower || value > range.upper))
      return fmt::format("found {}, which lies outside the joint's range {} .. {}", value,
                         range.lower, range.upper);
  return {};
}

void Parameter::setEnd(double value, std::vector<JointRange>& ranges) const {
  if (kind_ != Kind::lower && kind_ != Kind::upper) return;
  for (const int i : indices_) {
    JointRange& range = ranges[static_cast<std::size_t>(i)];
    (kind_ == Kind::lower ? range.lower : range.upper) = value;
  }
}

bool Parameter::isOfModel() const { return kindName(kind_).ofModel; }

void Parameter::apply(double value, Model& model, State& initial) const {
  if (kind_ == Kind::timestep) model.options.timestep = value;
  for (const int p : pairs_)
    model.contactPairs[static_cast<std::size_t>(p)].material.slidingFriction = value;
  for (const int i : indices_) {
    const auto at = static_cast<std::size_t>(i);
    switch (kind_) {
      case Kind::mass:
        setMass(value, i, model);
        break;
      case Kind::inertia:
        model.bodies[at].I_Bcm = scaled(model.bodies[at].I_Bcm, value);
        break;
      case Kind::friction:
        model.geometries[at].material.slidingFriction = value;
        break;
      case Kind::damping:
        model.dofs[at].damping = value;
        break;
      case Kind::armature:
        model.dofs[at].armature = value;
        break;
      case Kind::dryFriction:
        model.dofs[at].dryFriction = value;
        break;
      case Kind::effort:
        model.dofs[at].effortLower = -value;
        model.dofs[at].effortUpper = value;
        break;
      case Kind::gravity:
        model.options.gravity[i] = value;
        break;
      case Kind::q:
        initial.q[i] = value;
        if (body_ > 0) placeFollowers(model, {body_}, initial.q);
        break;
      case Kind::v:
        initial.v[i] = value;
        break;
      case Kind::lower:
      case Kind::upper:
      case Kind::timestep:
      case Kind::reach:
        break;
    }
  }
  setEnd(value, model.ranges);
}

bool Parameter::isOfTheSame(const Parameter& other) const {
  return kind_ == Kind::mass && other.kind_ == Kind::mass && indices_ == other.indices_;
}

std::string Parameter::problemOf(const Model& model) {
  for (const JointRange& range : model.ranges)
    if (range.lower > range.upper)
      return fmt::format("joint '{}' ranges from {} to {}, expected the smaller one first",
                         model.jointNames[static_cast<std::size_t>(range.body)], range.lower,
                         range.upper);
  return {};
}

void Parameter::apply(double value, gdd::GoalDirectedController& controller) const {
  if (kind_ != Kind::reach) return;
  bool found = false;
  for (const auto& goal : controller.goals)
    if (auto* reach = dynamic_cast<gdd::Reach*>(goal.get()); reach && reach->link == link_) {
      if (reach->trajectory)
        fail("found a reach goal whose target follows a trajectory, expected one with a target");
      reach->p_WTarget[indices_.front()] = value;
      found = true;
    }
  if (!found) fail("found no reach goal of that link, expected one among the goals");
}

}  // namespace softgauss
