// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/own_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/accuracy_cost/engine_under_test.hpp"
#include "softgauss/io/scene.hpp"
#include "softgauss/io/simulation/ground.hpp"

namespace softgauss::app {
namespace {

/// How it is built, and where it starts.
struct Start {
  ModelBuilder builder;
  State state;
};

Start loadRobot(const OwnModel& own, const io::UrdfOptions& urdf) {
  Start start;
  start.builder = io::readUrdf(own.file, urdf);
  const bool byDefault = own.ground.empty() && hasFloatingBase(start.builder.build());
  const bool given = !own.ground.empty() && own.ground != "none";
  const double height = given ? std::stod(own.ground) : 0.0;
  if (byDefault || given) addGround(start.builder, height, {});
  const Model model = start.builder.build();
  start.state = State(model);
  if (byDefault || given) standOnGround(model, height, nullptr, start.state);
  return start;
}

Start loadSceneFile(const OwnModel& own, const io::UrdfOptions& urdf,
                    std::vector<std::string>& notes) {
  io::SceneFile file = io::readScene(own.file, urdf);
  std::optional<double> ground = file.ground;
  if (!ground && !file.noGround && !file.starts.empty()) ground = 0.0;
  if (ground) addGround(file.builder, *ground, file.groundMaterial);
  const Model model = file.builder.build();
  State state = file.initialState(model);
  std::vector<std::string> standing;
  for (const io::SceneFile::Start& start : file.starts)
    if (start.onGround) standing.push_back(start.link);
  if (ground) standOnGround(model, *ground, &standing, state);
  if (file.hasGoals) notes.emplace_back("its goals are left out: the motion is passive");
  if (!file.wrenches.empty()) notes.emplace_back("its wrenches are left out");
  return {std::move(file.builder), std::move(state)};
}

/// Nothing takes energy from it.
bool isLossless(const Model& model, bool contact) {
  return !contact && model.ranges.empty() &&
         std::all_of(model.dofs.begin(), model.dofs.end(),
                     [](const Dof& dof) { return dof.damping == 0.0 && dof.dryFriction == 0.0; });
}

/// As the name of files and in a table of commas.
std::string plainName(std::string name) {
  for (char& c : name)
    if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9') && c != '.' &&
        c != '-')
      c = '_';
  return name;
}

}  // namespace

bool OwnModel::isScene() const { return file.extension() == ".yaml" || file.extension() == ".yml"; }

OwnProblem ownProblem(const OwnModel& own) {
  io::UrdfOptions urdf;
  urdf.base = own.base;
  urdf.packagePaths = own.packagePaths;
  OwnProblem result;
  if (own.isScene() && (own.base != BaseKind::automatic || !own.ground.empty()))
    throw ModelError({own.file.string(), 0}, "--base, --ground",
                     "are for a URDF; a scene file says it itself");
  const Start start = own.isScene() ? loadSceneFile(own, urdf, result.notes) : loadRobot(own, urdf);
  const Model model = start.builder.build();
  if (model.nv == 0)
    throw ModelError({own.file.string(), 0}, "model '" + model.name + "'",
                     "has no degrees of freedom, expected at least one");

  Problem& p = result.problem;
  p.name = plainName(own.file.filename().string());
  p.build = [builder = start.builder] { return builder; };
  p.start = [start = start.state](const Model&, State& state) {
    state.q = start.q;
    state.v = start.v;
  };
  const bool contact = !collision::SceneContacts(model).filter().pairs.empty();
  p.title = fmt::format("{} degrees of freedom, passive, {}", model.nv,
                        contact ? "with shapes that may touch" : "nothing may touch");
  if (contact) {
    p.periods = 31;
    p = inWindows(std::move(p));
  }
  p.lossless = isLossless(model, contact);
  const std::vector<Method> theirs = mujocoMethods(p);
  try {
    if (!theirs.empty()) makeEngine(p, theirs.front(), kPeriod);
  } catch (const ModelError& error) {
    p.inMujoco = false;
    result.notes.push_back(fmt::format("MuJoCo is left out: {}", error.what()));
  }
  return result;
}

}  // namespace softgauss::app
