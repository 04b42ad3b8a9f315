// SPDX-License-Identifier: Apache-2.0
// Whole live runs: a process that is talked to, what it does, and the same again from a file.

#include <gtest/gtest.h>

#include <fstream>

#include "softgauss/io/replay/page.hpp"
#include "tests/apps/process.hpp"
#include "tests/io/temp_folder.hpp"
#include "tests/live/live_process.hpp"
#include "tests/simulation/quadruped.hpp"

namespace softgauss::test {
namespace {

using nlohmann::json;

const std::string kHumanoid = SOFTGAUSS_SOURCE_DIR "/data/robots/humanoid.urdf";
const std::string kArm = SOFTGAUSS_SOURCE_DIR "/data/robots/arm.urdf";

json summaryOf(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return json::parse(stream);
}

/// Little-endian numbers of a frame.
template <class T>
T at(const std::string& frame, std::size_t offset) {
  T value;
  std::memcpy(&value, frame.data() + offset, sizeof value);
  return value;
}

TEST(LiveRun, IsDraggedAndPlayedAgainToTheSameBits) {
  const io::TempFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  LiveProcess process({kHumanoid, "--record", file("drag.yaml"), "--summary", file("live.json"),
                       "--log", file("live.csv"), "--view", file("live.html"), "--timestep",
                       "0.004"});
  Client page(process.port());
  page.until([](const json& s) { return s["steps"] > 10; });
  EXPECT_EQ(page.ask("\"grab\": {\"link\": \"right_hand\", \"point\": [0, 0, 0], \"target\": [0.2, "
                     "-0.3, 1.0]}"),
            "");
  page.until([](const json& s) { return s["holding"] == "drag 1" && s["steps"] > 100; });
  EXPECT_EQ(page.ask("\"move\": {\"target\": [0.25, -0.3, 1.0]}"), "");
  EXPECT_EQ(
      page.ask("\"push\": {\"link\": \"torso\", \"point\": [0, 0, 0], \"force\": [10, 0, 0]}"), "");
  EXPECT_EQ(page.ask("\"let_go\": {}"), "");
  EXPECT_EQ(page.ask("\"pin\": {}"), "");
  EXPECT_EQ(page.ask("\"goal\": {\"goal\": \"damping\", \"rate\": 12}"), "");
  EXPECT_EQ(page.ask("\"gravity\": {\"acceleration\": [0, 0, -9]}"), "");
  EXPECT_EQ(page.ask("\"effect\": {\"effect\": \"coriolis\", \"on\": false}"), "");
  EXPECT_EQ(page.ask("\"pause\": {\"on\": true}"), "");
  EXPECT_EQ(page.ask("\"joint\": {\"joint\": \"left_elbow\", \"position\": 0.9}"), "");
  EXPECT_EQ(page.ask("\"advance\": {\"count\": 7}"), "");
  const json paused = page.until([](const json& s) { return s["paused"].get<bool>(); });
  EXPECT_EQ(page.ask("\"back\": {\"seconds\": 0.1}"), "");
  EXPECT_EQ(page.ask("\"pause\": {\"on\": false}"), "");
  page.until([&](const json& s) { return s["steps"] > paused["steps"].get<long>() + 50; });
  EXPECT_EQ(process.stop(), 130);

  const json live = summaryOf(file("live.json"));
  EXPECT_EQ(live["outcome"], "interrupted");
  EXPECT_TRUE(std::filesystem::exists(file("live.html")));
  EXPECT_NE(process.out().find("state hash: " + live["state_hash"].get<std::string>()),
            std::string::npos);
  const std::string goals = live["goals"].dump();
  EXPECT_NE(goals.find("drag 1"), std::string::npos);
  EXPECT_EQ(goals.find("drag 2"), std::string::npos) << "nobody asked for it";
  const Csv log(readFile(file("live.csv")));
  EXPECT_GE(log.find("error:drag 1 [m]"), 0);

  const Outcome again = simulate({kHumanoid, "--play", file("drag.yaml"), "--summary",
                                  file("again.json"), "--timestep", "0.004", "--quiet"});
  EXPECT_EQ(again.exitCode, 0) << again.err;
  const json played = summaryOf(file("again.json"));
  EXPECT_EQ(played["state_hash"], live["state_hash"]);
  EXPECT_EQ(played["steps"], live["steps"]);
}

TEST(LiveRun, LetsGoWhatAPageHoldsThatIsGone) {
  // A drag and a push end with the page that held them; a pinned point stays. All of it is
  // recorded.
  const io::TempFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  LiveProcess process({kArm, "--record", file("held.yaml"), "--summary", file("live.json")});
  {
    Client page(process.port());
    const std::string place = "\"point\": [0, 0, 0], \"target\": [0.3, 0.3, 0.5]}";
    EXPECT_EQ(page.ask("\"grab\": {\"link\": \"forearm\", " + place), "");
    EXPECT_EQ(page.ask("\"pin\": {}"), "");
    EXPECT_EQ(page.ask("\"grab\": {\"link\": \"hand\", " + place), "");
    EXPECT_EQ(
        page.ask("\"push\": {\"link\": \"hand\", \"point\": [0, 0, 0], \"force\": [3, 0, 0]}"), "");
    page.until([](const json& s) { return s["holding"] == "drag 2"; });
  }
  Client next(process.port());
  const json status = next.until([](const json& s) { return s["holding"] == ""; });
  const auto isOn = [&](const std::string& name) {
    for (const json& goal : status["goals"])
      if (goal["name"] == name) return goal["on"].get<bool>();
    return false;
  };
  EXPECT_TRUE(isOn("drag 1"));
  for (const json& goal : status["goals"])
    if (goal["name"] == "drag 1") {
      EXPECT_EQ(goal["weight_default"], true) << goal;
    }
  EXPECT_FALSE(isOn("drag 2"));
  next.until([&](const json& s) { return s["steps"] > status["steps"].get<long>() + 50; });
  EXPECT_EQ(process.stop(), 130);
  const std::string record = readFile(file("held.yaml"));
  EXPECT_NE(record.find("release: {}"), std::string::npos);
  EXPECT_NE(record.find("let_go: {}"), std::string::npos);
  const Outcome again =
      simulate({kArm, "--play", file("held.yaml"), "--summary", file("again.json"), "--quiet"});
  EXPECT_EQ(again.exitCode, 0) << again.err;
  EXPECT_EQ(summaryOf(file("again.json"))["state_hash"],
            summaryOf(file("live.json"))["state_hash"]);
}

/// Position or target of a joint in a status, by its place among the joints.
double jointOf(const json& status, const char* key, std::size_t i) { return status[key][i]; }

TEST(LiveRun, GoesToStatesAndToWhatWasStored) {
  const QuadrupedPackage package;
  const auto file = [&](const char* name) { return (package.folder.path() / name).string(); };
  const std::vector<std::string> run = {package.urdf, "--state", "standing", "--timestep", "0.004"};
  std::vector<std::string> live = run;
  live.insert(live.end(), {"--record", file("states.yaml"), "--summary", file("live.json")});
  LiveProcess process(live);
  Client page(process.port());
  // Joints are those of the URDF in their order: hip and knee of FL, FR, RL, RR.
  json status = page.until([](const json& s) { return s["steps"] > 50; });
  ASSERT_EQ(status["joints"].size(), 8u);
  EXPECT_EQ(jointOf(status, "targets", 1), -1.4);
  EXPECT_EQ(page.ask("\"store\": {\"slot\": 3}"), "");
  EXPECT_EQ(page.ask("\"pause\": {\"on\": true}"), "");
  EXPECT_EQ(page.ask("\"state\": {\"state\": \"kneeling\"}"), "");
  status = page.until([](const json& s) { return s["stored"] == json({3}) && s["paused"]; });
  for (std::size_t knee = 1; knee < 8; knee += 2) {
    EXPECT_EQ(jointOf(status, "joints", knee), -2.5);
    EXPECT_EQ(jointOf(status, "targets", knee), -2.5) << "what holds a posture holds the state";
  }
  EXPECT_EQ(page.ask("\"recall\": {\"slot\": 3}"), "");
  status = page.until([](const json& s) { return s["joints"][1] > -2.0; });
  // It stood: within what it had sunk by then of the state.
  for (std::size_t knee = 1; knee < 8; knee += 2)
    EXPECT_NEAR(jointOf(status, "joints", knee), -1.4, 0.02);

  const auto refused = [&](const char* what, const char* why) {
    const std::string answer = page.ask(what);
    EXPECT_NE(answer.find(why), std::string::npos) << answer;
  };
  refused("\"recall\": {\"slot\": 2}", "nothing is stored in 2");
  refused("\"recall\": {\"slot\": 0}", "slot");
  refused("\"store\": {\"slot\": 10}", "slot");
  refused("\"store\": {\"slot\": 1.5}", "whole number");
  refused("\"state\": {\"state\": \"stending\"}", "did you mean 'standing'?");

  // A joint of a running run is sought by the posture, as far as the other legs let it.
  EXPECT_EQ(jointOf(status, "targets", 2), 0.7) << "postures too are as they were";
  EXPECT_EQ(page.ask("\"pause\": {\"on\": false}"), "");
  EXPECT_EQ(page.ask("\"joint\": {\"joint\": \"FR_hip\", \"position\": 0.8}"), "");
  status = page.until([](const json& s) { return s["joints"][2] > 0.71; });
  EXPECT_EQ(jointOf(status, "targets", 2), 0.8);
  EXPECT_EQ(page.ask("\"reset\": {}"), "");
  status = page.until([](const json& s) { return s["targets"][2] == 0.7; });
  const long steps = status["steps"];
  page.until([&](const json& s) { return s["steps"] > steps + 50; });
  EXPECT_EQ(process.stop(), 130);

  std::vector<std::string> again = run;
  again.insert(again.end(),
               {"--play", file("states.yaml"), "--summary", file("again.json"), "--quiet"});
  const Outcome outcome = simulate(again);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_EQ(summaryOf(file("again.json"))["state_hash"],
            summaryOf(file("live.json"))["state_hash"]);
}

// Torques alone, or nothing: there is no posture that could seek a joint.
TEST(LiveRun, JointsOfARunWithoutPostureMoveWhereItIsPaused) {
  LiveProcess process({kArm, "--passive"});
  Client page(process.port());
  const json status = page.until([](const json& s) { return s["steps"] > 10; });
  EXPECT_TRUE(status["targets"].empty());
  const std::string joint = "\"joint\": {\"joint\": \"elbow_pitch\", \"position\": 0.4}";
  const std::string answer = page.ask(joint);
  EXPECT_NE(answer.find("paused"), std::string::npos) << answer;
  EXPECT_EQ(page.ask("\"pause\": {\"on\": true}"), "");
  EXPECT_EQ(page.ask(joint), "");
  EXPECT_EQ(process.stop(), 130);
}

TEST(LiveRun, PausesBeforeAStepThatIsRefused) {
  // Whatever is asked for: the state stays, and the run goes on from it or from before.
  const std::string hard[] = {
      "\"push\": {\"link\": \"hand\", \"point\": [0, 0, 1e6], \"force\": [1e6, 0, 0]}",
      "\"push\": {\"link\": \"hand\", \"point\": [1e6, 1e6, 1e6], \"force\": [1e6, 1e6, -1e6]}",
      "\"push\": {\"link\": \"hand\", \"point\": [1e6, 0, 0], \"force\": [0, 0, 1e6]}"};
  const io::TempFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  LiveProcess process({kArm, "--record", file("hard.yaml"), "--summary", file("live.json")});
  Client page(process.port());
  for (const std::string& push : hard) {
    const long steps = page.until([](const json& s) { return !s["paused"]; })["steps"];
    page.until([&](const json& s) { return s["steps"] > steps + 60; });
    EXPECT_EQ(page.ask(push), "");
    const json paused = page.until([](const json& s) { return s["paused"].get<bool>(); });
    EXPECT_NE(paused["told"].dump().find("the run is paused"), std::string::npos);
    // The same again is refused again, and changes nothing.
    EXPECT_EQ(page.ask("\"pause\": {\"on\": false}"), "");
    const json again = page.until([](const json& s) { return s["paused"].get<bool>(); });
    EXPECT_EQ(again["steps"], paused["steps"]);
    EXPECT_EQ(page.ask("\"let_go\": {}"), "");
    EXPECT_EQ(page.ask("\"reset\": {}"), "");
    EXPECT_EQ(page.ask("\"pause\": {\"on\": false}"), "");
  }
  const long steps = page.until([](const json& s) { return !s["paused"]; })["steps"];
  page.until([&](const json& s) { return s["steps"] > steps + 60; });
  EXPECT_EQ(process.stop(), 130);
  const Outcome again =
      simulate({kArm, "--play", file("hard.yaml"), "--summary", file("again.json"), "--quiet"});
  EXPECT_EQ(again.exitCode, 0) << again.err;
  EXPECT_EQ(summaryOf(file("again.json"))["state_hash"],
            summaryOf(file("live.json"))["state_hash"]);
}

TEST(LiveRun, PlaysTheEventsOfItsModelAlone) {
  const io::TempFolder folder;
  const std::string file = (folder.path() / "other.yaml").string();
  std::ofstream(file) << "model: 'humanoid'\ntimestep: 0.002\nevents: []\nsteps: 10\n";
  const Outcome outcome = simulate({kArm, "--play", file});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.err.find("'humanoid'"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("'arm'"), std::string::npos) << outcome.err;
}

TEST(LiveRun, TellsWhichGoalsAreInForce) {
  // At 2 s of a task: the goals of other times are told as such, with their times and orientation.
  LiveProcess process({SOFTGAUSS_SOURCE_DIR "/data/scenes/arm_picks.yaml"});
  Client page(process.port());
  const json now = page.until([](const json& s) { return s["time"] > 1.1; });
  int acting = 0;
  for (const json& goal : now["goals"]) {
    const double start = goal.value("start", -1.0), end = goal.value("end", 1e9);
    EXPECT_EQ(goal["acts"], start <= now["time"] && now["time"] < end) << goal;
    if (goal["acts"]) ++acting;
    EXPECT_EQ(goal.contains("target"), goal.contains("quaternion")) << goal;
  }
  EXPECT_GT(acting, 1);
  EXPECT_LT(acting, static_cast<int>(now["goals"].size()));
  EXPECT_EQ(process.stop(), 130);
}

TEST(LiveRun, EndsInOrderWhenItIsInterruptedAtOnce) {
  // As soon as the address is told; several times, for it is a race.
  for (int i = 0; i < 5; ++i) {
    LiveProcess process({kArm});
    EXPECT_EQ(process.stop(), 130);
  }
}

TEST(LiveRun, DraggedPointsComeByMinimumJerk) {
  const io::TempFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  LiveProcess process({kArm, "--record", file("drag.yaml"), "--summary", file("live.json")});
  Client page(process.port());
  const std::string grab =
      "\"grab\": {\"link\": \"hand\", \"point\": [0, 0, 0], \"target\": [0.5, 0.3, 0.5], "
      "\"weight\": 1e6, \"duration\": ";
  EXPECT_NE(page.ask(grab + "0}"), "") << "no time at all";
  EXPECT_EQ(page.ask(grab + "0.6}"), "");
  const json held = page.until([](const json& s) { return s["holding"] == "drag 1"; });
  const auto drag = [](const json& s) {
    for (const json& goal : s["goals"])
      if (goal["name"] == "drag 1") return goal;
    return json();
  };
  EXPECT_EQ(drag(held)["duration"], 0.6);
  EXPECT_EQ(drag(held)["weight_unit"], "kg");
  EXPECT_FALSE(drag(held).contains("weight_default"));
  // Another place while it is under way: it comes there all the same. The posture holds back a
  // hundredth of what it would at 1e4 kg, 33 mm.
  EXPECT_EQ(page.ask("\"move\": {\"target\": [0.45, 0.25, 0.5]}"), "");
  const long steps = held["steps"];
  const json there = page.until([&](const json& s) { return s["steps"] > steps + 1500; });
  json error;
  for (const json& one : there["errors"])
    if (one["name"] == "drag 1") error = one;
  ASSERT_EQ(error["unit"], "m") << there["errors"];
  EXPECT_LT(error["value"], 0.01);
  EXPECT_EQ(page.ask("\"pin\": {}"), "");
  EXPECT_EQ(process.stop(), 130);
  const Outcome again =
      simulate({kArm, "--play", file("drag.yaml"), "--summary", file("again.json"), "--quiet"});
  EXPECT_EQ(again.exitCode, 0) << again.err;
  EXPECT_EQ(summaryOf(file("again.json"))["state_hash"],
            summaryOf(file("live.json"))["state_hash"]);
}

TEST(LiveRun, IsLeftAloneByWhoOnlyWatchesOrIsRefused) {
  // The same run with and without hostile pages: the same bits, as nothing of theirs was done.
  const io::TempFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  const Outcome alone = simulate(
      {kArm, "--posture", "--duration", "0.6", "--summary", file("alone.json"), "--quiet"});
  ASSERT_EQ(alone.exitCode, 0) << alone.err;
  LiveProcess process({kArm, "--posture", "--duration", "0.6", "--summary", file("live.json")});
  {
    Client writer(process.port());
    writer.next("writes");
    EXPECT_NE(
        writer.ask("\"grab\": {\"link\": \"nobody\", \"point\": [0,0,0], \"target\": [0,0,0]}"),
        "");
    EXPECT_NE(writer.ask("\"joint\": {\"joint\": \"elbow_pitch\", \"position\": 9}"), "");
    EXPECT_NE(writer.ask("\"advance\": {\"count\": 1}"), "") << "of a run that goes on";
    EXPECT_NE(writer.ask("\"move\": {\"target\": [0, 0, 0]}"), "");
    exchange(process.port(), std::string(1000, '\xff'), 0.05);
  }
  while (!std::filesystem::exists(file("live.json")))
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(process.stop(), 0);
  EXPECT_EQ(summaryOf(file("live.json"))["state_hash"],
            summaryOf(file("alone.json"))["state_hash"]);
}

TEST(LiveRun, ShowsFramesOfItsState) {
  LiveProcess process({kArm, "--passive"});
  Client page(process.port());
  page.until([](const json& s) { return s["steps"] > 100; });
  ASSERT_GT(page.frames(), 1);
  const std::string& frame = page.frame();
  EXPECT_EQ(frame.substr(0, 8), "SGFRAME1");
  const auto bodies = at<std::uint32_t>(frame, 24), goals = at<std::uint32_t>(frame, 28),
             contacts = at<std::uint32_t>(frame, 32);
  EXPECT_GT(bodies, 1u);
  EXPECT_EQ(frame.size(), 40 + 4 * (13 * bodies + 6 + 6 * goals + 11 * contacts));
  EXPECT_GT(at<double>(frame, 8), 0.0);
  EXPECT_EQ(page.ask("\"grab\": {\"link\": \"tool\", \"point\": [0,0,0], \"target\": [0,0,0]}")
                    .find("pushed") == std::string::npos,
            false)
      << "nothing drives a passive arm";
  EXPECT_EQ(process.stop(), 130);
}

TEST(LiveRun, RefusesOptionsThatDoNotGoTogether) {
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{kArm, "--record", "x.yaml", "--passive"}, "--live"},
      {{kArm, "--live-address", "0.0.0.0", "--passive"}, "--live"},
      {{kArm, "--live", "70000", "--passive"}, "65535"},
      {{kArm, "--live", "0", "--play", "x.yaml"}, "one of"},
      {{kArm, "--live", "0", "--live-address", "moon", "--passive"}, "moon"},
      {{kArm, "--live", "0", "--live-address", "127.evil", "--passive"}, "127.evil"},
      {{kArm, "--play", "/nowhere.yaml"}, "nowhere.yaml"},
  };
  for (const auto& [arguments, why] : cases) {
    const Outcome outcome = simulate(arguments);
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_NE(outcome.err.find(why), std::string::npos) << why << " -> " << outcome.err;
  }
}

}  // namespace
}  // namespace softgauss::test
