// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The log of a run as an MCAP file, for Foxglove, Rerun and PlotJuggler: JSON messages, each topic
/// with its schema. docs/reference/outputs.md lists the topics.
///
/// Schemas are foxglove's where there is one (docs.foxglove.dev/docs/sdk/schemas): FrameTransforms
/// of the links in the world, SceneUpdate of their shapes (once) and of the contact forces,
/// JointStates. The others are objects of numbers. Names and units are those of the CSV log; a
/// field without a value is left out.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/step/snapshot.hpp"
#include "softgauss/io/log.hpp"

namespace softgauss::io {

/// Whether a log of that name is an MCAP file.
bool isMcap(const std::filesystem::path& file);

class McapLog {
 public:
  /// As of a LogWriter. `after`: end() of the earlier process whose messages these follow.
  McapLog(const std::filesystem::path& file, const Model& model,
          const std::vector<std::string>& goals = {}, long every = 1,
          const std::string& after = {});
  ~McapLog();
  McapLog(const McapLog&) = delete;
  McapLog& operator=(const McapLog&) = delete;

  /// A step, or the end, with the contacts of the last step. These throw std::runtime_error if the
  /// disk is full or gone.
  void write(const StepRecord& record, const std::vector<Snapshot::ContactForce>& contacts);
  void close();
  /// How far it was written, for `after`; flushes.
  std::string end();

 private:
  struct Writer;
  std::unique_ptr<Writer> writer_;
  std::int64_t every_, seen_ = 0;
};

}  // namespace softgauss::io
