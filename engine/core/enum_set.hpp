// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Sets of the values of an enumeration, at most 32 of them.

#include <cstdint>

namespace softgauss {

template <class Enum>
class EnumSet {
 public:
  static constexpr EnumSet all() { return EnumSet(~0u); }
  static constexpr EnumSet none() { return EnumSet(0u); }
  constexpr bool has(Enum e) const { return (bits_ >> static_cast<unsigned>(e)) & 1u; }
  constexpr void insert(Enum e) { bits_ |= 1u << static_cast<unsigned>(e); }
  constexpr void remove(Enum e) { bits_ &= ~(1u << static_cast<unsigned>(e)); }
  constexpr EnumSet operator&(const EnumSet& o) const { return EnumSet(bits_ & o.bits_); }
  constexpr bool operator==(const EnumSet&) const = default;

 private:
  explicit constexpr EnumSet(std::uint32_t bits) : bits_(bits) {}
  std::uint32_t bits_;
};

}  // namespace softgauss
