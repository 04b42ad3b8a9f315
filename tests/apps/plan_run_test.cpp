// SPDX-License-Identifier: Apache-2.0
/// --plan and --mpc as a user runs them. What is refused is in tests/bad_input.

#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

std::string task(const std::string& name) { return dataFile("plans/" + name + ".yaml"); }

TEST(PlanRun, PlansActsOutAndTells) {
  const io::TempFolder folder;
  const std::string log = folder.path() / "log.csv", file = folder.path() / "summary.json",
                    page = folder.path() / "page.html";
  const Outcome outcome =
      simulate({task("cart_pole"), "--plan", "--log", log, "--summary", file, "--view", page});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  for (const char* says : {"planned 60 knots of 0.05 s", "root force 0",
                           "\nplanned:", "\ncarried out:", "farthest from the plan's end is"})
    EXPECT_NE(outcome.out.find(says), std::string::npos) << says << "\n" << outcome.out;
  EXPECT_EQ(outcome.err, "");  // no terminal, no progress
  // As long as the plan, in steps of the simulator.
  EXPECT_EQ(Csv(readFile(log)).rows.size(), 1501u);
  EXPECT_GT(readFile(page).size(), 100000u);
  const auto plan = nlohmann::json::parse(readFile(file))["plan"];
  EXPECT_EQ(plan["outcome"], "carried out");
  EXPECT_EQ(plan["root_force"], 0.0);
  EXPECT_LE(plan["gap"], 1e-10);
  EXPECT_NEAR(plan["cost"], plan["planned_cost"], 0.02 * plan["planned_cost"].get<double>());
  EXPECT_NEAR(plan["cost"].get<double>(),
              plan["running_cost"].get<double>() + plan["effort_cost"].get<double>() +
                  plan["final_cost"].get<double>(),
              1e-12);
  EXPECT_FALSE(plan.contains("ticks"));
}

// Translucent, beside the run: what a page holds for --view-with.
TEST(PlanRun, ShowsThePlanInThePage) {
  const io::TempFolder folder;
  const std::string page = folder.path() / "page.html";
  const auto bytes = [&](const std::string& option) {
    EXPECT_EQ(simulate({task("cart_pole"), option, "--duration", "0.1", "--view", page}).exitCode,
              0);
    return readFile(page).size();
  };
  EXPECT_GT(bytes("--plan"), bytes("--passive") + 3000u);
}

// Beside what was planned.
TEST(PlanRun, DrawsWhatItCosts) {
  const io::TempFolder folder;
  const std::string file = folder.path() / "run.svg";
  for (const char* option : {"--plan", "--mpc"}) {
    ASSERT_EQ(simulate({task("cart_pole"), option, "--duration", "0.2", "--plot", file}).exitCode,
              0);
    const std::string svg = readFile(file);
    for (const char* says : {"Cost of the plan [1/s]", "states, planned", "control, planned"})
      EXPECT_NE(svg.find(says), std::string::npos) << says;
  }
}

TEST(PlanRun, PlansAnewWhileItRuns) {
  const io::TempFolder folder;
  const std::string file = folder.path() / "summary.json";
  const Outcome outcome =
      simulate({task("cart_pole"), "--mpc", "--duration", "1", "--summary", file});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("\nplanned anew:"), std::string::npos) << outcome.out;
  const auto ticks = nlohmann::json::parse(readFile(file))["plan"]["ticks"];
  EXPECT_GE(ticks["count"], 49);
  EXPECT_EQ(ticks["failed"], 0);
  EXPECT_GT(ticks["p999_ms"], 0.0);
  EXPECT_GE(ticks["p999_ms"], ticks["p50_ms"]);
}

