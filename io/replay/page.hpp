// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The replay page: one HTML file that shows a run in any browser, offline.
///
/// A template made from io/replay/page/ with the run put in: a JSON header and typed arrays,
/// compressed by zlib, in base64. The layout is that of docs/replay.md.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "io/replay/recording.hpp"

namespace softgauss::io {

/// The run as the page holds it, before compression. `generator`: e.g. "softgauss 0.1.0".
std::string replayPayload(const Recording& recording, const std::string& generator);

class ReplayPage {
 public:
  /// Makes the file, so that a run whose page cannot be written need not begin. Throws ModelError.
  explicit ReplayPage(const std::filesystem::path& file);

  /// Throws std::runtime_error if the disk is full or gone.
  void write(const Recording& recording, const std::string& generator);

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace softgauss::io
