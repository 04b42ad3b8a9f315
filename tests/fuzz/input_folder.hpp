// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the fuzz targets of files share.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "tests/random_scenes/finding.hpp"

namespace softgauss::fuzz {

/// A folder of this process with the file that is read. It goes when the process ends.
class InputFolder {
 public:
  InputFolder();
  ~InputFolder();
  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;

  /// Writes a file of the folder and returns its path.
  std::filesystem::path write(const std::string& name, std::string_view bytes) const;
  /// Makes `name` lead to a file or folder of the source tree.
  void link(const std::string& name, const std::string& ofTree) const;

 private:
  std::filesystem::path path_;
};

inline std::string_view textOf(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Throws Finding where a refusal has a message that, as it is shown, is empty or longer than a
/// screen.
void expectMessage(const std::string& message);

}  // namespace softgauss::fuzz
