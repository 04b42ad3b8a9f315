// SPDX-License-Identifier: Apache-2.0
/// Islands go to bytes and back: groups, ages and sleep go on to the same bits.

#include <gtest/gtest.h>

#include "softgauss/engine/core/bytes.hpp"
#include "softgauss/engine/model/saved_state.hpp"
#include "tests/islands/crowd.hpp"

namespace softgauss::test {
namespace {

std::string bytesOf(Islands& islands) {
  ByteWriter writer;
  writer(islands);
  return writer.bytes();
}

void restore(Islands& islands, const std::string& bytes) {
  ByteReader reader(bytes);
  reader(islands);
  reader.expectEnd();
}

// A heap falls, comes to rest and falls asleep, part by part, and meets what still falls.
TEST(SavedIslands, GoOnToTheSameBits) {
  ModelBuilder builder = heap(12, 5);
  addCube(builder, "late", Vector3(0.1, 0.0, 12.0));
  const Model model = builder.build();
  const Sleep sleep{.enabled = true};
  Crowd unbroken(model, sleep);
  bool slept = false, met = false;
  for (int part = 0; part < 12; ++part) {
    Crowd resumed(model, sleep);
    resumed.steps(part);  // it has been elsewhere before
    restore(resumed.islands, bytesOf(unbroken.islands));
    EXPECT_TRUE(bytesOf(resumed.islands) == bytesOf(unbroken.islands)) << part;
    for (int i = 0; i < 97; ++i) {
      ASSERT_TRUE(unbroken.steps(1) && resumed.steps(1));
      const IslandStats &a = unbroken.islands.islandStats(), &b = resumed.islands.islandStats();
      ASSERT_EQ(a.islands, b.islands);
      ASSERT_EQ(a.awake, b.awake);
      ASSERT_EQ(a.regroups, b.regroups);
      ASSERT_EQ(hash(unbroken.islands.state()), hash(resumed.islands.state())) << part << " " << i;
      slept = slept || a.awake < a.islands;
      met = met || a.regroups > 0;
    }
    EXPECT_TRUE(bytesOf(resumed.islands) == bytesOf(unbroken.islands)) << part;
  }
  EXPECT_TRUE(slept);
  EXPECT_TRUE(met);
}

TEST(SavedIslands, AreRefusedWhereTheyDoNotFit) {
  Crowd crowd(heap(4, 1).build()), other(heap(5, 1).build());
  crowd.steps(50);
  const std::string bytes = bytesOf(crowd.islands);
  EXPECT_THROW(restore(other.islands, bytes), BytesError);
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    Crowd part(heap(4, 1).build());
    EXPECT_THROW(restore(part.islands, bytes.substr(0, size)), BytesError);
  }
}

}  // namespace
}  // namespace softgauss::test
