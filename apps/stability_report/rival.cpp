// SPDX-License-Identifier: Apache-2.0
#include "apps/stability_report/rival.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/compare_mujoco/mjcf.hpp"

namespace softgauss::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kPoints = 200;  // of a course that is kept, for pictures

std::string runName(const HardCase& hard, double timestep) {
  return fmt::format("{}_{:g}ms", hard.scene, 1e3 * timestep);
}

std::string outcomeName(const HardCase& hard, double timestep, const std::string& integrator) {
  return runName(hard, timestep) + "_" + integrator;
}

void write(const std::filesystem::path& file, const std::string& text) {
  if (!(std::ofstream(file) << text << std::flush))
    throw ModelError({file.string(), 0}, "file", "cannot be written");
}

std::string textOf(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw ModelError({file.string(), 0}, "file", "cannot be read");
  return {std::istreambuf_iterator<char>(in), {}};
}

/// States one after the other, q then v, until the run ends or MuJoCo warns.
Outcome measured(const std::filesystem::path& scenes, const HardCase& hard, double timestep,
                 const std::filesystem::path& states) {
  std::ifstream in(states, std::ios::binary);
  if (!in) return {};
  State initial;
  Stage stage(loadCase(scenes, hard, timestep, initial));
  stage.state = initial;
  const auto read = [&](VectorX& x) {
    in.read(reinterpret_cast<char*>(x.data()),
            static_cast<std::streamsize>(x.size() * static_cast<Eigen::Index>(sizeof(double))));
    return static_cast<bool>(in);
  };
  return runCase(stage, hard, [&] { return read(stage.state.q) && read(stage.state.v); });
}

Json jsonOf(const Outcome& outcome) {
  if (!outcome.ran) return {{"loaded", false}};
  Json json = {{"figures", outcome.figures}, {"courses", Json::array()}};
  if (outcome.diverged) json = {{"diverged_s", *outcome.diverged}, {"courses", Json::array()}};
  for (const std::vector<double>& course : outcome.courses) {
    std::vector<double> kept;
    const std::size_t stride = std::max<std::size_t>(1, course.size() / kPoints);
    for (std::size_t i = 0; i < course.size(); i += stride)
      kept.push_back(std::stod(fmt::format("{:.4g}", course[i])));
    json["courses"].push_back(kept);
  }
  return json;
}

}  // namespace

Rival::Rival(const std::filesystem::path& file) {
  try {
    const Json json = Json::parse(textOf(file));
    version_ = json.at("mujoco");
    for (const auto& [name, run] : json.at("runs").items()) {
      Outcome& outcome = outcomes_[name];
      outcome.ran = run.value("loaded", true);
      if (run.contains("diverged_s")) outcome.diverged = run["diverged_s"].get<double>();
      if (run.contains("figures")) outcome.figures = run["figures"].get<std::vector<double>>();
      if (run.contains("courses"))
        outcome.courses = run["courses"].get<std::vector<std::vector<double>>>();
    }
  } catch (const Json::exception& error) {
    throw ModelError({file.string(), 0}, "record", error.what());
  }
}

Outcome Rival::outcome(const HardCase& hard, double timestep, const std::string& integrator) const {
  const auto found = outcomes_.find(outcomeName(hard, timestep, integrator));
  return found == outcomes_.end() ? Outcome{} : found->second;
}

void exportCases(const std::filesystem::path& scenes, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const HardCase& hard : hardCases())
    for (const double timestep : kSteps) {
      State initial;
      const Stage stage(loadCase(scenes, hard, timestep, initial));
      const auto list = [](const VectorX& x) { return std::vector<double>(x.begin(), x.end()); };
      const std::string name = runName(hard, timestep);
      write(folder / (name + ".xml"), mjcfOf(stage.model, stage.contacts.filter()));
      write(folder / (name + ".json"),
            Json{{"q", list(initial.q)}, {"v", list(initial.v)}, {"steps", stepsOf(hard, timestep)}}
                .dump());
    }
}

void measureRival(const std::filesystem::path& scenes, const std::filesystem::path& folder,
                  const std::filesystem::path& file) {
  std::string version = textOf(folder / "version.txt");
  version.erase(version.find_last_not_of("\n ") + 1);
  Json runs = Json::object();
  for (const HardCase& hard : hardCases())
    for (const double timestep : kSteps)
      for (const char* integrator : kRivalIntegrators) {
        const std::string name = outcomeName(hard, timestep, integrator);
        runs[name] = jsonOf(measured(scenes, hard, timestep, folder / (name + ".bin")));
      }
  std::string text = fmt::format("{{\"mujoco\": \"{}\", \"runs\": {{\n", version);
  for (const auto& [name, run] : runs.items())
    text += fmt::format("{}\"{}\": {}", text.ends_with("{\n") ? "" : ",\n", name, run.dump());
  write(file, text + "\n}}\n");
}

}  // namespace softgauss::app
