// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/replay/detail/payload.hpp"

namespace softgauss::io::detail {
namespace {

void appendWord(std::string& out, std::uint32_t word) {
  char bytes[sizeof word];
  std::memcpy(bytes, &word, sizeof word);
  out.append(bytes, sizeof word);
}

}  // namespace

std::string Payload::pack(std::string header) const {
  header.resize((header.size() + 7) / 8 * 8, ' ');
  std::string out(kPayloadMagic);
  appendWord(out, kPayloadVersion);
  appendWord(out, static_cast<std::uint32_t>(header.size()));
  return out + header + binary_;
}

}  // namespace softgauss::io::detail
