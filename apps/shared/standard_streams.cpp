// SPDX-License-Identifier: Apache-2.0
#include "apps/shared/standard_streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "softgauss/io/printable.hpp"

namespace softgauss::app {
namespace {

int outputError = 0;  ///< errno of the first write to standard output that failed

}  // namespace

void prepareStreams() {
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  // The least free number is taken, so these are opened in order. What is opened to read cannot be
  // written to.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF) {
      const int opened = open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
      static_cast<void>(opened);
    }
}

void print(std::FILE* stream, const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  if (!written && stream == stdout && outputError == 0) outputError = errno;
}

void tell(const std::string& message) { print(stderr, io::printable(message) + "\n"); }

int finishStandardOutput(const std::string& program) {
  errno = 0;
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  if (outputError == 0) outputError = errno;
  if (!failed && outputError == 0) return 0;
  tell(fmt::format("{}: standard output: cannot be written: {}", program,
                   std::strerror(outputError != 0 ? outputError : EIO)));
  return 2;
}

}  // namespace softgauss::app
