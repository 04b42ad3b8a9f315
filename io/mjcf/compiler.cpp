// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/compiler.hpp"

#include <fmt/format.h>

#include <cmath>

#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::mjcf {

double Compiler::radians(double angle) const { return degrees ? angle * M_PI / 180.0 : angle; }

void Compiler::read(const Element& element) {
  element.expectAttributes(
      {"autolimits",      "boundmass",         "boundinertia",    "settotalmass", "balanceinertia",
       "strippath",       "coordinate",        "angle",           "fitaabb",      "eulerseq",
       "meshdir",         "texturedir",        "discardvisual",   "usethread",    "fusestatic",
       "inertiafromgeom", "inertiagrouprange", "saveinertial",    "assetdir",     "alignfree",
       "conflict",        "convexhull",        "exactmeshinertia"});
  element.expectChildren({"lengthrange"});
  if (const auto word = element.word("angle", {"radian", "degree"})) degrees = *word == 1;
  if (element.word("coordinate", {"local", "global"}) == 1)
    element.fail(
        "coordinate is global, which MuJoCo has given up too; expected local (MuJoCo 2.3.3 loads "
        "and saves the file so)");
  if (element.read("eulerseq", eulerseq) &&
      (eulerseq.size() != 3 || eulerseq.find_first_not_of("xyzXYZ") != std::string::npos))
    element.fail(fmt::format("eulerseq is {}, expected three letters of x, y, z, X, Y, Z",
                             detail::quotedText(eulerseq)));
  std::string folder;
  if (element.read("assetdir", folder)) meshdir = texturedir = folder;
  if (element.has("meshdir")) meshdir = element.text("meshdir");
  if (element.has("texturedir")) texturedir = element.text("texturedir");
  element.read("strippath", strippath);
  element.read("autolimits", autolimits);
  readChoice(element, "inertiafromgeom", inertiaFromGeom);
  element.readAll("inertiagrouprange", inertiaGroups);
  for (const auto& [name, value] :
       {std::pair("boundmass", &boundMass), {"boundinertia", &boundInertia}})
    if (element.read(name, *value) && *value < 0.0)
      element.fail(fmt::format("{} is {:g}, expected 0 or more", name, *value));
  element.read("balanceinertia", balanceInertia);
  element.read("settotalmass", totalMass);
  element.read("fitaabb", fitToBox);
  bool aligns = false;
  if (element.read("alignfree", aligns) && aligns)
    element.fail(
        "alignfree moves the frames of free bodies, which is not read; expected false, and the "
        "body written about its centre of mass where that is wanted");
  bool exact = false;
  if (element.read("exactmeshinertia", exact) && exact)
    element.fail(
        "exactmeshinertia is of MuJoCo before 3.2.5; expected inertia=\"exact\" in <mesh>");
}

std::filesystem::path Compiler::meshFile(const std::filesystem::path& model,
                                         const std::string& name) const {
  const std::filesystem::path file =
      strippath ? std::filesystem::path(name).filename() : std::filesystem::path(name);
  return (model.parent_path() / meshdir / file).lexically_normal();
}

}  // namespace softgauss::io::mjcf
