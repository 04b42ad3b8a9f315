// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/standing_balance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::gdd {
namespace {

constexpr double kTimesReach = 30.0;
constexpr double kSwing = 0.1;          // what angular momentum counts against linear [m²]
constexpr double kRotationShare = 1.0;  // w_r over w of the base [m²]
constexpr double kFootShare = 0.01;     // the same of links on the ground [m²]
constexpr double kWithin = 0.75;        // λ
constexpr double kUnloaded = 0.9;       // of the support, for what is to be lifted
constexpr double kFar = 0.01;           // [m]
constexpr double kLowered = 5e-3;       // [m]
constexpr double kRisen = 2e-3;         // [m] above where it stood: it has left the ground
constexpr int kLeastFeet = 2;           // on which the robot stands while others are lifted
constexpr double kNoEdge = 20.0;        // [m/s²]: what allows as much is no edge
constexpr double kNoArea = 1e-8;        // [m²]: corners in a line

/// The other geometry's body is the world.
int bodyOnWorld(const Contact& c) {
  if (c.bodyA == 0) return c.bodyB;
  return c.bodyB == 0 ? c.bodyA : -1;
}

Vector3 upOf(const Model& model) {
  const double g = model.options.gravity.norm();
  const bool pulls = model.options.effects.has(Effect::gravity) && g > 0.0;
  return pulls ? Vector3(-model.options.gravity / g) : Vector3::Zero();
}

/// The convex hull of points, seen from above.
class Support {
 public:
  struct Edge {
    Vector3 n;     ///< outwards, of length 1
    double reach;  ///< n·p ≤ reach
  };

  explicit Support(const Vector3& up) : up_(up) {
    const Vector3 x = std::abs(up.x()) < 0.9 ? Vector3::UnitX() : Vector3::UnitY();
    t_ = (x - x.dot(up) * up).normalized();
    s_ = up.cross(t_);
  }
  void add(const Vector3& p) {
    if (count_ < kMostPoints) points_[idx(count_++)] = {t_.dot(p), s_.dot(p)};
    height_ = std::min(height_, up_.dot(p));
  }
  bool empty() const { return count_ == 0; }
  double height() const { return height_; }  ///< of the lowest point
  /// Finds edges and middle: to be called when all points are there.
  void close();
  const Edge* begin() const { return edges_.data(); }
  const Edge* end() const { return edges_.data() + edgeCount_; }
  /// n·x on the edge of the support shrunk to `share` about its middle.
  double bound(const Edge& edge, double share) const {
    const double m = edge.n.dot(middle_);
    return m + share * (edge.reach - m);
  }
  bool has(const Vector3& p, double share) const {
    return std::all_of(begin(), end(),
                       [&](const Edge& edge) { return edge.n.dot(p) <= bound(edge, share); });
  }

 private:
  static constexpr int kMostPoints = 128;
  using Point = Eigen::Vector2d;

  static double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }
  int hull(std::array<Point, 2 * kMostPoints>& corners);
  void addEdge(const Point& n, const Point& p) {
    edges_[idx(edgeCount_++)] = {n.x() * t_ + n.y() * s_, n.dot(p)};
  }

  Vector3 up_, t_, s_, middle_ = Vector3::Zero();
  std::array<Point, kMostPoints> points_;
  std::array<Edge, kMostPoints + 4> edges_;
  int count_ = 0, edgeCount_ = 0;
  double height_ = kInfinity;
};

