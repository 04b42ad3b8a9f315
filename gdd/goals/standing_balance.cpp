// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/standing_balance.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/dynamics/jacobian.hpp"
#include "softgauss/gdd/goals/posture.hpp"
#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::gdd {
namespace {

constexpr double kTimesReach = 100.0;
constexpr double kSwing = 0.1;          // what angular momentum counts against linear [m²]
constexpr double kFlatShare = 0.03;     // of w: of points on which a foot stands
constexpr double kFlatRate = 20.0;      // γ [1/s]
constexpr double kFlatPlay = 0.5e-3;    // z₀ [m]
constexpr double kRotationShare = 1.0;  // w_r over w of the base [m²]
constexpr double kFootShare = 0.01;     // the same of links on the ground [m²]
constexpr double kHeldShare = 0.3;      // of w: of what is held while a foot is lifted
constexpr double kWithin = 0.75;        // λ
constexpr double kSteady = 0.3;         // ρ at which goals begin to fade
constexpr double kUnsteady = 0.8;       // ρ at which nothing is left of them
constexpr double kTurned = 0.3;         // turn of the base at which goals begin to fade [rad]
constexpr double kStrongest = 0.2;      // a place that is farther pulls no more than this far [m]
constexpr double kUnloaded = 0.9;       // of the support, for what is to be lifted
constexpr double kFar = 0.01;           // [m]
constexpr double kLowered = 5e-3;       // [m]
constexpr double kRisen = 2e-3;         // [m] above where it stood: it has left the ground
constexpr int kLeastFeet = 2;           // on which the robot stands while others are lifted
constexpr double kNoRise = 0.04;        // [m/s²]: what rises by 1 mm/s while all is steady stays
constexpr double kNoEdge = 20.0;        // [m/s²]: what allows as much is no edge

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
  p_WStart = MassCenter(model, start, robot).p;
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
    SupportPolygon support(up);
    std::vector<int> carries(idx(model.bodyCount()), 0);  // feet that a body moves
    for (const Contact& c : touching.contacts) {
      const int body = bodyOnWorld(c);
      if (body < tree.rootBody || body >= tree.bodyEnd) continue;
      support.add(c.p_WC);
      auto foot = std::find_if(goal->feet.begin(), goal->feet.end(),
                               [&](const Foot& known) { return known.body == body; });
      if (foot == goal->feet.end()) {
        goal->feet.push_back({body, {}, {}});
        foot = goal->feet.end() - 1;
        for (int b = body; b > 0; b = model.bodies[idx(b)].parent) ++carries[idx(b)];
      }
      const Vector3 p_BP = kLow.X_WB[idx(body)].inverse() * c.p_WC;
      foot->points.push_back({p_BP, up.dot(k.X_WB[idx(body)] * p_BP)});
    }
    for (Foot& foot : goal->feet)
      for (int b = foot.body; b != goal->base && carries[idx(b)] == 1;
           b = model.bodies[idx(b)].parent)
        foot.leg.push_back(b);
    support.close();
    if (!support.empty() && support.has(goal->p_WStart, 1.0)) goals.push_back(std::move(goal));
  }
  return goals;
}

