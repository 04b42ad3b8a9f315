// SPDX-License-Identifier: Apache-2.0
/// One run of one engine: SCENE.json STATES H [--least SECONDS] [--most SECONDS] [key=value…]
///
/// Writes to STATES 13 doubles a body and sample: position, orientation w x y z, velocity, angular
/// velocity. Prints one line of JSON: how the run ended, the engine's own mass, energy and inertia
/// at the start, its CPU time a step, and that of a fixed piece of arithmetic before and after it,
/// the mean.
///
/// A run that takes less than `least` is repeated from its start; one that takes longer than `most`
/// ends as late.

#include <time.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/rivals/engine.hpp"

namespace rivals {

namespace {

double cpuSeconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// CPU time of one product of two 32 × 32 matrices, least of twenty [µs]: how fast the machine is
/// now.
double calibration() {
  static double a[32][32], b[32][32], c[32][32];
  for (int i = 0; i < 32; ++i)
    for (int j = 0; j < 32; ++j) a[i][j] = 1e-3 * (32 * i + j), b[i][j] = 1.0;
  double best = 1e9;
  for (int round = 0; round < 20; ++round) {
    const double begin = cpuSeconds();
    for (int repeat = 0; repeat < 20; ++repeat) {
      for (int i = 0; i < 32; ++i)
        for (int k = 0; k < 32; ++k)
          for (int j = 0; j < 32; ++j) c[i][j] += a[i][k] * b[k][j];
      asm volatile("" : : "r"(c) : "memory");
    }
    best = std::min(best, cpuSeconds() - begin);
  }
  return 1e6 * best / 20.0;
}

bool isSane(const std::vector<BodyState>& states) {
  constexpr double kFar = 1e6;  // [m, m/s, rad/s]: nothing of a scene comes near it
  for (const BodyState& s : states)
    for (const Vector3d& x : {s.position, s.velocity, s.angularVelocity})
      if (!(x.norm() < kFar)) return false;
  return true;
}

void write(std::ofstream& file, const std::vector<BodyState>& states) {
  for (const BodyState& s : states) {
    const Quaterniond& q = s.orientation;
    const double row[13] = {s.position[0],
                            s.position[1],
                            s.position[2],
                            q.w(),
                            q.x(),
                            q.y(),
                            q.z(),
                            s.velocity[0],
                            s.velocity[1],
                            s.velocity[2],
                            s.angularVelocity[0],
                            s.angularVelocity[1],
                            s.angularVelocity[2]};
    file.write(reinterpret_cast<const char*>(row), sizeof row);
  }
}

struct Arguments {
  std::string scene, states;
  double h = 0.0, least = 0.0, most = 60.0;
  std::vector<std::string> settings;
};

Arguments readArguments(int argc, char** argv) {
  Arguments a;
  std::vector<std::string> plain;
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    if (i + 1 < argc && (text == "--least" || text == "--most"))
      (text == "--least" ? a.least : a.most) = std::stod(argv[++i]);
    else if (plain.size() < 3)
      plain.push_back(text);
    else
      a.settings.push_back(text);
  }
  if (plain.size() < 3)
    throw std::invalid_argument("usage: SCENE.json STATES H [--least s] [--most s] [key=value…]");
  a.scene = plain[0], a.states = plain[1], a.h = std::stod(plain[2]);
  return a;
}

struct Run {
  std::string end = "done";
  double time = 0.0, cpu = 0.0;
  long steps = 0;
};

Run runOnce(Engine& engine, const Scene& scene, const Arguments& a, std::ofstream* file) {
  Run run;
  const int stepsASample = static_cast<int>(std::lround(scene.sample / a.h));
  const int samples = static_cast<int>(std::lround(scene.duration / scene.sample));
  if (file) write(*file, engine.state());
  for (int k = 1; k <= samples; ++k) {
    const double begin = cpuSeconds();
    const bool goesOn = engine.step(stepsASample);
    run.cpu += cpuSeconds() - begin;
    run.steps += stepsASample;
    const std::vector<BodyState> states = engine.state();
    run.time = k * scene.sample;
    if (!goesOn || !isSane(states)) {
      run.end = "diverged";
      break;
    }
    if (file) write(*file, states);
    if (run.cpu > a.most && k < samples) {
      run.end = "late";
      break;
    }
  }
  return run;
}

int main(int argc, char** argv) {
  nlohmann::json out;
  const Arguments a = readArguments(argc, argv);
  const Scene scene = readScene(a.scene);
  if (const double steps = scene.sample / a.h; std::abs(steps - std::round(steps)) > 1e-9 * steps)
    throw std::invalid_argument(a.scene + ": a sample of " + std::to_string(scene.sample) +
                                " s is no whole number of steps of " + std::to_string(a.h) + " s");
  std::ofstream file(a.states, std::ios::binary);
  double cpu = 0.0;
  long steps = 0;
  out["version"] = engineVersion();
  const double before = calibration();
  try {
    for (bool first = true; first || cpu < a.least; first = false) {
      Settings settings(a.settings);
      const std::unique_ptr<Engine> engine = makeEngine(scene, a.h, settings);
      settings.expectAllTaken();
      if (first) {
        out["mass"] = engine->mass();
        if (const auto energy = engine->kineticEnergy()) out["kinetic_energy"] = *energy;
        const Eigen::MatrixXd M = engine->massMatrix();
        out["mass_matrix"] = std::vector<double>(M.data(), M.data() + M.size());
      }
      const Run run = runOnce(*engine, scene, a, first ? &file : nullptr);
      if (first) out["end"] = run.end, out["time"] = run.time;
      cpu += run.cpu;
      steps += run.steps;
    }
    out["us_a_step"] = 1e6 * cpu / static_cast<double>(steps);
    out["calibration_us"] = 0.5 * (before + calibration());
  } catch (const CannotExpress& e) {
    out["end"] = "cannot express", out["why"] = e.what();
  }
  std::cout << out.dump() << '\n';
  return 0;
}

}  // namespace
}  // namespace rivals

int main(int argc, char** argv) {
  try {
    return rivals::main(argc, argv);
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
