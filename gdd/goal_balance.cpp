// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goal_balance.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "softgauss/engine/step/inverse.hpp"
#include "softgauss/gdd/goals/posture.hpp"
#include "softgauss/gdd/goals/reach.hpp"
#include "softgauss/gdd/goals/standing_balance.hpp"

namespace softgauss::gdd {
namespace {

using Kind = Opponent::Kind;

constexpr double kAtBound = 1e-7;   // of a bound, or of 1
constexpr double kFastShare = 0.5;  // of a velocity limit: slower is not held by it
constexpr double kPulls = 1e-9;     // of the pull that free controls would have: less is none
constexpr double kLeast = 1e-9;     // share that is told
constexpr double kSingular = 1e-4;  // of |∇ℓ|²: the place is within 0.6° of where nothing moves

/// x as a slope in y, of g = T y.
VectorX inCoordinates(const ControlLimits& limits, const VectorX& x) {
  return limits.transmission ? VectorX(limits.transmission->T().transpose() * x) : x;
}

/// A reach of a pose in two: its place, its orientation.
std::unique_ptr<Goal> partOf(const Reach& reach, bool orientation) {
  auto part = std::make_unique<Reach>(reach);
  (orientation ? part->weight : part->rotationWeight) = 0.0;
  return part;
}

/// What a row is to a person.
template <class Rows>
Opponent opponentOf(const Rows& rows, int kind, int row) {
  if constexpr (requires { rows.contactsWithRows(); }) {
    const ContactRows& contact = rows.contactsWithRows()[idx(rows.contactOfRow(row))];
    return {Kind::contact, std::min(contact.geometryA, contact.geometryB),
            std::max(contact.geometryA, contact.geometryB)};
  } else if constexpr (requires { rows.dof(row); }) {
    const auto of = static_cast<RowKind>(kind);
    if (of == RowKind::servo) return {Kind::servo, rows.dof(row)};
    return {of == RowKind::jointLimit ? Kind::range : Kind::dryFriction, rows.dof(row)};
  } else {
    return {Kind::equality};
  }
}

}  // namespace

/// Pulls along a direction, by what they are of; > 0 opposes.
struct GoalBalance::Sum {
  std::map<std::tuple<Kind, int, int>, double> pulls;

  void add(const Opponent& of, double pull) { pulls[{of.kind, of.index, of.other}] += pull; }
  std::vector<Opponent> opponents() const {
    double all = 0.0;
    for (const auto& [of, pull] : pulls) all += std::max(0.0, pull);
    std::vector<Opponent> list;
    for (const auto& [of, pull] : pulls)
      if (pull > kLeast * all)
        list.push_back({std::get<0>(of), std::get<1>(of), std::get<2>(of), pull / all});
    std::stable_sort(list.begin(), list.end(),
                     [](const Opponent& a, const Opponent& b) { return a.share > b.share; });
    return list;
  }
};

GoalBalance::GoalBalance(const Model& model, const GoalDirectedController& controller)
    : model_(model),
      controller_(controller),
      data_(model),
      cost_(model.nv),
      activeSet_(model),
      augmentedLagrangian_(model),
      expansion_(model),
      holding_(model) {
  activeSet_.options = controller.activeSet.options;
  activeSet_.options.longestSearchWait = 0;  // the minimum where the run is, no other
  augmentedLagrangian_.options = controller.augmentedLagrangian.options;
  expansion_.tolerance = controller.expansion.tolerance;
  expansion_.maxSolves = controller.expansion.maxSolves;
  for (int i = 0; i < model.nv; ++i)
    driven_.push_back(controller.limits.lower[i] < controller.limits.upper[i]);
}

void GoalBalance::listTerms(double time) {
  terms_.clear();
  const std::vector<std::string> names = distinctNames(controller_.goals);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Goal* const goal = controller_.goals[i].get();
    if (!goal->actsAt(time)) continue;
    const auto* reach = dynamic_cast<const Reach*>(goal);
    const bool isPose = reach && reach->R_WTarget;
    for (const bool orientation : {false, true}) {
      if (orientation && !isPose) continue;
      Term term;
      term.goal = goal, term.name = names[i] + (orientation ? " (orientation)" : "");
      if (isPose) term.own = partOf(*reach, orientation);
      terms_.push_back(std::move(term));
    }
  }
}

void GoalBalance::findShares(const State& state) {
  for (Term& term : terms_) {
    int by = -1;
    term.share = shareAmong(controller_.goals, *term.goal, {model_, state, data_}, &by);
    if (by >= 0) term.fadesFor = find(*controller_.goals[idx(by)], "");
  }
}

