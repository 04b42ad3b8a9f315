// SPDX-License-Identifier: Apache-2.0
/// A sweep that is killed at random moments, whole or one of its ranks: the results are those of a
/// sweep that nobody disturbed.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

class KilledSweepLong : public testing::Test {
 protected:
  void SetUp() override {
    // 400 runs of 20 to 30 ms.
    folder.write("sweep.yaml", "model: " + dataFile("robots/arm.urdf") +
                                   "\nduration: 8\nreach: {hand: [0.5, 0.2, 0.5]}\nseed: 5\n"
                                   "runs: 400\nvary:\n  mass:hand: {uniform: [0.5, 2]}\n"
                                   "  reach:hand.x: {uniform: [0.3, 0.6]}\n");
    const Outcome whole = shell("simulate_batch sweep.yaml --quiet --threads 2 --out whole");
    ASSERT_EQ(whole.exitCode, 0) << whole.err;
  }
  Outcome shell(const std::string& script) const { return runShell(folder.path(), script); }
  std::string table(const std::string& out) const {
    return readFile((folder.path() / out / "runs.csv").string());
  }
  /// Seconds, as the shell's sleep reads them.
  std::string moment(double most) {
    return std::to_string(std::uniform_real_distribution(0.0, most)(random));
  }

  io::TempFolder folder;
  std::mt19937 random{2018};
};

TEST_F(KilledSweepLong, OneProcessGoesOn) {
  for (int trial = 0; trial < 20; ++trial) {
    // Killed three times, then once more to the end.
    std::string script;
    const std::string sweep =
        "simulate_batch sweep.yaml --quiet --threads 2 --checkpoint --out one";
    for (int kill = 0; kill < 3; ++kill)
      script +=
          sweep + " & pid=$!\nsleep " + moment(1.5) + "\nkill -9 $pid 2>/dev/null; wait $pid\n";
    const Outcome outcome = shell(script + sweep);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    ASSERT_EQ(table("one"), table("whole")) << "trial " << trial;
    std::filesystem::remove_all(folder.path() / "one");
  }
}

TEST_F(KilledSweepLong, RanksThatAreLostCostNothingButTheirTime) {
  if (shell("command -v mpirun").exitCode != 0) GTEST_SKIP() << "no mpirun here";
  int interrupted = 0;
  for (int kill = 0; kill < 50; ++kill) {
    const std::string sweep =
        "mpirun --allow-run-as-root --oversubscribe -n 4 simulate_batch sweep.yaml --quiet "
        "--checkpoint --out ranks";
    // One of the ranks that run by then, by a number that is drawn.
    const Outcome first = shell(sweep + " & launcher=$!\nsleep " + moment(5.0) +
                                "\nset -- $(pgrep -P $launcher -f 'simulate_batch sweep.yaml')\n"
                                "[ $# -gt 0 ] && shift $(( " +
                                std::to_string(random() % 4) +
                                " % $# )) && kill -9 $1\n"
                                "wait $launcher");
    if (first.exitCode != 0) {
      ++interrupted;
      const Outcome second = shell(sweep);
      ASSERT_EQ(second.exitCode, 0) << second.err;
    }
    ASSERT_EQ(table("ranks"), table("whole")) << "kill " << kill;
    std::filesystem::remove_all(folder.path() / "ranks");
  }
  EXPECT_GT(interrupted, 10) << "kills that came while it ran";
  RecordProperty("interrupted", interrupted);
}

// The last run of one rank is begun by the other, which is far from its end when it is done.
TEST_F(KilledSweepLong, ARankLeavesWhatAnotherHasDone) {
  if (shell("command -v mpirun").exitCode != 0) GTEST_SKIP() << "no mpirun here";
  folder.write("late.yaml", "model: " + dataFile("robots/humanoid.urdf") +
                                "\npassive: true\nduration: 800\n"
                                "list: [{timestep: 0.001}, {timestep: 0.0025}]\n");
  const Outcome outcome = shell(
      "mpirun --allow-run-as-root --oversubscribe -n 2 simulate_batch late.yaml --quiet --out "
      "late");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
}

TEST_F(KilledSweepLong, ALauncherThatCarriesOnComesToAnEnd) {
  if (shell("command -v mpirun").exitCode != 0) GTEST_SKIP() << "no mpirun here";
  const Outcome outcome = shell(
      "mpirun --enable-recovery --allow-run-as-root --oversubscribe -n 3 simulate_batch sweep.yaml "
      "--quiet --out left & launcher=$!\nsleep 3\nkill -9 $(pgrep -n -P $launcher)\n"
      "for i in $(seq 90); do kill -0 $launcher 2>/dev/null || exit 0; sleep 1; done\n"
      "pkill -9 -P $launcher; kill -9 $launcher; exit 124");
  EXPECT_NE(outcome.exitCode, 124) << "it did not end";
  EXPECT_EQ(table("left"), table("whole"));
}

}  // namespace
}  // namespace softgauss::test
