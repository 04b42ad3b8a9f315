// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Recorded controls for open-loop simulation: the columns time_s and `u:<joint>` of a CSV file.
///
/// A log (io/log.hpp) is such a file. Other columns are left alone; a joint without a column has
/// control 0. Held between rows (zero-order hold): at time t the last row with time_s ≤ t is in
/// force, no control before the first row, the last row for ever. A last row whose controls are all
/// empty, as a log ends, is in force as no control.

#include <filesystem>
#include <vector>

#include "softgauss/engine/model/model.hpp"

namespace softgauss::io {

class TorqueTable {
 public:
  /// Throws ModelError (`file:line: column 'u:knee': …`) on a missing or broken file, no time_s,
  /// no u: column, an unknown joint, a field that is no finite number, times that do not rise, or
  /// a control other than 0 on a joint that is not actuated. Controls beyond their box are kept.
  static TorqueTable read(const std::filesystem::path& file, const Model& model);

  /// u (nv) [N m or N] in force at `time` [s].
  void controlAt(double time, VectorX& u) const;

  /// The first row that comes into force after `time` [s]; ∞ if there is none.
  double nextRow(double time) const;

  std::size_t rows() const { return times_.size(); }
  double startTime() const { return times_.front(); }
  double endTime() const { return times_.back(); }

 private:
  std::vector<double> times_;
  std::vector<int> dofs_;         ///< of the columns
  std::vector<double> controls_;  ///< row by row, one per column
  int nv_ = 0;
};

}  // namespace softgauss::io
