// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/base_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "softgauss/collision/lowest_point.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/figure_text.hpp"
#include "softgauss/io/simulation/stance_notes.hpp"

namespace softgauss {
namespace {

constexpr double kStandsWithin = 5e-3;  // [m] of the lowest point
constexpr double kToldOutside = 5e-3;   // [m]
constexpr std::size_t kMostLines = 4;
constexpr std::size_t kMostNames = 6;

using Points = std::vector<Eigen::Vector2d>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Corners of the convex hull, counter-clockwise (Andrew's monotone chain).
Points hull(Points points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  if (points.size() < 3) return points;
  Points corners;
  for (const int direction : {1, -1}) {
    const std::size_t first = corners.size();
    const auto add = [&](const Eigen::Vector2d& p) {
      while (corners.size() >= first + 2 &&
             cross(corners.back() - corners[corners.size() - 2], p - corners.back()) <= 0.0)
        corners.pop_back();
      corners.push_back(p);
    };
    if (direction > 0)
      std::for_each(points.begin(), points.end(), add);
    else
      std::for_each(points.rbegin(), points.rend(), add);
    corners.pop_back();
  }
  return corners;
}

double distanceToSegment(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                         const Eigen::Vector2d& p) {
  const Eigen::Vector2d d = b - a;
  const double length = d.squaredNorm();
  const double s = length > 0.0 ? std::clamp((p - a).dot(d) / length, 0.0, 1.0) : 0.0;
  return (a + s * d - p).norm();
}

/// How far p is outside the convex hull of the points [m]; 0 inside.
double distanceOutside(const Points& points, const Eigen::Vector2d& p) {
  const Points corners = hull(points);
  double nearest = kInfinity;
  bool inside = corners.size() > 2;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    nearest = std::min(nearest, distanceToSegment(a, b, p));
    inside = inside && cross(b - a, p - a) >= 0.0;
  }
  return inside ? 0.0 : nearest;
}

/// Where the fixed base of a URDF is: its root link, merged with the world.
std::string fixedRoot(const Model& model) {
  for (const Frame& frame : model.frames)
    if (frame.body == 0 && frame.name != "world") return frame.name;
  return "world";
}

/// `origin` tells URDFs, which may be a body alone, from the objects of a scene.
bool isRobot(const Model& model, int tree, BaseOrigin origin) {
  const Tree& t = model.trees[tree];
  return model.floats(tree) && (origin != BaseOrigin::scene || t.bodyEnd - t.rootBody > 1);
}

std::string boltsDown(BaseOrigin origin) {
  return origin == BaseOrigin::scene ? "`base: fixed` in the scene" : "--base fixed";
}

/// The robot's links that its support is made of, within 5 mm of its lowest point.
std::vector<std::string> standsOn(const Model& model, const Kinematics& k, int tree) {
  const Tree& t = model.trees[tree];
  const double lowest = collision::lowestPoint(model, k, tree);
  std::vector<std::string> links;
  for (const Geometry& g : model.geometries)
    if (g.body >= t.rootBody && g.body < t.bodyEnd &&
        collision::lowestPoint(g.shape, k.X_WB[g.body] * g.X_BG) < lowest + kStandsWithin &&
        std::find(links.begin(), links.end(), g.link) == links.end())
      links.push_back(g.link);
  return links;
}

std::vector<std::string> floatingLines(const Model& model, const Kinematics& k, BaseOrigin origin) {
  std::vector<std::string> lines, names;
  for (int t = 0; t < static_cast<int>(model.trees.size()); ++t) {
    if (!isRobot(model, t, origin)) continue;
    const std::string& base = model.bodyNames[model.trees[t].rootBody];
    names.push_back(base);
    const std::string why = origin == BaseOrigin::guess
                                ? fmt::format(", a guess, for it stands on {}",
                                              io::detail::listed(standsOn(model, k, t), kMostNames))
                                : "";
    lines.push_back(
        fmt::format("base {} floats{}; {} bolts it down", base, why, boltsDown(origin)));
  }
  if (lines.size() > kMostLines)
    lines = {fmt::format("{} bases float: {}; {} bolts one down", names.size(),
                         io::detail::listed(names, kMostNames), boltsDown(origin))};
  return lines;
}

/// A robot whose centre of mass is not over what it stands on.
std::optional<std::string> supportWarning(const Model& model, const Kinematics& start, int tree,
                                          const ContactSet& touching, BaseOrigin origin) {
  const Tree& t = model.trees[tree];
  const auto isOfTree = [&](int body) { return body >= t.rootBody && body < t.bodyEnd; };
  Points support;
  for (const Contact& c : touching.contacts)
    if ((isOfTree(c.bodyA) && c.bodyB == 0) || (isOfTree(c.bodyB) && c.bodyA == 0))
      support.push_back(c.p_WC.head<2>());
  if (support.empty()) return std::nullopt;
  Vector3 center = Vector3::Zero();
  for (int b = t.rootBody; b < t.bodyEnd; ++b)
    center += model.bodies[b].mass / t.mass * (start.X_WB[b] * model.bodies[b].com);
  const double outside = distanceOutside(support, center.head<2>());
  if (!(outside > kToldOutside)) return std::nullopt;
  return fmt::format(
      "base {} floats, and the centre of mass is {} outside its support at the start: it tips over "
      "where nothing holds it; {} bolts it down",
      model.bodyNames[t.rootBody], io::lengthText(outside), boltsDown(origin));
}

}  // namespace

bool looksBolted(const Model& model, const Kinematics& start, int tree) {
  const Tree& t = model.trees[tree];
  const double lowest = collision::lowestPoint(model, start, tree);
  if (!std::isfinite(lowest)) return true;
  return std::none_of(model.geometries.begin(), model.geometries.end(), [&](const Geometry& g) {
    return g.body > t.rootBody && g.body < t.bodyEnd &&
           collision::lowestPoint(g.shape, start.X_WB[g.body] * g.X_BG) < lowest + kStandsWithin;
  });
}

BaseNotes baseNotes(const Model& model, const State& start, ContactSource& contacts,
                    BaseOrigin origin, const std::string& otherStart) {
  BaseNotes notes;
  notes.origin = origin;
  Kinematics k(model);
  computeKinematics(model, start, k);
  notes.lines = floatingLines(model, k, origin);
  if (notes.lines.empty() && origin != BaseOrigin::scene) {
    const std::string root = fixedRoot(model);
    const std::string why = origin == BaseOrigin::guess
                                ? ", a guess, for nothing but its root would touch the ground"
                                : "";
    notes.lines.push_back(
        root == "world" && origin == BaseOrigin::convention
            ? "base world is fixed, as the root link is called so; --base "
              "floating lets it go"
            : fmt::format("base {} is bolted down{}; --base floating lets it go", root, why));
  }
  State lowered = start;
  for (const Tree& tree : model.trees)
    if (const Body& root = model.bodies[tree.rootBody]; root.joint == JointKind::floating)
      lowered.q[root.q + 2] -= kStandsWithin;
  Kinematics below(model);
  computeKinematics(model, lowered, below);
  ContactSet touching;
  contacts.detect(model, below, touching);
  std::vector<std::string> knees;
  const bool heavy =
      model.options.gravity.norm() > 0.0 && model.options.effects.has(Effect::gravity);
  for (int t = 0; t < static_cast<int>(model.trees.size()); ++t) {
    if (!model.floats(t)) continue;
    const int root = model.trees[t].rootBody;
    if (model.bodies[root].massless)
      notes.warnings.push_back(fmt::format("root link {} has no mass and floats: was {} meant?",
                                           model.bodyNames[root], boltsDown(origin)));
    else if (heavy && isRobot(model, t, origin))
      if (auto warning = supportWarning(model, k, t, touching, origin))
        notes.warnings.push_back(std::move(*warning));
    if (!heavy || !isRobot(model, t, origin)) continue;
    if (auto stance = standingWarning(model, k, t, touching))
      notes.stances.push_back(
          fmt::format("{} {}; another start: {}", model.bodyNames[root], *stance, otherStart));
    for (std::string& knee : straightKnees(model, k, t, touching)) knees.push_back(std::move(knee));
  }
  if (!knees.empty())
    notes.straightKnees = fmt::format(
        "straight at the start: {}; a bent leg can lower the base, a straight one cannot: {}",
        io::detail::listed(knees, kMostNames), otherStart);
  return notes;
}

std::string boltAdvice(const std::string& base, BaseOrigin origin) {
  return fmt::format("{} floats and fell; it looks as if it were bolted down: {} does that", base,
                     boltsDown(origin));
}

}  // namespace softgauss
