// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "sample_urdf.hpp"
#include "softgauss/io/urdf.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {
namespace {

/// Flips bytes, deletes and repeats parts, duplicates lines.
std::string mutatedUrdf(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  for (std::size_t edits = 1 + below(3); edits > 0 && !text.empty(); --edits) {
    const std::size_t at = below(text.size());
    const std::size_t length = 1 + below(std::min<std::size_t>(12, text.size() - at));
    switch (below(6)) {
      case 0:
        text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      case 3: {
        const std::size_t begin = text.rfind('\n', at) + 1;  // npos + 1 is the start
        const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
        if (begin < end) text.insert(end, text.substr(begin, end - begin));
        break;
      }
      case 4: {
        const char* const scraps[] = {"-", "e", "9", "nan", "1e308", "<", "/>", "\"", " ", "&#0;"};
        text.insert(at, scraps[below(10)]);
        break;
      }
      default:
        text.resize(at);
        break;
    }
  }
  return text;
}

/// The sample with what URDF 1.1 adds.
std::string modernUrdf() {
  return with(with(with(kSampleUrdf, "name=\"sample\"", "name=\"sample\" version=\"1.1\""),
                   "rpy=\"0.1 0.2 0.3\"", "quat_xyzw=\"0.5 0.5 -0.5 0.5\""),
              "<cylinder", "<capsule");
}

TEST(UrdfFuzz, MutatedFilesLoadOrThrowModelError) {
  const TempFolder folder;
  std::mt19937 random(20240601);
  int loaded = 0, refused = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string text = mutatedUrdf(i % 2 ? modernUrdf() : kSampleUrdf, random);
    const auto file = folder.write("fuzz.urdf", text);
    try {
      const Model m = loadUrdf(file);
      ++loaded;
      for (const Body& body : m.bodies) {
        ASSERT_TRUE(std::isfinite(body.mass) && body.com.allFinite()) << text;
        ASSERT_TRUE(body.I_Bcm.matrix().allFinite()) << text;
        ASSERT_TRUE(body.X_PB.p.allFinite() && body.X_PB.R.allFinite()) << text;
      }
    } catch (const ModelError& error) {
      ++refused;
      ASSERT_TRUE(std::string(error.what()).starts_with(file.string())) << error.what() << text;
    } catch (const std::exception& error) {
      FAIL() << error.what() << "\n" << text;
    }
  }
  // Both ends are exercised.
  EXPECT_GT(loaded, 50);
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace softgauss::io
