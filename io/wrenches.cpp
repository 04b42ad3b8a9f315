// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/wrenches.hpp"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "softgauss/engine/core/check.hpp"

namespace softgauss::io {

WrenchSchedule::WrenchSchedule(const Model& model, const std::vector<TimedWrench>& wrenches)
    : wrenches_(wrenches) {
  std::unordered_map<std::string_view, const Frame*> frames;
  if (!wrenches_.empty())
    for (const Frame& frame : model.frames) frames.emplace(frame.name, &frame);
  for (const TimedWrench& wrench : wrenches_) {
    const auto found = frames.find(wrench.link);
    const std::string element = "wrench on '" + wrench.link + "'";
    if (found == frames.end())
      throw ModelError(wrench.where, element, "found no link of that name");
    const Frame& frame = *found->second;
    if (frame.body == 0)
      throw ModelError(wrench.where, element,
                       "found a link fixed to the world, expected one that moves");
    bodies_.push_back(frame.body);
    p_BP_.push_back(frame.X_BF * wrench.p_LP);
  }
}

double WrenchSchedule::nextChange(double time) const {
  constexpr double kSameTime = 1e-9;  // [s]
  double next = kInfinity;
  for (const TimedWrench& wrench : wrenches_)
    for (const double change : {wrench.start, wrench.end})
      if (change > time + kSameTime) next = std::min(next, change);
  return next;
}

void WrenchSchedule::at(double time, double timestep, const Kinematics& kinematics,
                        std::vector<ExternalWrench>& out) const {
  out.clear();
  const double middle = time + 0.5 * timestep;
  for (std::size_t i = 0; i < wrenches_.size(); ++i) {
    const TimedWrench& wrench = wrenches_[i];
    if (middle < wrench.start || middle > wrench.end) continue;
    const Vector3 r_W = kinematics.X_WB[static_cast<std::size_t>(bodies_[i])].R * p_BP_[i];
    out.push_back({bodies_[i], {wrench.moment_W + r_W.cross(wrench.force_W), wrench.force_W}});
  }
}

}  // namespace softgauss::io
