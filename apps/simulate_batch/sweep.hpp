// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A sweep file: a scene or URDF, and what differs from run to run. The schema is
/// docs/reference/batch.md.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/simulate_gdd/options.hpp"
#include "softgauss/engine/model/model.hpp"
#include "softgauss/io/simulation/parameter.hpp"

namespace softgauss::app {

inline constexpr double kMostRuns = 1e7;  ///< of a sweep

/// A parameter that is drawn for each run.
struct Draw {
  enum class Law { uniform, logUniform, normal };
  Law law = Law::uniform;
  double a = 0.0, b = 1.0;  ///< from a to b; normal: mean and standard deviation
};

/// A place in the world that is written down at the end: `ball.z`.
struct Measure {
  std::string name;
  std::string link;
  int axis = 0;
  SourceLocation where;
};

struct Sweep {
  std::filesystem::path file;
  SimulateOptions options;  ///< of every run
  std::uint64_t seed = 0;

  struct Varied {
    std::string name;
    SourceLocation where;
    std::vector<double> values;  ///< on the grid; empty: it is drawn
    Draw draw;
  };
  std::vector<Varied> varied;               ///< in the order of the file
  std::vector<std::vector<double>> listed;  ///< values of varied[0 …], instead of a grid
  long repeats = 1;                         ///< runs at each point of the grid or list
  std::vector<Measure> measures;

  bool planned() const { return options.plan || options.mpc; }  ///< each run, from its own start
  /// The command that repeats one run.
  std::string repeatCommand(long run) const;
};

/// Throws ModelError `file:line: key 'vary.mass:ball': found …, expected …`.
Sweep readSweep(const std::filesystem::path& file);

/// All runs of a sweep: values (runs × parameters) and seeds (runs).
struct SweepRuns {
  long count = 0;
  std::vector<std::string> parameters;
  std::vector<double> values;
  std::vector<std::uint64_t> seeds;
};

/// Run k is the k / repeats-th point of the grid, whose last parameter changes fastest. What is
/// drawn comes from the run's seed alone, which comes from the sweep's and k. Throws ModelError
/// where the model has no such parameter, or a value is out of range, in the line that says so.
SweepRuns planRuns(const Sweep& sweep, const Model& model);

}  // namespace softgauss::app
