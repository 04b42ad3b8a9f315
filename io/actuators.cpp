// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/actuators.hpp"

namespace softgauss::io {

gdd::ControlLimits controlLimits(const Model& model, const std::vector<SceneActuator>& actuators) {
  if (actuators.empty()) return gdd::ControlLimits(model);
  std::vector<gdd::Actuator> list;
  for (const SceneActuator& actuator : actuators) {
    gdd::Actuator out;
    out.name = actuator.name;
    out.lower = actuator.lower;
    out.upper = actuator.upper;
    out.where = actuator.where;
    for (const auto& [joint, coefficient] : actuator.joints) {
      const int body = model.findJoint(joint);
      if (body < 0 || model.bodies[static_cast<std::size_t>(body)].dofs != 1)
        throw ModelError(actuator.where, "actuator '" + actuator.name + "'",
                         "the model has no joint '" + joint + "' of one degree of freedom");
      out.pulls.push_back({model.bodies[static_cast<std::size_t>(body)].v, coefficient});
    }
    list.push_back(std::move(out));
  }
  return {model, std::move(list)};
}

}  // namespace softgauss::io