TEST(PlanRun, GivesTheSameBitsAgain) {
  const io::TempFolder folder;
  std::string hashes[2];
  for (std::string& hash : hashes) {
    const std::string file = folder.path() / "summary.json";
    EXPECT_EQ(simulate({task("hopper"), "--mpc", "--duration", "0.3", "--summary", file}).exitCode,
              0);
    hash = nlohmann::json::parse(readFile(file))["state_hash"];
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(PlanRun, IsJudgedByWhatIsMissing) {
  const Outcome cut = simulate({task("cart_pole"), "--plan", "--duration", "1"});
  EXPECT_NE(cut.out.find("\ncut short:"), std::string::npos) << cut.out;
  // By steps of first order, as long as the plan's, the pole does not get up.
  const Outcome lost = simulate(
      {task("cart_pole"), "--plan", "--timestep", "0.05", "--integrator", "semi-implicit-euler"});
  EXPECT_NE(lost.out.find("\nlost:"), std::string::npos) << lost.out;
}

// A cart whose effort is too dear, so that its plan holds still, and an acrobot that is up and
// falls when its plan has ended, for nothing is planned anew.
TEST(PlanRun, SaysWhatSomebodyWouldWhoWatched) {
  const io::TempFolder folder;
  const std::string text = "robots:\n  - urdf: " + dataFile("plans/cart_pole.urdf") +
                           "\nplan:\n  knots: 10\n  effort: 1e9\n  final: {position: 1}\n"
                           "  target: {joints: {slide: 1}}\n";
  const Outcome still = simulate({folder.write("still.yaml", text), "--plan"});
  EXPECT_NE(still.out.find("\nno nearer:"), std::string::npos) << still.out;
  const Outcome fell = simulate({task("acrobot"), "--plan", "--duration", "6"});
  EXPECT_NE(fell.out.find("\nlost after its end:"), std::string::npos) << fell.out;
}

/// Of a hop, by `how` (--plan or --mpc): the longest flight [s], and where it ends.
std::pair<double, double> hopped(const std::string& how) {
  const io::TempFolder folder;
  const std::string file = folder.path() / "hop.csv";
  const Outcome hop = simulate({task("hop"), how, "--duration", "3", "--log", file});
  EXPECT_NE(hop.out.find("\ncarried out:"), std::string::npos) << hop.out;
  std::istringstream log(readFile(file));
  std::string line;
  std::getline(log, line);
  double flight = 0.0, longest = 0.0, x = 0.0, last = 0.0;
  while (std::getline(log, line)) {
    double t, z, pitch, knee, ankle;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", &t, &x, &z, &pitch, &knee, &ankle) !=
        6)
      continue;
    // Of the foot's two balls, from the torso's place by the lengths of thigh and shank.
    const double foot = pitch + knee + ankle,
                 height = z - 0.2 * std::cos(pitch) - 0.4 * std::cos(pitch + knee),
                 lowest = std::min(height - 0.15 * std::sin(foot), height + 0.05 * std::sin(foot)) -
                          0.03;
    flight = lowest > 0.01 ? flight + t - last : 0.0;
    longest = std::max(longest, flight), last = t;
  }
  return {longest, x};
}

// Made anew while it flies and lands, too.
TEST(PlanRun, AHopperHopsHalfAMetreAndStands) {
  for (const char* how : {"--plan", "--mpc"}) {
    const auto [flight, x] = hopped(how);
    EXPECT_GT(flight, 0.15) << how;
    EXPECT_NEAR(x, 0.5, 0.03) << how;
  }
}

// An object of the scene is what the plan is about: contacts do it.
TEST(PlanRun, ABoxIsPushedAndABallIsTurnedInTheHand) {
  const Outcome push = simulate({task("push"), "--plan"}),
                turn = simulate({task("hand_turns_ball"), "--mpc", "--duration", "2"});
  for (const Outcome* outcome : {&push, &turn})
    EXPECT_NE(outcome->out.find("\ncarried out:"), std::string::npos) << outcome->out;
}

/// A hand that is to come to a place, which an event moves; what happens to it by the events.
struct Moved {
  Moved(const std::string& events, const std::string& how)
      : outcome(simulate(
            {folder.write(
                 "reach.yaml",
                 "robots:\n  - urdf: " + dataFile("robots/arm.urdf") +
                     "\nplan:\n  knots: 20\n  effort: 1e-3\n"
                     "  running: {velocity: 0.02, points: {hand: {target: [0.5, 0.3, 0.5], "
                     "weight: 10}}}\n"
                     "  final: {velocity: 20, points: {hand: {target: [0.5, 0.3, 0.5], "
                     "weight: 2000}}}\n"),
             how, "--summary", folder.path() / "summary.json", "--play",
             folder.write("events.yaml", "model: 'reach'\ntimestep: 0.002\nevents:\n" + events)})) {
    if (outcome.exitCode == 0)
      summary = nlohmann::json::parse(readFile(folder.path() / "summary.json"));
  }
  io::TempFolder folder;
  Outcome outcome;
  nlohmann::json summary;
};

// The final terms, ½ 2000 |e|² of a hand that rests, are those of the place it was moved to; they
// are 380 there where the hand was.
TEST(PlanRun, FollowsATargetThatMoves) {
  const std::string events =
      "  - {step: 500, target: {goal: 'plan hand', place: [0.45, -0.3, 0.4]}}\nsteps: 1500\n";
  const Moved moved(events, "--mpc"), again(events, "--mpc");
  ASSERT_EQ(moved.outcome.exitCode, 0) << moved.outcome.err;
  EXPECT_EQ(moved.summary["plan"]["outcome"], "carried out") << moved.outcome.out;
  EXPECT_LT(moved.summary["plan"]["final_cost"], 0.5 * 2000 * 0.005 * 0.005);
  EXPECT_EQ(moved.summary["plan"]["ticks"]["failed"], 0);
  EXPECT_EQ(moved.summary["state_hash"], again.summary["state_hash"]);
}

// As it was at the start, the target too: the plan there is the first one again.
TEST(PlanRun, PlansAnewWhereSomebodyGoesBack) {
  const std::string rest = "  - {step: 0, factor: {value: 1}}\nsteps: 1000\n",
                    moved =
                        "  - {step: 300, target: {goal: 'plan hand', place: [0.45, -0.3, 0.4]}}\n"
                        "  - {step: 600, reset: {}}\nsteps: 1600\n";
  for (const char* how : {"--plan", "--mpc"}) {
    const bool recedes = std::string(how) == "--mpc";
    const Moved straight(rest, how),
        back(recedes ? moved : "  - {step: 600, reset: {}}\nsteps: 1600\n", how);
    ASSERT_EQ(back.outcome.exitCode, 0) << how << back.outcome.err;
    EXPECT_EQ(back.summary["plan"]["cost"], straight.summary["plan"]["cost"]) << how;
    EXPECT_EQ(back.summary["plan"]["outcome"], "carried out") << how;
  }
}

TEST(PlanRun, RefusesEventsOfWhichPlansDoNotKnow) {
  for (const auto& [event, how, says] :
       {std::tuple{"gravity: {acceleration: [0, 0, -1]}", "--mpc", "as it was loaded"},
        {"effect: {effect: 'gravity', on: false}", "--mpc", "as it was loaded"},
        {"target: {goal: 'plan hand', place: [0.45, -0.3, 0.4]}", "--plan", "no place"}}) {
    const Moved moved(std::string("  - {step: 5, ") + event + "}\nsteps: 10\n", how);
    EXPECT_EQ(moved.outcome.exitCode, 2) << event;
    EXPECT_NE(moved.outcome.err.find(says), std::string::npos) << moved.outcome.err;
  }
}

TEST(PlanRun, IsExplained) {
  const Outcome outcome = simulate({task("hopper"), "--mpc", "--explain"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("plan: 40 knots of 0.05 s, planned anew 50 times a second"),
            std::string::npos)
      << outcome.out;
  EXPECT_EQ(outcome.out.find("planned 40 knots"), std::string::npos);
}

TEST(PlanRun, EndsWithCodeThreeWhereThereIsNoPlan) {
  const io::TempFolder folder;
  const std::string text = "robots:\n  - {urdf: " + dataFile("plans/cart_pole.urdf") +
                           ", joint_velocities: {hinge: 1e5}}\nplan: {knots: 10}\n";
  const Outcome outcome = simulate({folder.write("fast.yaml", text), "--plan"});
  EXPECT_EQ(outcome.exitCode, 3) << outcome.out;
  EXPECT_NE(outcome.err.find("no plan was found"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("try"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace softgauss::test
