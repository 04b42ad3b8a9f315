// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The replay page: one HTML file that shows a run in any browser, offline.
///
/// A template made from io/replay/page/ with the run put in: a JSON header and typed arrays,
/// compressed by zlib, in base64. The layout is that of docs/replay_format.md.

#include <filesystem>
#include <string>

#include "softgauss/io/detail/output_file.hpp"
#include "softgauss/io/replay/recording.hpp"

namespace softgauss::io {

/// The run as the page holds it, before compression. `generator`: e.g. "softgauss 0.1.0".
std::string replayPayload(const Recording& recording, const std::string& generator);

/// The page as a server gives it that shows a run as it goes: it begins with the recording's frames
/// and may talk to that server. `live`: JSON, the header's member of that name
/// (docs/reference/live.md). `beside`: a run of runInPage(), or empty.
std::string livePage(const Recording& recording, const std::string& generator,
                     const std::string& live, const std::string& beside = {});

/// The run as it stands in a page, to be shown beside another.
std::string runText(const Recording& recording, const std::string& generator);

/// The run that a replay page holds, as it stands there, to be shown beside another. Throws
/// ModelError where the file is no such page, its run is damaged or of another format.
std::string runInPage(const std::filesystem::path& file);

class ReplayPage {
 public:
  /// Makes sure that the file can be written, before a run is begun whose page could not. A page
  /// that is there stays until the new one is complete. `beside`: a run of runInPage() that the
  /// page shows too, translucent, or empty. Throws ModelError.
  explicit ReplayPage(const std::filesystem::path& file, std::string beside = {});

  /// Throws std::runtime_error if the disk is full or gone.
  void write(const Recording& recording, const std::string& generator);

 private:
  detail::OutputFile file_;
  std::string beside_;
};

}  // namespace softgauss::io
