// SPDX-License-Identifier: Apache-2.0
#include "io/log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "engine/core/check.hpp"
#include "io/detail/csv.hpp"
#include "io/detail/text.hpp"

namespace softgauss::io {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 18;

constexpr const char* kPoseParts[] = {".x", ".y", ".z", ".qw", ".qx", ".qy", ".qz"};
constexpr const char* kVelocityParts[] = {".vx", ".vy", ".vz", ".wx", ".wy", ".wz"};

constexpr const char* kStepColumns[] = {"contacts",     "constraints",       "iterations",
                                        "dual_updates", "physics_violation", "gdd_violation",
                                        "stationarity", "forward_us",        "gdd_us",
                                        "step_us",      "energy_J",          "max_penetration_m"};

/// What columns call a joint; for what floats, so that its parts have names of their own.
std::string columnName(const Model& model, int body) {
  const std::string& name = model.jointNames[static_cast<std::size_t>(body)];
  if (model.bodies[static_cast<std::size_t>(body)].joint != JointKind::floating) return name;
  const bool taken = std::any_of(std::begin(kPoseParts), std::end(kPoseParts),
                                 [&](auto part) { return model.findJoint(name + part) >= 0; });
  return taken ? name + "(floating)" : name;
}

void appendValues(std::string& out, const VectorX& values) {
  for (const double x : values) {
    out += ',';
    detail::appendNumber(out, x);
  }
}

}  // namespace

std::vector<std::string> logColumns(const Model& model) {
  std::vector<std::string> columns = {"time_s"};
  const auto addGroup = [&](const std::string& prefix, auto&& floatingParts) {
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
  addGroup("u:", std::vector<const char*>{});
  columns.insert(columns.end(), std::begin(kStepColumns), std::end(kStepColumns));
  return columns;
}

LogWriter::LogWriter(const std::filesystem::path& file, const Model& model)
    : path_(file.string()), file_(std::fopen(path_.c_str(), "wb")), nq_(model.nq), nv_(model.nv) {
  if (!file_)
    throw ModelError({path_, 0}, "log", fmt::format("cannot be written: {}", std::strerror(errno)));
  for (const Body& body : model.bodies)
    if (body.dofs == 1) controls_.push_back(body.v);
  buffer_.reserve(2 * kBufferSize);
  for (const std::string& column : logColumns(model)) {
    if (!buffer_.empty()) buffer_ += ',';
    buffer_ += detail::quotedCsv(column);
  }
  buffer_ += '\n';
}

LogWriter::~LogWriter() {
  if (file_) send();
}

void LogWriter::write(const StepRecord& r) {
  SOFTGAUSS_ASSERT(r.q.size() == nq_ && r.v.size() == nv_ && r.a.size() == nv_ &&
                   r.u.size() == nv_);
  detail::appendNumber(buffer_, r.time);
  appendValues(buffer_, r.q);
  appendValues(buffer_, r.v);
  appendValues(buffer_, r.a);
  for (const int dof : controls_) {
    buffer_ += ',';
    detail::appendNumber(buffer_, r.u[dof]);
  }
  for (const int count : {r.contacts, r.constraints, r.iterations, r.dualUpdates})
    fmt::format_to(std::back_inserter(buffer_), ",{}", count);
  for (const double x : {r.physicsViolation, r.gddViolation, r.stationarity, r.forwardUs, r.gddUs,
                         r.stepUs, r.energy, r.maxPenetration}) {
    buffer_ += ',';
    detail::appendNumber(buffer_, x);
  }
  buffer_ += '\n';
  if (buffer_.size() >= kBufferSize && !send()) failed();
}

void LogWriter::flush() {
  if (!send() || std::fflush(file_.get()) != 0) failed();
}

void LogWriter::close() {
  if (!file_) return;
  const bool sent = send();
  if (std::fclose(file_.release()) != 0 || !sent) failed();
}

bool LogWriter::send() noexcept {
  const bool sent = std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) == buffer_.size();
  buffer_.clear();
  return sent;
}

void LogWriter::failed() const {
  throw std::runtime_error(
      fmt::format("{}: log: cannot be written: {}", path_, std::strerror(errno)));
}

}  // namespace softgauss::io