int GoalBalance::find(const Goal& goal, const std::string& name) const {
  int found = -1;
  for (int i = 0; i < goalCount(); ++i) {
    if (terms_[idx(i)].goal != &goal) continue;
    if (terms_[idx(i)].name == name) return i;
    if (found < 0) found = i;
  }
  return found;
}

/// ∇ℓ_k at a, for the rows as they were last evaluated; leaves the goal's prices in cost_.
VectorX GoalBalance::slopeOf(const Term& term, const State& state, const VectorX& a) {
  cost_.clear();
  addCostAmong(controller_.goals, *term.goal, {model_, state, data_}, cost_, term.own.get());
  if (cost_.hasSides()) cost_.chooseSides(a);
  VectorX Ma(model_.nv), slope = VectorX::Zero(model_.nv);
  if (cost_.hasFunctions() && !cost_.expand(data_.inertia.M, a, 0.0)) return slope;
  data_.inertia.M.multiply(a, Ma);
  cost_.gradient(a, Ma, slope);
  ContactForceTerms forces;
  forces.setCost(cost_.forces());
  forces.evaluate(data_.constraints);
  forces.addGradient(data_.constraints, slope);
  return slope;
}

/// 2 ℓ tr(D⁻¹∇²ℓ) of the rows that are in cost_.
double GoalBalance::mostSlope(const VectorX& a) {
  VectorX unit(model_.nv), Mx(model_.nv), column(model_.nv);
  double trace = 0.0;
  for (int i = 0; i < model_.nv; ++i) {
    unit = VectorX::Unit(model_.nv, i);
    data_.inertia.M.multiply(unit, Mx);
    cost_.multiplyCurvature(unit, Mx, column);
    trace += column[i] / inertia_[i];
  }
  data_.inertia.M.multiply(a, Mx);
  return 2.0 * cost_.value(a, Mx) * trace;
}

/// What each goal would pull with if nothing moved.
void GoalBalance::findStillSlopes(const Input& input, State state, ContactSource* contacts) {
  state.v.setZero();
  if (isRefused(computeStages(model_, input, state, data_, contacts))) return;
  const VectorX rest = VectorX::Zero(model_.nv);
  bool changed = false;
  data_.constraints.setResidual(rest);
  data_.constraints.evaluate(changed);
  for (Term& term : terms_)
    if (term.goal->steadyAt(state.time)) term.still = slopeOf(term, state, rest);
}

bool GoalBalance::findAcceleration(const State& state) {
  data_.forces.c -= data_.forces.tau;  // what acts besides the control
  controller_.addCost(model_, state, data_, holding_, cost_);
  expansion_.iterationsLeft = std::numeric_limits<int>::max();
  const auto solved = [&](auto& solver) {
    return !isRefused(solveOneSided(expansion_, solver, model_, cost_, controller_.limits, data_,
                                    state.warmstart, between_)
                          .status);
  };
  const bool paths =
      controller_.solver == GddSolver::activeSet && data_.constraints.piecewiseQuadratic();
  if (!(paths ? solved(activeSet_) : solved(augmentedLagrangian_))) return false;
  a_ = expansion_.acceleration();
  expansion_.keepWarmStart(warm_);
  return !isRefused(inverseDynamics(model_, a_, data_, g_));
}

/// The slopes of goals, of motion limits and of the price of force.
void GoalBalance::findSlopes(const State& state) {
  ControlCostTerm R(model_.nv);
  R.set(controller_.forceMetric);
  const ControlCostTerm& whole = cost_.controlCost();
  if (whole.hasFree()) R.setFree(holding_.force());
  R.prepare(massFactor_);
  VectorX Rg(model_.nv);
  R.multiply(massFactor_, g_, Rg);
  if (R.hasFree()) Rg -= R.freeSlope();
  costSlope_ = inCoordinates(controller_.limits, Rg);
  for (Term& term : terms_) {
    term.slope = slopeOf(term, state, a_);
    if (dynamic_cast<const Reach*>(term.goal)) term.most = mostSlope(a_);
    const ControlCostTerm& W = cost_.controlCost();
    term.price = W.diagonal().cwiseProduct(g_);
    for (int k = 0; k < W.directionCount(); ++k)
      term.price += W.direction(k).dot(g_) * W.direction(k);
    term.price = inCoordinates(controller_.limits, term.price);
  }
  motionSlope_ = VectorX::Zero(model_.nv);
  if (!controller_.motionLimits) return;
  cost_.clear();
  controller_.motionLimits->addCost({model_, state, data_}, controller_.limits, cost_);
  cost_.chooseSides(a_);
  VectorX Ma(model_.nv);
  data_.inertia.M.multiply(a_, Ma);
  cost_.gradient(a_, Ma, motionSlope_);
}

