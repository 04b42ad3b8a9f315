// SPDX-License-Identifier: Apache-2.0
#include "apps/shared/run_origin.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <fstream>

#include "apps/shared/file_hash.hpp"

namespace softgauss::app {
namespace {

#if defined(__clang__)
constexpr const char* kCompiler = "clang " __clang_version__;
#elif defined(__GNUC__)
constexpr const char* kCompiler = "gcc " __VERSION__;
#else
constexpr const char* kCompiler = "";
#endif

/// As the kernel tells it, or the machine's architecture.
std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name"))
      if (const std::size_t colon = line.find(": "); colon != std::string::npos)
        return line.substr(colon + 2);
  utsname machine = {};
  return uname(&machine) == 0 ? machine.machine : "";
}

}  // namespace

io::RunOrigin runOrigin(const std::string& commandLine, std::vector<std::filesystem::path> files) {
  io::RunOrigin origin;
  origin.commandLine = commandLine;
  origin.commit = SOFTGAUSS_COMMIT;
  origin.compiler = kCompiler;
  origin.processor = processor();
  for (auto file = files.begin(); file != files.end(); ++file)
    if (!file->empty() && std::find(files.begin(), file, *file) == file)
      origin.files.push_back({file->string(), sha256(*file)});
  return origin;
}

}  // namespace softgauss::app
