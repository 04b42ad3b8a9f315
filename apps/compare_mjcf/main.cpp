// SPDX-License-Identifier: Apache-2.0
/// compare_mjcf: MJCF files as MuJoCo reads them, and as this engine does.
///
/// Of every .xml in a folder and below: masses, and in ten seeded random states mass matrix, bias,
/// passive forces and accelerations without contacts, and what each actuator can do at most. Prints
/// a table with the largest difference of each, or with why the file is refused. --record writes
/// MuJoCo's numbers, which tests/mjcf compares without MuJoCo.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>

#include "apps/compare_mjcf/mujoco_numbers.hpp"
#include "apps/compare_mjcf/record.hpp"
#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/mjcf.hpp"

namespace {

using namespace softgauss;

struct Tally {
  int same = 0, different = 0, refused = 0, refusedByMujoco = 0;
};

std::string firstLine(std::string text) {
  text = text.substr(0, text.find('\n'));
  std::replace(text.begin(), text.end(), '|', '/');
  return text;
}

/// A row of the table.
std::string compare(const std::filesystem::path& file, const std::string& name, double bound,
                    Tally& tally) {
  int dofs = 0;
  try {
    dofs = app::mujocoDofs(file);
  } catch (const ModelError& error) {
    ++tally.refusedByMujoco;
    return fmt::format("| {} | - | {} |\n", name, firstLine(error.what()));
  }
  app::MjcfNumbers own, theirs;
  try {
    own = app::ownNumbers(file, {});
    theirs = app::mujocoNumbers(file);
    own = app::ownNumbers(file, theirs.states);
  } catch (const ModelError& error) {
    ++tally.refused;
    std::string why = firstLine(error.what());
    if (const std::size_t at = why.find(file.filename().string()); at != std::string::npos)
      why = why.substr(at);
    return fmt::format("| {} | {} | refused: {} |\n", name, dofs, why);
  }
  std::string text;
  double most = 0.0;
  for (const app::MjcfDifference& d : app::differences(own, theirs)) {
    most = std::max(most, d.size);
    text += fmt::format("{}{} {:.1e}", text.empty() ? "" : ", ", d.what, d.size);
  }
  (most <= bound ? tally.same : tally.different) += 1;
  return fmt::format("| {} | {} | {}: {} |\n", name, dofs, most <= bound ? "same" : "DIFFERENT",
                     text);
}

std::vector<std::filesystem::path> filesOf(const std::string& folder) {
  if (!std::filesystem::is_directory(folder)) return {folder};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".xml" && entry.is_regular_file()) try {
        if (io::isMjcf(entry.path())) files.push_back(entry.path());
      } catch (const ModelError&) {
        continue;
      }
  std::sort(files.begin(), files.end());
  return files;
}

int run(const std::string& folder, const std::string& record, double bound) {
  // MuJoCo finds nested includes of absolute paths alone.
  const std::string root = std::filesystem::absolute(folder).lexically_normal().string();
  const std::vector<std::filesystem::path> files = filesOf(root);
  if (!record.empty()) {
    for (const std::filesystem::path& file : files)
      app::writeRecord(app::mujocoNumbers(file),
                       std::filesystem::path(record) / file.filename().replace_extension(".json"));
    return 0;
  }
  Tally tally;
  fmt::print("| file | dofs | largest differences from MuJoCo {} |\n|---|---|---|\n",
             app::mujocoVersion());
  for (const std::filesystem::path& file : files)
    fmt::print("{}", compare(file, file.lexically_relative(root).string(), bound, tally));
  fmt::print("\n{} files: {} same to {:g}, {} different, {} refused, {} refused by MuJoCo\n",
             files.size(), tally.same, bound, tally.different, tally.refused,
             tally.refusedByMujoco);
  return tally.different > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Compares MJCF files as MuJoCo and this engine read them.", "compare_mjcf"};
  std::string folder, record;
  double bound = 1e-9;
  app.add_option("FOLDER", folder, "folder of .xml files, or one file")->required();
  app.add_option("--record", record,
                 "write MuJoCo's numbers into this folder, and compare nothing");
  app.add_option("--bound", bound, "relative difference that counts as the same");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(folder, record, bound);
  } catch (const std::exception& error) {
    fmt::print(stderr, "compare_mjcf: {}\n", error.what());
    return 2;
  }
}
