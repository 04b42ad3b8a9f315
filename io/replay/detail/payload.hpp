// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The container of a recorded run: a JSON header, then typed arrays, little-endian.

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace softgauss::io::detail {

inline constexpr std::string_view kPayloadMagic = "SGREPLAY";
inline constexpr std::uint32_t kPayloadVersion = 1;
inline constexpr std::size_t kPayloadStart = 16;  ///< [bytes] magic, version, length of the header

/// Gathers arrays, each on a multiple of 8 bytes.
class Payload {
 public:
  struct Entry {
    std::string name;
    const char* type;
    std::size_t offset;  ///< [bytes] from the start of the arrays
    std::size_t length;  ///< entries
  };

  template <class T>
  void array(const std::string& name, const std::vector<T>& values) {
    static_assert(std::endian::native == std::endian::little);
    constexpr const char* kType = std::is_same_v<T, double>          ? "f64"
                                  : std::is_same_v<T, float>         ? "f32"
                                  : std::is_same_v<T, std::uint32_t> ? "u32"
                                  : std::is_same_v<T, std::uint8_t>  ? "u8"
                                                                     : nullptr;
    static_assert(kType != nullptr);
    const std::size_t start = binary_.size(), bytes = values.size() * sizeof(T);
    entries_.push_back({name, kType, start, values.size()});
    binary_.resize(start + (bytes + 7) / 8 * 8, '\0');
    if (bytes > 0) std::memcpy(binary_.data() + start, values.data(), bytes);
  }

  const std::vector<Entry>& entries() const { return entries_; }

  /// "SGREPLAY", version, length of the header, header (which lists the entries), arrays.
  std::string pack(std::string header) const;

 private:
  std::vector<Entry> entries_;
  std::string binary_;
};

}  // namespace softgauss::io::detail
