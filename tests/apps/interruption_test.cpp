// SPDX-License-Identifier: Apache-2.0
/// What becomes of outputs when a run is ended from outside, or when there is no room for them.

#include <csignal>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

namespace fs = std::filesystem;

std::set<std::string> namesIn(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

std::string arm() { return dataFile("robots/arm.urdf") + " --passive --quiet "; }

/// A long run that gets signals once its log is there; then its exit code. Of a model whose steps
/// take their time: its log and page are read again. A shell without a terminal has what runs
/// behind it ignore SIGINT and SIGQUIT; env gives them back.
std::string signalled(const std::string& before, const std::string& signals) {
  return before + "env --default-signal=INT,QUIT simulate_gdd " + dataFile("robots/humanoid.urdf") +
         " --passive --quiet --duration 100000 --log log.csv --summary s.json --view page.html &\n"
         "while [ ! -s log.csv ]; do sleep 0.01; done\nsleep 0.3\n" +
         signals + "\nwait $!\n";
}

const std::set<std::string> kOutputs = {"log.csv", "page.html", "s.json"};

TEST(Interruption, ByEachSignalThatAsksForItEndsInOrder) {
  // Who started the tests may have had this ignored, as nohup has it.
  std::signal(SIGHUP, SIG_DFL);
  for (const char* signal : {"HUP", "TERM", "INT"}) {
    const io::TempFolder folder;
    const Outcome outcome =
        runShell(folder.path(), signalled("", std::string("kill -") + signal + " $!"));
    EXPECT_EQ(outcome.exitCode, 130) << signal << outcome.err;
    EXPECT_EQ(namesIn(folder.path()), kOutputs) << signal;
    const auto json = nlohmann::json::parse(readFile(folder.path() / "s.json"));
    EXPECT_EQ(json["outcome"], "interrupted") << signal;
    const Csv log(readFile(folder.path() / "log.csv"));
    EXPECT_EQ(log.rows.size(), json["steps"].get<std::size_t>() + 1);
  }
}

// nohup has SIGHUP ignored.
TEST(Interruption, BySighupIsIgnoredWhereItWas) {
  const io::TempFolder folder;
  const Outcome outcome =
      runShell(folder.path(), signalled("trap '' HUP\n", "kill -HUP $!; sleep 0.3; kill -TERM $!"));
  EXPECT_EQ(outcome.exitCode, 130);
  EXPECT_EQ(namesIn(folder.path()), kOutputs);
}

TEST(Interruption, ByOtherSignalsLeavesNothingHalfWritten) {
  for (const char* signals : {"kill -QUIT $!", "kill -USR1 $!", "kill -ALRM $!", "kill -ABRT $!"}) {
    const io::TempFolder folder;
    const Outcome outcome = runShell(folder.path(), signalled("ulimit -c 0\n", signals));
    EXPECT_GT(outcome.exitCode, 128) << signals;
    EXPECT_EQ(namesIn(folder.path()), std::set<std::string>{"log.csv"}) << signals;
  }
}

// A limit on the size of files stands for a full disk: the write fails in the same place. The page
// is smaller than the log.
TEST(FullDisk, StopsALongRunAtOnceAndKeepsWhatItHas) {
  const io::TempFolder folder;
  const Outcome outcome = runShell(
      folder.path(), "ulimit -f 8000\nsimulate_gdd " + arm() +
                         "--duration 100000 --log log.csv --summary s.json --view page.html");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.err.find("log.csv: log: cannot be written: File too large"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("stopped at t = "), std::string::npos) << outcome.err;
  EXPECT_GT(fs::file_size(folder.path() / "log.csv"), 250'000u);
  const auto json = nlohmann::json::parse(readFile(folder.path() / "s.json"));
  EXPECT_EQ(json["outcome"], "stopped");
  EXPECT_LT(json["simulated_s"].get<double>(), 1000.0);
  EXPECT_EQ(namesIn(folder.path()), kOutputs);
}

TEST(FullDisk, IsToldOfEachOutputWithItsReason) {
  const io::TempFolder folder;
  const Outcome outcome = runShell(
      folder.path(), "ulimit -f 1\nsimulate_gdd " + arm() +
                         "--duration 0.01 --summary s.json --view page.html --log /dev/null");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.err.find("page.html: replay page: cannot be written: File too large"),
            std::string::npos)
      << outcome.err;
  EXPECT_EQ(outcome.err.find("internal"), std::string::npos) << outcome.err;
  for (const std::string& name : namesIn(folder.path()))
    EXPECT_EQ(name.find(".part"), std::string::npos);
}

TEST(StandardOutput, ThatCannotBeWrittenIsAnError) {
  const io::TempFolder folder;
  for (const std::string& what :
       {arm() + "--explain", std::string("--help"), std::string("--version"),
        dataFile("robots/arm.urdf") + " --passive --duration 0.01"})
    for (const std::string to : {">/dev/full", ">&-"}) {
      const Outcome outcome = runShell(folder.path(), "simulate_gdd " + what + " " + to);
      EXPECT_EQ(outcome.exitCode, 2) << what << to;
      EXPECT_NE(outcome.err.find("standard output: cannot be written: "), std::string::npos)
          << what << to << ": " << outcome.err;
    }
  const Outcome pipe =
      runShell(folder.path(), "(simulate_gdd --help; echo $? >code) | (exec <&-; sleep 0.3)");
  EXPECT_EQ(readFile(folder.path() / "code"), "2\n");
  EXPECT_NE(pipe.err.find("Broken pipe"), std::string::npos) << pipe.err;
}

TEST(StandardError, ThatCannotBeWrittenChangesNothing) {
  const io::TempFolder folder;
  for (const char* to : {" 2>/dev/full", " 2>&-"}) {
    EXPECT_EQ(runShell(folder.path(), "simulate_gdd --no-such-option" + std::string(to)).exitCode,
              2);
    EXPECT_EQ(runShell(folder.path(), "simulate_gdd " + arm() + "--duration 0.01" + to).exitCode,
              0);
  }
}

// The log alone, so that it can be piped; the table of the run is on standard error.
TEST(StandardOutput, TakesAnOutput) {
  const io::TempFolder folder;
  const std::string run =
      "simulate_gdd " + dataFile("robots/arm.urdf") + " --passive --duration 0.01 --log ";
  const Outcome outcome = runShell(folder.path(), run + "-");
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const Csv log(outcome.out);
  EXPECT_EQ(log.rows.size(), 6u);
  for (const auto& row : log.rows) EXPECT_EQ(row.size(), log.columns.size());
  EXPECT_NE(outcome.err.find("simulated"), std::string::npos) << outcome.err;
  EXPECT_EQ(runShell(folder.path(), run + "/dev/stdout >file").exitCode, 0);
  EXPECT_EQ(Csv(readFile(folder.path() / "file")).rows.size(), 6u);
  EXPECT_EQ(namesIn(folder.path()), std::set<std::string>{"file"});
}

// A later output that cannot be made costs no earlier file its content.
TEST(Outputs, AreAllLookedAtBeforeAnyIsOverwritten) {
  for (const char* bad : {"--summary no/s.json", "--view no/page.html", "--plot no/such/p.svg",
                          "--plot page.png", "--reach nobody=0,0,1", "--goals no.yaml"}) {
    const io::TempFolder folder;
    folder.write("log.csv", "earlier");
    folder.write("page.html", "earlier");
    const bool goals = std::string(bad).find("s ") != std::string::npos && bad[2] == 'g';
    const std::string what = goals || bad[2] == 'r' ? "" : " --passive";
    const Outcome outcome =
        runShell(folder.path(), "simulate_gdd " + dataFile("robots/arm.urdf") + what +
                                    " --duration 0.01 --log log.csv " + bad);
    EXPECT_EQ(outcome.exitCode, 2) << bad << outcome.err;
    EXPECT_EQ(readFile(folder.path() / "log.csv"), "earlier") << bad;
    EXPECT_EQ(readFile(folder.path() / "page.html"), "earlier") << bad;
    EXPECT_EQ(namesIn(folder.path()), (std::set<std::string>{"log.csv", "page.html"})) << bad;
  }
}

TEST(StandardInput, IsAModelOrAFileOfOne) {
  const io::TempFolder folder;
  const std::string arm = dataFile("robots/arm.urdf");
  folder.write("scene.yaml", "robots:\n  - {urdf: " + arm + ", base: fixed}\n");
  folder.write("bad.yaml", "robots:\n  - {urdf: no.urdf}\n");
  folder.write("goals.yaml", "goals:\n  - hold: {link: hand}\n");
  const auto run = [&](const std::string& commands) { return runShell(folder.path(), commands); };
  const std::string end = " --duration 0.01 --quiet";
  EXPECT_EQ(run("simulate_gdd - --passive <" + arm + end).exitCode, 0);
  EXPECT_EQ(run("cat scene.yaml | simulate_gdd - --passive" + end).exitCode, 0);
  EXPECT_EQ(run("simulate_gdd " + arm + " --goals - <goals.yaml" + end).exitCode, 0);
  const Outcome bad = run("simulate_gdd - --passive <bad.yaml");
  EXPECT_EQ(bad.exitCode, 2);
  EXPECT_EQ(bad.err.rfind("standard input:2: robot 1: key 'urdf'", 0), 0u) << bad.err;
}

}  // namespace
}  // namespace softgauss::test
