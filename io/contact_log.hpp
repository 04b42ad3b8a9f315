// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The contacts of a run as comma-separated values: a header, then one row a contact and step.
///
/// Columns: time_s; link_a, link_b, shape_a, shape_b: what touches; x_m, y_m, z_m: where the force
/// acts; nx, ny, nz: unit normal from A to B; fx_N, fy_N, fz_N: the force on B, and normal_N and
/// friction_N, its parts along and across the normal. All in world axes; A feels the opposite.
/// Contacts that are not pressed, within their margin, have the force 0.

#include <filesystem>
#include <memory>
#include <vector>

#include "softgauss/engine/model/model.hpp"
#include "softgauss/engine/step/snapshot.hpp"
#include "softgauss/io/log.hpp"

namespace softgauss::io {

namespace detail {
class RowFile;
}

class ContactLog {
 public:
  /// `after`: as of a LogWriter. Throws ModelError if the file cannot be made, or is not what was
  /// written then.
  ContactLog(const std::filesystem::path& file, const Model& model,
             const std::optional<TableEnd>& after = {});
  ~ContactLog();

  /// The contacts of the step from `time` [s]. Throws std::runtime_error as close() does.
  void write(double time, const std::vector<Snapshot::ContactForce>& contacts);
  void close();
  TableEnd end();  ///< flushes

 private:
  const Model& model_;
  std::unique_ptr<detail::RowFile> rows_;
};

}  // namespace softgauss::io
