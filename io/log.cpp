// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/log.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/dynamics/energy.hpp"
#include "softgauss/io/detail/row_file.hpp"

namespace softgauss::io {
namespace {

constexpr const char* kPoseParts[] = {".x", ".y", ".z", ".qw", ".qx", ".qy", ".qz"};
constexpr const char* kVelocityParts[] = {".vx", ".vy", ".vz", ".wx", ".wy", ".wz"};

constexpr const char* kPlaceParts[] = {".x", ".y", ".z"};
constexpr const char* kWholeColumns[] = {"com", "cop", "momentum", "angular_momentum"};

constexpr const char* kStepColumns[] = {"contacts",     "constraints",       "iterations",
                                        "dual_updates", "physics_violation", "gdd_violation",
                                        "stationarity", "forward_us",        "gdd_us",
                                        "step_us",      "energy_J",          "max_penetration_m"};

/// Names of their own for columns: a second one of a name is "name#2".
std::string unique(const std::string& name, std::map<std::string, int>& known) {
  const int count = ++known[name];
  return count == 1 ? name : unique(name + "#" + std::to_string(count), known);
}

}  // namespace

std::string columnName(const Model& model, int body) {
  const std::string& name = model.jointNames[static_cast<std::size_t>(body)];
  if (model.bodies[static_cast<std::size_t>(body)].joint != JointKind::floating) return name;
  const bool taken = std::any_of(std::begin(kPoseParts), std::end(kPoseParts),
                                 [&](auto part) { return model.findJoint(name + part) >= 0; });
  return taken ? name + "(floating)" : name;
}

void measureWhole(const Model& model, const Kinematics& kinematics, StepRecord& record) {
  const Momentum momentum = computeMomentum(model, kinematics);
  record.centerOfMass = centerOfMass(model, kinematics);
  record.momentum = momentum.linear;
  record.angularMomentum = momentum.angular - record.centerOfMass.cross(momentum.linear);
}

std::vector<std::string> logColumns(const Model& model, const std::vector<std::string>& goals) {
  std::vector<std::string> columns = {"time_s"};
  const auto addGroup = [&](const std::string& prefix, std::span<const char* const> floatingParts) {
    for (int b = 1; b < model.bodyCount(); ++b) {
      const std::string name = prefix + columnName(model, b);
      if (model.bodies[static_cast<std::size_t>(b)].joint != JointKind::floating)
        columns.push_back(name);
      else
        for (const char* part : floatingParts) columns.push_back(name + part);
    }
  };
  addGroup("q:", kPoseParts);
  addGroup("v:", kVelocityParts);
  addGroup("a:", kVelocityParts);
  addGroup("u:", {});
  columns.insert(columns.end(), std::begin(kStepColumns), std::end(kStepColumns));
  std::map<std::string, int> known;
  for (const std::string& goal : goals) columns.push_back(unique("error:" + goal, known));
  const auto addPlace = [&](const std::string& name) {
    for (const char* part : kPlaceParts) columns.push_back(name + part);
  };
  for (const char* name : kWholeColumns) addPlace(name);
  const ContactLinks links(model);
  for (const std::string& link : links.names()) addPlace(unique("f:" + link, known));
  return columns;
}

LogWriter::LogWriter(const std::filesystem::path& file, const Model& model,
                     const std::vector<std::string>& goals, long every,
                     const std::optional<TableEnd>& after)
    : rows_(std::make_unique<detail::RowFile>(file, "log", logColumns(model, goals),
                                              after ? std::optional(after->bytes) : std::nullopt)),
      nq_(model.nq),
      nv_(model.nv),
      goals_(static_cast<Eigen::Index>(goals.size())),
      forces_(3 * ContactLinks(model).size()),
      every_(every),
      seen_(after ? after->seen : 0) {
  for (const Body& body : model.bodies)
    if (body.dofs == 1) controls_.push_back(body.v);
}

LogWriter::~LogWriter() = default;
LogWriter::LogWriter(LogWriter&&) noexcept = default;

void LogWriter::flush() { rows_->flush(); }
void LogWriter::close() { rows_->close(); }
TableEnd LogWriter::end() { return {rows_->end(), seen_}; }

void LogWriter::write(const StepRecord& r) {
  SOFTGAUSS_ASSERT(r.q.size() == nq_ && r.v.size() == nv_);
  if (seen_++ % every_ != 0 && !r.isEnd) return;
  rows_->add(r.time);
  rows_->add(r.q);
  rows_->add(r.v);
  writeStep(r);
  const bool known = r.goalErrors.size() == goals_;
  for (Eigen::Index i = 0; i < goals_; ++i)
    if (known && std::isfinite(r.goalErrors[i]))
      rows_->add(r.goalErrors[i]);
    else
      rows_->addEmpty(1);
  rows_->add(r.centerOfMass);
  if (r.centerOfPressure && !r.isEnd)
    rows_->add(*r.centerOfPressure);
  else
    rows_->addEmpty(3);
  rows_->add(r.momentum);
  rows_->add(r.angularMomentum);
  if (r.linkForces.size() == forces_ && !r.isEnd)
    rows_->add(r.linkForces);
  else
    rows_->addEmpty(forces_);
  rows_->endRow();
}

/// What the step from the record's state has given; nothing at the end.
void LogWriter::writeStep(const StepRecord& r) {
  const auto scalars = static_cast<Eigen::Index>(controls_.size());
  SOFTGAUSS_ASSERT(r.isEnd || (r.a.size() == nv_ && r.u.size() == nv_));
  if (r.isEnd) {
    rows_->addEmpty(nv_ + scalars);
  } else {
    rows_->add(r.a);
    for (const int dof : controls_) rows_->add(r.u[dof]);
  }
  rows_->add(r.contacts);
  rows_->add(r.constraints);
  if (r.isEnd) {
    rows_->addEmpty(8);
  } else {
    rows_->add(r.iterations);
    rows_->add(r.dualUpdates);
    for (const double x :
         {r.physicsViolation, r.gddViolation, r.stationarity, r.forwardUs, r.gddUs, r.stepUs})
      rows_->add(x);
  }
  rows_->add(r.energy);
  rows_->add(r.maxPenetration);
}

}  // namespace softgauss::io
