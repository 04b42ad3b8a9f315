// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "engine/dynamics/kinematics.hpp"
#include "gdd/goals/balance.hpp"
#include "io/detail/goal_kinds.hpp"
#include "io/detail/text.hpp"

namespace softgauss::io::detail {

std::string movingLink(const YamlMap& keys, const YamlMap::Entry& entry, const Model& model) {
  const std::string link = keys.name(entry);
  std::vector<std::string> links;
  for (const Frame& frame : model.frames)
    if (frame.body != 0) links.push_back(frame.name);
  const int frame = model.findFrame(link);
  if (frame < 0)
    keys.fail(entry, fmt::format("found {}, expected a link of model '{}'{}", quotedText(link),
                                 model.name, suggestion(link, links)));
  if (model.frames[static_cast<std::size_t>(frame)].body == 0)
    keys.fail(entry,
              fmt::format("found {}, which is fixed to the world, expected a link that moves",
                          quotedText(link)));
  return link;
}

std::vector<std::pair<int, double>> readJoints(const YamlMap& joints, const Model& model) {
  std::vector<std::string> names;
  for (int b = 1; b < model.bodyCount(); ++b)
    if (model.bodies[static_cast<std::size_t>(b)].dofs == 1)
      names.push_back(model.jointNames[static_cast<std::size_t>(b)]);

  std::vector<std::pair<int, double>> values;
  for (const YamlMap::Entry& entry : joints.entries()) {
    const int body = model.findJoint(entry.key);
    if (body < 0)
      joints.fail(entry, fmt::format("found an unknown joint, expected one of model '{}'{}",
                                     model.name, suggestion(entry.key, names)));
    const int dofs = model.bodies[static_cast<std::size_t>(body)].dofs;
    if (dofs != 1)
      joints.fail(entry, fmt::format("found a joint of {} degrees of freedom, expected a revolute, "
                                     "continuous or prismatic one",
                                     dofs));
    values.emplace_back(body, joints.number(entry));
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
