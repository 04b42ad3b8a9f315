// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/stance_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "softgauss/collision/lowest_point.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/figure_text.hpp"

namespace softgauss {
namespace {

constexpr double kInTheAir = 5e-3;  // [m]
constexpr std::size_t kMostFeet = 6;
constexpr double kStraight = 6.0 * M_PI / 180.0;  // [rad]
constexpr double kLever = 0.1;                    // of a leg's length
constexpr double kFoot = 0.25;                    // of a leg's length: a longer end is a shin

/// How far the shape reaches from the origin of its body [m].
double reachOf(const Geometry& g) {
  if (!g.shape.mesh) {
    const Shape& s = g.shape;
    return g.X_BG.p.norm() + std::max({s.radius, s.halfLength, s.halfExtents.maxCoeff()});
  }
  double reach = 0.0;
  for (const Vector3& vertex : g.shape.mesh->vertices)
    reach = std::max(reach, (g.X_BG * vertex).norm());
  return reach;
}

bool isCalledFoot(std::string link) {
  std::transform(link.begin(), link.end(), link.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array kNames = {"foot", "feet", "sole", "toe", "wheel", "hoof", "paw"};
  return std::any_of(kNames.begin(), kNames.end(),
                     [&](const char* name) { return link.find(name) != std::string::npos; });
}

/// The links with contacts of one kinematic tree with the world, and of each body what they are.
class Support {
 public:
  Support(const Model& model, const Tree& tree, const ContactSet& touching) {
    for (const Contact& c : touching.contacts) {
      if (c.bodyA != 0 && c.bodyB != 0) continue;
      const int g = c.bodyA == 0 ? c.geometryB : c.geometryA;
      const Geometry& geometry = model.geometries[idx(g)];
      if (geometry.body < tree.rootBody || geometry.body >= tree.bodyEnd) continue;
      links_.insert(geometry.link);
      points_[geometry.body].push_back(c.p_WC);
      first_.emplace(geometry.body, geometry.link);
    }
  }
  bool has(const std::string& link) const { return links_.count(link) > 0; }
  bool empty() const { return links_.empty(); }
  /// A link of the body in contact; null where none is.
  const std::string* linkOf(int body) const {
    const auto found = first_.find(body);
    return found == first_.end() ? nullptr : &found->second;
  }
  /// Bodies in contact, and where.
  const std::map<int, std::vector<Vector3>>& points() const { return points_; }

 private:
  std::set<std::string> links_;
  std::map<int, std::string> first_;
  std::map<int, std::vector<Vector3>> points_;
};

/// The link with a shape at the far end of a body that carries no other; null where it has none.
const std::string* endLink(const Model& model, int body) {
  if (model.bodies[idx(body)].subtreeEnd != body + 1) return nullptr;
  const std::string* end = nullptr;
  std::pair<bool, double> best;
  for (const Geometry& g : model.geometries) {
    if (g.body != body) continue;
    const std::pair<bool, double> far = {isCalledFoot(g.link), reachOf(g)};
    if (!end || best < far) end = &g.link, best = far;
  }
  return end;
}

double lowestOf(const Model& model, const Kinematics& k, const std::string& link) {
  double lowest = kInfinity;
  for (const Geometry& g : model.geometries)
    if (g.link == link)
      lowest = std::min(lowest, collision::lowestPoint(g.shape, k.X_WB[g.body] * g.X_BG));
  return lowest;
}

/// Bodies from behind the root to `body`.
std::vector<int> legOf(const Model& model, int root, int body) {
  std::vector<int> leg;
  for (int b = body; b != root && b != 0; b = model.bodies[idx(b)].parent) leg.push_back(b);
  std::reverse(leg.begin(), leg.end());
  return leg;
}

/// The knee of a leg that ends at a point; −1 where it has none, or a bent one.
int straightKnee(const Model& model, const Kinematics& k, const std::vector<int>& leg,
                 const Vector3& contact) {
  double length = 0.0;
  for (std::size_t i = 1; i < leg.size(); ++i)
    length += (k.X_WB[leg[i]].p - k.X_WB[leg[i - 1]].p).norm();
  const Vector3 start = k.X_WB[leg.front()].p;
  const double shin = (contact - k.X_WB[leg.back()].p).norm();
  const bool endsInShin = shin > kFoot * (length + shin);
  const Vector3 end = endsInShin ? contact : k.X_WB[leg.back()].p;
  if (endsInShin) length += shin;
  int knee = -1;
  double longest = 0.0, bend = 0.0;
  for (const int body : leg) {
    if (model.bodies[idx(body)].joint != JointKind::revolute) continue;
    const Vector3 axis = k.X_WB[body].R * model.bodies[idx(body)].axis, at = k.X_WB[body].p;
    const auto lever = [&](const Vector3& p) -> Vector3 {
      return (p - at) - axis * axis.dot(p - at);
    };
    const Vector3 up = lever(start), down = lever(end);
    if (std::min(up.norm(), down.norm()) < kLever * length) continue;
    if (up.norm() * down.norm() <= longest) continue;
    longest = up.norm() * down.norm();
    bend = std::acos(std::clamp(-up.dot(down) / longest, -1.0, 1.0));
    knee = body;
  }
  return bend < kStraight ? knee : -1;
}

}  // namespace

std::optional<std::string> standingWarning(const Model& model, const Kinematics& start, int tree,
                                           const ContactSet& touching) {
  const Tree& t = model.trees[idx(tree)];
  const Support support(model, t, touching);
  if (support.empty()) return std::nullopt;
  const double ground = collision::lowestPoint(model, start, tree);
  std::string text;
  std::vector<std::string> others;
  for (int leaf = t.rootBody + 1; leaf < t.bodyEnd; ++leaf) {
    const std::string* end = endLink(model, leaf);
    if (!end || support.has(*end)) continue;
    const double height = lowestOf(model, start, *end) - ground;
    if (height < kInTheAir) continue;
    const std::string* standsOn = nullptr;
    for (int b = leaf; b != 0 && !standsOn; b = model.bodies[idx(b)].parent)
      if (b != t.rootBody || isCalledFoot(*end)) standsOn = support.linkOf(b);
    if (!standsOn) continue;
    if (text.empty())
      text =
          fmt::format("stands on {}, {} is {} in the air", *standsOn, *end, io::lengthText(height));
    else
      others.push_back(*end);
  }
  if (text.empty()) return std::nullopt;
  if (!others.empty()) text += ", and so are " + io::detail::listed(others, kMostFeet);
  return text;
}

std::vector<std::string> straightKnees(const Model& model, const Kinematics& start, int tree,
                                       const ContactSet& touching) {
  const Tree& t = model.trees[idx(tree)];
  std::vector<std::string> knees;
  const Support support(model, t, touching);
  for (const auto& [body, points] : support.points()) {
    const std::vector<int> leg = legOf(model, t.rootBody, body);
    if (leg.size() < 2) continue;
    Vector3 center = Vector3::Zero();
    for (const Vector3& p : points) center += p / static_cast<double>(points.size());
    if (const int knee = straightKnee(model, start, leg, center); knee >= 0)
      if (const std::string& name = model.jointNames[idx(knee)];
          std::find(knees.begin(), knees.end(), name) == knees.end())
        knees.push_back(name);
  }
  return knees;
}

}  // namespace softgauss
