// SPDX-License-Identifier: Apache-2.0
#pragma once

/// An MCAP file (mcap.dev/spec, version 0): JSON messages on channels with JSON schemas, in chunks
/// without compression, with the indices by which readers seek. No distribution packages a writer.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "softgauss/io/detail/growing_file.hpp"

namespace softgauss::io::detail {

struct McapChannel {
  std::string topic;
  std::string schemaName;
  std::string schema;  ///< JSON Schema, as text
};

/// Where a chunk and the indices of its messages are, and the times [ns] of its messages.
struct McapChunk {
  std::uint64_t firstTime = 0, lastTime = 0;
  std::uint64_t start = 0, length = 0;             ///< of its record [bytes]
  std::uint64_t indexLength = 0, recordsSize = 0;  ///< [bytes]
  std::map<std::uint16_t, std::uint64_t> indices;  ///< channel to place of its index

  template <class Archive>
  void archive(Archive& a) {
    a(firstTime, lastTime, start, length, indexLength, recordsSize, indices);
  }
};

/// How far a file was written when a run was saved.
struct McapEnd {
  std::int64_t bytes = 0;
  std::vector<McapChunk> chunks;
  std::vector<std::uint64_t> messages;  ///< (channels)

  template <class Archive>
  void archive(Archive& a) {
    a(bytes, chunks, messages);
  }
};

class McapFile {
 public:
  /// `library` names the writer. `after`: end() of an earlier process, which this one goes on
  /// from. Throws ModelError as a GrowingFile does.
  McapFile(const std::filesystem::path& file, const std::string& library,
           std::vector<McapChannel> channels, const std::optional<McapEnd>& after = {});

  /// A message of the channel at that place of the list at `time` ≥ 0 [s]. These throw
  /// std::runtime_error if the disk is full or gone.
  void write(std::size_t channel, double time, const std::string& json);
  /// Ends the chunk that is being written, and flushes.
  McapEnd end();
  /// Writes the summary. Without it, readers find the messages by reading all of the file.
  void close();

 private:
  void append(const std::string& bytes);
  void endChunk();
  std::string summary() const;

  std::vector<McapChannel> channels_;
  GrowingFile file_;
  McapEnd end_;
  std::string records_;  ///< of the chunk that is being written
  /// Of its messages, by channel: times [ns] and places in records_.
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> places_;
};

}  // namespace softgauss::io::detail
