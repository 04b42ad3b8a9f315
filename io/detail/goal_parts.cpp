// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "softgauss/engine/dynamics/kinematics.hpp"
#include "softgauss/gdd/goals/balance.hpp"
#include "softgauss/io/detail/goal_kinds.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/names.hpp"

namespace softgauss::io::detail {

std::string movingLink(const YamlMap& keys, const YamlMap::Entry& entry, const Model& model) {
  const std::string link = keys.name(entry);
  if (const std::string problem = linkProblem(model, link); !problem.empty())
    keys.fail(entry, problem);
  return link;
}

std::vector<std::pair<int, double>> readJoints(const YamlMap& joints, const Model& model) {
  std::vector<std::pair<int, double>> values;
  for (const YamlMap::Entry& entry : joints.entries()) {
    if (const std::string problem = jointProblem(model, entry.key); !problem.empty())
      joints.fail(entry, problem);
    values.emplace_back(model.findJoint(entry.key), joints.number(entry));
  }
  return values;
}

Transform initialPose(const GoalScene& scene, int frame) {
  Kinematics kinematics(scene.model);
  computeKinematics(scene.model, scene.initial, kinematics);
  return framePose(scene.model, kinematics, frame);
}

int readRobot(const YamlMap& keys, const Model& model) {
  const bool driven = std::any_of(model.dofs.begin(), model.dofs.end(),
                                  [](const Dof& dof) { return dof.actuated; });
  if (driven && !keys.find("link")) return gdd::drivenRobot(model);
  const YamlMap::Entry& entry =
      keys.required("link", "a link of the robot meant, as no joint is actuated");
  const int frame = model.findFrame(movingLink(keys, entry, model));
  const Frame& link = model.frames[static_cast<std::size_t>(frame)];
  return model.bodies[static_cast<std::size_t>(link.body)].robot;
}

std::array<bool, 3> readAxes(const YamlMap& keys, const YamlMap::Entry& entry) {
  const std::string letters = keys.name(entry);
  std::array<bool, 3> axes{};
  bool good = !letters.empty();
  for (const char letter : letters) {
    good = good && letter >= 'x' && letter <= 'z' && !axes[static_cast<std::size_t>(letter - 'x')];
    if (good) axes[static_cast<std::size_t>(letter - 'x')] = true;
  }
  if (!good)
    keys.fail(entry, fmt::format("found {}, expected some of the letters x, y, z, each once",
                                 quotedText(letters)));
  return axes;
}

}  // namespace softgauss::io::detail
