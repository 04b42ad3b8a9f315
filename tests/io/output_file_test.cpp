// SPDX-License-Identifier: Apache-2.0
/// Outputs appear when they are complete, where links lead, and in place on what cannot be renamed.

#include "softgauss/io/detail/output_file.hpp"

#include <sys/stat.h>

#include <fstream>
#include <set>
#include <sstream>
#include <thread>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/output.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {
namespace {

namespace fs = std::filesystem;

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::set<std::string> namesIn(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

void writeAll(const fs::path& file, const std::string& text) {
  detail::OutputFile out(file, "page");
  out.write(text);
  out.commit();
}

TEST(OutputFile, AppearsWhenItIsComplete) {
  const TempFolder folder;
  const fs::path file = folder.write("page.html", "old");
  {
    detail::OutputFile out(file, "page");
    EXPECT_EQ(namesIn(folder.path()), std::set<std::string>{"page.html"}) << "nothing until then";
    out.write("new");
    EXPECT_EQ(textOf(file), "old");
    out.commit();
  }
  EXPECT_EQ(textOf(file), "new");
  {
    detail::OutputFile out(file, "page");
    out.write("third");
  }
  EXPECT_EQ(textOf(file), "new") << "what was not committed leaves no trace";
  EXPECT_EQ(namesIn(folder.path()), std::set<std::string>{"page.html"});
}

TEST(OutputFile, FollowsLinks) {
  const TempFolder folder;
  const fs::path target = folder.write("there/page.html", "old");
  const fs::path link = folder.path() / "link", chain = folder.path() / "chain";
  fs::create_symlink("there/page.html", link);
  fs::create_symlink("link", chain);
  for (const fs::path& name : {link, chain}) {
    writeAll(name, name.filename().string());
    EXPECT_TRUE(fs::is_symlink(name));
    EXPECT_FALSE(fs::is_symlink(target));
    EXPECT_EQ(textOf(target), name.filename().string());
  }
  // To where nothing is yet.
  const fs::path dangling = folder.path() / "dangling";
  fs::create_symlink("there/new.html", dangling);
  writeAll(dangling, "new");
  EXPECT_TRUE(fs::is_symlink(dangling));
  EXPECT_EQ(textOf(folder.path() / "there/new.html"), "new");
  EXPECT_EQ(namesIn(folder.path() / "there"), (std::set<std::string>{"new.html", "page.html"}));
}

TEST(OutputFile, WritesToDevicesAndPipesInPlace) {
  const TempFolder folder;
  const fs::path link = folder.path() / "null";
  fs::create_symlink("/dev/null", link);
  writeAll(link, "gone");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));

  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = textOf(pipe); });
  writeAll(pipe, "through the pipe");
  reader.join();
  EXPECT_EQ(read, "through the pipe");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(OutputFile, OnAFullDiskIsAnErrorWithItsReason) {
  detail::OutputFile out("/dev/full", "page");
  out.write("something");
  try {
    out.commit();
    FAIL() << "written to a full disk";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "/dev/full: page: cannot be written: No space left on device");
  }
}

// Whether it can be written is known before, and asking changes nothing.
TEST(OutputFile, ThatCannotBeWrittenIsRefusedAtOnce) {
  const TempFolder folder;
  const fs::path file = folder.write("file", "kept");
  fs::create_directory(folder.path() / "folder");
  fs::create_symlink("loop", folder.path() / "loop");
  const std::set<std::string> before = namesIn(folder.path());
  const std::pair<fs::path, const char*> cases[] = {
      {folder.path() / "no/such/page.html", "No such file or directory"},
      {folder.path() / "folder", "Is a directory"},
      {file / "page.html", "Not a directory"},
      {folder.path() / "loop", "Too many levels of symbolic links"},
      {folder.path() / std::string(300, 'x'), "File name too long"},
      {folder.path() / "", "Is a directory"},
      {"/proc/page.html", "No such file or directory"},
  };
  for (const auto& [path, words] : cases) {
    try {
      expectWritable(path, "page");
      ADD_FAILURE() << path << " can be written";
    } catch (const ModelError& error) {
      EXPECT_EQ(std::string(error.what()).rfind(path.string() + ": page: cannot be written: ", 0),
                0u)
          << error.what();
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }
  expectWritable(file, "page");
  expectWritable(folder.path() / "new", "page");
  expectWritable(folder.path() / std::string(255, 'x'), "page");
  EXPECT_EQ(textOf(file), "kept");
  EXPECT_EQ(namesIn(folder.path()), before);
}

TEST(OutputFile, HalfWrittenIsRemovedBeforeASignalEndsTheProcess) {
  const TempFolder folder;
  detail::OutputFile out(folder.path() / "page.html", "page");
  out.write("half");
  ASSERT_EQ(namesIn(folder.path()).size(), 1u);
  removePartFiles();
  EXPECT_TRUE(namesIn(folder.path()).empty());
}

TEST(OutputFile, LeftByAKilledProcessIsRemovedByTheNext) {
  const TempFolder folder, other;
  folder.write("softgauss-123-4.part", "left");
  folder.write("softgauss-notes.part", "of the user");
  fs::create_symlink("page.html", folder.path() / "softgauss-5-6.part");
  writeAll(folder.path() / "page.html", "new");
  EXPECT_EQ(namesIn(folder.path()),
            (std::set<std::string>{"page.html", "softgauss-5-6.part", "softgauss-notes.part"}));
  EXPECT_EQ(textOf(folder.path() / "page.html"), "new");

  // What is being written stays, also where it is looked for.
  detail::OutputFile out(other.path() / "page.html", "page");
  out.write("half");
  writeAll(folder.path() / "page.html", "newer");
  writeAll(other.path() / "second.html", "second");
  EXPECT_EQ(namesIn(other.path()).size(), 2u);
  out.commit();
  EXPECT_EQ(textOf(other.path() / "page.html"), "half");
}

}  // namespace
}  // namespace softgauss::io
