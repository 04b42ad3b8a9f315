// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/run_recording.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "softgauss/engine/dynamics/energy.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/io/replay/page.hpp"
#include "softgauss/io/simulation/simulation_parts.hpp"

namespace softgauss {

std::vector<std::shared_ptr<const Mesh>> collidingHulls(const Scene& scene) {
  std::vector<std::shared_ptr<const Mesh>> hulls(scene.model.geometries.size());
  std::map<const collision::ConvexHull*, std::shared_ptr<const Mesh>> made;
  for (std::size_t i = 0; i < hulls.size(); ++i) {
    const collision::ConvexHull* hull = scene.contacts->hull(static_cast<int>(i));
    if (!hull) continue;
    std::shared_ptr<const Mesh>& mesh = made[hull];
    if (!mesh) mesh = std::make_shared<const Mesh>(collision::triangulated(*hull));
    hulls[i] = mesh;
  }
  return hulls;
}

std::map<const Mesh*, io::MeshImages> visualImages(const Model& model, double largest,
                                                   std::vector<std::string>& warnings) {
  std::map<const Mesh*, io::MeshImages> all;
  const auto bytes = static_cast<std::uintmax_t>(largest * (1 << 20));
  for (const Visual& visual : model.visuals) {
    const Mesh* mesh = visual.shape.mesh.get();
    if (!mesh || all.contains(mesh)) continue;
    io::MeshImages& images = all[mesh] = io::imagesOf(*mesh, bytes);
    for (const std::string& text : images.notShown)
      if (std::find(warnings.begin(), warnings.end(), "not shown: " + text) == warnings.end())
        warnings.push_back("not shown: " + text);
  }
  return all;
}

void recordSolve(const Data& data, const gdd::GoalDirectedController& controller, double stepUs,
                 io::StepRecord& record) {
  const bool controlled = !controller.goals.empty();
  const StepStats& stats = data.stats;
  record.a = data.plan.drifts ? data.acceleration : data.forward.a;
  appliedForces(data, record.u);
  record.contacts = stats.contacts;
  record.constraints = stats.rows;
  record.iterations = controlled ? controller.report.iterations : stats.iterations;
  record.dualUpdates = controlled ? controller.report.dualUpdates : 0;
  record.gddViolation = controlled ? controller.report.violation : 0.0;
  record.stationarity = controlled ? controller.report.stationarity : 0.0;
  record.realised = stats.realised;
  record.stepUs = stepUs;
  record.gddUs = controlled ? 1e6 * controller.solveTime : 0.0;
  record.forwardUs = stepUs - record.gddUs;
  record.maxPenetration = stats.maxPenetration;
}

io::Recording RunRecording::begin(SimulationParts& parts) {
  const Model& model = parts.scene->model;
  Data start(model, Data::Evaluation{});
  computeKinematics(model, parts.state, start.kinematics);
  io::Recording recording(model, parts.controller->goals, {model, parts.state, start});
  recording.hulls = collidingHulls(*parts.scene);
  recording.images = visualImages(model, parts.options.largestMesh, recording.warnings);
  recording.command = parts.scene->file.string();
  return recording;
}

RunRecording::RunRecording(SimulationParts& parts)
    : parts_(parts), recording_(begin(parts)), kinematics_(parts.scene->model) {
  record_.time = -kInfinity;
}

void RunRecording::beforeStep() {
  const State& state = parts_.state;
  if (state.time <= record_.time) recording_.rewind(state.time);
  record_.time = state.time;
  record_.q = state.q, record_.v = state.v;
  computeKinematics(parts_.scene->model, state, kinematics_);
}

void RunRecording::afterStep(double stepUs) {
  Data& data = *parts_.data;
  recordSolve(data, *parts_.controller, stepUs, record_);
  const Energy energy = computeEnergy(parts_.scene->model, kinematics_, record_.q, record_.v);
  record_.energy = energy.total();
  record_.kineticEnergy = energy.kinetic;
  // What is seen is the step's start.
  std::swap(data.kinematics, kinematics_);
  recording_.addStep(record_, data);
  std::swap(data.kinematics, kinematics_);
}

void RunRecording::write(const std::filesystem::path& file) const {
  const Model& model = parts_.scene->model;
  io::ReplayPage page(file);
  Data end(model);
  computeStages(model, parts_.inputOfStep(), parts_.state, end, &parts_.scene->source());
  io::StepRecord last;
  last.isEnd = true;
  last.time = parts_.state.time;
  last.q = parts_.state.q, last.v = parts_.state.v;
  last.a = last.u = VectorX::Zero(model.nv);
  last.maxPenetration = end.stats.maxPenetration;
  const Energy energy = computeEnergy(model, end.kinematics, last.q, last.v);
  last.energy = energy.total(), last.kineticEnergy = energy.kinetic;
  io::Recording whole = recording_;
  whole.finish(last, end);
  page.write(whole, std::string("softgauss ") + SOFTGAUSS_VERSION);
}

}  // namespace softgauss
