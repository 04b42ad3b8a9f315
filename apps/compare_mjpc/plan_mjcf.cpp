// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mjpc/plan_mjcf.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apps/compare_mujoco/mjcf.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/constraints/law/row_law.hpp"
#include "softgauss/engine/core/index.hpp"

namespace softgauss::app {
namespace {

/// The spring K and the damper τ K of (3.15) at the end of a step, which is r + h ẋ⁺ of Euler's. Of
/// what the row feels, A, they leave 1/(1 + κ'), κ' = h (h + τ) K A:
///   ẋ⁺ = (ẋ + h a₀)/(1 + κ') − d r/(h + τ),   d = κ'/(1 + κ')
/// with a₀ without the row. MuJoCo's row of the impedance d and a reference that is given directly:
///   ẋ⁺ = ẋ + (1 − d) h a₀ − h (B ẋ + K_ref r).
Impedance nearRigid(const Impedance& own, double h) {
  const double tau =
      std::max(2.0 * own.timeConstant * own.dampingRatio * own.dampingRatio, 0.5 * h);
  const double kappa = kNearRigid * (h + tau) / (0.5 * h + tau), d = kappa / (1.0 + kappa);
  Impedance i = own;
  i.dMin = i.dMax = d;
  i.direct = ReferenceSpring{d / (h * (h + tau)), d / h};
  return i;
}

Model withNearRigidRows(const Model& model) {
  Model copy = model;
  const auto soften = [&](Impedance& i) {
    if (i == Impedance{}) i = nearRigid(i, model.options.timestep);
  };
  for (Geometry& geometry : copy.geometries) soften(geometry.material.impedance);
  for (ContactPair& pair : copy.contactPairs) soften(pair.material.impedance);
  for (JointRange& range : copy.ranges) soften(range.impedance);
  return copy;
}

std::string motors(const Model& model) {
  std::string out = "<actuator>\n";
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[idx(b)];
    const Dof* const dof = body.dofs == 1 ? &model.dofs[idx(body.v)] : nullptr;
    if (!dof || !dof->actuated) continue;
    if (!(dof->effortUpper < kInfinity && dof->effortLower > -kInfinity))
      throw ModelError({}, "joint '" + model.jointNames[idx(b)] + "'",
                       "has no bounds of effort, expected some: MuJoCo MPC clamps to them");
    out +=
        fmt::format("<motor joint=\"j{}\" ctrllimited=\"true\" ctrlrange=\"{:.17g} {:.17g}\"/>\n",
                    b, dof->effortLower, dof->effortUpper);
  }
  return out + "</actuator>\n";
}

std::string sensors(const Model& model, double weight) {
  const auto controls = std::count_if(model.dofs.begin(), model.dofs.end(),
                                      [](const Dof& dof) { return dof.actuated; });
  std::string out = "<sensor>\n";
  for (const auto& [name, rows] : {std::pair("position", model.nv), std::pair("velocity", model.nv),
                                   std::pair("control", static_cast<int>(controls))})
    out += fmt::format("<user name=\"{}\" dim=\"{}\" user=\"0 {:.17g} 0 {:.17g}\"/>\n", name, rows,
                       weight, weight);
  return out + "</sensor>\n";
}

}  // namespace

std::string planMjcf(const Model& model, UngivenSoftness softness, double weight) {
  const collision::SceneContacts contacts(model);
  const bool stiff = softness == UngivenSoftness::nearRigid && model.options.hasRowLaw();
  std::string text = mjcfOf(stiff ? withNearRigidRows(model) : model, contacts.filter());
  text.insert(text.rfind("</mujoco>"), motors(model) + sensors(model, weight));
  return text;
}

}  // namespace softgauss::app