namespace {

/// Whether the foot touches the world or has not left where it stood, and the points on which it
/// stands: of one that rolls those where it touches.
bool addCarried(const StandingBalance::Foot& foot, const GoalContext& context, const Vector3& up,
                SupportPolygon* support) {
  const Transform& X = context.data.kinematics.X_WB[idx(foot.body)];
  const auto& contacts = context.data.contacts.contacts;
  const auto isOfFoot = [&](const Contact& c) { return bodyOnWorld(c) == foot.body; };
  const bool touches = std::any_of(contacts.begin(), contacts.end(), isOfFoot);
  const bool stands = std::any_of(foot.points.begin(), foot.points.end(), [&](const auto& point) {
    return up.dot(X * point.p_BP) < point.height + kRisen;
  });
  if (!touches && !stands) return false;
  if (!support) return true;
  if (stands)
    for (const auto& point : foot.points) support->add(X * point.p_BP);
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

SupportPolygon StandingBalance::rest(const GoalContext& context, const Goals& others) const {
  const Vector3 up = upOf(context.model);
  SupportPolygon support(up);
  for (const Foot& foot : feet)
    if (!isLifted(context, others, foot)) addCarried(foot, context, up, &support);
  if (!support.empty()) support.close();
  return support;
}

/// ξ; nothing where the robot stands on nothing or is no pendulum.
std::optional<Vector3> StandingBalance::capturePoint(const GoalContext& context,
                                                     const SupportPolygon& support) const {
  if (support.empty()) return std::nullopt;
  const MassCenter center(context.model, context.data.kinematics, robot);
  const double omega =
      swayRate(context.model, upOf(context.model).dot(center.p) - support.height());
  if (omega == 0.0) return std::nullopt;
  return center.p + center.v / omega;
}

/// The rotation vector of the base back to where it was at the start.
Vector3 StandingBalance::turnBack(const GoalContext& context) const {
  const Matrix3& R = context.data.kinematics.X_WB[idx(base)].R;
  return quaternionLog(Quaternion(Matrix3(X_WBase.R * R.transpose())));
}

double StandingBalance::steadiness(const GoalContext& context,
                                   const SupportPolygon& support) const {
  const std::optional<Vector3> point = capturePoint(context, support);
  if (!point) return 1.0;
  const auto fade = [](double x, double from, double to) {  // smoothly from 1 to 0
    const double s = std::clamp((to - x) / (to - from), 0.0, 1.0);
    return s * s * (3.0 - 2.0 * s);
  };
  return fade(support.wayToEdge(p_WStart, *point, kWithin), kSteady, kUnsteady) *
         fade(turnBack(context).norm(), kTurned, 2.0 * kTurned);
}

double StandingBalance::share(const GoalContext& context, const Goals& others,
                              const Goal& goal) const {
  const Vector3 up = upOf(context.model);
  if (goal.linkFrame() < 0 || up.isZero()) return 1.0;
  const int body = context.model.frames[idx(goal.linkFrame())].body;
  if (context.model.bodies[idx(body)].robot != robot) return 1.0;
  const auto of = std::find_if(feet.begin(), feet.end(),
                               [&](const Foot& foot) { return lifts(context, goal, foot); });
  if (of == feet.end()) {
    const std::optional<double> away = goal.error(context);
    return std::min(1.0, kStrongest / std::max(away.value_or(0.0), kStrongest)) *
           steadiness(context, rest(context, others));
  }
  if (!isLifted(context, others, *of) || presses(context, goal, *of, up)) return 0.0;
  if (!addCarried(*of, context, up, nullptr)) return 1.0;
  const SupportPolygon support = rest(context, others);
  const std::optional<Vector3> point = capturePoint(context, support);
  return point && !support.has(*point, kUnloaded) ? 0.0 : 1.0;
}

void StandingBalance::keepUp(const GoalContext& context, const Vector3& up, GoalCost& cost) const {
  const Kinematics& k = context.data.kinematics;
  const double held = kHeldShare * weight;
  const Transform& X = k.X_WB[idx(base)];
  {
    const LinkRows rows(context, base, X.p, cost.workspace());
    const Vector3 alpha =
        stiffness * turnBack(context) - damping * rows.velocity.tail<3>() - rows.bias.tail<3>();
    cost.addRows(rows.J.bottomRows<3>(), kRotationShare * held, alpha);
    const Eigen::Matrix<double, 1, 1> wished(stiffness * up.dot(X_WBase.p - X.p) -
                                             damping * up.dot(rows.velocity.head<3>()) -
                                             up.dot(rows.bias.head<3>()));
    cost.workspace().rows.row(0).noalias() = up.transpose() * rows.J.topRows<3>();
    cost.addRows(cost.workspace().rows.topRows(1), held, wished);
  }
  for (const Foot& foot : feet) {
    if (!addCarried(foot, context, up, nullptr)) continue;
    Vector3 middle = Vector3::Zero();
    for (const auto& point : foot.points)
      middle += point.p_BP / static_cast<double>(foot.points.size());
    const LinkRows rows(context, foot.body, k.X_WB[idx(foot.body)] * middle, cost.workspace());
    const Vector6 wished = -damping * rows.velocity;
    addLinkCost(context, rows, wished.head(foot.isFlat() ? 6 : 3), {held, kFootShare * held}, cost);
  }
}

/// What keeps a foot flat on the ground: of one that rolls, where it touches.
void StandingBalance::keepFlat(const Foot& foot, bool steady, const GoalContext& context,
                               const Vector3& up, GoalCost& cost) const {
  const Kinematics& k = context.data.kinematics;
  const auto keep = [&](const Vector3& p, double height) {
    const double v = up.dot(pointVelocity(context.model, k, foot.body, p));
    const double most =
        -kFlatRate *
        (2.0 * v + kFlatRate * std::max(0.0, height - kFlatPlay));  // of the acceleration upwards
    if (most > (steady ? -kNoRise : kNoEdge)) return;
    GoalWorkspace& work = cost.workspace();
    pointJacobian(context.model, k, foot.body, p, work.J.topRows<3>());
    work.dofs.noalias() = work.J.topRows<3>().transpose() * -up;
    cost.addOneSided(work.dofs, kFlatShare * weight,
                     up.dot(pointBiasAcceleration(context.model, k, foot.body, p)) - most);
  };
  if (foot.isFlat()) {
    const Transform& X = k.X_WB[idx(foot.body)];
    for (const auto& point : foot.points)
      keep(X * point.p_BP, up.dot(X * point.p_BP) - point.height);
  } else {
    for (const Contact& c : context.data.contacts.contacts)
      if (bodyOnWorld(c) == foot.body) keep(c.p_WC, c.distance);
  }
}

/// What slows the capture point towards the edges of the support.
void StandingBalance::keepWithin(const SupportPolygon& support, double omega, const Centroidal& c,
                                 GoalCost& cost) const {
  for (const SupportPolygon::Edge& edge : support) {
    const double v = edge.n.dot(c.v_WC);
    const double beyond = edge.n.dot(c.p_WC) + v / omega - support.bound(edge, kWithin);
    const double most = -omega * (v + rate * beyond);  // of n·ẍ
    if (most > kNoEdge) continue;
    cost.workspace().dofs.noalias() = c.A.topRows<3>().transpose() * (edge.n / -c.mass);
    cost.addOneSided(cost.workspace().dofs, weight, edge.n.dot(c.bias.head<3>()) / c.mass - most);
  }
}

void StandingBalance::addCost(const GoalContext& context, const Goals& others,
                              GoalCost& cost) const {
  const Vector3 up = upOf(context.model);
  if (up.isZero()) return;
  const SupportPolygon support = rest(context, others);
  if (support.empty()) return;
  const bool lifted = std::any_of(
      feet.begin(), feet.end(), [&](const Foot& foot) { return isLifted(context, others, foot); });
  if (lifted) keepUp(context, up, cost);
  const double steady = steadiness(context, support);
  for (const Foot& foot : feet)
    if (!isSought(context, others, foot) && addCarried(foot, context, up, nullptr))
      keepFlat(foot, steady == 1.0, context, up, cost);
  Centroidal& c = cost.workspace().centroidal;
  computeCentroidal(context.model, context.data.kinematics, context.data.inertia, robot, c);
  const double omega = swayRate(context.model, up.dot(c.p_WC) - support.height());
  if (omega == 0.0) return;
  const double unsteady = lifted ? kHeldShare : 1.0 - steady;
  if (unsteady > 0.0) {  // else arms and trunk swing for what the feet cannot do
    const Vector3 slows = -rate * c.momentum.tail<3>() - c.bias.tail<3>();
    cost.addRows(c.A.bottomRows<3>(), unsteady * weight / (c.mass * c.mass * kSwing), slows);
  }
  keepWithin(support, omega, c, cost);
}

namespace {

/// The goal as a balance that acts now, else null.
const StandingBalance* actingBalance(const Goal& goal, double time) {
  const auto* balance = dynamic_cast<const StandingBalance*>(&goal);
  return balance && balance->actsAt(time) ? balance : nullptr;
}

}  // namespace

double shareAmong(const std::vector<std::unique_ptr<Goal>>& goals, const Goal& goal,
                  const GoalContext& context, int* by) {
  double share = 1.0;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const StandingBalance* balance = actingBalance(*goals[i], context.state.time);
    if (!balance) continue;
    const double least = balance->share(context, goals, goal);
    if (least < share && by) *by = static_cast<int>(i);
    share = std::min(share, least);
  }
  return share;
}

void addCostAmong(const std::vector<std::unique_ptr<Goal>>& goals, const Goal& goal,
                  const GoalContext& context, GoalCost& cost, const Goal* part) {
  if (const auto* balance = dynamic_cast<const StandingBalance*>(&goal))
    return balance->addCost(context, goals, cost);
  const double share = shareAmong(goals, goal, context);
  if (share == 0.0) return;
  double& placeShare = cost.workspace().placeShare = 1.0;
  if (dynamic_cast<const Posture*>(&goal))
    for (const auto& other : goals)
      if (const StandingBalance* balance = actingBalance(*other, context.state.time))
        placeShare *= balance->steadiness(context, balance->rest(context, goals));
  cost.setShare(share);
  (part ? *part : goal).addCost(context, cost);
  cost.setShare(1.0);
}

}  // namespace softgauss::gdd
