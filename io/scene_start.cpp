// SPDX-License-Identifier: Apache-2.0
/// The state in which a scene starts.

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/model/followers.hpp"
#include "softgauss/io/detail/unit_mistakes.hpp"
#include "softgauss/io/scene.hpp"

namespace softgauss::io {

State SceneFile::initialState(const Model& model, std::vector<std::string>* warnings) const {
  State state(model);
  for (const RobotSrdf& robot : srdfs)
    if (!robot.state.empty())
      for (std::string& warning : placeState(model, robot.srdf, robot.state, robot.prefix, state.q))
        if (warnings) warnings->push_back(std::move(warning));
  std::map<int, const JointRange*> ranges;
  for (const JointRange& range : model.ranges) ranges[range.body] = &range;
  for (const auto& [joint, value, where, element] : positions) {
    const int body = model.findJoint(joint);
    const auto range = ranges.find(body);
    if (range != ranges.end() && (value < range->second->lower || value > range->second->upper))
      throw ModelError(where, element,
                       fmt::format("found {:g}{}, expected a position within the joint's range, "
                                   "{:g} to {:g}",
                                   value, detail::radiansMeant(model, *range->second, value),
                                   range->second->lower, range->second->upper));
    state.q[model.bodies[static_cast<std::size_t>(body)].q] = value;
  }
  std::set<int> placed;
  for (const JointValue& position : positions) placed.insert(model.findJoint(position.joint));
  placeFollowers(model, placed, state.q);
  for (const auto& [joint, value, where, element] : positions) {
    const double asked = followedPosition(model, model.findJoint(joint), state.q).value_or(value);
    if (std::abs(value - asked) > kFollowerTolerance)
      throw ModelError(where, element,
                       fmt::format("found {:g}, expected {:.6g}, for the joint follows another; "
                                   "give its leader",
                                   value, asked));
  }
  for (const JointValue& velocity : velocities)
    state.v[model.bodies[static_cast<std::size_t>(model.findJoint(velocity.joint))].v] =
        velocity.value;
  for (const Start& start : starts) {
    const Frame& frame = model.frames[static_cast<std::size_t>(model.findFrame(start.link))];
    const Body& body = model.bodies[static_cast<std::size_t>(frame.body)];
    const Quaternion q(state.q[body.q + 3], state.q[body.q + 4], state.q[body.q + 5],
                       state.q[body.q + 6]);
    state.v.segment<3>(body.v) = start.velocity;
    state.v.segment<3>(body.v + 3) = q.conjugate() * start.angularVelocity;
  }
  return state;
}

}  // namespace softgauss::io
