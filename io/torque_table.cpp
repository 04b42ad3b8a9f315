// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/torque_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "softgauss/io/detail/csv.hpp"
#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io {
namespace {

/// A row recorded at t is in force at t, whatever rounding has added up on either side.
constexpr double kTimeTolerance = 1e-9;

struct Column {
  std::size_t field = 0;
  int dof = -1;
  std::string name;
};

/// Says where in the file something is wrong.
class Place {
 public:
  explicit Place(std::string file) : file_(std::move(file)) {}

  [[noreturn]] void fail(int line, const std::string& element, const std::string& problem) const {
    throw ModelError({file_, line}, element, problem);
  }
  double number(int line, const std::string& column, const std::string& field) const {
    const std::optional<double> x = detail::parseNumber(field);
    if (!x || std::abs(*x) > detail::kLargestNumber)
      fail(line, "column " + detail::quotedText(column),
           fmt::format("{} is not a finite number{}", detail::quotedText(field),
                       x ? fmt::format(" of size {:g} at most", detail::kLargestNumber) : ""));
    return *x;
  }

 private:
  std::string file_;
};

std::vector<Column> findControls(const std::vector<std::string>& header, const Model& model,
                                 const Place& place, int line) {
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
      place.fail(line, "column " + detail::quotedText(header[i]),
                 fmt::format("model '{}' has no joint {} with a control{}", model.name,
                             detail::quotedText(joint), detail::offered(joint, joints)));
    const int body = model.findJoint(joint);
    columns.push_back({i, model.bodies[static_cast<std::size_t>(body)].v, header[i]});
  }
  if (columns.empty()) place.fail(line, "header", "has no column u:<joint>");
  return columns;
}

}  // namespace

TorqueTable TorqueTable::read(const std::filesystem::path& file, const Model& model) {
  const std::string text = detail::readInput(file.string(), "CSV with time_s and u:<joint>");
  const Place place(detail::inputName(file.string()));
  if (const std::size_t bad = detail::invalidUtf8(text); bad != std::string::npos)
    place.fail(1 + static_cast<int>(std::count(
                       text.begin(), text.begin() + static_cast<std::ptrdiff_t>(bad), '\n')),
               "file", "holds a byte that is no UTF-8, expected text in UTF-8");

  detail::CsvReader reader(text);
  const std::vector<std::string>* fields = reader.next();
  if (!fields) place.fail(1, "header", "is missing, expected time_s and u:<joint>");
  const std::vector<std::string> header = *fields;
  std::set<std::string> names;
  for (const std::string& name : header)
    if (!names.insert(name).second)
      place.fail(reader.line(), "column " + detail::quotedText(name), "is there twice");
  const auto timeColumn = std::find(header.begin(), header.end(), "time_s");
  if (timeColumn == header.end()) place.fail(reader.line(), "header", "has no column time_s");
  const auto timeField = static_cast<std::size_t>(timeColumn - header.begin());
  const std::vector<Column> columns = findControls(header, model, place, reader.line());

  TorqueTable table;
  table.nv_ = model.nv;
  for (const Column& column : columns) table.dofs_.push_back(column.dof);
  int end = 0;  // the line of the row that has no control
  while ((fields = reader.next())) {
    const int line = reader.line();
    if (fields->size() != header.size())
      place.fail(
          line, "row",
          fmt::format("has {} fields, expected {} as the header", fields->size(), header.size()));
    if (end > 0) place.fail(end, "row", "has no control, expected only of the last row");
    const double time = place.number(line, "time_s", (*fields)[timeField]);
    if (!table.times_.empty() && time <= table.times_.back())
      place.fail(line, "column 'time_s'",
                 fmt::format("{} follows {}, expected rising times", time, table.times_.back()));
    table.times_.push_back(time);
    // The last row of a log is a state that no control was found for.
    const bool isEnd = std::all_of(columns.begin(), columns.end(),
                                   [&](const Column& c) { return (*fields)[c.field].empty(); });
    if (isEnd) {
      end = line;
      table.controls_.resize(table.controls_.size() + columns.size(), 0.0);
      continue;
    }
    for (const Column& column : columns) {
      const double u = place.number(line, column.name, (*fields)[column.field]);
      if (u != 0.0 && !model.dofs[static_cast<std::size_t>(column.dof)].actuated)
        place.fail(line, "column " + detail::quotedText(column.name),
                   fmt::format("is {}, but the joint is not actuated, expected 0", u));
      table.controls_.push_back(u);
    }
  }
  if (reader.quoteIsOpen()) place.fail(reader.line(), "row", "a quote is not closed");
  if (table.times_.empty()) place.fail(reader.line(), "file", "has no row below the header");
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
