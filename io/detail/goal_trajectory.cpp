// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/goal_trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/scene_parts.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/time_table.hpp"
#include "softgauss/io/log.hpp"
#include "softgauss/io/names.hpp"

namespace softgauss::io::detail {
namespace {

using gdd::Interpolation;
using TrajectoryPointer = std::shared_ptr<const gdd::Trajectory>;

/// What a file or its tables say of knots: one column of numbers for each time.
struct Knots {
  std::vector<double> times;
  std::vector<std::vector<double>> columns;

  /// What `entry` says, with the times counted from `start`.
  TrajectoryPointer made(const YamlMap& keys, const YamlMap::Entry& entry, double start,
                         Interpolation interpolation) const {
    std::vector<double> from = times;
    for (double& time : from) time += start;
    if (std::adjacent_find(from.begin(), from.end(), std::greater_equal<>()) != from.end())
      keys.fail(entry, fmt::format("found times that are equal to rounding once they count from "
                                   "{} s, expected an earlier start",
                                   start));
    const auto rows = static_cast<Eigen::Index>(columns.front().size());
    MatrixX p(rows, static_cast<Eigen::Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k)
      p.col(static_cast<Eigen::Index>(k)) = Eigen::Map<const VectorX>(columns[k].data(), rows);
    return std::make_shared<gdd::KnotTrajectory>(std::move(from), p, interpolation);
  }
};

/// At which its time is 0: the key `start`, else when the goal begins, else 0 s.
double startOf(const YamlMap& goal, const YamlMap& keys) {
  double start = 0.0;
  goal.read("start", start, Range::any);
  keys.read("start", start, Range::any);
  return start;
}

Interpolation interpolationOf(const YamlMap& keys) {
  const YamlMap::Entry* entry = keys.find("interpolation");
  if (!entry) return Interpolation::minimumJerk;
  const std::string name =
      keys.choice(*entry, {"minimum_jerk", "natural_spline", "clamped_spline"});
  if (name == "minimum_jerk") return Interpolation::minimumJerk;
  return name == "natural_spline" ? Interpolation::naturalSpline : Interpolation::clampedSpline;
}

std::vector<double> readKnotTimes(const YamlMap& keys) {
  const char* expected = "a list of rising times [s]";
  const YamlMap::Entry& entry = keys.required("times", expected);
  const std::vector<double> times = keys.numbers(entry, 1, static_cast<std::size_t>(-1), expected);
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] >= times[i - 1] + kShortestPiece))
      keys.fail(entry, fmt::format("found {} s after {} s, expected times that rise by at least "
                                   "{:g} s",
                                   times[i], times[i - 1], kShortestPiece));
  return times;
}

/// A table of knots whose numbers are in these fields.
Knots readTable(TimeTable& table, const std::vector<std::size_t>& fields) {
  Knots knots;
  while (table.next()) {
    if (!knots.times.empty() && !(table.time() >= knots.times.back() + kShortestPiece))
      table.fail("column 'time_s'",
                 fmt::format("{} follows {}, expected times that rise by at least {:g} s",
                             table.time(), knots.times.back(), kShortestPiece));
    knots.times.push_back(table.time());
    knots.columns.emplace_back();
    for (const std::size_t field : fields) knots.columns.back().push_back(table.number(field));
  }
  return knots;
}

/// The one of these keys that says what the trajectory is.
const YamlMap::Entry& onlyOf(const YamlMap& keys, const std::vector<std::string>& kinds) {
  const YamlMap::Entry* found = nullptr;
  for (const std::string& kind : kinds) {
    const YamlMap::Entry* entry = keys.find(kind);
    if (entry && found)
      keys.fail(*entry,
                fmt::format("found beside {}, expected one of {}", found->key, listed(kinds)));
    if (entry) found = entry;
  }
  return found ? *found : keys.required(kinds.front(), "one of " + listed(kinds));
}

std::vector<std::string> keysOf(const std::string& kind) {
  if (kind == "circle") return {"circle", "start"};
  if (kind == "file") return {"file", "interpolation", "start"};
  return {kind, "times", "interpolation", "start"};
}

TrajectoryPointer readCircle(const YamlMap& keys, double start) {
  keys.expectOnly({"center", "radius", "frequency", "normal", "phase"});
  gdd::CircleTrajectory::Circle circle;
  circle.startTime = start;
  circle.center = keys.vector3(keys.required("center", "three numbers [x, y, z]"));
  circle.radius = keys.number(keys.required("radius", "a number > 0 [m]"), Range::positive);
  circle.frequency = keys.number(keys.required("frequency", "turns a second [1/s]"), Range::any);
  keys.read("normal", circle.normal);
  if (circle.normal.stableNorm() == 0.0)
    keys.fail(*keys.find("normal"), "found a vector of length 0, expected a direction");
  keys.read("phase", circle.phase, Range::any);
  return std::make_shared<gdd::CircleTrajectory>(circle);
}

