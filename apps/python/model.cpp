// SPDX-License-Identifier: Apache-2.0
/// Simulation: sizes and names of what is simulated.

#include "apps/python/held.hpp"
#include "softgauss/io/log.hpp"

namespace softgauss::python {
namespace {

using Names = std::vector<std::string>;

/// Columns of the log with this prefix, without it: "q:elbow" is "elbow".
Names columnsWith(const Model& model, const std::string& prefix) {
  Names names;
  for (const std::string& column : io::logColumns(model))
    if (column.starts_with(prefix)) names.push_back(column.substr(prefix.size()));
  return names;
}

Names linksOf(const Model& model) {
  Names names;
  for (const Frame& frame : model.frames) names.push_back(frame.name);
  return names;
}

Names jointsOf(const Model& model) {
  Names names;
  for (std::size_t body = 1; body < model.bodies.size(); ++body)
    if (model.bodies[body].dofs == 1) names.push_back(model.jointNames[body]);
  return names;
}

using Bounds = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

Bounds effortOf(const Model& model) {
  Bounds bounds = Bounds::Zero(model.nv, 2);
  for (int i = 0; i < model.nv; ++i) {
    const Dof& dof = model.dofs[static_cast<std::size_t>(i)];
    if (dof.actuated) bounds.row(i) << dof.effortLower, dof.effortUpper;
  }
  return bounds;
}

Bounds rangesOf(const Model& model) {
  Bounds bounds(model.nv, 2);
  bounds.col(0).setConstant(-kInfinity);
  bounds.col(1).setConstant(kInfinity);
  for (const JointRange& range : model.ranges)
    bounds.row(model.bodies[static_cast<std::size_t>(range.body)].v) << range.lower, range.upper;
  return bounds;
}

}  // namespace

void bindModel(HeldClass& sim) {
  const auto ofModel = [&](const char* name, auto get, const char* doc) {
    sim.def_property_readonly(
        name, [get](Held& h) { return get(h.sim().model()); }, doc);
  };
  ofModel(
      "name", [](const Model& m) { return m.name; }, "Of the robot or scene.");
  ofModel(
      "nq", [](const Model& m) { return m.nq; }, "Size of q.");
  ofModel(
      "nv", [](const Model& m) { return m.nv; }, "Degrees of freedom, size of v.");
  ofModel(
      "timestep", [](const Model& m) { return m.options.timestep; }, "[s]");
  ofModel(
      "mass", [](const Model& m) { return m.totalMass(); }, "Of all that moves [kg].");
  ofModel("links", linksOf, "Names of all links.");
  ofModel("joints", jointsOf, "Names of the joints of one degree of freedom, in the order of v.");
  ofModel(
      "q_names", [](const Model& m) { return columnsWith(m, "q:"); },
      "(nq) what the entries of q are called in logs.");
  ofModel(
      "v_names", [](const Model& m) { return columnsWith(m, "v:"); },
      "(nv) what the entries of v are called in logs.");
  ofModel(
      "actuated",
      [](const Model& m) {
        std::vector<bool> actuated;
        for (const Dof& dof : m.dofs) actuated.push_back(dof.actuated);
        return actuated;
      },
      "(nv) whether a motor acts there.");
  ofModel(
      "effort", effortOf,
      "(nv, 2) least and largest control [N m or N], 0 where there is no motor, ±inf without a\n"
      "limit.");
  ofModel("range", rangesOf, "(nv, 2) ends of the joints' ranges [rad or m], ±inf without.");
  ofModel(
      "warnings", [](const Model& m) { return m.warnings; },
      "What one should know about how the model was read.");
}

}  // namespace softgauss::python
