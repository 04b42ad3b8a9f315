// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/text.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

namespace softgauss::io::detail {
namespace {

TEST(StrictNumber, ReadsDecimalNumbersWithBlanksAround) {
  EXPECT_EQ(parseNumber("1"), 1.0);
  EXPECT_EQ(parseNumber(" -2.5e-3\n"), -2.5e-3);
  EXPECT_EQ(parseNumber("+.5"), 0.5);
  EXPECT_EQ(parseNumber("3."), 3.0);
  EXPECT_EQ(parseNumber("1E+2"), 100.0);
}

TEST(StrictNumber, RefusesWhatIsNotOneFiniteNumber) {
  for (const char* text : {"", " ", "1e", "1,5", "nan", "inf", "-inf", "0x1", "1 2", "1m", "--1",
                           "+-1", "+", ".", "1e999", "true", "${x}", "1e5.5"})
    EXPECT_FALSE(parseNumber(text)) << "'" << text << "'";
}

TEST(StrictNumber, ReadsListsWholeOrNotAtAll) {
  EXPECT_EQ(parseNumbers(" 1\t2\n3 "), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(parseNumbers(""), std::vector<double>{});
  EXPECT_FALSE(parseNumbers("1 2 x"));
  EXPECT_FALSE(parseNumbers("1, 2, 3"));
}

TEST(WrittenNumber, ReadsBackBitForBit) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100000; ++i) {
    const double x = std::bit_cast<double>(random());
    if (!std::isfinite(x)) continue;
    std::string text;
    appendNumber(text, x);
    const auto back = parseNumber(text);
    ASSERT_TRUE(back) << text;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(*back), std::bit_cast<std::uint64_t>(x)) << text;
  }
}

TEST(Suggestion, NamesTheNearestAndNothingFar) {
  EXPECT_EQ(suggestion("sholder", {"elbow", "shoulder"}), ", did you mean 'shoulder'?");
  EXPECT_EQ(suggestion("head", {"left_foot", "shoulder"}), "");
}

}  // namespace
}  // namespace softgauss::io::detail
