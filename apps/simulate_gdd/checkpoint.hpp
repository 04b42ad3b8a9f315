// SPDX-License-Identifier: Apache-2.0
#pragma once

/// --checkpoint and --resume: a file from which a run goes on to the bits that it would have had.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/simulate_gdd/options.hpp"
#include "softgauss/engine/core/bytes.hpp"
#include "softgauss/io/summary.hpp"

namespace softgauss::app {

/// What tells one run from another.
struct RunIdentity {
  std::uint64_t model = 0;  ///< its hash, options included
  /// Options, as they were typed.
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<std::string> files;  ///< their hashes
  std::string build;               ///< of softgauss, and the processor: other bits may come of them

  template <class Archive>
  void archive(Archive& a) {
    a(model, settings, files, build);
  }
};

/// How `run` is another than `saved`, as a message goes on; nothing where it is the same. Builds
/// are not compared.
std::string differenceOf(const RunIdentity& saved, const RunIdentity& run);

/// A checkpoint file: identity, then the content. Throws BytesError where the bytes are none.
std::string checkpointBytes(const RunIdentity& identity, std::string_view content);
std::pair<RunIdentity, std::string> readCheckpoint(std::string_view bytes);

class Checkpoints {
 public:
  /// Reads the file that is to be gone on from. Throws ModelError where it is none, or of another
  /// run. `origin` is this run's.
  Checkpoints(const SimulateOptions& options, const Model& model, const io::RunOrigin& origin);

  /// What this build does not promise, to be told; empty where there is nothing.
  const std::string& warning() const { return warning_; }

  /// Lets the run read what it was. Returns whether there is something to go on from. Throws
  /// ModelError.
  template <class Run>
  bool restore(Run& run) {
    if (!content_) return false;
    try {
      ByteReader reader(*content_);
      run.archive(reader);
      reader.expectEnd();
    } catch (const BytesError& error) {
      refuse(error.what());
    }
    content_.reset();
    return true;
  }
  /// Whether a checkpoint is to be written after a step that ended at `time` [s].
  bool isDue(double time) const { return asked() && time >= next_; }
  bool asked() const { return !options_.checkpoint.empty(); }
  /// Writes the file as a whole. Throws std::runtime_error where it cannot be written.
  template <class Run>
  void write(Run& run, double time) {
    ByteWriter writer;
    run.archive(writer);
    write(writer.bytes(), time);
  }
  /// The run has gone on from `time` [s], or begins there.
  void beginAt(double time);

 private:
  void write(const std::string& content, double time);
  [[noreturn]] void refuse(const std::string& problem) const;

  const SimulateOptions& options_;
  RunIdentity identity_;
  std::optional<std::string> content_;  ///< of the run to go on with
  std::string warning_;
  double next_ = 0.0;  ///< [s]
};

}  // namespace softgauss::app