/// λ and μ, of P w = J_Kᵀμ − Σ∇ℓ.
void GoalBalance::findMultipliers() {
  const ControlLimits& limits = controller_.limits;
  VectorX w = -motionSlope_, y;
  for (const Term& term : terms_) w -= term.slope;
  double scale = 1e-300;
  const auto seen = [&](VectorX slope) {
    factor_.solve(slope);
    scale = std::max(scale, inCoordinates(limits, slope).cwiseAbs().maxCoeff());
  };
  for (const Term& term : terms_) seen(term.slope);
  factor_.solve(w);
  lambda_ = inCoordinates(limits, w) - costSlope_;
  for (const Term& term : terms_) lambda_ -= term.price;

  limits.coordinates(g_, y);
  std::vector<Eigen::Index> within;
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const auto meets = [&](double bound) {
      return std::abs(y[i] - bound) <= kAtBound * std::max(1.0, std::abs(bound));
    };
    if (driven_[idx(i)] && !meets(limits.lower[i]) && !meets(limits.upper[i])) within.push_back(i);
  }
  held_.clear();
  heldRows_.clear();
  for (const BreakpointKey& name : warm_.breakpoints)
    if (const auto breakpoint = data_.constraints.find(name)) held_.push_back(*breakpoint);
  const auto rows = static_cast<Eigen::Index>(within.size());
  MatrixX A(rows, static_cast<Eigen::Index>(held_.size())), x(model_.nv, A.cols());
  for (Eigen::Index k = 0; k < A.cols(); ++k) {
    VectorX J(model_.nv);
    data_.constraints.breakpointGradient(held_[idx(k)], J);
    heldRows_.push_back(J);
    factor_.solve(J);
    x.col(k) = inCoordinates(limits, J);
    for (Eigen::Index i = 0; i < rows; ++i) A(i, k) = x(within[idx(i)], k);
  }
  mu_ = VectorX::Zero(A.cols());
  if (rows > 0 && A.cols() > 0) {
    VectorX b(rows);
    for (Eigen::Index i = 0; i < rows; ++i) b[i] = -lambda_[within[idx(i)]];
    mu_ = A.completeOrthogonalDecomposition().solve(b);
    lambda_ += x * mu_;
  }
  imbalance_ = 0.0;
  for (const Eigen::Index i : within) {
    imbalance_ = std::max(imbalance_, std::abs(lambda_[i]) / scale);
    lambda_[i] = 0.0;
  }
}

bool GoalBalance::solve(const Input& input, const State& state, ContactSource* contacts) {
  Input held = input;
  controller_.markControlled(model_, held.controlled);
  listTerms(state.time);
  findStillSlopes(held, state, contacts);
  if (isRefused(computeStages(model_, held, state, data_, contacts))) return false;
  findShares(state);
  if (!findAcceleration(state)) return false;
  inverseDynamicsJacobian(data_, P_);
  if (!factor_.compute(P_) || !massFactor_.compute(data_.inertia.hat())) return false;
  velocity_ = state.v;
  inertia_.resize(model_.nv);
  for (int i = 0; i < model_.nv; ++i) inertia_[i] = data_.inertia.hat().row(i)[i];
  findSlopes(state);
  findMultipliers();
  return true;
}

/// The acceleration nearest to D⁻¹ wish that the controls can cause.
VectorX GoalBalance::direction(const VectorX& wish) const {
  const VectorX free = wish.cwiseQuotient(inertia_);
  std::vector<int> controls;
  for (int i = 0; i < model_.nv; ++i)
    if (driven_[idx(i)]) controls.push_back(i);
  if (static_cast<int>(controls.size()) == model_.nv) return free;
  if (controls.empty()) return VectorX::Zero(model_.nv);
  const ControlLimits& limits = controller_.limits;
  MatrixX S(model_.nv, static_cast<Eigen::Index>(controls.size()));
  for (Eigen::Index k = 0; k < S.cols(); ++k) {
    const int i = controls[idx(static_cast<int>(k))];
    VectorX s = limits.transmission ? VectorX(limits.transmission->T().col(i))
                                    : VectorX(VectorX::Unit(model_.nv, i));
    factor_.solve(s);
    S.col(k) = s / s.cwiseAbs().maxCoeff();
  }
  const VectorX root = inertia_.cwiseSqrt();
  const MatrixX scaled = root.asDiagonal() * S;
  return S * scaled.completeOrthogonalDecomposition().solve(VectorX(root.cwiseProduct(free)));
}

