// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The tables that a run writes as it goes on: --log and --contacts.

#include <optional>
#include <string>
#include <vector>

#include "apps/simulate_gdd/options.hpp"
#include "softgauss/io/contact_log.hpp"
#include "softgauss/io/log.hpp"
#include "softgauss/io/mcap_log.hpp"

namespace softgauss::app {

/// Outputs that could not be written: each is tried, whatever became of the others.
class OutputErrors {
 public:
  template <class F>
  void attempt(F&& write) {
    try {
      write();
    } catch (const std::exception& error) {
      add(error.what());
    }
  }
  void add(std::string error) { errors_.push_back(std::move(error)); }
  bool none() const { return errors_.empty(); }
  /// One a line, below `first` where that is not empty.
  std::string text(std::string first) const {
    for (const std::string& error : errors_) first += (first.empty() ? "" : "\n") + error;
    return first;
  }

 private:
  std::vector<std::string> errors_;
};

class RunTables {
 public:
  RunTables(const SimulateOptions& options, OutputErrors& errors)
      : options_(options), errors_(errors) {}

  /// `goals`: columns of their errors. After archive() has read where an earlier process had come
  /// to, the tables go on from there. Throws ModelError.
  void open(const Model& model, const std::vector<std::string>& goals);
  bool hasLog() const { return log_ || mcap_; }
  /// A step, or the end, with the contacts of the last step. After an error nothing is written.
  void write(const io::StepRecord& row, const std::vector<Snapshot::ContactForce>& touching);
  void close();

  /// How far they were written, which is on disk then. Throws std::runtime_error.
  template <class Archive>
  void archive(Archive& a) {
    if constexpr (!Archive::kReads) {
      mcapEnd_ = mcap_ ? mcap_->end() : std::string();
      logEnd_ = log_ ? std::optional(log_->end()) : std::nullopt;
      contactsEnd_ = contacts_ ? std::optional(contacts_->end()) : std::nullopt;
    }
    a(logEnd_, contactsEnd_, mcapEnd_);
  }

 private:
  const SimulateOptions& options_;
  OutputErrors& errors_;
  std::optional<io::LogWriter> log_;
  std::optional<io::McapLog> mcap_;  ///< in its place
  std::optional<io::ContactLog> contacts_;
  std::optional<io::TableEnd> logEnd_, contactsEnd_;  ///< where they go on from
  std::string mcapEnd_;
};

}  // namespace softgauss::app
