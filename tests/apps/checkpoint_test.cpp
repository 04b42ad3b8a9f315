// SPDX-License-Identifier: Apache-2.0
/// A run that is broken, even by kill -9, goes on from its checkpoint to the bits and the outputs
/// of the unbroken one.

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"
#include "tests/support/random.hpp"

namespace softgauss::test {
namespace {

namespace fs = std::filesystem;

const std::string kOutputs =
    " --quiet --log log.csv --contacts contacts.csv --summary s.json --view page.html ";
const std::string kCheckpoint = " --checkpoint run.checkpoint --checkpoint-every 0.05 ";

struct RunCase {
  const char* name;
  std::string arguments;
  double duration;  ///< [s]
};

std::vector<RunCase> runs() {
  const std::string arm = dataFile("robots/arm.urdf"), humanoid = dataFile("robots/humanoid.urdf");
  return {
      {"goals", arm + " --goals " + dataFile("goals/arm_through_limits.yaml"), 0.6},
      {"falling", humanoid + " --passive", 0.4},
      {"grip", dataFile("scenes/hand_and_ball.yaml") + " --report-error", 0.2},
      {"dormand-prince", arm + " --passive --integrator dormand-prince --report-error", 0.3},
      {"sleep", dataFile("scenes/two_arms.yaml") + " --sleep all", 0.9},
  };
}

std::string program(const RunCase& run, double duration) {
  return fmt::format("simulate_gdd {} --duration {} {}", run.arguments, duration, kOutputs);
}

/// A summary without what another process, or another clock, says.
nlohmann::json comparable(const fs::path& folder) {
  nlohmann::json summary = nlohmann::json::parse(readFile(folder / "s.json"));
  for (const char* key : {"origin", "wall_s", "real_time_factor", "time_us"}) summary.erase(key);
  return summary;
}

/// A log without the times of its steps.
std::vector<std::vector<std::string>> rowsOf(const fs::path& folder) {
  Csv log(readFile(folder / "log.csv"));
  for (const char* column : {"forward_us", "gdd_us", "step_us"})
    for (auto& row : log.rows) row[static_cast<std::size_t>(log.find(column))].clear();
  return log.rows;
}

void expectSameRun(const fs::path& folder, const fs::path& unbroken, const std::string& what) {
  EXPECT_EQ(comparable(folder).dump(1), comparable(unbroken).dump(1)) << what;
  EXPECT_EQ(rowsOf(folder), rowsOf(unbroken)) << what;
  EXPECT_EQ(readFile(folder / "contacts.csv"), readFile(unbroken / "contacts.csv")) << what;
  // Times of steps are packed with the rest.
  const auto size = [](const fs::path& f) {
    return static_cast<double>(fs::file_size(f / "page.html"));
  };
  EXPECT_NEAR(size(folder) / size(unbroken), 1.0, 0.01) << what;
}

TEST(Checkpoint, GoesOnToTheBitsAndOutputsOfTheUnbrokenRun) {
  for (const RunCase& run : runs()) {
    const io::TempFolder unbroken, broken;
    Outcome outcome = runShell(unbroken.path(), program(run, run.duration));
    ASSERT_EQ(outcome.exitCode, 0) << run.name << outcome.err;
    outcome = runShell(broken.path(), program(run, 0.4 * run.duration) + kCheckpoint);
    ASSERT_EQ(outcome.exitCode, 0) << run.name << outcome.err;
    outcome = runShell(broken.path(),
                       program(run, run.duration) + kCheckpoint + " --resume run.checkpoint");
    ASSERT_EQ(outcome.exitCode, 0) << run.name << outcome.err;
    EXPECT_EQ(outcome.err, "") << run.name;
    expectSameRun(broken.path(), unbroken.path(), run.name);
  }
}

/// Lets a run be killed `seconds` after its start, or after its first checkpoint, and go on.
/// Returns whether it went on from one.
bool killAndResume(const fs::path& folder, const RunCase& run, double seconds, bool waits) {
  const std::string command = program(run, run.duration) + kCheckpoint;
  const std::string wait =
      waits ? "while [ ! -s run.checkpoint ] && kill -0 $! 2>/dev/null; do sleep 0.005; done\n"
            : "";
  const Outcome killed = runShell(
      folder, fmt::format("{} & {}\nsleep {}; kill -9 $! 2>/dev/null; wait $!; rm -f *.part; true",
                          command, wait, seconds));
  EXPECT_EQ(killed.exitCode, 0) << killed.err;
  const bool resumes = fs::exists(folder / "run.checkpoint");
  const Outcome again = runShell(folder, command + (resumes ? " --resume run.checkpoint" : ""));
  EXPECT_EQ(again.exitCode, 0) << again.err;
  return resumes;
}

void killOften(const RunCase& run, int kills, std::uint64_t seed) {
  const io::TempFolder unbroken;
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(runShell(unbroken.path(), program(run, run.duration)).exitCode, 0);
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Random random(seed);
  int resumed = 0;
  for (int i = 0; i < kills; ++i) {
    const io::TempFolder folder;
    const double seconds = random.uniform(0.0, wall);
    resumed += killAndResume(folder.path(), run, seconds, i % 4 != 0);
    expectSameRun(folder.path(), unbroken.path(), fmt::format("kill {} at {} s", i, seconds));
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_GE(resumed, kills / 2);
}

TEST(Checkpoint, OutlivesKills) { killOften(runs()[0], 4, 1); }

// A run of some seconds, which writes a checkpoint every few hundredths of one.
TEST(CheckpointLong, OutlivesTwoHundredKills) {
  const RunCase standing{
      "standing",
      dataFile("robots/humanoid.urdf") + " --goals " + dataFile("goals/stand_and_reach.yaml"), 1.0};
  killOften(standing, 100, 2);
  if (!testing::Test::HasFailure()) killOften(runs()[0], 100, 3);
}

// A checkpoint is the old one or the new one, whenever it is looked at.
TEST(Checkpoint, IsWholeWheneverItIsRead) {
  const io::TempFolder folder;
  const RunCase run = runs()[0];
  // The run is longer than eight copies take on any machine, and is killed after the last one. (cp
  // leaves a file out that is replaced between its look and its opening; a redirection does not.)
  const Outcome outcome =
      runShell(folder.path(), program(run, 1000.0) +
                                  " --checkpoint run.checkpoint --checkpoint-every 0.002 & \n"
                                  "while [ ! -s run.checkpoint ]; do sleep 0.005; done\n"
                                  "for n in 0 1 2 3 4 5 6 7; do cat < run.checkpoint > copy$n; "
                                  "sleep 0.05; done; kill -9 $!; wait $!; true");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  int copies = 0;
  for (; fs::exists(folder.path() / fmt::format("copy{}", copies)); ++copies) {
    const Outcome resumed =
        runShell(folder.path(),
                 fmt::format("simulate_gdd {} --duration 0.001 --quiet --log l.csv --contacts "
                             "c.csv --view p.html --resume copy{}",
                             run.arguments, copies));
    // Its tables are others, so it is refused, but only after the whole checkpoint was read.
    EXPECT_NE(resumed.err.find("l.csv: log: cannot be written: No such file"), std::string::npos)
        << resumed.err;
  }
  EXPECT_EQ(copies, 8);
}

TEST(Checkpoint, IsWrittenAtAnInterruptionToo) {
  const io::TempFolder folder, unbroken;
  const std::string command = "env --default-signal=INT simulate_gdd " +
                              dataFile("robots/humanoid.urdf") +
                              " --passive --log log.csv --contacts contacts.csv --summary s.json "
                              "--view page.html --quiet ";
  ASSERT_EQ(runShell(unbroken.path(), command + "--duration 0.5").exitCode, 0);
  const Outcome interrupted = runShell(
      folder.path(), command +
                         "--duration 1000 --checkpoint c --checkpoint-every 900 &\n"
                         "while [ ! -s log.csv ]; do sleep 0.01; done; kill -INT $!; wait $!");
  ASSERT_EQ(interrupted.exitCode, 130) << interrupted.err;
  const nlohmann::json cut = nlohmann::json::parse(readFile(folder.path() / "s.json"));
  if (cut["simulated_s"].get<double>() < 0.5) {
    const Outcome resumed = runShell(folder.path(), command + "--duration 0.5 --resume c");
    ASSERT_EQ(resumed.exitCode, 0) << resumed.err;
    expectSameRun(folder.path(), unbroken.path(), "interrupted");
  }
}

/// Exit code and messages of a command that follows a run with a checkpoint.
Outcome afterARun(const std::string& then) {
  const io::TempFolder folder;
  const std::string arm = dataFile("robots/arm.urdf");
  const Outcome run = runShell(
      folder.path(), "cp " + arm +
                         " arm.urdf; simulate_gdd arm.urdf --passive --quiet "
                         "--duration 0.1 --log log.csv --checkpoint c --checkpoint-every 0.05\n");
  EXPECT_EQ(run.exitCode, 0) << run.err;
  return runShell(folder.path(), then);
}

TEST(Checkpoint, OfAnotherRunIsRefused) {
  const std::string base = "simulate_gdd arm.urdf --quiet --duration 0.2 --resume c ";
  const std::string same = base + "--passive --log log.csv ";
  EXPECT_EQ(afterARun(same).exitCode, 0);
  for (const auto& [command, message] : {
           std::pair{same + "--timestep 0.001",
                     "c: checkpoint: found a run without --timestep 0.001"},
           {base + "--passive", "found a run with --log"},
           {base + "--passive --log log.mcap", "log.mcap: --log: found MCAP, expected CSV"},
           {base + "--hold hand --log log.csv",
            "found a run with --passive, expected one with --hold hand"},
           {"sed -i 's/mass value=\"/&1/' arm.urdf; " + same, "found a run of other files"},
           {"sed -i 's/,/;/' log.csv; " + same, "log.csv: log: found another table"},
           {"head -n 5 log.csv > l; mv l log.csv; " + same, "log.csv: log: found "},
           {"rm log.csv; " + same, "log.csv: log: cannot be written: No such file"},
           {"printf x >> c; " + same, "c: checkpoint: found "},
           {"cp arm.urdf c; " + same, "c: checkpoint: found other bytes, expected that it begins"},
           {"head -c 200 c > d; mv d c; " + same, "c: checkpoint: found "},
           {"mkfifo f; simulate_gdd arm.urdf --passive --resume f", "f: file: is a named pipe"},
           {"simulate_gdd arm.urdf --passive --resume none", "none: file: cannot be read"},
           {same + "--live 0", "expected no --live"},
           {same + "--explain", "expected no --explain"},
           {"simulate_gdd arm.urdf --passive --checkpoint-every 1", "expected both"},
           {same + "--checkpoint d --checkpoint-every 0", "expected a number of seconds above 0"},
           {same + "--checkpoint log.csv", "--checkpoint would overwrite --log"},
           {same + "--checkpoint /nowhere/c", "cannot be written"},
       }) {
    const Outcome outcome = afterARun(command);
    EXPECT_EQ(outcome.exitCode, 2) << command;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << command << "\n" << outcome.err;
  }
}

// Rows that go to who reads them now: those that follow, without a header.
TEST(Checkpoint, LetsStandardOutputGoOn) {
  const std::string command = "simulate_gdd arm.urdf --passive --quiet --log - --duration ";
  const Outcome outcome = afterARun(command + "0.1 --checkpoint d > a.csv; " + command +
                                    "0.2 --resume d > b.csv; " + command +
                                    "0.2 > all.csv; head -n -1 a.csv | cat - b.csv | cut -d, -f1-9 "
                                    "> ab; cut -d, -f1-9 all.csv | cmp ab -");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.out << outcome.err;
}

}  // namespace
}  // namespace softgauss::test
