// SPDX-License-Identifier: Apache-2.0
/// What is read are regular files of a size that ends.

#include "softgauss/io/detail/input_file.hpp"

#include <sys/stat.h>

#include <fstream>

#include "scene_folder.hpp"
#include "softgauss/io/goals.hpp"
#include "softgauss/io/inputs.hpp"
#include "softgauss/io/torque_table.hpp"

namespace softgauss::test {
namespace {

std::string problemOf(const std::string& file) {
  try {
    io::detail::readInput(file, "a sonnet");
  } catch (const ModelError& error) {
    return error.what();
  }
  return {};
}

TEST(InputFile, IsReadAsItIs) {
  const io::TempFolder folder;
  const std::string text("a\0b\r\n\xff", 6);
  EXPECT_EQ(io::detail::readInput(folder.write("file", text), "text"), text);
  EXPECT_EQ(io::detail::readInput(folder.write("empty", ""), "text"), "");
  std::filesystem::create_symlink("file", folder.path() / "link");
  EXPECT_EQ(io::detail::readInput(folder.path() / "link", "text"), text);
}

// At once: a pipe without a writer would wait for ever, /dev/zero never end.
TEST(InputFile, ThatHasNoEndIsRefused) {
  const io::TempFolder folder;
  const std::string pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::pair<std::string, std::string> cases[] = {
      {pipe, "is a named pipe, not a regular file, expected a sonnet"},
      {"/dev/zero", "is a device, not a regular file"},
      {"/dev/null", "is a device, not a regular file"},
      {folder.path(), "is a folder, not a regular file"},
      {folder.path() / "no", "cannot be read: No such file"},
  };
  for (const auto& [file, words] : cases) {
    const std::string message = problemOf(file);
    EXPECT_EQ(message.rfind(file + ": file: ", 0), 0u) << message;
    EXPECT_NE(message.find(words), std::string::npos) << message;
  }
}

TEST(InputFile, LargerThanTheLimitIsRefusedUnlessTheLimitIsLifted) {
  const io::TempFolder folder;
  const std::string sparse = folder.write("sparse", "");
  std::filesystem::resize_file(sparse, std::uintmax_t{3} << 30);
  EXPECT_NE(problemOf(sparse).find("is larger than 64 MB (--largest-file allows more)"),
            std::string::npos);
  const std::string small = folder.write("small", std::string(1000, 'x'));
  const io::InputLimits before = io::inputLimits();
  io::inputLimits().text = 999;
  EXPECT_NE(problemOf(small).find("is larger than"), std::string::npos);
  io::inputLimits().text = 1000;
  EXPECT_EQ(problemOf(small), "");
  io::inputLimits() = before;
}

// Each reader asks it.
TEST(InputFile, OfEveryKindIsLookedAt) {
  const SceneFolder scene("robots: [{urdf: sample.urdf}]\n");
  const Model model = scene.read().builder.build();
  const auto refused = [](auto&& read) {
    try {
      read();
    } catch (const ModelError& error) {
      return std::string(error.what()).find("is a device") != std::string::npos;
    }
    return false;
  };
  const char* const device = "/dev/zero";
  EXPECT_TRUE(refused([&] { io::readScene(device); }));
  EXPECT_TRUE(refused([&] { io::readUrdf(device); }));
  EXPECT_TRUE(refused([&] { io::readGoals(device, model, State(model)); }));
  EXPECT_TRUE(refused([&] { io::TorqueTable::read(device, model); }));
  EXPECT_NE(refusal("robots: [{urdf: /dev/zero}]\n").find("is a device"), std::string::npos);
  EXPECT_NE(refusal("objects:\n  - {name: o, mesh: {file: /dev/zero}}\n").find("is a device"),
            std::string::npos);
}

// Aliases multiply, and what holds itself has no end.
TEST(InputFile, OfYamlEndsWhereItsAliasesAreReplaced) {
  std::string bomb = "a: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 9; ++i) {
    const std::string item = "*a" + std::to_string(i - 1);
    bomb += "b" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + item;
    for (int k = 1; k < 10; ++k) bomb += ", " + item;
    bomb += "]\n";
  }
  EXPECT_NE(refusal(bomb).find("values once its aliases are replaced"), std::string::npos);
  EXPECT_NE(refusal("objects: &o [*o]\n").find("alias inside of what it stands for"),
            std::string::npos);
  const SceneFolder folder(
      "objects:\n  - &first {name: a, sphere: &s {radius: 0.5}}\n  - {name: b, sphere: *s}\n");
  EXPECT_EQ(folder.read().builder.build().geometries.at(1).shape.radius, 0.5);
}

}  // namespace
}  // namespace softgauss::test