TrajectoryPointer readPlaces(const YamlMap& goal, const YamlMap& keys) {
  const YamlMap::Entry& kind = onlyOf(keys, {"circle", "points", "file"});
  keys.expectOnly(keysOf(kind.key));
  const double start = startOf(goal, keys);
  if (kind.key == "circle") return readCircle(keys.map(kind), start);
  const Interpolation interpolation = interpolationOf(keys);
  if (kind.key == "file") {
    TimeTable table(existingFile(keys, kind, keys.name(kind)), "time_s, x, y and z");
    std::vector<std::size_t> fields;
    for (const char* axis : {"x", "y", "z"}) {
      const std::optional<std::size_t> field = table.find(axis);
      if (!field) table.fail("header", fmt::format("has no column {}", axis));
      fields.push_back(*field);
    }
    return readTable(table, fields).made(keys, kind, start, interpolation);
  }
  Knots knots{readKnotTimes(keys), {}};
  for (const YamlValue& item : keys.list(kind)) {
    const Vector3 p = keys.vector3({kind.key, item, item.line});
    knots.columns.push_back({p.x(), p.y(), p.z()});
  }
  if (knots.columns.size() != knots.times.size())
    keys.fail(kind, fmt::format("found {}, expected {}, one for each of times",
                                counted(knots.columns.size(), "point"), knots.times.size()));
  return knots.made(keys, kind, start, interpolation);
}

/// Whether a column of a log is of a base that floats: its position has more than one number.
bool isOfBase(const Model& model, const std::string& column) {
  for (int b = 1; b < model.bodyCount(); ++b)
    if (model.bodies[static_cast<std::size_t>(b)].joint == JointKind::floating &&
        column.starts_with("q:" + columnName(model, b) + "."))
      return true;
  return false;
}

/// The columns q:<joint> of a log; the bodies that the joints carry go into `bodies`.
std::vector<std::size_t> findJoints(const TimeTable& table, const Model& model,
                                    std::vector<int>& bodies) {
  std::vector<std::size_t> fields;
  for (std::size_t i = 0; i < table.header().size(); ++i) {
    const std::string& column = table.header()[i];
    if (!column.starts_with("q:") || isOfBase(model, column)) continue;
    const std::string joint = column.substr(2);
    if (const std::string problem = jointProblem(model, joint); !problem.empty())
      table.fail("column " + quotedText(column), problem);
    fields.push_back(i);
    bodies.push_back(model.findJoint(joint));
  }
  if (fields.empty()) table.fail("header", "has no column q:<joint>");
  return fields;
}

/// The numbers of the joints, a list each, as long as there are times.
Knots readJointKnots(const YamlMap& keys, const YamlMap& joints, const Model& model,
                     std::vector<int>& bodies) {
  Knots knots{readKnotTimes(keys), {}};
  knots.columns.resize(knots.times.size());
  const std::size_t count = knots.times.size();
  for (const YamlMap::Entry& entry : joints.entries()) {
    if (const std::string problem = jointProblem(model, entry.key); !problem.empty())
      joints.fail(entry, problem);
    bodies.push_back(model.findJoint(entry.key));
    const std::vector<double> values = joints.numbers(
        entry, count, count,
        fmt::format("a list of {}, one for each of times", counted(count, "number")));
    for (std::size_t k = 0; k < count; ++k) knots.columns[k].push_back(values[k]);
  }
  return knots;
}

}  // namespace

void readPlaceTarget(const YamlMap& keys, bool required, gdd::PlaceTarget& target) {
  const YamlMap::Entry* trajectory = keys.find("trajectory");
  const YamlMap::Entry* place = keys.find("target");
  if (trajectory && place)
    keys.fail(*trajectory, "found beside target, expected one of target, trajectory");
  if (trajectory)
    target.trajectory = readPlaces(keys, keys.map(*trajectory));
  else if (place || required)
    target.restAt(keys.vector3(keys.required("target", "three numbers [x, y, z], or trajectory")));
}

std::vector<gdd::JointTarget> readJointTrajectory(const YamlMap& goal, const Model& model) {
  std::vector<gdd::JointTarget> targets;
  const YamlMap::Entry* entry = goal.find("trajectory");
  if (!entry) return targets;
  const YamlMap keys = goal.map(*entry);
  const YamlMap::Entry& kind = onlyOf(keys, {"joints", "file"});
  keys.expectOnly(keysOf(kind.key));
  std::vector<int> bodies;
  Knots knots;
  if (kind.key == "file") {
    TimeTable table(existingFile(keys, kind, keys.name(kind)), "time_s and q:<joint>");
    const std::vector<std::size_t> fields = findJoints(table, model, bodies);
    knots = readTable(table, fields);
  } else {
    knots = readJointKnots(keys, keys.map(kind), model, bodies);
    if (bodies.empty()) keys.fail(kind, "found an empty map, expected at least one joint");
  }
  const TrajectoryPointer path = knots.made(keys, kind, startOf(goal, keys), interpolationOf(keys));
  for (const int body : bodies) {
    gdd::JointTarget& target = targets.emplace_back();
    target.body = body;
    target.trajectory = path;
    target.coordinate = static_cast<int>(targets.size()) - 1;
  }
  return targets;
}

}  // namespace softgauss::io::detail
