// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/warning_list.hpp"

#include <gtest/gtest.h>

namespace softgauss::io {
namespace {

using Lines = std::vector<std::string>;

TEST(WarningList, WhatIsSaidOfManyIsOneLineWithAList) {
  EXPECT_EQ(grouped({"joint 'a': its effort of 10 is large; try 2", "visual of 'a': missing",
                     "joint 'b': its effort of 2.5e-3 is large; try 0.1",
                     "joint 'c': its effort of -1 is large; try 7"}),
            (Lines{"joint 'a': its effort of 10 is large; try 2; the same of 'b'",
                   "visual of 'a': missing", "joint 'c': its effort of -1 is large; try 7"}))
      << "another sign is another kind";
}

TEST(WarningList, ListsTheNameThatDiffers) {
  EXPECT_EQ(grouped({"'box' and 'ground' overlap by 3 mm", "'ball' and 'ground' overlap by 2 mm",
                     "'cup' and 'ground' overlap by 1 mm", "'cup' and 'ground' overlap by 4 mm"}),
            (Lines{"'box' and 'ground' overlap by 3 mm; the same of 'ball', 'cup'"}));
  EXPECT_EQ(grouped({"link 'a' of 'r'", "link 'a' of 's'"}),
            (Lines{"link 'a' of 'r'; the same of 's'"}));
  EXPECT_EQ(grouped({"at 3 s", "at 4 s", "at 5 s"}), (Lines{"at 3 s; 2 more of this kind"}));
}

TEST(WarningList, LongListsAreCut) {
  Lines many;
  for (int i = 0; i < 100; ++i) many.push_back("joint 'j" + std::to_string(i) + "' is odd");
  const Lines lines = grouped(many);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_LT(lines[0].size(), 120u);
  EXPECT_TRUE(lines[0].ends_with("'j8' and 91 more")) << lines[0];
}

TEST(WarningList, ApostrophesAreNoNames) {
  EXPECT_EQ(grouped({"the robot's link 'a' is odd", "the robot's link 'b' is odd"}),
            (Lines{"the robot's link 'a' is odd; the same of 'b'"}));
  EXPECT_EQ(grouped({}), Lines{});
  EXPECT_EQ(grouped({"x", "y"}), (Lines{"x", "y"}));
}

}  // namespace
}  // namespace softgauss::io
