// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/core/bytes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "softgauss/engine/core/sealed.hpp"
#include "tests/support/random.hpp"

namespace softgauss::test {
namespace {

struct Part {
  int count = 0;
  std::string name;
  bool operator==(const Part&) const = default;
  template <class Archive>
  void archive(Archive& a) {
    a(count, name);
  }
};

struct Whole {
  bool yes = false;
  double number = 0.0;
  std::string text;
  VectorX vector;
  Vector3 place = Vector3::Zero();
  std::vector<float> list;
  std::vector<Part> parts;
  std::optional<Part> one, none;
  std::map<int, Part> byNumber;
  std::pair<long, std::array<double, 2>> pair{};

  auto all() const {
    return std::tie(yes, number, text, vector, place, list, parts, one, none, byNumber, pair);
  }
  template <class Archive>
  void archive(Archive& a) {
    a(yes, number, text, vector, place, list, parts, one, none, byNumber, pair);
  }
};

Whole sample() {
  Whole w{true,
          -0.0,
          std::string("a\0b", 3),
          VectorX::LinSpaced(5, 1.0, 2.0),
          {1, 2, 3},
          {1.5f},
          {{1, "x"}, {2, ""}},
          Part{3, "y"},
          {},
          {{-1, {4, "z"}}},
          {7, {0.1, 1e-308}}};
  return w;
}

std::string bytesOf(const Whole& whole) {
  ByteWriter writer;
  writer(whole);
  return writer.bytes();
}

TEST(Bytes, GoBackToWhatTheyWere) {
  const Whole whole = sample();
  const std::string bytes = bytesOf(whole);
  Whole again;
  again.parts.resize(9);  // what was there is gone
  again.none = Part{};
  ByteReader reader(bytes);
  reader(again);
  reader.expectEnd();
  EXPECT_EQ(again.all(), whole.all());
  EXPECT_TRUE(std::signbit(again.number));
  EXPECT_EQ(bytesOf(again), bytes);
}

TEST(Bytes, KeepNumbersThatAreNone) {
  ByteWriter writer;
  writer(std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity());
  double nan = 0.0, infinity = 0.0;
  ByteReader(writer.bytes())(nan, infinity);
  EXPECT_TRUE(std::isnan(nan));
  EXPECT_EQ(infinity, -std::numeric_limits<double>::infinity());
}

TEST(Bytes, ThatEndEarlyAreToldWhereverTheyEnd) {
  const std::string bytes = bytesOf(sample());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    Whole whole;
    ByteReader reader(std::string_view(bytes).substr(0, size));
    EXPECT_THROW(reader(whole), BytesError) << size;
  }
  const std::string tooLong = bytes + "x";
  ByteReader longer(tooLong);
  Whole whole;
  longer(whole);
  EXPECT_THROW(longer.expectEnd(), BytesError);
}

// Any bytes are read or refused, and no count makes memory be fetched that they cannot fill.
TEST(Bytes, ThatAreAnythingAreReadOrRefused) {
  Random random(1);
  const std::string bytes = bytesOf(sample());
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string other = bytes;
    for (int n = 1 + random.index(4); n > 0; --n)
      other[static_cast<std::size_t>(random.index(static_cast<int>(other.size())))] =
          static_cast<char>(random.index(256));
    Whole whole;
    try {
      ByteReader reader(other);
      reader(whole);
    } catch (const BytesError&) {
      ++refused;
    }
    EXPECT_LE(whole.text.size() + whole.list.size() + whole.parts.size(), bytes.size());
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 19000);
}

TEST(Bytes, HoldListsToTheirLength) {
  ByteWriter writer;
  writer.sized(std::vector<Part>(2));
  std::vector<Part> two(2), three(3);
  ByteReader(writer.bytes()).sized(two);
  EXPECT_THROW(ByteReader(writer.bytes()).sized(three), BytesError);
}

TEST(SealedBytes, AreOfOneKindAndVersionAndWhole) {
  const std::string content = "content";
  const std::string bytes = sealed("SGTEST..", 3, content);
  EXPECT_EQ(unsealed("SGTEST..", 3, bytes), content);
  EXPECT_THROW(unsealed("SGOTHER.", 3, bytes), BytesError);
  EXPECT_THROW(unsealed("SGTEST..", 4, bytes), BytesError);
  EXPECT_THROW(unsealed("SGTEST..", 3, bytes + "x"), BytesError);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_THROW(unsealed("SGTEST..", 3, bytes.substr(0, i)), BytesError);
    for (int bit = 0; bit < 8; ++bit) {
      std::string changed = bytes;
      changed[i] = static_cast<char>(changed[i] ^ (1 << bit));
      EXPECT_THROW(unsealed("SGTEST..", 3, changed), BytesError) << i;
    }
  }
}

}  // namespace
}  // namespace softgauss::test
