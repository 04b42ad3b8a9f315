// SPDX-License-Identifier: Apache-2.0
#include "tests/parity/reference_log.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>

#include "tests/parity/json_vector.hpp"
#include "tests/parity/reference_scene.hpp"

namespace softgauss::test {
namespace {

namespace fs = std::filesystem;

fs::path folder() { return fs::path(SOFTGAUSS_SOURCE_DIR) / "data" / "reference"; }

std::vector<VectorX> samplesOf(const Json& lists) {
  std::vector<VectorX> samples;
  for (const Json& list : lists) samples.push_back(vectorOf(list));
  return samples;
}

ReferenceContact contactOf(const Json& item) {
  ReferenceContact contact;
  contact.geometries[0] = item.at("geometries").at(0);
  contact.geometries[1] = item.at("geometries").at(1);
  contact.position = vectorOf(item.at("position"));
  const VectorX frame = vectorOf(item.at("frame"));
  contact.normal = frame.head<3>();
  contact.tangent = frame.segment<3>(3);
  contact.distance = item.at("distance");
  return contact;
}

Row rowOf(const Json& item) {
  return {vectorOf(item.at("J")), item.at("D"), item.at("reference"), item.at("force")};
}

ExternalWrench wrenchOf(const Model& model, const Json& item) {
  const int frame = model.findFrame(item.at("link"));
  if (frame < 0) throw std::runtime_error("a wrench on " + item.at("link").dump());
  const Frame& link = model.frames[static_cast<std::size_t>(frame)];
  if (!link.X_BF.p.isZero(0.0)) throw std::runtime_error("a wrench on a link that is merged");
  return {link.body, {vectorOf(item.at("moment")), vectorOf(item.at("force"))}};
}

Totals totalsOf(const Json& item) {
  return {item.at("mass"),
          item.at("potential"),
          item.at("kinetic"),
          vectorOf(item.at("centre_of_mass")),
          vectorOf(item.at("momentum")),
          vectorOf(item.at("angular_momentum"))};
}

ReferenceState stateOf(const Model& model, const Json& item) {
  ReferenceState s;
  s.q = vectorOf(item.at("q"));
  s.v = vectorOf(item.at("v"));
  s.force = vectorOf(item.at("force"));
  if (item.contains("wrenches"))
    for (const Json& wrench : item["wrenches"]) s.wrenches.push_back(wrenchOf(model, wrench));
  s.totals = totalsOf(item.at("totals"));
  const Eigen::Index nv = s.v.size();
  s.M.resize(nv, nv);
  for (Eigen::Index i = 0; i < nv; ++i)
    s.M.row(i) = vectorOf(item.at("mass_matrix").at(static_cast<std::size_t>(i))).transpose();
  s.bias = vectorOf(item.at("bias"));
  s.smoothAcceleration = vectorOf(item.at("smooth_acceleration"));
  s.acceleration = vectorOf(item.at("acceleration"));
  for (const Json& contact : item.at("contacts")) s.contacts.push_back(contactOf(contact));
  for (const Json& row : item.at("rows")) s.rows.push_back(rowOf(row));
  s.inverseAcceleration = vectorOf(item.at("inverse").at("acceleration"));
  s.inverseForce = vectorOf(item.at("inverse").at("force"));
  return s;
}

/// Both engines number the degrees of freedom depth first.
void checkDofs(const Model& model, const Json& dofs) {
  if (dofs.size() != model.dofs.size()) throw std::runtime_error("another number of dofs");
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const std::string& ours = model.jointNames[static_cast<std::size_t>(model.dofs[i].body)];
    if (dofs[i] != ours)
      throw std::runtime_error("dof " + std::to_string(i) + " is of joint " + ours +
                               ", the log has " + dofs[i].dump());
  }
}

/// Names of the logs that begin with gdd_, or of the others.
std::vector<std::string> logNames(bool gdd) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder())) {
    const std::string name = entry.path().stem().string();
    if (name.starts_with("gdd_") == gdd) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

ReferenceLog read(const std::string& name) {
  std::ifstream file(folder() / (name + ".json"));
  const Json json = Json::parse(file);
  ReferenceLog log;
  log.name = json.at("name");
  log.model = referenceModel(log.name, json.at("scene"), json.at("options"));
  checkDofs(log.model, json.at("dofs"));
  log.force = vectorOf(json.at("applied_force"));
  for (const Json& state : json.at("states")) log.states.push_back(stateOf(log.model, state));
  for (const Json& run : json.at("trajectories"))
    log.trajectories.push_back({run.at("integrator"), run.at("timestep"), run.at("every"),
                                samplesOf(run.at("q")), samplesOf(run.at("v"))});
  return log;
}

}  // namespace

const ReferenceTrajectory& ReferenceLog::trajectory(const std::string& integrator,
                                                    bool halfStep) const {
  const double h = model.options.timestep * (halfStep ? 0.5 : 1.0);
  for (const ReferenceTrajectory& run : trajectories)
    if (run.integrator == integrator && run.timestep == h) return run;
  throw std::runtime_error(name + " has no trajectory by " + integrator);
}

std::vector<std::string> referenceLogNames() { return logNames(false); }
std::vector<std::string> gddLogNames() { return logNames(true); }

const ReferenceLog& referenceLog(const std::string& name) {
  static std::map<std::string, std::unique_ptr<ReferenceLog>> logs;
  std::unique_ptr<ReferenceLog>& log = logs[name];
  if (!log) log = std::make_unique<ReferenceLog>(read(name));
  return *log;
}

}  // namespace softgauss::test
