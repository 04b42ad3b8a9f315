// SPDX-License-Identifier: Apache-2.0
#include "io/replay/plot.hpp"

#include "engine/core/check.hpp"
#include "io/detail/text.hpp"
#include "tests/io/replay/recorded_run.hpp"
#include "tests/io/temp_folder.hpp"

namespace softgauss::test {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(Plot, OneFileHoldsEveryGroupWithItsUnit) {
  const RecordedRun run(200);
  const io::TempFolder folder;
  const std::string file = folder.path() / "run.svg";
  io::Plot(file).write(*run.recording);
  const std::string svg = *io::detail::readFile(file);
  EXPECT_EQ(svg.rfind("<?xml", 0), 0u);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  for (const io::CurveGroup& group : run.recording->plots()) {
    const std::string heading =
        group.unit.empty() ? group.name : group.name + " [" + group.unit + "]";
    EXPECT_EQ(count(svg, heading + " over time [s]"), 1u) << heading;
    for (const io::Curve& curve : group.curves) EXPECT_GE(count(svg, curve.name), 1u) << curve.name;
  }
}

TEST(Plot, AFolderGetsAFileForEachGroup) {
  const RecordedRun run(50);
  const io::TempFolder folder;
  io::Plot(folder.path() / "plots").write(*run.recording);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "plots")) {
    EXPECT_EQ(entry.path().extension(), ".svg");
    EXPECT_NE(io::detail::readFile(entry.path())->find("</svg>"), std::string::npos);
    ++files;
  }
  EXPECT_EQ(files, run.recording->plots().size());
}

// Names come from files: quotes and line breaks of a name stay in its text.
TEST(Plot, NamesCannotLeaveTheirQuotes) {
  RecordedRun run(20);
  run.recording->command = "it's 'quoted'\nand broken";
  const std::string script = io::plotScript(*run.recording, run.recording->plots());
  EXPECT_NE(script.find("'it''s ''quoted'' and broken'"), std::string::npos);
}

TEST(Plot, OtherFormatsAndPlacesAreRefused) {
  const io::TempFolder folder;
  EXPECT_THROW(io::Plot(folder.path() / "run.png"), ModelError);
  EXPECT_THROW(io::Plot(folder.path() / "no" / "folder" / "run.svg"), ModelError);
}

}  // namespace
}  // namespace softgauss::test
