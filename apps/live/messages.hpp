// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What pages and the run say to each other, docs/reference/live.md: events as JSON from the page,
/// frames in binary and answers and the state of affairs as JSON to it.

#include <optional>
#include <string>
#include <variant>

#include "apps/live/event.hpp"
#include "apps/live/names.hpp"
#include "softgauss/io/replay/frames.hpp"

namespace softgauss::live {

/// What a page asks for.
struct Asked {
  long id = 0;           ///< that the answer repeats
  bool toWrite = false;  ///< to be the one who writes; else
  /// that it has had so many frames and statuses; else
  std::optional<long> seen;
  Event event;
};

/// A message that was refused.
struct Refused {
  long id = 0;
  std::string reason;
};

inline constexpr std::size_t kLongestMessage = 4096;  ///< [bytes]

/// Reads a message: one JSON object, `{"id": 7, "grab": {"link": "hand", …}}`, `{"write": true}` or
/// `{"seen": 12}`.
/// Whatever the text holds, it is answered by one of the two and nothing is thrown.
std::variant<Asked, Refused> readMessage(const std::string& text, const Names& names) noexcept;

/// `{"re": 7, "done": true}`, or with the reason in "refused".
std::string answer(long id, const std::string& refused);

/// One instant, as docs/reference/live.md has it. `frames` holds that one.
std::string frameMessage(const io::FrameTrack& frames, long steps, bool paused);

}  // namespace softgauss::live
