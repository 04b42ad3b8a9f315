// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/replay/recording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace softgauss::io {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

constexpr double kNearShare = 0.02;  ///< of the range between two limits

/// Entries of a series however many columns: 128 MB of samples at most.
int mostEntries(int columns) { return std::min(20000, (16 << 20) / std::max(1, columns)); }

}  // namespace

NearLimits::NearLimits(const Curve& curve, double least, double greatest) {
  const double range = curve.upper - curve.lower;
  const double near = std::max(greatest - least, std::isfinite(range) ? kNearShare * range : 0.0);
  lower = std::isfinite(curve.lower) && least - curve.lower <= near;
  upper = std::isfinite(curve.upper) && curve.upper - greatest <= near;
}

Recording::Recording(const Model& model, const std::vector<std::unique_ptr<gdd::Goal>>& goals,
                     const gdd::GoalContext& start)
    : model_(model), series_(0), frames_(0, 0) {
  const std::vector<std::string> names = gdd::distinctNames(goals);
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const std::optional<gdd::GoalMark> mark = goals[i]->mark(start);
    if (!mark) continue;
    goals_.push_back(goals[i].get());
    labels_.push_back({names[i], model.frames[static_cast<std::size_t>(mark->frame)].name});
  }
  addJointGroups();
  addOtherGroups();
  makeSeries();
  frames_ = FrameTrack(model.bodyCount(), static_cast<int>(goals_.size()));
  marks_.resize(goals_.size());
}

void Recording::makeSeries() { series_ = SeriesTable(columns_, mostEntries(columns_)); }

void Recording::addPlot(std::string name, std::string unit,
                        const std::vector<std::string>& curves) {
  CurveGroup& group = addGroup(std::move(name), std::move(unit));
  for (const std::string& curve : curves) addCurve(group, curve);
  added.resize(added.size() + curves.size(), kNoValue);
  makeSeries();
}

CurveGroup& Recording::addGroup(std::string name, std::string unit, bool logarithmic) {
  groups_.push_back({std::move(name), std::move(unit), logarithmic, {}});
  return groups_.back();
}

void Recording::addCurve(CurveGroup& group, std::string name, double lower, double upper) {
  group.curves.push_back({std::move(name), columns_++, lower, upper});
}

/// Positions and controls first, for they are what one looks for.
void Recording::addJointGroups() {
  const auto ofKind = [&](JointKind kind, auto&& visit) {
    for (int b = 1; b < model_.bodyCount(); ++b)
      if (model_.bodies[static_cast<std::size_t>(b)].joint == kind)
        visit(b, model_.bodies[static_cast<std::size_t>(b)],
              model_.jointNames[static_cast<std::size_t>(b)]);
  };
  constexpr JointKind kScalar[] = {JointKind::revolute, JointKind::prismatic};

  for (const JointKind kind : kScalar) {
    CurveGroup& group = addGroup("Joint positions", kind == JointKind::revolute ? "rad" : "m");
    ofKind(kind, [&](int b, const Body& body, const std::string& name) {
      double lower = -kInfinity, upper = kInfinity;
      for (const JointRange& range : model_.ranges)
        if (range.body == b) lower = range.lower, upper = range.upper;
      addCurve(group, name, lower, upper);
      q_.push_back(body.q);
    });
  }
  for (const JointKind kind : kScalar) {
    CurveGroup& group = addGroup("Controls", kind == JointKind::revolute ? "N m" : "N");
    ofKind(kind, [&](int, const Body& body, const std::string& name) {
      const Dof& dof = model_.dofs[static_cast<std::size_t>(body.v)];
      if (!dof.actuated) return;
      addCurve(group, name, dof.effortLower, dof.effortUpper);
      u_.push_back(body.v);
    });
  }
  for (const JointKind kind : kScalar) {
    CurveGroup& group = addGroup("Joint velocities", kind == JointKind::revolute ? "rad/s" : "m/s");
    ofKind(kind, [&](int, const Body& body, const std::string& name) {
      addCurve(group, name);
      v_.push_back(body.v);
    });
  }
  CurveGroup& bases = addGroup("Floating bases", "m");
  ofKind(JointKind::floating, [&](int b, const Body& body, const std::string&) {
    for (int i = 0; i < 3; ++i) {
      addCurve(bases, model_.bodyNames[static_cast<std::size_t>(b)] + "." + "xyz"[i]);
      base_.push_back(body.q + i);
    }
  });
}

