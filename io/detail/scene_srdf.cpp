// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/scene_srdf.hpp"

#include "softgauss/io/detail/scene_parts.hpp"

namespace softgauss::io::detail {

void readSrdfKeys(const YamlMap& map, const std::filesystem::path& urdf,
                  const UrdfContents& contents, const std::string& prefix, ModelBuilder& robot,
                  SceneFile& scene) {
  SrdfChoice choice;
  choice.named = "the key 'srdf'";
  // MuJoCo knows no SRDF.
  choice.search = scene.builder.options.constraintModel == ConstraintModel::softgauss;
  if (const YamlMap::Entry* file = map.find("srdf")) {
    choice.file = map.name(*file);
    if (choice.file != "none") choice.file = existingFile(map, *file, map.name(*file));
  }
  const YamlMap::Entry* state = map.find("state");
  if (state) choice.state = map.name(*state);
  std::vector<std::string> warnings;
  Srdf srdf = chooseSrdf(urdf, robot.name(), choice, {map.file(), state ? state->line : map.line()},
                         state ? map.element(*state) : "robot", warnings);
  for (std::string& warning : warnings) robot.warning(std::move(warning));
  if (srdf.file.empty()) return;
  scene.contents.files.push_back(srdf.file);
  for (const auto& [linkA, linkB] : srdf.apartAmong(contents.linkNames))
    robot.keepApart(linkA, linkB);
  if (choice.file.empty())
    scene.notes.push_back(describe(srdf, contents.linkNames, "the key 'state'"));
  scene.srdfs.push_back({std::move(srdf), choice.state, prefix});
}

}  // namespace softgauss::io::detail
