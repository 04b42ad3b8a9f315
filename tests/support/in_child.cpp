// SPDX-License-Identifier: Apache-2.0
#include "tests/support/in_child.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>

namespace softgauss::test {
namespace {

/// Of the child: sends the text and ends without running anything of the parent's.
[[noreturn]] void send(int pipe, const std::function<std::string()>& body) {
  std::string text;
  try {
    text = body();
  } catch (const std::exception& error) {
    text = std::string("child: throws: ") + error.what();
  }
  for (std::size_t sent = 0; sent < text.size();) {
    const auto n = write(pipe, text.data() + sent, text.size() - sent);
    if (n <= 0) _exit(2);
    sent += static_cast<std::size_t>(n);
  }
  _exit(0);
}

}  // namespace

std::string inChild(const std::function<std::string()>& body, double seconds) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return "child: no pipe";
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) return "child: no process";
  if (child == 0) {
    close(ends[0]);
    send(ends[1], body);
  }
  close(ends[1]);

  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  std::string text;
  bool isDone = false;
  while (!isDone) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    pollfd readable{ends[0], POLLIN, 0};
    if (left.count() <= 0 || poll(&readable, 1, static_cast<int>(left.count())) <= 0) break;
    std::array<char, 4096> buffer;
    const auto n = read(ends[0], buffer.data(), buffer.size());
    isDone = n <= 0;
    if (n > 0) text.append(buffer.data(), static_cast<std::size_t>(n));
  }
  close(ends[0]);
  if (!isDone) kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  if (!isDone) return "child: not done in " + std::to_string(seconds) + " s";
  if (WIFSIGNALED(status)) return "child: ended by signal " + std::to_string(WTERMSIG(status));
  if (WEXITSTATUS(status) != 0)
    return "child: ended with code " + std::to_string(WEXITSTATUS(status));
  return text;
}

}  // namespace softgauss::test
