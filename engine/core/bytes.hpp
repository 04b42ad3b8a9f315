// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Values as bytes, bit for bit, and back: what states and runs are saved by.
///
/// A class names its parts once, for both ways:
///
///   template <class Archive> void archive(Archive& a) { a(x_, y_); a.sized(links_); }
///
/// or a free function archive(a, value) beside it does. Bytes may come from anywhere: a count is
/// held against the bytes that are left before memory is fetched for it.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "softgauss/engine/core/types.hpp"

namespace softgauss {

static_assert(std::endian::native == std::endian::little, "bytes are little-endian");

/// Bytes that are not what they should be; what() says how.
class BytesError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// FNV-1a, eight bytes at a time, over what it is given one after the other.
class Fnv1a {
 public:
  void add(std::string_view bytes) {
    while (!bytes.empty()) {
      std::uint64_t word = 0;
      const std::size_t count = std::min(bytes.size(), sizeof word);
      std::memcpy(&word, bytes.data(), count);
      bytes.remove_prefix(count);
      value_ = (value_ ^ word) * 0x100000001b3ull;
      value_ ^= value_ >> 32;  // a product does not carry high bits down
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ull;
};

namespace detail {

template <class T>
inline constexpr bool isPlain = std::is_arithmetic_v<T> || std::is_enum_v<T>;
/// A vector or matrix of Eigen whose size its type tells.
template <class T>
inline constexpr bool isFixed = false;
template <class T>
requires std::is_base_of_v<Eigen::DenseBase<T>, T>
inline constexpr bool isFixed<T> = T::SizeAtCompileTime != Eigen::Dynamic;
template <class T>
struct Kind : std::integral_constant<int, 0> {};
template <>
struct Kind<std::string> : std::integral_constant<int, 1> {};
template <class T>
struct Kind<std::vector<T>> : std::integral_constant<int, 2> {};
template <class T>
struct Kind<std::optional<T>> : std::integral_constant<int, 3> {};
template <class K, class V>
struct Kind<std::map<K, V>> : std::integral_constant<int, 4> {};
template <class T, class U>
struct Kind<std::pair<T, U>> : std::integral_constant<int, 5> {};
template <class T, std::size_t N>
struct Kind<std::array<T, N>> : std::integral_constant<int, 6> {};

template <class T>
inline constexpr bool isUnknown = false;

/// The parts of what has parts, for either way.
template <class Archive, class T>
void takeParts(Archive& a, T& x) {
  if constexpr (requires { x.archive(a); }) {
    x.archive(a);
  } else if constexpr (requires { archive(a, x); }) {
    archive(a, x);
  } else if constexpr (Kind<T>::value == 5) {
    a(x.first, x.second);
  } else if constexpr (Kind<T>::value == 6) {
    for (auto& part : x) a(part);
  } else {
    static_assert(isUnknown<T>, "this type does not name its parts: it needs archive()");
  }
}

}  // namespace detail

class ByteWriter {
 public:
  static constexpr bool kReads = false;
  template <class... T>
  void operator()(const T&... x) {
    (write(x), ...);
  }
  /// Lists that have their length before they are read.
  template <class... T>
  void sized(const T&... x) {
    (write(x), ...);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void append(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  template <class Numbers>
  void appendAll(const Numbers& x) {
    write(static_cast<std::uint64_t>(x.size()));
    append(x.data(), static_cast<std::size_t>(x.size()) * sizeof(*x.data()));
  }
  template <class T>
  void write(const T& x) {
    constexpr int kKind = detail::Kind<T>::value;
    if constexpr (detail::isPlain<T>) {
      append(&x, sizeof x);
    } else if constexpr (detail::isFixed<T>) {
      append(x.data(), sizeof(typename T::Scalar) * T::SizeAtCompileTime);
    } else if constexpr (std::is_base_of_v<Eigen::DenseBase<T>, T> || kKind == 1) {
      appendAll(x);
    } else if constexpr (kKind == 2) {
      if constexpr (detail::isPlain<typename T::value_type>) {
        appendAll(x);
      } else {
        write(static_cast<std::uint64_t>(x.size()));
        for (const auto& part : x) write(part);
      }
    } else if constexpr (kKind == 3) {
      write(x.has_value());
      if (x) write(*x);
    } else if constexpr (kKind == 4) {
      write(static_cast<std::uint64_t>(x.size()));
      for (const auto& part : x) write(part);
    } else {
      detail::takeParts(*this, const_cast<T&>(x));  // who writes changes nothing
    }
  }

  std::string bytes_;
};

/// Reads in the order of writing. Everything throws BytesError where the bytes are not such.
class ByteReader {
 public:
  static constexpr bool kReads = true;  ///< for what has to be looked at after it was read
  explicit ByteReader(std::string_view bytes) : left_(bytes) {}

  template <class... T>
  void operator()(T&... x) {
    (read(x), ...);
  }
  /// Lists that must have the length that they have now.
  template <class... T>
  void sized(T&... x) {
    (readSized(x), ...);
  }
  /// To be called at the end: nothing may be left.
  void expectEnd() const {
    if (!left_.empty()) fail("has " + std::to_string(left_.size()) + " bytes too many");
  }
  std::size_t left() const { return left_.size(); }
  [[noreturn]] static void fail(const std::string& problem) { throw BytesError(problem); }
  /// Of what was read: that it fits together.
  static void expect(bool holds) {
    if (!holds) fail("holds what does not fit together");
  }

 private:
  const char* take(std::size_t size) {
    if (size > left_.size()) fail("ends early");
    const char* const data = left_.data();
    left_.remove_prefix(size);
    return data;
  }
  /// A count of parts that take at least so many bytes each.
  std::size_t readCount(std::size_t size) {
    std::uint64_t count = 0;
    read(count);
    if (count > left_.size() / size) fail("ends early");
    return static_cast<std::size_t>(count);
  }
  template <class T>
  void readSized(T& x) {
    const auto size = x.size();
    if constexpr (detail::Kind<T>::value == 2 && !detail::isPlain<typename T::value_type>) {
      if (readCount(1) != size) fail("is of another model or other options");
      for (auto& part : x) read(part);
    } else {
      read(x);
      if (x.size() != size) fail("is of another model or other options");
    }
  }
  template <class T>
  void read(T& x) {
    constexpr int kKind = detail::Kind<T>::value;
    if constexpr (std::is_same_v<T, bool>) {
      const char byte = *take(1);
      if (byte != 0 && byte != 1) fail("holds what is neither true nor false");
      x = byte == 1;
    } else if constexpr (detail::isPlain<T>) {
      std::memcpy(&x, take(sizeof x), sizeof x);
    } else if constexpr (detail::isFixed<T>) {
      readInto(x.data(), T::SizeAtCompileTime);
    } else if constexpr (std::is_base_of_v<Eigen::DenseBase<T>, T>) {
      x.resize(static_cast<Eigen::Index>(readCount(sizeof(typename T::Scalar))));
      readInto(x.data(), static_cast<std::size_t>(x.size()));
    } else if constexpr (kKind == 1) {
      const std::size_t count = readCount(1);
      x.assign(take(count), count);
    } else if constexpr (kKind == 2) {
      using Part = typename T::value_type;
      x.clear();
      if constexpr (detail::isPlain<Part>) {
        x.resize(readCount(sizeof(Part)));
        readInto(x.data(), x.size());
      } else {
        for (std::size_t n = readCount(1); n > 0; --n) read(x.emplace_back());
      }
    } else if constexpr (kKind == 3) {
      bool present = false;
      read(present);
      x.reset();
      if (present) read(x.emplace());
    } else if constexpr (kKind == 4) {
      x.clear();
      for (std::size_t n = readCount(1); n > 0; --n) {
        std::pair<typename T::key_type, typename T::mapped_type> part{};
        read(part);
        x.insert(std::move(part));
      }
    } else {
      detail::takeParts(*this, x);
    }
  }
  template <class T>
  void readInto(T* out, std::size_t count) {
    if (count > 0) std::memcpy(out, take(count * sizeof(T)), count * sizeof(T));
  }

  std::string_view left_;
};

}  // namespace softgauss