/// Corners, counter-clockwise (Andrew's monotone chain); how many.
int Support::hull(std::array<Point, 2 * kMostPoints>& corners) {
  std::sort(points_.begin(), points_.begin() + count_, [](const Point& a, const Point& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  int n = 0, first = 0;
  const auto add = [&](const Point& p) {
    while (n >= first + 2 &&
           cross(corners[idx(n - 1)] - corners[idx(n - 2)], p - corners[idx(n - 1)]) <= kNoArea)
      --n;
    corners[idx(n++)] = p;
  };
  for (int i = 0; i < count_; ++i) add(points_[idx(i)]);
  first = --n;
  for (int i = count_; i-- > 0;) add(points_[idx(i)]);
  return std::max(1, n - 1);
}

void Support::close() {
  std::array<Point, 2 * kMostPoints> corners;
  const int n = hull(corners);
  Point middle = Point::Zero();
  double area = 0.0;
  for (int i = 0; i < n; ++i) {
    const Point &a = corners[idx(i)], &b = corners[idx((i + 1) % n)];
    const Point along = b - a;
    if (n > 2 || (n == 2 && i == 0)) {
      const Point normal = Point(along.y(), -along.x()).normalized();
      addEdge(normal, a);
      if (n == 2)
        addEdge(-normal, a), addEdge(along.normalized(), b), addEdge(-along.normalized(), a);
    }
    const double twice = cross(a - corners[0], b - corners[0]);
    area += twice;
    middle += n > 2 ? Point(twice / 3.0 * (a + b + corners[0])) : Point(a / n);
  }
  if (n == 1)
    for (const Point& axis : {Point(1, 0), Point(-1, 0), Point(0, 1), Point(0, -1)})
      addEdge(axis, corners[0]);
  if (n > 2) middle /= area;
  middle_ = middle.x() * t_ + middle.y() * s_;
}

/// The centre of mass of a robot, and its velocity.
struct MassCenter {
  Vector3 p = Vector3::Zero(), v = Vector3::Zero();

  MassCenter(const Model& model, const Kinematics& k, int robot) {
    double mass = 0.0;
    for (int b = 1; b < model.bodyCount(); ++b) {
      const Body& body = model.bodies[idx(b)];
      if (body.robot != robot || body.mass == 0.0) continue;
      const Vector3 at = k.X_WB[idx(b)] * body.com;
      mass += body.mass;
      p += body.mass * at;
      v += body.mass * pointVelocity(model, k, b, at);
    }
    if (mass > 0.0) p /= mass, v /= mass;
  }
};

/// ω₀ of the linear inverted pendulum; 0 where there is none.
double swayRate(const Model& model, double height) {
  return height > 1e-3 ? std::sqrt(model.options.gravity.norm() / height) : 0.0;
}

}  // namespace

StandingBalance::StandingBalance(const Model& model, int tree, const Kinematics& start)
    : base(model.trees[idx(tree)].rootBody), X_WBase(start.X_WB[idx(base)]), defaultWeight(0.0) {
  isRegulariser = true;
  robot = model.bodies[idx(base)].robot;
  weight = kTimesReach * kReachWeightPerMass * massOfRobot(model, robot);
  defaultWeight = DefaultWeight(weight);
}

StandingBalance::Goals StandingBalance::ofRobotsThatStand(const Model& model, const State& start,
                                                          ContactSource& contacts) {
  Goals goals;
  const Vector3 up = upOf(model);
  if (up.isZero() || !contacts.mayTouch()) return goals;
  State lowered = start;
  for (int t = 0; t < static_cast<int>(model.trees.size()); ++t)
    if (model.floats(t))
      lowered.q.segment<3>(model.bodies[idx(model.trees[idx(t)].rootBody)].q) -= kLowered * up;
  Kinematics k(model), kLow(model);
  computeKinematics(model, start, k);
  computeKinematics(model, lowered, kLow);
  ContactSet touching;
  contacts.detect(model, kLow, touching);
  for (int t = 0; t < static_cast<int>(model.trees.size()); ++t) {
    const Tree& tree = model.trees[idx(t)];
    if (!model.floats(t) || !tree.actuated) continue;
    std::unique_ptr<StandingBalance> goal(new StandingBalance(model, t, k));
    Support support(up);
    std::vector<int> carries(idx(model.bodyCount()), 0);  // feet that a body moves
    for (const Contact& c : touching.contacts) {
      const int body = bodyOnWorld(c);
      if (body < tree.rootBody || body >= tree.bodyEnd) continue;
      support.add(c.p_WC);
      auto foot = std::find_if(goal->feet.begin(), goal->feet.end(),
                               [&](const Foot& known) { return known.body == body; });
      if (foot == goal->feet.end()) {
        goal->feet.push_back({body, {}, {}, kInfinity});
        foot = goal->feet.end() - 1;
        for (int b = body; b > 0; b = model.bodies[idx(b)].parent) ++carries[idx(b)];
      }
      foot->p_BP.push_back(kLow.X_WB[idx(body)].inverse() * c.p_WC);
      foot->height = std::min(foot->height, up.dot(k.X_WB[idx(body)] * foot->p_BP.back()));
    }
    for (Foot& foot : goal->feet)
      for (int b = foot.body; b != goal->base && carries[idx(b)] == 1;
           b = model.bodies[idx(b)].parent)
        foot.leg.push_back(b);
    support.close();
    if (!support.empty() && support.has(MassCenter(model, k, goal->robot).p, 1.0))
      goals.push_back(std::move(goal));
  }
  return goals;
}

namespace {

/// Whether the foot touches the world or has not left where it stood, and the points on which it
/// stands: of one that rolls those where it touches.
bool addCarried(const StandingBalance::Foot& foot, const GoalContext& context, const Vector3& up,
                Support* support) {
  const Transform& X = context.data.kinematics.X_WB[idx(foot.body)];
  const auto& contacts = context.data.contacts.contacts;
  const auto isOfFoot = [&](const Contact& c) { return bodyOnWorld(c) == foot.body; };
  const bool touches = std::any_of(contacts.begin(), contacts.end(), isOfFoot);
  double lowest = kInfinity;
  for (const Vector3& p : foot.p_BP) lowest = std::min(lowest, up.dot(X * p));
  const bool stands = lowest < foot.height + kRisen;
  if (!touches && !stands) return false;
  if (!support) return true;
  if (stands)
    for (const Vector3& p : foot.p_BP) support->add(X * p);
  else
    for (const Contact& c : contacts)
      if (isOfFoot(c)) support->add(c.p_WC);
  return true;
}

}  // namespace

bool StandingBalance::lifts(const GoalContext& context, const Goal& goal, const Foot& foot) const {
  if (&goal == this || goal.linkFrame() < 0 || !goal.actsAt(context.state.time)) return false;
  const int body = context.model.frames[idx(goal.linkFrame())].body;
  if (std::find(foot.leg.begin(), foot.leg.end(), body) == foot.leg.end()) return false;
  const std::optional<GoalMark> mark = goal.mark(context);
  return mark && ((mark->p_WTarget - mark->p_WPoint).norm() > kFar ||
                  !addCarried(foot, context, upOf(context.model), nullptr));
}

/// Whether it seeks a place below where the foot stands.
bool StandingBalance::presses(const GoalContext& context, const Goal& goal, const Foot& foot,
                              const Vector3& up) const {
  const std::optional<GoalMark> mark = goal.mark(context);
  return mark && up.dot(mark->p_WTarget - mark->p_WPoint) < -kFar &&
         addCarried(foot, context, up, nullptr);
}

bool StandingBalance::isSought(const GoalContext& context, const Goals& others,
                               const Foot& foot) const {
  return std::any_of(others.begin(), others.end(),
                     [&](const auto& goal) { return lifts(context, *goal, foot); });
}

bool StandingBalance::isLifted(const GoalContext& context, const Goals& others,
                               const Foot& foot) const {
  const Vector3 up = upOf(context.model);
  const bool isPressed = std::any_of(others.begin(), others.end(), [&](const auto& goal) {
    return lifts(context, *goal, foot) && presses(context, *goal, foot, up);
  });
  return isSought(context, others, foot) && !isPressed &&
         std::count_if(feet.begin(), feet.end(), [&](const Foot& other) {
           return !isSought(context, others, other);
         }) >= kLeastFeet;
}

bool StandingBalance::holdsBack(const GoalContext& context, const Goals& others,
                                const Goal& goal) const {
  if (goal.linkFrame() < 0) return false;
  const Vector3 up = upOf(context.model);
  const auto of = std::find_if(feet.begin(), feet.end(),
                               [&](const Foot& foot) { return lifts(context, goal, foot); });
  if (of == feet.end()) return false;
  if (up.isZero()) return false;
  if (!isLifted(context, others, *of) || presses(context, goal, *of, up)) return true;
  if (!addCarried(*of, context, up, nullptr)) return false;
  Support rest(up);
  for (const Foot& foot : feet)
    if (!isLifted(context, others, foot)) addCarried(foot, context, up, &rest);
  if (rest.empty()) return false;
  rest.close();
  const MassCenter center(context.model, context.data.kinematics, robot);
  const double omega = swayRate(context.model, up.dot(center.p) - rest.height());
  return omega > 0.0 && !rest.has(center.p + center.v / omega, kUnloaded);
}

void StandingBalance::keepUp(const GoalContext& context, const Vector3& up, GoalCost& cost) const {
  const Kinematics& k = context.data.kinematics;
  const Transform& X = k.X_WB[idx(base)];
  {
    const LinkRows rows(context, base, X.p, cost.workspace());
    const Vector3 turn = quaternionLog(Quaternion(Matrix3(X_WBase.R * X.R.transpose())));
    const Vector3 alpha =
        stiffness * turn - damping * rows.velocity.tail<3>() - rows.bias.tail<3>();
    cost.addRows(rows.J.bottomRows<3>(), kRotationShare * weight, alpha);
    const Eigen::Matrix<double, 1, 1> wished(stiffness * up.dot(X_WBase.p - X.p) -
                                             damping * up.dot(rows.velocity.head<3>()) -
                                             up.dot(rows.bias.head<3>()));
    cost.workspace().rows.row(0).noalias() = up.transpose() * rows.J.topRows<3>();
    cost.addRows(cost.workspace().rows.topRows(1), weight, wished);
  }
  for (const Foot& foot : feet) {
    if (!addCarried(foot, context, up, nullptr)) continue;
    Vector3 middle = Vector3::Zero();
    for (const Vector3& p : foot.p_BP) middle += p / static_cast<double>(foot.p_BP.size());
    const LinkRows rows(context, foot.body, k.X_WB[idx(foot.body)] * middle, cost.workspace());
    const Vector6 wished = -damping * rows.velocity;
    const bool isFlat = foot.p_BP.size() > 2;  // a ball or an edge turns about where it stands
    addLinkCost(context, rows, wished.head(isFlat ? 6 : 3), {weight, kFootShare * weight}, cost);
  }
}

void StandingBalance::addCost(const GoalContext& context, const Goals& others,
                              GoalCost& cost) const {
  const Vector3 up = upOf(context.model);
  if (up.isZero()) return;
  Support support(up);
  bool lifted = false;
  for (const Foot& foot : feet) lifted = lifted || isLifted(context, others, foot);
  for (const Foot& foot : feet)
    if (!lifted || !isLifted(context, others, foot)) addCarried(foot, context, up, &support);
  if (support.empty()) return;
  support.close();
  if (lifted) keepUp(context, up, cost);
  Centroidal& c = cost.workspace().centroidal;
  computeCentroidal(context.model, context.data.kinematics, context.data.inertia, robot, c);
  const double omega = swayRate(context.model, up.dot(c.p_WC) - support.height());
  if (omega == 0.0) return;
  if (lifted) {  // else arms and trunk swing for what the feet cannot do
    const Vector3 slows = -rate * c.momentum.tail<3>() - c.bias.tail<3>();
    cost.addRows(c.A.bottomRows<3>(), weight / (c.mass * c.mass * kSwing), slows);
  }
  for (const Support::Edge& edge : support) {
    const double v = edge.n.dot(c.v_WC);
    const double beyond = edge.n.dot(c.p_WC) + v / omega - support.bound(edge, kWithin);
    const double most = -omega * (v + rate * beyond);  // of n·ẍ
    if (most > kNoEdge) continue;
    cost.workspace().dofs.noalias() = c.A.topRows<3>().transpose() * (edge.n / -c.mass);
    cost.addOneSided(cost.workspace().dofs, weight, edge.n.dot(c.bias.head<3>()) / c.mass - most);
  }
}

std::unique_ptr<Goal> StandingBalance::within(const Model& whole, const SubModel& island) const {
  std::unique_ptr<StandingBalance> part(new StandingBalance(*this));
  part->base = island.bodyOf(whole, base);
  if (part->base < 0) return nullptr;
  for (Foot& foot : part->feet) {
    foot.body = island.bodyOf(whole, foot.body);
    for (int& body : foot.leg) body = island.bodyOf(whole, body);
  }
  return part;
}

void addCostAmong(const std::vector<std::unique_ptr<Goal>>& goals, const Goal& goal,
                  const GoalContext& context, GoalCost& cost) {
  for (const auto& other : goals) {
    const auto* balance = dynamic_cast<const StandingBalance*>(other.get());
    if (!balance || !balance->actsAt(context.state.time)) continue;
    if (balance == &goal) return balance->addCost(context, goals, cost);
    if (balance->holdsBack(context, goals, goal)) return;
  }
  goal.addCost(context, cost);
}

}  // namespace softgauss::gdd
