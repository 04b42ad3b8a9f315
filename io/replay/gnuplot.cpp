// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/replay/gnuplot.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "softgauss/io/detail/output_file.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io {
namespace {

/// A folder of its own, gone at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "softgauss-XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw std::runtime_error(fmt::format("plot: no folder {}: {}", name, std::strerror(errno)));
    path = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::filesystem::path path;
};

}  // namespace

bool hasGnuplot() { return std::system("command -v gnuplot >/dev/null 2>&1") == 0; }

std::string gnuplotDrawing(const std::string& script) {
  const ScratchFolder scratch;
  detail::OutputFile file(scratch.path / "script", "plot");
  file.write(script);
  file.commit();

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, scratch.path.c_str());
  char program[] = "gnuplot", plain[] = "-d", name[] = "script";
  char* const arguments[] = {program, plain, name, nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, program, &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    throw std::runtime_error(
        fmt::format("plot: gnuplot cannot be started: {}", std::strerror(error)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;

  const std::optional<std::string> svg =
      detail::readFile((scratch.path / kGnuplotDrawing).string());
  if (status != 0 || !svg || svg->find("</svg>") == std::string::npos)
    throw std::runtime_error("plot: gnuplot failed; its message, if it had one, is above");
  return *svg;
}

}  // namespace softgauss::io
