// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/speed_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <utility>

#include "apps/compare_mujoco/batch_race.hpp"
#include "apps/compare_mujoco/equal_error.hpp"
#include "apps/compare_mujoco/step_duel.hpp"
#include "apps/shared/fitted_power.hpp"
#include "apps/shared/run_origin.hpp"

namespace softgauss::app {
namespace {

using Json = nlohmann::ordered_json;

/// Three digits, of large numbers all.
std::string figure(double x) {
  return x >= 100.0 ? fmt::format("{:.0f}", x) : fmt::format("{:.3g}", x);
}

/// What is timed besides a step, in the order of its rows.
struct Besides {
  const char* prefix;
  bool TableScene::*asked;
  RaceTimes RaceResult::*times;
};
constexpr Besides kBesides[] = {
    {"inverse dynamics, ", &TableScene::inverse, &RaceResult::inverse},
    {"derivatives of a step, ", &TableScene::derivatives, &RaceResult::derivatives}};

/// Collects the rows.
class Table {
 public:
  explicit Table(const TableOptions& options) : options_(options), wanted_(options.filter) {}

  bool wants(const std::string& name) const {
    return options_.filter.empty() || std::regex_search(name, wanted_);
  }

  void addScene(const TableScene& scene) {
    const bool step = wants(scene.name);
    const auto wantsIt = [&](const Besides& b) {
      return scene.*b.asked && wants(b.prefix + scene.name);
    };
    const bool any = step || std::any_of(std::begin(kBesides), std::end(kBesides), wantsIt);
    if ((options_.quick && scene.large) || !any) return;
    RaceOptions limits;
    limits.rounds = options_.quick ? 1 : options_.rounds;
    const RaceResult r = race(scene, limits);
    if (scene.drive == Drive::reach) {
      add(scene.name + ", with its control", {r.reaching, r.step.mujoco}, r);
      return;
    }
    if (step) add(scene.name, r.step, r);
    races_.emplace_back(scene, r);
    if (!scene.curve.empty() && r.refused.empty()) {
      Json& curve = curves_[scene.curve];
      curve["sizes"].push_back(scene.size);
      curve["mujoco_us"].push_back(r.step.mujoco);
      curve["ours_us"].push_back(r.step.ours);
    }
  }

  void addEqualError(int links) {
    const std::string name = fmt::format("chain of {} links swinging, at equal error", links);
    constexpr int kPeriods = 62, kQuickPeriods = 8, kRepeats = 5;
    if (!wants(name) || (options_.quick && links > 10)) return;
    const EqualError r = swingAtEqualError(links, options_.quick ? kQuickPeriods : kPeriods,
                                           options_.quick ? 1 : kRepeats);
    Json row{{"name", name}};
    if (r.refused.empty()) {
      row["name"] = fmt::format("{} ({:.1g} m, MuJoCo by {}; its default {:.1g} m)", name, r.error,
                                r.way, r.theirs);
      setTimes(row, r.times);
    } else {
      row["refused"] = r.refused;
    }
    push(std::move(row));
  }

  void addBatch() {
    const BatchChoice choice{.rounds = options_.quick ? 1 : options_.rounds};
    const std::string name = fmt::format("a batch of {} humanoids, a core", choice.runs);
    if (!wants(name)) return;
    Json row{{"name", name}};
    setTimes(row, raceBatch(std::filesystem::path(options_.robots) / "humanoid.urdf", choice));
    push(std::move(row));
  }

  /// They come after all steps.
  void addBesides() {
    for (const Besides& b : kBesides)
      for (const auto& [scene, r] : races_)
        if (const std::string name = b.prefix + scene.name; scene.*b.asked && wants(name))
          add(name, r.*b.times, r);
  }

  Json json() const {
    Json result{{"rows", rows_}, {"curves", Json::array()}};
    for (auto [name, curve] : curves_.items()) {
      Json whole{{"name", name}};
      whole.update(curve);
      if (curve["sizes"].size() > 1)
        for (const std::string engine : {"mujoco", "ours"}) {
          std::vector<std::pair<double, double>> points;
          for (std::size_t i = 0; i < curve["sizes"].size(); ++i)
            points.emplace_back(curve["sizes"][i], curve[engine + "_us"][i]);
          whole[engine + "_exponent"] = fittedPower(points);
        }
      result["curves"].push_back(std::move(whole));
    }
    return result;
  }