/// What rows make of the price of a motion along d, and what holds rows at their breakpoints.
void GoalBalance::addRows(const VectorX& d, Sum& sum) {
  const ControlLimits& limits = controller_.limits;
  VectorX paid = VectorX::Zero(model_.nv);  // on the forces, by the controls alone
  {
    VectorX kappa = costSlope_ + lambda_;
    for (int i = 0; i < model_.nv; ++i)
      if (!driven_[idx(i)]) kappa[i] = 0.0;
    limits.addSlope(kappa, paid);
  }
  Constraints& rows = data_.constraints;
  rows.setRay(d);
  rows.setForceRate();
  VectorX force(model_.nv);
  rows.visit([&](const auto& c, int kind) {
    for (int row = 0; row < c.rowCount(); ++row) {
      if (c.df[idx(row)] == 0.0) continue;
      force.setZero();
      c.addRow(row, -c.df[idx(row)], force);
      sum.add(opponentOf(c, kind, row), paid.dot(force));
    }
    for (std::size_t k = 0; k < held_.size(); ++k)
      if (held_[k].row.kind == kind)
        sum.add(opponentOf(c, kind, held_[k].row.row),
                -mu_[static_cast<Eigen::Index>(k)] * heldRows_[k].dot(d));
  });
}

/// Takes from the slope of a goal of joints what is about other joints than that of `dof`.
void GoalBalance::split(const Goal& goal, int dof, VectorX& slope, VectorX& others) const {
  others = VectorX::Zero(slope.size());
  if (dof < 0 || slope.size() == 0) return;
  VectorX own = VectorX::Zero(slope.size());
  if (dynamic_cast<const Posture*>(&goal)) {  // M times a sum over dofs
    VectorX x = slope;
    massFactor_.solve(x);
    data_.inertia.hat().multiply(VectorX::Unit(model_.nv, dof) * x[dof], own);
  } else {
    own[dof] = slope[dof];
  }
  others = slope - own;
  slope = own;
}

Opposition GoalBalance::against(int i, int dof) {
  const Term& goal = terms_[idx(i)];
  if (goal.share == 0.0) return {{{Kind::goal, goal.fadesFor, -1, 1.0}}, 1.0};
  Opposition result;
  VectorX slope = goal.slope, still = goal.still, others, stillOthers;
  split(*goal.goal, dof, slope, others);
  split(*goal.goal, dof, still, stillOthers);
  VectorX wish = -slope;
  if (dof >= 0) {
    const double sign = slope[dof] > 0.0 ? -1.0 : 1.0;
    wish = VectorX::Unit(model_.nv, dof) * (sign * inertia_[dof]);
  }
  const VectorX free = wish.cwiseQuotient(inertia_);
  if (wish.dot(free) < kSingular * goal.most) return {{}, 0.0, dof < 0};
  const VectorX d = direction(wish);
  const double pull = -slope.dot(d);
  if (!(wish.dot(d) > kPulls * wish.dot(free)) || !(pull > 0.0)) return result;
  result.held = 1.0;
  if (still.size() > 0)
    if (const double atRest = -still.dot(d); atRest > pull) result.held = pull / atRest;
  const ControlLimits& limits = controller_.limits;
  VectorX Pd(model_.nv), whole, own;
  P_.multiply(d, Pd);
  limits.coordinates(Pd, whole);
  limits.coordinates(VectorX(inertia_.cwiseProduct(d)), own);
  Sum sum;
  sum.add({Kind::goal, i}, others.dot(d));
  for (int j = 0; j < model_.nv; ++j) {
    if (!driven_[idx(j)]) continue;
    sum.add({Kind::controlCost}, costSlope_[j] * own[j]);
    sum.add({Kind::controlLimit, j}, lambda_[j] * own[j]);
    for (int k = 0; k < goalCount(); ++k)
      if (k != i) sum.add({Kind::goal, k}, terms_[idx(k)].price[j] * whole[j]);
  }
  for (int k = 0; k < goalCount(); ++k)
    if (k != i) sum.add({Kind::goal, k}, terms_[idx(k)].slope.dot(d));
  for (int j = 0; j < model_.nv; ++j) {
    if (motionSlope_[j] == 0.0) continue;
    const bool fast = std::abs(velocity_[j]) > kFastShare * model_.dofs[idx(j)].velocityLimit;
    sum.add({fast ? Kind::velocityLimit : Kind::range, j}, motionSlope_[j] * d[j]);
  }
  addRows(d, sum);
  if (goal.share < 1.0)  // what the balance has taken from it would pull as well
    sum.add({Kind::goal, goal.fadesFor}, pull * (1.0 / goal.share - 1.0));
  result.opponents = sum.opponents();
  return result;
}

}  // namespace softgauss::gdd
