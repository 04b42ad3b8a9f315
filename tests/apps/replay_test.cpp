// SPDX-License-Identifier: Apache-2.0
/// --view and --plot: a page and drawings from every run, however it ends.

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "tests/apps/process.hpp"
#include "tests/io/replay/payload_reader.hpp"

namespace softgauss::test {
namespace {

TEST(View, ShowsTheRunOfTheLog) {
  const io::TempFolder folder;
  const std::string log = folder.path() / "log.csv", page = folder.path() / "run.html",
                    plot = folder.path() / "run.svg";
  const Outcome outcome =
      simulate({dataFile("robots/humanoid.urdf"), "--reach", "right_hand=0.45,-0.25,1.1",
                "--duration", "0.2", "--log", log, "--view", page, "--plot", plot, "--quiet"});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const Csv csv((readFile(log)));
  const PayloadReader run(payloadOfPage(readFile(page)));
  EXPECT_EQ(run.header["outcome"]["kind"], "completed");
  EXPECT_EQ(run.header["model"], "humanoid");
  EXPECT_FALSE(run.header["visuals"].empty());
  const auto series = run.array<double>("series_time");
  ASSERT_EQ(series.size(), csv.rows.size());
  for (const auto& group : run.header["series"]["groups"])
    for (const auto& curve : group["curves"]) {
      const int column = csv.find("q:" + curve["name"].get<std::string>());
      if (group["name"] != "Joint positions" || column < 0) continue;
      const auto values = run.array<float>(curve["values"]);
      for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_EQ(values[i], static_cast<float>(std::stod(csv.rows[i][column])));
    }
  EXPECT_NE(readFile(plot).find("right_elbow"), std::string::npos);
}

TEST(View, ARunThatEndsBadlyShowsItsLastGoodStepAndWhy) {
  const io::TempFolder folder;
  const std::string page = folder.path() / "run.html", plots = folder.path() / "plots";
  const std::string torques =
      folder.write("torques.csv", "time_s,u:shoulder_yaw,u:elbow_pitch\n0,0,0\n0.098,1e12,-1e12\n");
  const Outcome outcome =
      simulate({dataFile("robots/arm.urdf"), "--torques", torques, "--duration", "1",
                "--integrator", "runge-kutta-4", "--view", page, "--plot", plots, "--quiet"});
  EXPECT_EQ(outcome.exitCode, 3);
  const PayloadReader run(payloadOfPage(readFile(page)));
  EXPECT_EQ(run.header["outcome"]["kind"], "non-finite");
  const std::string message = run.header["outcome"]["message"];
  EXPECT_NE(message.find("t = "), std::string::npos) << message;
  EXPECT_NE(message.find("joint '"), std::string::npos) << message;
  EXPECT_NE(outcome.err.find(message), std::string::npos) << "the same words as on stderr";
  for (const float x : run.array<float>("pose")) ASSERT_TRUE(std::isfinite(x));
  // The last frame is of the step before the one that failed.
  const double failed = std::stod(message.substr(message.find("t = ") + 4));
  EXPECT_NEAR(run.array<double>("frame_time").back(), failed, 0.01);
  EXPECT_FALSE(std::filesystem::is_empty(plots));
}

TEST(View, AnInterruptedRunShowsWhatWasSimulated) {
  const io::TempFolder folder;
  const std::string page = folder.path() / "run.html", log = folder.path() / "log.csv";
  const Outcome outcome = simulate({dataFile("robots/humanoid.urdf"), "--passive", "--duration",
                                    "10000", "--view", page, "--log", log, "--quiet"},
                                   0.5, log);
  EXPECT_EQ(outcome.exitCode, 130);
  const PayloadReader run(payloadOfPage(readFile(page)));
  EXPECT_EQ(run.header["outcome"]["kind"], "interrupted");
  EXPECT_GT(run.header["frames"]["count"], 2);
}

TEST(View, OutputsThatCannotBeMadeAreToldBeforeTheRun) {
  const io::TempFolder folder;
  const std::string arm = dataFile("robots/arm.urdf"), missing = folder.path() / "no" / "run";
  for (const auto& [option, file] :
       {std::pair<std::string, std::string>{"--view", missing + ".html"},
        {"--plot", missing + ".svg"},
        {"--plot", folder.path() / "run.png"}}) {
    const Outcome outcome = simulate({arm, "--passive", "--duration", "1e6", option, file});
    EXPECT_EQ(outcome.exitCode, 2) << option << ' ' << file;
    EXPECT_NE(outcome.err.find(file), std::string::npos) << outcome.err;
  }
  const std::string same = folder.path() / "run.svg";
  EXPECT_EQ(simulate({arm, "--passive", "--view", same, "--plot", same}).exitCode, 2);
}

// What a user has set up for gnuplot is for their own drawings.
TEST(View, UsersGnuplotSettingsDoNotReachThePlots) {
  const io::TempFolder home;
  home.write(".gnuplot", "set datafile separator comma\n");
  const std::string plot = home.path() / "it's a | name.svg", plain = home.path() / "plain.svg";
  const std::vector<std::string> run = {dataFile("robots/arm.urdf"),
                                        "--reach",
                                        "hand=0.5,0.3,0.5",
                                        "--duration",
                                        "0.1",
                                        "--quiet",
                                        "--plot"};
  const auto with = [&](const std::string& file) {
    std::vector<std::string> arguments = run;
    arguments.push_back(file);
    return simulate(arguments);
  };
  ASSERT_EQ(with(plain).exitCode, 0);
  const std::string old = std::getenv("HOME") ? std::getenv("HOME") : "";
  setenv("HOME", home.path().c_str(), 1);
  const Outcome outcome = with(plot);
  setenv("HOME", old.c_str(), 1);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  // The same curves: times of steps differ from run to run, sizes hardly do.
  EXPECT_NEAR(
      static_cast<double>(readFile(plot).size()) / static_cast<double>(readFile(plain).size()), 1.0,
      0.2);
}

TEST(View, ShowsARunBesideAnother) {
  const io::TempFolder folder;
  const std::string arm = dataFile("robots/arm.urdf"), first = folder.path() / "first.html",
                    second = folder.path() / "second.html";
  const auto view = [&](const std::string& page, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {arm,      "--passive", "--duration", "0.05",
                                          "--view", page,        "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return simulate(arguments);
  };
  ASSERT_EQ(view(first, {}).exitCode, 0);
  const std::string before = readFile(first);
  ASSERT_EQ(view(second, {"--view-with", first}).exitCode, 0);
  EXPECT_GT(readFile(second).size(), before.size());
  // Told before the run: what is no page, what is not there, itself.
  EXPECT_NE(view(second, {"--view-with", arm}).err.find("expected a page"), std::string::npos);
  EXPECT_EQ(view(second, {"--view-with", folder.path() / "nowhere.html"}).exitCode, 2);
  EXPECT_NE(view(first, {"--view-with", first}).err.find("overwrite"), std::string::npos);
  EXPECT_EQ(readFile(first), before);
  const Outcome alone = simulate({arm, "--passive", "--view-with", first});
  EXPECT_EQ(alone.exitCode, 2);
  EXPECT_NE(alone.err.find("--view"), std::string::npos);
}

TEST(View, OutputsNeverReplaceWhatWasReadOrWhatIsThere) {
  const io::TempFolder folder;
  const std::string urdf = readFile(dataFile("robots/arm.urdf"));
  const std::string robot = folder.write("arm.urdf", urdf);
  const std::string scene = folder.write("scene.yaml", "robots: [{urdf: arm.urdf}]\n");
  EXPECT_EQ(simulate({scene, "--duration", "0.01", "--quiet", "--view", robot}).exitCode, 2);
  EXPECT_EQ(readFile(robot), urdf);
  // A page stays until the next one is complete.
  const std::string page = folder.write("run.html", "the page of last night");
  EXPECT_EQ(simulate({scene, "--view", page, "--plot", folder.path() / "no" / "a.svg"}).exitCode,
            2);
  EXPECT_EQ(readFile(page), "the page of last night");
}

}  // namespace
}  // namespace softgauss::test