 private:
  static void setTimes(Json& row, const RaceTimes& times) {
    row["mujoco_us"] = times.mujoco;
    row["ours_us"] = times.ours;
    row["ratio"] = times.ours / times.mujoco;
  }
  void add(const std::string& name, const RaceTimes& times, const RaceResult& r) {
    Json row{{"name", name}};
    if (r.refused.empty()) {
      setTimes(row, times);
      row["dofs"] = r.dofs;
      row["apart_m"] = r.apart;
      row["rounds"] = r.rounds;
    } else {
      row["refused"] = r.refused;
    }
    push(std::move(row));
  }
  void push(Json row) {
    const std::string name = row["name"];
    if (row.contains("refused"))
      fmt::print(stderr, "{}: {}\n", name, row["refused"].get<std::string>());
    else
      fmt::print(stderr, "{}: {} of {} µs, {:.3g}\n", name, figure(row["ours_us"]),
                 figure(row["mujoco_us"]), row["ratio"].get<double>());
    rows_.push_back(std::move(row));
  }

  const TableOptions& options_;
  std::regex wanted_;
  Json rows_ = Json::array(), curves_ = Json::object();
  std::vector<std::pair<TableScene, RaceResult>> races_;
};

Json heading(const TableOptions& options) {
  const io::RunOrigin origin = runOrigin({}, {});
  return {
      fmt::format("softgauss {}{}, built with {}, {}", SOFTGAUSS_VERSION,
                  origin.commit.empty() ? "" : " at " + origin.commit, origin.compiler,
                  SOFTGAUSS_BUILD_FLAGS),
      fmt::format("{}, {}", mujocoBuild(),
                  options.mujocoFlags.empty() ? "its flags are not known" : options.mujocoFlags),
      fmt::format("{}; default against default, steps of 2 ms, CPU time of one thread, "
                  "{}",
                  origin.processor,
                  options.quick ? "one round"
                                : fmt::format("the least of {} rounds in turn (fewer in the "
                                              "largest scenes)",
                                              options.rounds))};
}

}  // namespace

Json measureSpeeds(const TableOptions& options) {
  Table table(options);
  bool swung = false;
  for (const TableScene& scene : tableScenes(options.robots, options.extra)) {
    // After the last chain that swings.
    if (swung && scene.curve != kSwinging) {
      for (const int links : {10, 100}) table.addEqualError(links);
      swung = false;
    }
    table.addScene(scene);
    swung = scene.curve == kSwinging;
  }
  table.addBatch();
  table.addBesides();
  Json result{{"heading", heading(options)}};
  result.update(table.json());
  return result;
}

std::string speedMarkdown(const Json& speeds) {
  std::string text = "# A step beside MuJoCo\n\n";
  for (const auto& line : speeds["heading"]) text += "- " + line.get<std::string>() + "\n";
  text += "\n| scene | MuJoCo [µs] | softgauss [µs] | ratio |\n|---|---|---|---|\n";
  for (const Json& row : speeds["rows"]) {
    const std::string name = row["name"];
    text +=
        row.contains("refused")
            ? fmt::format("| {} | no figure: {} | | |\n", name, row["refused"].get<std::string>())
            : fmt::format("| {} | {} | {} | {:.3g} |\n", name, figure(row["mujoco_us"]),
                          figure(row["ours_us"]), row["ratio"].get<double>());
  }
  text +=
      "\nTime grows as a power of the size:\n\n| scene | sizes | MuJoCo | softgauss |\n"
      "|---|---|---|---|\n";
  std::string csv = "scene,size,mujoco_us,softgauss_us\n";
  for (const Json& curve : speeds["curves"]) {
    const std::string name = curve["name"];
    const Json& sizes = curve["sizes"];
    if (curve.contains("ours_exponent"))
      text += fmt::format("| {} | {} to {} | {:.2f} | {:.2f} |\n", name, sizes.front().get<int>(),
                          sizes.back().get<int>(), curve["mujoco_exponent"].get<double>(),
                          curve["ours_exponent"].get<double>());
    for (std::size_t i = 0; i < sizes.size(); ++i)
      csv += fmt::format("{},{},{:.4g},{:.4g}\n", name, sizes[i].get<int>(),
                         curve["mujoco_us"][i].get<double>(), curve["ours_us"][i].get<double>());
  }
  return text + "\n```\n" + csv + "```\n";
}

}  // namespace softgauss::app
