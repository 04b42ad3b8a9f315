// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/input_folder.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "softgauss/io/printable.hpp"

namespace softgauss::fuzz {

InputFolder::InputFolder() {
  std::string path = (std::filesystem::temp_directory_path() / "softgauss-fuzz-XXXXXX").string();
  const char* const made = mkdtemp(path.data());
  if (!made) throw Finding("no folder could be made: " + path);
  path_ = made;
}

InputFolder::~InputFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path InputFolder::write(const std::string& name, std::string_view bytes) const {
  std::filesystem::path file = path_ / name;
  std::FILE* out = std::fopen(file.c_str(), "wb");
  if (!out && std::filesystem::create_directories(file.parent_path()))
    out = std::fopen(file.c_str(), "wb");
  if (!out || std::fwrite(bytes.data(), 1, bytes.size(), out) != bytes.size() ||
      std::fclose(out) != 0)
    throw Finding("cannot be written: " + file.string());
  return file;
}

void InputFolder::link(const std::string& name, const std::string& ofTree) const {
  const std::filesystem::path from = path_ / name;
  std::filesystem::create_directories(from.parent_path());
  std::filesystem::create_symlink(std::filesystem::path(SOFTGAUSS_SOURCE_DIR) / ofTree, from);
}

void expectMessage(const std::string& message) {
  const std::string shown = io::printable(message);
  constexpr std::size_t kLongest = 3000;  // as of tests/bad_input
  if (shown.empty() || shown.size() > kLongest)
    throw Finding("a message of " + std::to_string(shown.size()) + " bytes: " + shown);
}

}  // namespace softgauss::fuzz
