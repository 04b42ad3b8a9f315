// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/core/sealed.hpp"

#include "softgauss/engine/core/bytes.hpp"
#include "softgauss/engine/core/check.hpp"

namespace softgauss {
namespace {

struct Head {
  std::uint32_t version = 0;
  std::uint64_t length = 0, checksum = 0;
  template <class Archive>
  void archive(Archive& a) {
    a(version, length, checksum);
  }
};
constexpr std::size_t kKindSize = 8;
constexpr std::size_t kHeadSize = 4 + 8 + 8;

std::uint64_t checksumOf(std::string_view content) {
  Fnv1a sum;
  sum.add(content);
  return sum.value();
}

}  // namespace

std::string sealed(std::string_view kind, std::uint32_t version, std::string_view content) {
  SOFTGAUSS_ASSERT(kind.size() == kKindSize);
  ByteWriter head;
  head(Head{version, content.size(), checksumOf(content)});
  std::string bytes(kind);
  bytes.reserve(kKindSize + kHeadSize + content.size());
  bytes += head.bytes();
  return bytes += content;
}

std::string_view unsealed(std::string_view kind, std::uint32_t version, std::string_view bytes) {
  if (!bytes.starts_with(kind))
    ByteReader::fail("found other bytes, expected that it begins with '" +
                     std::string(kind.substr(0, kind.find_last_not_of('\n') + 1)) + "'");
  bytes.remove_prefix(kind.size());
  Head head;
  ByteReader(bytes.substr(0, kHeadSize))(head);
  if (head.version != version)
    ByteReader::fail("found version " + std::to_string(head.version) + ", expected " +
                     std::to_string(version) + ": another softgauss has written it");
  bytes.remove_prefix(kHeadSize);
  if (bytes.size() != head.length)
    ByteReader::fail("found " + std::to_string(bytes.size()) + " bytes of content, expected " +
                     std::to_string(head.length));
  if (checksumOf(bytes) != head.checksum)
    ByteReader::fail("was changed after it was written: its checksum is another");
  return bytes;
}

}  // namespace softgauss
