// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/problem.hpp"

namespace softgauss::gdd {

ControlLimits::ControlLimits(const Model& model, std::vector<Actuator> actuators)
    : ControlLimits(model) {
  transmission = std::make_shared<const Transmission>(model.nv, std::move(actuators));
  const bool actuation = model.options.effects.has(Effect::actuation);
  for (int i = 0; i < model.nv; ++i)
    if (transmission->pulls(i)) lower[i] = upper[i] = 0.0;
  for (std::size_t k = 0; actuation && k < transmission->actuators().size(); ++k) {
    const int i = transmission->coordinateOf(static_cast<int>(k));
    lower[i] = transmission->actuators()[k].lower;
    upper[i] = transmission->actuators()[k].upper;
  }
}

void ControlLimits::markControlled(const Model& model, std::vector<std::uint8_t>& trees,
                                   std::uint8_t mark) const {
  if (trees.empty()) trees.resize(model.trees.size(), 0);
  if (lower.size() != model.nv || upper.size() != model.nv || trees.size() != model.trees.size())
    return;  // the step is refused
  const auto set = [&](int dof) {
    const int body = model.dofs[static_cast<std::size_t>(dof)].body;
    trees[static_cast<std::size_t>(model.bodies[static_cast<std::size_t>(body)].tree)] = mark;
  };
  for (int i = 0; i < model.nv; ++i) {
    if (!(lower[i] < upper[i])) continue;
    if (isPlain(i)) {
      set(i);
      continue;
    }
    for (int dof = 0; dof < model.nv; ++dof)
      if (transmission->T()(dof, i) != 0.0) set(dof);
  }
}

void ControlLimits::appendPairs(const Model& model, std::vector<std::pair<int, int>>& pairs) const {
  if (!transmission) return;
  for (const Actuator& actuator : transmission->actuators())
    for (const Actuator::Pull& pull : actuator.pulls)
      pairs.emplace_back(model.dofs[idx(actuator.pulls.front().dof)].body,
                         model.dofs[idx(pull.dof)].body);
}

void ControlLimits::clamp(const VectorX& g, VectorX& tau, VectorX& y) const {
  coordinates(g, y);
  tau = g;
  bool inside = true;
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double clamped = std::min(std::max(y[i], lower[i]), upper[i]);
    inside &= clamped == y[i];
    y[i] = clamped;
  }
  if (inside) return;
  if (transmission)
    tau.noalias() = transmission->T() * y;
  else
    tau = y;
}

void ControlLimits::clamp(Segments dofs, const VectorX& g, VectorX& tau, VectorX& y) const {
  bool inside = true;
  for (const Segment s : dofs)
    for (int i = s.begin; i < s.end; ++i) {
      const double asked = coordinate(i, g);
      y[i] = std::min(std::max(asked, lower[i]), upper[i]);
      inside &= y[i] == asked;
    }
  for (const Segment s : dofs)
    for (int i = s.begin; i < s.end; ++i)
      if (inside)
        tau[i] = g[i];
      else
        tau[i] = isPlain(i) ? y[i] : transmission->T().row(i).dot(y);
}

}  // namespace softgauss::gdd
