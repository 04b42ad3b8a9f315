// SPDX-License-Identifier: Apache-2.0
/// The memory of a run does not grow with its length.

#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "tests/apps/process.hpp"

extern char** environ;

namespace softgauss::test {
namespace {

/// Largest memory [bytes] that a run of `steps` of the arm, left to itself, has had.
long peakOf(long steps) {
  const io::TempFolder folder;
  std::vector<std::string> texts = {std::string(SOFTGAUSS_APP_DIR) + "/simulate_gdd",
                                    dataFile("robots/arm.urdf"),
                                    "--passive",
                                    "--quiet",
                                    "--timestep",
                                    "0.001",
                                    "--duration",
                                    fmt::format("{}", 0.001 * static_cast<double>(steps)),
                                    "--summary",
                                    folder.path() / "s.json",
                                    "--log",
                                    "/dev/null",
                                    "--contacts",
                                    folder.path() / "contacts.csv"};
  std::vector<char*> argv;
  for (std::string& text : texts) argv.push_back(text.data());
  argv.push_back(nullptr);
  pid_t pid = 0;
  if (posix_spawn(&pid, argv[0], nullptr, nullptr, argv.data(), environ) != 0) return -1;
  int status = 0;
  rusage used = {};
  wait4(pid, &status, 0, &used);
  EXPECT_EQ(status, 0);
  return 1024L * used.ru_maxrss;
}

// Ten statistics of 8 bytes a step were kept once: 32 MB more in the longer run. What libraries
// fetch differs by some pages from one process to the next.
TEST(MemoryLong, OfARunDoesNotGrowWithItsLength) {
  const long shortRun = peakOf(100'000), longRun = peakOf(500'000);
  EXPECT_GT(shortRun, 0);
  EXPECT_LT(longRun - shortRun, 1 << 20);
}

}  // namespace
}  // namespace softgauss::test
