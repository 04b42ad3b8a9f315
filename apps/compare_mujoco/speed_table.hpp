// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The table of speeds: a step of ours over one of MuJoCo's, scene by scene, in one run.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/compare_mujoco/scene_race.hpp"

namespace softgauss::app {

struct TableOptions {
  std::string robots = "data/robots";  ///< folder of arm.urdf, hand.urdf, humanoid.urdf
  std::vector<RobotFile> extra;        ///< robots of the user
  std::string filter;                  ///< regular expression of rows, empty: all
  std::string mujocoFlags;             ///< by which the library was compiled, for the heading
  bool quick = false;                  ///< one round, without the large scenes
  int rounds = 20;
};

/// Measures every row, tells each on stderr when it is done, and returns
///   heading   lines that name versions, compilers, flags and machine
///   rows      name, mujoco_us, ours_us, ratio, dofs, apart_m and rounds, or refused
///   curves    name, sizes, mujoco_us, ours_us and, of two sizes or more, both exponents
/// Throws ModelError where a robot cannot be read.
nlohmann::ordered_json measureSpeeds(const TableOptions& options);

/// The same as Markdown: the rows, the exponents, and the curves as comma separated values.
std::string speedMarkdown(const nlohmann::ordered_json& speeds);

/// The curves as an SVG by gnuplot, of chains on the ground, piles and boxes. Throws
/// std::runtime_error where gnuplot fails or the file cannot be written.
void drawSpeeds(const nlohmann::ordered_json& speeds, const std::filesystem::path& file);

}  // namespace softgauss::app
