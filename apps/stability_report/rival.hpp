// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What MuJoCo does on the hard cases, recorded, so that neither tests nor the table need it.
///
/// `./dev record stability` makes the record: exportCases() writes every case as MuJoCo's own
/// description, with its start; a script runs them in the newest MuJoCo from npm, by its default
/// integrator and by `discrete`, and writes q and v of every step; measureRival() computes the
/// figures of these, by the functions that measure ours.

#include <filesystem>
#include <map>
#include <string>

#include "apps/stability_report/outcome.hpp"

namespace softgauss::app {

/// The integrators of the record, as MuJoCo calls them; the first is its default.
inline constexpr const char* kRivalIntegrators[] = {"Euler", "discrete"};

class Rival {
 public:
  /// A record. Throws ModelError.
  explicit Rival(const std::filesystem::path& file);

  const std::string& version() const { return version_; }
  /// What it did; `ran` is false where the record does not have it.
  Outcome outcome(const HardCase& hard, double timestep, const std::string& integrator) const;

 private:
  std::string version_;
  std::map<std::string, Outcome> outcomes_;
};

/// Writes CASE_H.xml and CASE_H.json for every case and step. Throws ModelError.
void exportCases(const std::filesystem::path& scenes, const std::filesystem::path& folder);

/// The record of the runs in `folder`, CASE_H_INTEGRATOR.bin and version.txt, into `file`. Throws
/// ModelError.
void measureRival(const std::filesystem::path& scenes, const std::filesystem::path& folder,
                  const std::filesystem::path& file);

}  // namespace softgauss::app
