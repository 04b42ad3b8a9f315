// SPDX-License-Identifier: Apache-2.0
#include "apps/step_benchmark/crowds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <regex>
#include <vector>

#include "apps/step_benchmark/in_turn.hpp"
#include "apps/step_benchmark/scaling.hpp"
#include "apps/step_benchmark/scenes.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/urdf.hpp"

namespace softgauss::app {
namespace {

constexpr int kHumanoids = 100;
constexpr int kSleepers = 1000;

using Goals = std::vector<std::unique_ptr<gdd::Goal>>;

/// A scene in which objects sleep, with goals or without.
std::unique_ptr<Scene> sleepers(ModelBuilder builder, bool sleeps = true,
                                const std::function<Goals(const Model&)>& goals = nullptr) {
  builder.options.sleep.enabled = sleeps;
  std::unique_ptr<Scene> scene = makeScene(builder.build());
  if (!goals) return scene;
  scene->controller = std::make_unique<gdd::GoalDirectedController>(scene->model);
  scene->controller->goals = goals(scene->model);
  return scene;
}

void steps(Scene& scene, int count) {
  for (int i = 0; i < count; ++i) scene.step();
}

int awake(const Scene& scene) {
  return static_cast<int>(scene.model.trees.size()) - scene.data->stats.asleepTrees;
}

using Step = std::function<void()>;

struct Pair {
  double first, second;  ///< median times of a step [µs]
};

Pair timePair(const Step& first, const Step& second, int stepsOfFirst, int stepsOfSecond) {
  const std::vector<double> times =
      timeInTurn({{nullptr, first, stepsOfFirst}, {nullptr, second, stepsOfSecond}});
  return {times[0], times[1]};
}

Pair asleep(const std::string& robots) {
  const auto asleep = sleepers(humanoidsOnGround(robots, kHumanoids)),
             all = sleepers(humanoidsOnGround(robots, kHumanoids), false);
  // Each of the same humanoids lies still at the same time.
  int count = 0;
  for (; count == 0 || awake(*asleep) > 0; ++count) asleep->step();
  steps(*all, count);
  const Pair pair = timePair([&] { asleep->step(); }, [&] { all->step(); }, 100, 2);
  wake(asleep->state.sleep, 0);
  asleep->step();
  if (awake(*asleep) != 1) throw std::runtime_error("to wake one humanoid has woken others");
  return pair;
}

/// An arm reaches beside boxes that sleep.
Pair reacher(const std::string& folder) {
  const auto goals = [](const Model& model) {
    Goals reach;
    reach.push_back(std::make_unique<gdd::Reach>(model, "arm/hand", Vector3(0.5, 0.3, 0.5)));
    reach.push_back(std::make_unique<gdd::VirtualDamping>());
    return reach;
  };
  const auto make = [&](int boxes) {
    ModelBuilder builder = boxesOnGround(boxes, 0.6);
    ModelBuilder arm = io::readUrdf(folder + "/arm.urdf");
    arm.X_WRoot.p = Vector3(-3.0, 0.0, 0.0);
    builder.add(arm, "arm");
    return sleepers(builder, true, goals);
  };
  const auto among = make(kSleepers), alone = make(0);
  for (const auto& scene : {among.get(), alone.get()}) {
    steps(*scene, 1500);
    if (awake(*scene) != 1) throw std::runtime_error("the arm is not alone awake");
  }
  return timePair([&] { among->step(); }, [&] { alone->step(); }, 100, 100);
}

/// The right hand of each humanoid seeks a place before it, and none is to move otherwise.
Goals reachingHands(const Model& model) {
  Goals goals;
  for (const Frame& frame : model.frames) {
    if (!frame.name.ends_with("right_hand")) continue;
    const Body& root = model.bodies[static_cast<std::size_t>(
        model
            .trees[static_cast<std::size_t>(
                model.bodies[static_cast<std::size_t>(frame.body)].tree)]
            .rootBody)];
    const Vector3 base = model.q0.segment<3>(root.q);
    goals.push_back(std::make_unique<gdd::Reach>(model, frame.name,
                                                 Vector3(base.x() + 0.45, base.y() - 0.25, 1.1)));
    static_cast<gdd::Reach&>(*goals.back()).weight = 100.0;
  }
  goals.push_back(std::make_unique<gdd::VirtualDamping>());
  return goals;
}

/// A ball that rolls along x between rows of boxes that sleep.
ModelBuilder ballAmong(int boxes) {
  ModelBuilder builder = boxesOnGround(boxes, 0.6);
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
  return builder;
}

Pair mover() {
  const auto among = sleepers(ballAmong(kSleepers)), alone = sleepers(ballAmong(0));
  for (Scene* scene : {among.get(), alone.get()}) {
    steps(*scene, 1000);
    // Its rows are those of the boxes that it passes; 50 cm/s, and it never stops.
    scene->state.v.tail<6>() << 0.5, 0.0, 0.0, 0.0, 5.0, 0.0;
    steps(*scene, 500);
    if (awake(*scene) != 1) throw std::runtime_error("the ball is not alone awake");
  }
  return timePair([&] { among->step(); }, [&] { alone->step(); }, 100, 100);
}

/// A robot of many in one scene, over one alone.
Pair together(const std::string& folder, int count,
              const std::function<Goals(const Model&)>& goals = nullptr) {
  const auto make = [&](int robots) {
    std::unique_ptr<Scene> scene = makeHumanoids(folder, robots);
    if (goals) {
      scene->controller = std::make_unique<gdd::GoalDirectedController>(scene->model);
      scene->controller->goals = goals(scene->model);
    }
    for (int i = 0; i < 100; ++i) scene->step();
    return scene;
  };
  const auto many = make(count), one = make(1);
  const Pair pair = timePair([&] { many->step(); }, [&] { one->step(); }, 5, 5);
  return {pair.first / count, pair.second};
}

/// A rod that hangs by its end from a point 50 m away, and turns about it at 40 rad/s.
ModelBuilder spinner() {
  ModelBuilder builder("spinner");
  builder.base = BaseKind::floating;
  builder.X_WRoot.p = Vector3(50.0, 0.0, 5.0);
  LinkSpec rod;
  rod.name = "rod";
  rod.mass = 1.0;
  rod.I_Lcm = Vector3(0.02, 0.02, 0.001).asDiagonal();
  builder.link(rod);
  ConnectSpec end;
  end.linkA = "rod";
  end.linkB = "world";
  end.p_LAP.z() = 0.25;
  end.p_LBP = builder.X_WRoot.p + end.p_LAP;
  builder.connect(end);
  return builder;
}

/// A scene beside what stands on its ground, over each of the two alone. `ready` readies what has
/// the scene, or the other, before its first step.
Pair beside(const ModelBuilder& scene, const ModelBuilder& other,
            const std::function<void(Scene&, bool hasScene, bool hasOther)>& ready) {
  const auto make = [&](bool hasScene, bool hasOther) {
    ModelBuilder builder = hasScene ? scene : ModelBuilder("ground");
    if (!hasScene) addGround(builder);
    if (hasOther) builder.add(other, "");
    std::unique_ptr<Scene> made = makeScene(builder.build());
    ready(*made, hasScene, hasOther);
    for (int i = 0; i < 500; ++i) made->step();
    return made;
  };
  const auto both = make(true, true), without = make(true, false), alone = make(false, true);
  const std::vector<double> times = timeInTurn({{nullptr, [&] { both->step(); }, 50},
                                                {nullptr, [&] { without->step(); }, 50},
                                                {nullptr, [&] { alone->step(); }, 50}});
  return {times[0], times[1] + times[2]};
}

/// Beside the rod.
Pair besideSpinner(const ModelBuilder& scene, const std::function<void(Scene&)>& goals = nullptr) {
  return beside(scene, spinner(), [&](Scene& made, bool hasScene, bool spins) {
    if (spins) made.state.v.tail<6>() << -0.75, 10.0, 0.0, 40.0, 3.0, 0.0;  // about that end
    if (hasScene && goals) goals(made);
  });
}

void reachWithRightHand(Scene& scene) {
  addReach(scene, "humanoid0/right_hand", Vector3(0.45, -0.25, 1.1));
}

/// A humanoid that reaches, among boxes that lie on the ground.
Pair amongBoxes(const std::string& robots, int count) {
  const ModelBuilder boxes = freeBoxes(count, 0.1 - 1e-4, 0.3, Vector3(3.0, 0.0, 0.0));
  return beside(humanoidsOnGround(robots, 1), boxes, [](Scene& made, bool hasScene, bool) {
    if (hasScene) reachWithRightHand(made);
  });
}

}  // namespace

std::map<std::string, double> crowdFigures(const std::string& robotsFolder,
                                           const std::string& filter) {
  const std::pair<const char*, std::function<Pair()>> pairs[] = {
      {"sleep_humanoids", [&] { return asleep(robotsFolder); }},
      {"sleep_ball", [] { return mover(); }},
      {"sleep_reacher", [&] { return reacher(robotsFolder); }},
      {"islands_humanoids", [&] { return together(robotsFolder, kHumanoids); }},
      {"parts_boxes", [] { return besideSpinner(boxesOnGround(50, 0.3)); }},
      {"parts_humanoid", [&] { return besideSpinner(humanoidsOnGround(robotsFolder, 1)); }},
      {"parts_reach",
       [&] { return besideSpinner(humanoidsOnGround(robotsFolder, 1), reachWithRightHand); }},
      {"goals_robots", [&] { return together(robotsFolder, 8, reachingHands); }},
      {"goals_boxes", [&] { return amongBoxes(robotsFolder, 200); }}};
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
