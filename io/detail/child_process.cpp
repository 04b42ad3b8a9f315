// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>

namespace softgauss::io::detail {
namespace {

constexpr int kOutOfMemory = 42, kThrew = 43;  // exit codes

/// Address space of this process [bytes], or 0.
std::uint64_t addressSpace() {
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (!file) return 0;
  unsigned long long pages = 0;
  const int read = std::fscanf(file, "%llu", &pages);
  std::fclose(file);
  return read == 1 ? pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
}

void setLimit(decltype(RLIMIT_CPU) resource, std::uint64_t most) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, most);
  limit.rlim_max = limit.rlim_cur;
  setrlimit(resource, &limit);
}

bool writeAll(int fd, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = write(fd, data, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    data += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

void readAll(int fd, std::string& bytes) {
  char buffer[1 << 16];
  while (true) {
    const ssize_t n = read(fd, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    bytes.append(buffer, static_cast<std::size_t>(n));
  }
}

[[noreturn]] void beChild(const std::function<std::string()>& work, const ChildLimits& limits,
                          int out) {
  constexpr std::uint64_t kSanitized = std::uint64_t{1} << 40;  // maps terabytes, to be left alone
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGSEGV, SIGABRT, SIGXCPU})
    std::signal(signal, SIG_DFL);
  if (const int null = open("/dev/null", O_WRONLY | O_CLOEXEC); null >= 0) {
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
  }
  setLimit(RLIMIT_CORE, 0);
  setLimit(RLIMIT_CPU, static_cast<std::uint64_t>(limits.seconds));
  if (const std::uint64_t now = addressSpace(); now > 0 && now < kSanitized)
    setLimit(RLIMIT_AS, now + limits.bytes);
  try {
    const std::string result = work();
    const std::uint64_t size = result.size();
    const bool written = writeAll(out, reinterpret_cast<const char*>(&size), sizeof size) &&
                         writeAll(out, result.data(), result.size());
    _exit(written ? 0 : kThrew);
  } catch (const std::bad_alloc&) {
    _exit(kOutOfMemory);
  } catch (...) {
    _exit(kThrew);
  }
}

std::string failureOf(int status, const ChildLimits& limits) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemory)
    return fmt::format("needs more than {} MB of memory", limits.bytes >> 20);
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    return fmt::format("needs more than {} s", limits.seconds);
  if (WIFSIGNALED(status)) return fmt::format("crashes ({})", strsignal(WTERMSIG(status)));
  return "crashes";
}

}  // namespace

ChildResult runInChild(const std::function<std::string()>& work, const ChildLimits& limits) {
  ChildResult result;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    result.failure = fmt::format("has no pipe ({})", std::strerror(errno));
    return result;
  }
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    beChild(work, limits, ends[1]);
  }
  close(ends[1]);
  if (child < 0) {
    result.failure = fmt::format("cannot be started ({})", std::strerror(errno));
    close(ends[0]);
    return result;
  }
  readAll(ends[0], result.bytes);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  std::uint64_t size = 0;
  if (result.bytes.size() >= sizeof size) std::memcpy(&size, result.bytes.data(), sizeof size);
  if (result.bytes.size() == sizeof size + size && size > 0) {
    result.bytes.erase(0, sizeof size);
  } else {
    result.bytes.clear();
    result.failure = failureOf(status, limits);
  }
  return result;
}

}  // namespace softgauss::io::detail