/// In the order in which addStep() fills them.
void Recording::addOtherGroups() {
  jointGroups_ = groups_.size();
  const int firstForce = columns_;
  CurveGroup& forces = addGroup("Contact normal forces", "N");
  addCurve(forces, "all");
  std::vector<int> columnOfBody(model_.bodies.size(), -1);
  for (const Geometry& geometry : model_.geometries) {
    int& column = columnOfBody[static_cast<std::size_t>(geometry.body)];
    if (geometry.body != 0 && column < 0) {
      column = columns_;
      addCurve(forces, model_.bodyNames[static_cast<std::size_t>(geometry.body)]);
    }
    forceColumn_.push_back(column);
  }
  forceColumns_ = columns_ - firstForce;
  CurveGroup& errors = addGroup("Goal errors", "m");
  for (const GoalLabel& label : labels_) addCurve(errors, label.name);
  CurveGroup& energy = addGroup("Energy", "J");
  for (const char* name : {"kinetic", "potential", "total"}) addCurve(energy, name);
  CurveGroup& counts = addGroup("Constraints and iterations", "");
  for (const char* name : {"contacts", "rows", "iterations", "dual updates"})
    addCurve(counts, name);
  CurveGroup& time = addGroup("Time per step", "µs");
  for (const char* name : {"forward", "goal directed", "step"}) addCurve(time, name);
  CurveGroup& depth = addGroup("Deepest penetration", "m");
  addCurve(depth, "penetration");
  CurveGroup& physics = addGroup("Physics violation", "N, N m", true);
  addCurve(physics, "as applied");
  addCurve(physics, "before clamping");
}

void Recording::readMarks(const StepRecord& r, const Data& data) {
  state_.q = r.q;
  state_.v = r.v;
  state_.time = r.time;
  for (std::size_t i = 0; i < goals_.size(); ++i) marks_[i] = markOf(i, {model_, state_, data});
}

void Recording::addStep(const StepRecord& r, const Data& data) {
  contactForces(data, contacts_);
  addStep(r, data, contacts_);
}

void Recording::addStep(const StepRecord& r, const Data& data,
                        const std::vector<Snapshot::ContactForce>& contacts) {
  if (&contacts != &contacts_) contacts_ = contacts;
  readMarks(r, data);
  writeSample(r, false, series_.add(r.time));
  if (frames_.due(r.time)) {
    takeSnapshot(model_, data.kinematics, contacts_, r.time, snapshot_);
    frames_.add(snapshot_, marks_);
  }
}

/// In the order of the columns. At the end of a run nothing has been solved or controlled.
void Recording::writeSample(const StepRecord& r, bool isEnd, double* sample) {
  const auto solved = [&](double x) { return isEnd ? kNoValue : x; };
  double* next = sample;
  for (const int i : q_) *next++ = r.q[i];
  for (const int i : u_) *next++ = solved(r.u[i]);
  for (const int i : v_) *next++ = r.v[i];
  for (const int i : base_) *next++ = r.q[i];
  // A contact of two bodies is felt by both, and is one of all.
  double& all = *next;
  std::fill_n(next, forceColumns_, solved(0.0));
  for (const Snapshot::ContactForce& c : contacts_) {
    all += c.normalForce();
    for (const int geometry : {c.geometryA, c.geometryB}) {
      const int column = forceColumn_[static_cast<std::size_t>(geometry)];
      if (column >= 0) sample[column] += c.normalForce();
    }
  }
  next += forceColumns_;
  for (const std::optional<gdd::GoalMark>& mark : marks_)
    *next++ = mark ? (mark->p_WTarget - mark->p_WPoint).norm() : kNoValue;
  for (const double x : {r.kineticEnergy, r.energy - r.kineticEnergy, r.energy}) *next++ = x;
  for (const int count : {r.contacts, r.constraints, r.iterations, r.dualUpdates})
    *next++ = solved(count);
  for (const double x : {r.forwardUs, r.gddUs, r.stepUs}) *next++ = solved(x);
  *next++ = r.maxPenetration;
  for (const double x : {r.physicsViolation, r.gddViolation}) *next++ = solved(x);
  for (const double x : added) *next++ = solved(x);
  SOFTGAUSS_ASSERT(next == sample + columns_);
}

void Recording::finish(const StepRecord& last, const Data& data) {
  readMarks(last, data);
  writeSample(last, true, series_.add(last.time));
  series_.finish();
  takeSnapshot(model_, data, last.time, snapshot_);
  // No force has been solved for here. Those of the last step led here.
  if (!contacts_.empty()) {
    snapshot_.contacts = contacts_;
    snapshot_.centerOfPressure = centerOfPressure(model_, contacts_);
  }
  frames_.add(snapshot_, marks_);
}

std::vector<CurveGroup> Recording::plots() const {
  const auto isZero = [&](const Curve& curve) {
    const std::vector<double> values = series_.column(curve.column);
    return std::none_of(values.begin(), values.end(),
                        [](double x) { return std::isfinite(x) && x != 0.0; });
  };
  std::vector<CurveGroup> plots;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    CurveGroup group = groups_[i];
    if (std::all_of(group.curves.begin(), group.curves.end(), isZero)) continue;
    // A joint that rests is drawn, a link that nothing touches is not.
    if (i >= jointGroups_) std::erase_if(group.curves, isZero);
    plots.push_back(std::move(group));
  }
  return plots;
}

}  // namespace softgauss::io
