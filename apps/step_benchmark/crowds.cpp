// SPDX-License-Identifier: Apache-2.0
#include "apps/step_benchmark/crowds.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <regex>
#include <vector>

#include "apps/step_benchmark/median.hpp"
#include "apps/step_benchmark/scaling.hpp"
#include "apps/step_benchmark/scenes.hpp"
#include "collision/unit_contacts.hpp"

namespace softgauss::app {
namespace {

constexpr int kHumanoids = 100;
constexpr int kSleepers = 1000;

/// A model, stepped in islands.
struct Crowd {
  Model model;
  collision::UnitContacts contacts;
  Islands islands;
  Crowd(Model m, bool sleeps)
      : model(std::move(m)), contacts(model), islands(model, &contacts, Sleep{.enabled = sleeps}) {}
  void step() {
    if (islands.step({}) == SolveStatus::notFinite)
      throw std::runtime_error("the scene became non-finite");
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
};

/// CPU time of this thread [µs].
double cpuTime() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

using Step = std::function<void()>;

struct Pair {
  double first, second;  ///< median times of a step [µs]
};

/// Pieces of both in turn; of each piece the mean, of the pieces the median.
Pair timeInTurn(const Step& first, const Step& second, int stepsOfFirst, int stepsOfSecond) {
  constexpr int kPieces = 21;
  std::vector<double> times[2];
  for (int piece = 0; piece < kPieces; ++piece)
    for (const int which : {0, 1}) {
      const Step& step = which == 0 ? first : second;
      const int count = which == 0 ? stepsOfFirst : stepsOfSecond;
      const double start = cpuTime();
      for (int i = 0; i < count; ++i) step();
      times[which].push_back((cpuTime() - start) / count);
    }
  return {median(times[0]), median(times[1])};
}

Pair asleep(const std::string& robots) {
  Crowd asleep(humanoids(robots, kHumanoids), true), awake(humanoids(robots, kHumanoids), false);
  // Each of the same humanoids lies still at the same time.
  int steps = 0;
  for (; asleep.islands.islandStats().awake > 0 || steps == 0; ++steps) asleep.step();
  awake.steps(steps);
  return timeInTurn([&] { asleep.step(); }, [&] { awake.step(); }, 100, 2);
}

/// A ball that rolls along x between rows of boxes that sleep, `sleepers` of them.
Model ballAmong(int sleepers) {
  ModelBuilder builder = boxesOnGround(sleepers, 0.6);
  ModelBuilder ball("ball");
  ball.base = BaseKind::floating;
  ball.X_WRoot.p = Vector3(-1.0, 0.3, 0.1);
  LinkSpec link;
  link.name = "ball";
  link.mass = 1.0;
  link.com = Vector3(0.0, 0.0, 0.01);
  link.I_Lcm = 0.004 * Matrix3::Identity();
  ball.link(link);
  GeometrySpec shape;
  shape.name = "ball";
  shape.link = "ball";
  shape.shape = Shape::sphere(0.1);
  ball.geometry(shape);
  builder.add(ball, "");
  return builder.build();
}

Pair mover() {
  Crowd among(ballAmong(kSleepers), true), alone(ballAmong(0), true);
  for (Crowd* crowd : {&among, &alone}) {
    crowd->steps(1000);
    // Its rows are those of the boxes that it passes; 50 cm/s, and it never stops.
    State state = crowd->islands.state();
    state.v.tail<6>() << 0.5, 0.0, 0.0, 0.0, 5.0, 0.0;
    crowd->islands.setState(state);
    crowd->steps(500);
    if (crowd->islands.islandStats().awake != 1)
      throw std::runtime_error("the ball is not alone awake");
  }
  return timeInTurn([&] { among.step(); }, [&] { alone.step(); }, 100, 100);
}

Pair robots(const std::string& folder, int count) {
  Crowd many(humanoids(folder, count), false), one(humanoids(folder, 1), false);
  many.steps(100);
  one.steps(100);
  const Pair pair = timeInTurn([&] { many.step(); }, [&] { one.step(); }, 5, 5);
  return {pair.first / count, pair.second};
}

Pair withoutIslands(const std::string& folder) {
  const std::unique_ptr<Scene> many = makeHumanoids(folder, kHumanoids);
  const std::unique_ptr<Scene> one = makeHumanoids(folder, 1);
  for (int i = 0; i < 100; ++i) many->step(), one->step();
  const Pair pair = timeInTurn([&] { many->step(); }, [&] { one->step(); }, 5, 5);
  return {pair.first / kHumanoids, pair.second};
}

Pair joint(const std::string& folder) {
  Crowd islands(humanoids(folder, kHumanoids), false);
  std::unique_ptr<Scene> scene = makeHumanoids(folder, kHumanoids);
  islands.steps(100);
  for (int i = 0; i < 100; ++i) scene->step();
  return timeInTurn([&] { islands.step(); }, [&] { scene->step(); }, 5, 5);
}

}  // namespace

std::map<std::string, double> crowdFigures(const std::string& robotsFolder,
                                           const std::string& filter) {
  const std::pair<const char*, std::function<Pair()>> pairs[] = {
      {"islands_asleep", [&] { return asleep(robotsFolder); }},
      {"islands_mover", [&] { return mover(); }},
      {"islands_robots", [&] { return robots(robotsFolder, kHumanoids); }},
      {"islands_few", [&] { return robots(robotsFolder, 16); }},
      {"islands_none", [&] { return withoutIslands(robotsFolder); }},
      {"islands_joint", [&] { return joint(robotsFolder); }}};
  std::map<std::string, double> figures;
  for (const auto& [name, time] : pairs) {
    if (!std::regex_search(name, std::regex(filter))) continue;
    const Pair pair = time();
    for (const auto& [key, value] : {std::pair{"first.us", pair.first},
                                     {"second.us", pair.second},
                                     {"ratio", pair.first / pair.second}}) {
      figures[fmt::format("{}.{}", name, key)] = value;
      fmt::print("{}.{} {:.4g}\n", name, key, value);
    }
    std::fflush(stdout);
  }
  return figures;
}

}  // namespace softgauss::app
