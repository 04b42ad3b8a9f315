// SPDX-License-Identifier: Apache-2.0
#include "tests/apps/process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

extern char** environ;

namespace softgauss::test {
namespace {

void pause(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

/// Until the file exists, or for ten seconds at most.
void waitForFile(const std::string& path) {
  for (int i = 0; i < 1000 && !std::filesystem::exists(path); ++i) pause(0.01);
}

/// A program, in a folder or where the tests run, to its end.
Outcome runAt(const std::string& program, const std::vector<std::string>& arguments,
              const std::string& inFolder, double interruptAfter = -1.0,
              const std::string& interruptFile = {});

}  // namespace

Outcome simulate(const std::vector<std::string>& arguments, double interruptAfter,
                 const std::string& interruptFile) {
  return runProgram("simulate_gdd", arguments, interruptAfter, interruptFile);
}

Outcome runProgram(const std::string& name, const std::vector<std::string>& arguments,
                   double interruptAfter, const std::string& interruptFile) {
  return runAt(std::string(SOFTGAUSS_APP_DIR) + "/" + name, arguments, {}, interruptAfter,
               interruptFile);
}

Outcome runProgramIn(const std::string& folder, const std::string& name,
                     const std::vector<std::string>& arguments) {
  return runAt(std::string(SOFTGAUSS_APP_DIR) + "/" + name, arguments, folder);
}

Outcome runShell(const std::string& folder, const std::string& commands) {
  return runAt("/bin/sh", {"-c", "PATH=" SOFTGAUSS_APP_DIR ":$PATH\n" + commands}, folder);
}

namespace {

Outcome runAt(const std::string& program, const std::vector<std::string>& arguments,
              const std::string& inFolder, double interruptAfter,
              const std::string& interruptFile) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "out", err = folder.path() / "err";
  std::vector<std::string> texts{program};
  texts.insert(texts.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& text : texts) argv.push_back(text.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, out.c_str(), kFlags, 0600);
  posix_spawn_file_actions_addopen(&files, 2, err.c_str(), kFlags, 0600);
  if (!inFolder.empty()) posix_spawn_file_actions_addchdir_np(&files, inFolder.c_str());
  pid_t pid = 0;
  const int failed = posix_spawn(&pid, program.c_str(), &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  Outcome outcome;
  if (failed != 0) {
    ADD_FAILURE() << "cannot start " << program;
    return outcome;
  }
  if (interruptAfter >= 0.0) {
    waitForFile(interruptFile);
    pause(interruptAfter);
    kill(pid, SIGINT);
  }
  int status = 0;
  waitpid(pid, &status, 0);
  outcome.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.out = readFile(out);
  outcome.err = readFile(err);
  return outcome;
}

}  // namespace

std::string readFile(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string dataFile(const std::string& path) {
  return std::string(SOFTGAUSS_SOURCE_DIR) + "/data/" + path;
}

std::vector<std::string> passiveArm(const std::string& duration) {
  return {dataFile("robots/arm.urdf"), "--passive", "--quiet", "--duration", duration};
}

Csv::Csv(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, ',');) fields.push_back(field);
    if (line.ends_with(',')) fields.emplace_back();
    if (columns.empty())
      columns = fields;
    else
      rows.push_back(fields);
  }
}

int Csv::find(const std::string& column) const {
  const auto it = std::find(columns.begin(), columns.end(), column);
  return it == columns.end() ? -1 : static_cast<int>(it - columns.begin());
}

double Csv::number(int row, const std::string& column) const {
  const int i = find(column);
  EXPECT_GE(i, 0) << column;
  return i < 0 ? 0.0 : std::strtod(rows.at(row).at(i).c_str(), nullptr);
}

}  // namespace softgauss::test
