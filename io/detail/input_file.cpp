// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/input_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <optional>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/inputs.hpp"

namespace softgauss::io {

InputLimits& inputLimits() {
  static InputLimits limits;
  return limits;
}

bool standardInputIsXml() {
  const std::string text = detail::readInput(kStandardInput, "a URDF or a scene");
  const std::size_t begin = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return begin != std::string::npos && text[begin] == '<';
}

}  // namespace softgauss::io

namespace softgauss::io::detail {
namespace {

constexpr double kMegabyte = 1 << 20;

/// What is no regular file, in words; nothing for one that is.
const char* otherKind(mode_t mode) {
  if (S_ISREG(mode)) return nullptr;
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a named pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

std::string notRegular(const char* kind) { return fmt::format("is {}, not a regular file", kind); }

std::string tooLarge(std::optional<std::uintmax_t> most) {
  return fmt::format("is larger than {:.6g} MB{}",
                     static_cast<double>(most.value_or(inputLimits().text)) / kMegabyte,
                     most ? "" : " (--largest-file allows more)");
}

struct OpenInput {
  int number = -1;
  ~OpenInput() {
    if (number > STDERR_FILENO) close(number);
  }
};

/// All that can be read, as long as it is not too much: a regular file may grow, or belong to the
/// kernel and have no size. What went wrong is the second.
std::pair<std::string, std::string> readAll(int descriptor, std::optional<std::uintmax_t> most) {
  std::string text;
  char buffer[1 << 16];
  for (;;) {
    const ssize_t n = read(descriptor, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return {{}, fmt::format("cannot be read: {}", std::strerror(errno))};
    if (n == 0) return {std::move(text), std::string()};
    text.append(buffer, static_cast<std::size_t>(n));
    if (text.size() > most.value_or(inputLimits().text)) return {{}, tooLarge(most)};
  }
}

[[noreturn]] void refuse(const std::string& file, const std::string& problem,
                         const std::string& expected) {
  throw ModelError({inputName(file), 0}, "file", problem + ", expected " + expected);
}

const std::string& standardInput(const std::string& expected) {
  static std::optional<std::string> text;
  if (!text) {
    auto [all, problem] = readAll(STDIN_FILENO, {});
    if (!problem.empty()) refuse(kStandardInput, problem, expected);
    text = std::move(all);
  }
  return *text;
}

}  // namespace

std::string inputName(const std::string& file) {
  return file == kStandardInput ? "standard input" : file;
}

std::string inputProblem(const std::string& file) {
  struct stat info = {};
  if (stat(file.c_str(), &info) != 0)
    return fmt::format("cannot be read: {}", std::strerror(errno));
  const char* const kind = otherKind(info.st_mode);
  return kind ? notRegular(kind) : std::string();
}

std::string readInput(const std::string& file, const std::string& expected,
                      std::optional<std::uintmax_t> most) {
  if (file == kStandardInput) return standardInput(expected);
  // Looked at before it is opened, as opening may wait or act, and after it, as it may be another.
  if (const std::string problem = inputProblem(file); !problem.empty())
    refuse(file, problem, expected);
  const OpenInput opened{open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
  struct stat info = {};
  if (opened.number < 0 || fstat(opened.number, &info) != 0)
    refuse(file, fmt::format("cannot be read: {}", std::strerror(errno)), expected);
  if (const char* const kind = otherKind(info.st_mode)) refuse(file, notRegular(kind), expected);
  if (info.st_size > 0 &&
      static_cast<std::uintmax_t>(info.st_size) > most.value_or(inputLimits().text))
    refuse(file, tooLarge(most), expected);
  auto [text, problem] = readAll(opened.number, most);
  if (!problem.empty()) refuse(file, problem, expected);
  return std::move(text);
}

}  // namespace softgauss::io::detail
