// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/names.hpp"

#include <fmt/format.h>

#include "softgauss/io/detail/text.hpp"

namespace softgauss::io {
namespace {

constexpr std::pair<const char*, const char*> kShortNames[] = {{"euler", "semi-implicit-euler"},
                                                               {"midpoint", "implicit-midpoint"},
                                                               {"rk4", "runge-kutta-4"},
                                                               {"dopri5", "dormand-prince"}};

}  // namespace

std::string nameText(const std::string& name) {
  const bool isNumber = name.find_first_not_of("0123456789.+-") == std::string::npos;
  return isNumber ? "'" + name + "'" : name;
}

std::string linkProblem(const Model& model, const std::string& link) {
  const int frame = model.findFrame(link);
  const bool isWorld = frame < 0 && link == "world";
  if (isWorld || (frame >= 0 && model.frames[static_cast<std::size_t>(frame)].body == 0))
    return fmt::format("found {}, which is fixed to the world, expected a link that moves",
                       detail::quotedText(link));
  if (frame >= 0) return {};
  std::vector<std::string> links;
  for (const Frame& other : model.frames)
    if (other.body != 0) links.push_back(other.name);
  return fmt::format("found {}, expected a link of model {}{}", detail::quotedText(link),
                     detail::quotedText(model.name), detail::offered(link, links));
}

std::string jointProblem(const Model& model, const std::string& joint) {
  const int body = model.findJoint(joint);
  if (body >= 0 && model.bodies[static_cast<std::size_t>(body)].dofs == 1) return {};
  if (body >= 0)
    return fmt::format(
        "found a joint of {} degrees of freedom, expected a revolute, continuous or prismatic one",
        model.bodies[static_cast<std::size_t>(body)].dofs);
  std::vector<std::string> joints;
  for (int b = 1; b < model.bodyCount(); ++b)
    if (model.bodies[static_cast<std::size_t>(b)].dofs == 1)
      joints.push_back(model.jointNames[static_cast<std::size_t>(b)]);
  return fmt::format("found an unknown joint, expected one of model {}{}",
                     detail::quotedText(model.name), detail::offered(joint, joints));
}

std::vector<std::string> integratorNames() {
  std::vector<std::string> names;
  for (const IntegratorName& i : kIntegratorNames) names.emplace_back(i.name);
  for (const auto& [shortName, full] : kShortNames) names.emplace_back(shortName);
  return names;
}

std::optional<Integrator> integratorCalled(const std::string& name) {
  for (const auto& [shortName, full] : kShortNames)
    if (name == shortName) return integratorFromName(full);
  return integratorFromName(name);
}

std::optional<Sleep> sleepCalled(const std::string& name) {
  if (name != "none" && name != "objects" && name != "all") return std::nullopt;
  return Sleep{.enabled = name != "none", .controlled = name == "all"};
}

}  // namespace softgauss::io
