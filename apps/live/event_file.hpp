// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Events in a file: what --record writes and --play runs again (docs/reference/live.md).

#include <filesystem>
#include <vector>

#include "apps/live/event.hpp"
#include "apps/live/names.hpp"
#include "softgauss/io/detail/output_file.hpp"

namespace softgauss::live {

struct EventFile {
  long steps = 0;  ///< of the whole run
  std::vector<Event> events;
};

/// Strict: an unknown key, a value of another type, a number out of range, a name that the run does
/// not have, events out of order, another model or time step end in a ModelError
/// `file:line: event 3: key 'grab.link': found …, expected …`.
EventFile readEvents(const std::filesystem::path& file, const Names& names, double timestep);

/// Writes events as they come; the file appears when it is complete.
class EventWriter {
 public:
  /// Throws ModelError where the file cannot be written.
  EventWriter(const std::filesystem::path& file, const std::string& model, double timestep);

  void write(const Event& event);
  /// Throws std::runtime_error if the disk is full or gone.
  void finish(long steps);

 private:
  io::detail::OutputFile file_;
  bool any_ = false;
};

/// `{step: 12, grab: {link: hand, point: [0, 0, 0.1], target: [0.4, 0, 1]}}`
std::string eventText(const Event& event);

}  // namespace softgauss::live
