// SPDX-License-Identifier: Apache-2.0
/// A run taken out of its page, and shown beside another.

#include <fstream>
#include <sstream>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/replay/page.hpp"
#include "tests/io/replay/payload_reader.hpp"
#include "tests/io/replay/recorded_run.hpp"
#include "tests/io/temp_folder.hpp"

namespace softgauss::test {
namespace {

const std::string kOther = "<script id=\"softgauss-other-run\" type=\"application/octet-stream\">";

std::string textOf(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::string writePage(const std::filesystem::path& file, const RecordedRun& run,
                      const std::string& beside = "") {
  io::ReplayPage(file, beside).write(*run.recording, "softgauss test");
  return textOf(file);
}

TEST(RunInPage, IsTheRunThatThePageHolds) {
  const io::TempFolder folder;
  const RecordedRun first(50), second(80);
  const std::string alone = writePage(folder.path() / "first.html", first);
  EXPECT_NE(alone.find(kOther + "<"), std::string::npos) << "nothing is beside it";
  const std::string run = io::runInPage(folder.path() / "first.html");
  EXPECT_EQ(inflated(fromBase64(run)), payloadOfPage(alone));
  const std::string both = writePage(folder.path() / "both.html", second, run);
  EXPECT_NE(both.find(kOther + run + "<"), std::string::npos);
  EXPECT_EQ(payloadOfPage(both), io::replayPayload(*second.recording, "softgauss test"));
  // Of a page that shows two, its own.
  EXPECT_EQ(inflated(fromBase64(io::runInPage(folder.path() / "both.html"))), payloadOfPage(both));
}

TEST(RunInPage, IsRefusedWhereItIsNone) {
  const io::TempFolder folder;
  const std::string page = writePage(folder.path() / "run.html", RecordedRun(5));
  const std::string run = io::runInPage(folder.path() / "run.html");
  const auto changed = [&](const std::string& other) {
    std::string text = page;
    return text.replace(text.find(run), run.size(), other);
  };
  std::string flipped = run;
  flipped[run.size() / 2] = flipped[run.size() / 2] == 'A' ? 'B' : 'A';
  const std::pair<std::string, std::string> cases[] = {
      {"", "no run"},
      {"<p>a letter</p>", "no run"},
      {page.substr(0, page.find(run) + 100), "no run"},
      {changed(""), "damaged"},
      {changed("not base64!!"), "damaged"},
      {changed(run.substr(0, run.size() / 8 * 4)), "damaged"},
      {changed(flipped), "damaged"},
      {changed("eJwrSC0GAAL8AVo="), "damaged"},  // zlib of a word
  };
  for (const auto& [text, why] : cases) {
    const std::filesystem::path file = folder.write("bad.html", text);
    try {
      io::runInPage(file);
      FAIL() << why;
    } catch (const ModelError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(why), std::string::npos) << message;
      EXPECT_NE(message.find("bad.html"), std::string::npos) << message;
    }
  }
  EXPECT_THROW(io::runInPage(folder.path() / "nowhere.html"), ModelError);
  EXPECT_THROW(io::runInPage(folder.path()), ModelError);
}

}  // namespace
}  // namespace softgauss::test
