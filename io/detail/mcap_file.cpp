// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/mcap_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace softgauss::io::detail {
namespace {

static_assert(std::endian::native == std::endian::little, "MCAP is little-endian");

constexpr char kMagic[] = "\x89MCAP0\r\n";
constexpr std::size_t kChunkSize = std::size_t{3}
                                   << 18;  // [bytes] as large as other writers' chunks

enum class Opcode : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  messageIndex = 7,
  chunkIndex = 8,
  statistics = 11,
  dataEnd = 15
};

/// The fields of a record, one after the other.
class Fields {
 public:
  template <class Number>
  Fields& number(Number x) {
    bytes_.append(reinterpret_cast<const char*>(&x), sizeof x);
    return *this;
  }
  /// Text, or a list of fields: its length [bytes] in four bytes, then it.
  Fields& text(const std::string& x) { return number(static_cast<std::uint32_t>(x.size())).raw(x); }
  Fields& raw(const std::string& x) {
    bytes_ += x;
    return *this;
  }
  Fields& map(const std::map<std::uint16_t, std::uint64_t>& entries) {
    Fields list;
    for (const auto& [key, value] : entries) list.number(key).number(value);
    return text(list.bytes_);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string record(Opcode opcode, const Fields& fields) {
  return Fields()
      .number(opcode)
      .number(static_cast<std::uint64_t>(fields.bytes().size()))
      .raw(fields.bytes())
      .bytes();
}

std::uint32_t checksum(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::uint16_t idOf(std::size_t place) { return static_cast<std::uint16_t>(place + 1); }

/// Every channel has a schema of its own, of the same number; schemas come first, as readers ask
/// of a summary.
std::string definitions(const std::vector<McapChannel>& channels) {
  std::string schemas, records;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const auto& [topic, schemaName, schema] = channels[i];
    schemas += record(Opcode::schema,
                      Fields().number(idOf(i)).text(schemaName).text("jsonschema").text(schema));
    records += record(Opcode::channel,
                      Fields().number(idOf(i)).number(idOf(i)).text(topic).text("json").text(""));
  }
  return schemas + records;
}

std::string beginning(const std::string& library, const std::vector<McapChannel>& channels) {
  return kMagic + record(Opcode::header, Fields().text("").text(library)) + definitions(channels);
}

}  // namespace

McapFile::McapFile(const std::filesystem::path& file, const std::string& library,
                   std::vector<McapChannel> channels, const std::optional<McapEnd>& after)
    : channels_(std::move(channels)),
      file_(file, "log", beginning(library, channels_),
            after ? std::optional(after->bytes) : std::nullopt) {
  if (after)
    end_ = *after;
  else
    end_ = {static_cast<std::int64_t>(beginning(library, channels_).size()),
            {},
            std::vector<std::uint64_t>(channels_.size(), 0)};
}

void McapFile::write(std::size_t channel, double time, const std::string& json) {
  const auto nanoseconds = static_cast<std::uint64_t>(std::llround(1e9 * time));
  places_[idOf(channel)].emplace_back(nanoseconds, records_.size());
  records_ += record(Opcode::message,
                     Fields()
                         .number(idOf(channel))
                         .number(static_cast<std::uint32_t>(end_.messages[channel]++))
                         .number(nanoseconds)  // recorded
                         .number(nanoseconds)  // published
                         .raw(json));
  if (records_.size() >= kChunkSize) endChunk();
}

void McapFile::append(const std::string& bytes) {
  file_.buffer() += bytes;
  end_.bytes += static_cast<std::int64_t>(bytes.size());
  file_.sendIfFull();
}

void McapFile::endChunk() {
  if (records_.empty()) return;
  McapChunk chunk;
  chunk.firstTime = std::numeric_limits<std::uint64_t>::max();
  for (const auto& [channel, places] : places_)
    for (const auto& [time, place] : places) {
      chunk.firstTime = std::min(chunk.firstTime, time);
      chunk.lastTime = std::max(chunk.lastTime, time);
    }
  chunk.start = static_cast<std::uint64_t>(end_.bytes);
  chunk.recordsSize = records_.size();
  append(record(Opcode::chunk, Fields()
                                   .number(chunk.firstTime)
                                   .number(chunk.lastTime)
                                   .number(chunk.recordsSize)
                                   .number(checksum(records_))
                                   .text("")
                                   .number(chunk.recordsSize)
                                   .raw(records_)));
  const auto indexStart = static_cast<std::uint64_t>(end_.bytes);
  chunk.length = indexStart - chunk.start;
  for (const auto& [channel, places] : places_) {
    chunk.indices[channel] = static_cast<std::uint64_t>(end_.bytes);
    Fields list;
    for (const auto& [time, place] : places) list.number(time).number(place);
    append(record(Opcode::messageIndex, Fields().number(channel).text(list.bytes())));
  }
  chunk.indexLength = static_cast<std::uint64_t>(end_.bytes) - indexStart;
  end_.chunks.push_back(std::move(chunk));
  records_.clear();
  places_.clear();
}

McapEnd McapFile::end() {
  endChunk();
  file_.flush();
  return end_;
}

std::string McapFile::summary() const {
  std::string summary = definitions(channels_);
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max(), last = 0, messages = 0;
  for (const McapChunk& c : end_.chunks) {
    first = std::min(first, c.firstTime);
    last = std::max(last, c.lastTime);
    summary += record(Opcode::chunkIndex, Fields()
                                              .number(c.firstTime)
                                              .number(c.lastTime)
                                              .number(c.start)
                                              .number(c.length)
                                              .map(c.indices)
                                              .number(c.indexLength)
                                              .text("")
                                              .number(c.recordsSize)
                                              .number(c.recordsSize));
  }
  std::map<std::uint16_t, std::uint64_t> counts;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    counts[idOf(i)] = end_.messages[i];
    messages += end_.messages[i];
  }
  return summary + record(Opcode::statistics,
                          Fields()
                              .number(messages)
                              .number(static_cast<std::uint16_t>(channels_.size()))  // schemas
                              .number(static_cast<std::uint32_t>(channels_.size()))
                              .number(std::uint32_t{0})  // attachments
                              .number(std::uint32_t{0})  // metadata
                              .number(static_cast<std::uint32_t>(end_.chunks.size()))
                              .number(messages > 0 ? first : 0)
                              .number(last)
                              .map(counts));
}

void McapFile::close() {
  endChunk();
  append(record(Opcode::dataEnd, Fields().number(std::uint32_t{0})));  // without a checksum
  const std::string content = summary();
  // The checksum is of the summary and of the footer before it.
  Fields places;
  places.number(static_cast<std::uint64_t>(end_.bytes)).number(std::uint64_t{0});
  const Fields footer = Fields(places).number(std::uint32_t{0});
  const std::string head = record(Opcode::footer, footer).substr(0, 9);
  const std::uint32_t sum = checksum(content + head + places.bytes());
  append(content + record(Opcode::footer, places.number(sum)) + kMagic);
  file_.close();
}

}  // namespace softgauss::io::detail
