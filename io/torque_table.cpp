// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/torque_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/time_table.hpp"

namespace softgauss::io {
namespace {

/// A row recorded at t is in force at t, whatever rounding has added up on either side.
constexpr double kTimeTolerance = 1e-9;

struct Column {
  std::size_t field = 0;
  int dof = -1;
};

std::vector<Column> findControls(const detail::TimeTable& file, const Model& model) {
  const std::vector<std::string>& header = file.header();
  std::vector<std::string> joints;
  for (int b = 1; b < model.bodyCount(); ++b)
    if (model.bodies[static_cast<std::size_t>(b)].dofs == 1)
      joints.push_back(model.jointNames[static_cast<std::size_t>(b)]);

  const std::set<std::string> known(joints.begin(), joints.end());
  std::vector<Column> columns;
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (!header[i].starts_with("u:")) continue;
    const std::string joint = header[i].substr(2);
    if (!known.count(joint))
      file.fail("column " + detail::quotedText(header[i]),
                fmt::format("model '{}' has no joint {} with a control{}", model.name,
                            detail::quotedText(joint), detail::offered(joint, joints)));
    const int body = model.findJoint(joint);
    columns.push_back({i, model.bodies[static_cast<std::size_t>(body)].v});
  }
  if (columns.empty()) file.fail("header", "has no column u:<joint>");
  return columns;
}

}  // namespace

TorqueTable TorqueTable::read(const std::filesystem::path& path, const Model& model) {
  detail::TimeTable file(path, "time_s and u:<joint>");
  const std::vector<Column> columns = findControls(file, model);
  TorqueTable table;
  table.nv_ = model.nv;
  for (const Column& column : columns) table.dofs_.push_back(column.dof);
  int end = 0;  // the line of the row that has no control
  while (file.next()) {
    if (end > 0) file.fail(end, "row", "has no control, expected only of the last row");
    table.times_.push_back(file.time());
    // The last row of a log is a state that no control was found for.
    const bool isEnd = std::all_of(columns.begin(), columns.end(),
                                   [&](const Column& c) { return file.isEmpty(c.field); });
    if (isEnd) {
      end = file.line();
      table.controls_.resize(table.controls_.size() + columns.size(), 0.0);
      continue;
    }
    for (const Column& column : columns) {
      const double u = file.number(column.field);
      if (u != 0.0 && !model.dofs[static_cast<std::size_t>(column.dof)].actuated)
        file.fail("column " + detail::quotedText(file.header()[column.field]),
                  fmt::format("is {}, but the joint is not actuated, expected 0", u));
      table.controls_.push_back(u);
    }
  }
  return table;
}

void TorqueTable::controlAt(double time, VectorX& u) const {
  u.setZero(nv_);
  const auto after = std::upper_bound(times_.begin(), times_.end(), time + kTimeTolerance);
  if (after == times_.begin()) return;
  const auto row = static_cast<std::size_t>(after - times_.begin()) - 1;
  for (std::size_t i = 0; i < dofs_.size(); ++i) u[dofs_[i]] = controls_[row * dofs_.size() + i];
}

double TorqueTable::nextRow(double time) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time + kTimeTolerance);
  return after == times_.end() ? kInfinity : *after;
}

}  // namespace softgauss::io
