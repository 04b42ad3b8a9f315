// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/detail/follower_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/model/followers.hpp"

namespace softgauss::detail {
namespace {

/// From where to where a joint may be.
struct Span {
  double lower = -kInfinity, upper = kInfinity;
  bool isFinite() const { return lower > -kInfinity && upper < kInfinity; }
};

/// The values of a coupling's polynomial over a span: of a line exactly, of others on a grid.
Span valuesOver(const JointCoupling& c, const Span& span) {
  constexpr int kGrid = 1000;
  const double slope = c.polynomial[1];
  const bool isLine = c.polynomial[2] == 0.0 && c.polynomial[3] == 0.0 && c.polynomial[4] == 0.0;
  if (c.leader == 0 || (isLine && slope == 0.0)) return {c.polynomial[0], c.polynomial[0]};
  if (isLine) {
    const double a = c.polynomial[0] + slope * span.lower, b = c.polynomial[0] + slope * span.upper;
    return {std::min(a, b), std::max(a, b)};
  }
  if (!span.isFinite()) return {};
  Span values{kInfinity, -kInfinity};
  for (int i = 0; i <= kGrid; ++i) {
    const double value = c.value(span.lower + (span.upper - span.lower) * i / kGrid);
    values.lower = std::min(values.lower, value);
    values.upper = std::max(values.upper, value);
  }
  return values;
}

/// Whether a range leaves out some of what is asked for, or where the joint starts.
bool excludes(const JointRange& range, const Span& asked, double start) {
  constexpr double kRounding = 1e-9;
  double size = 1.0;
  for (const double end : {range.lower, range.upper})
    if (std::isfinite(end)) size = std::max(size, std::abs(end));
  const auto isOutside = [&](double q) {
    return q < range.lower - kRounding * size || q > range.upper + kRounding * size;
  };
  return (asked.lower > -kInfinity && isOutside(asked.lower)) ||
         (asked.upper < kInfinity && isOutside(asked.upper)) || isOutside(start);
}

std::string text(const Span& span) {
  std::ostringstream out;
  out.precision(4);
  out << span.lower;
  if (span.lower != span.upper) out << " … " << span.upper;
  return out.str();
}

}  // namespace

void relaxFollowerRanges(Model& model) {
  if (model.couplings.empty() || model.options.constraintModel == ConstraintModel::mujoco) return;
  std::vector<Span> spans(model.bodies.size());
  std::vector<const JointRange*> rangeOf(model.bodies.size(), nullptr);
  for (const JointRange& range : model.ranges) {
    spans[idx(range.body)] = {range.lower, range.upper};
    rangeOf[idx(range.body)] = &range;
  }
  std::vector<char> yields(model.bodies.size(), 0);
  std::string told;
  for (const JointCoupling* c : leadersFirst(model)) {
    Span& span = spans[idx(c->follower)];
    const JointRange* range = rangeOf[idx(c->follower)];
    const Span asked = valuesOver(*c, c->leader == 0 ? Span{} : spans[idx(c->leader)]);
    const double start = model.q0[model.bodies[idx(c->follower)].q];
    if (!range || !excludes(*range, asked, start)) {
      span = {std::max(span.lower, asked.lower), std::min(span.upper, asked.upper)};
      continue;
    }
    span = asked;
    yields[idx(c->follower)] = 1;
    told += (told.empty() ? " '" : "; '") + model.jointNames[idx(c->follower)] + "' has " +
            text({range->lower, range->upper}) + ", and ";
    told += c->leader == 0 ? "its coupling" : "'" + model.jointNames[idx(c->leader)] + "'";
    told +=
        " asks for " + (asked.isFinite() ? text(asked) : text({start, start}) + " at the start");
  }
  if (told.empty()) return;
  const auto end = std::remove_if(model.ranges.begin(), model.ranges.end(),
                                  [&](const JointRange& r) { return yields[idx(r.body)] != 0; });
  model.ranges.erase(end, model.ranges.end());
  model.warnings.push_back("joints that follow others beyond their own range, which yields:" +
                           told + "; try ranges that agree");
}

}  // namespace softgauss::detail
