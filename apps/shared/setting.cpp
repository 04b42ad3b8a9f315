// SPDX-License-Identifier: Apache-2.0
#include "apps/shared/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/shared/pose_error.hpp"

namespace softgauss::app {
namespace {

constexpr int kMostSteps = 4096;       // a period
constexpr double kMostSeconds = 30.0;  // CPU, for one run of the reference
constexpr double kAimedShare = 0.9;    // of what the reference leaves, at which the next aims
constexpr double kNearlyAsFast = 1.4;  // times the best: timed once more
constexpr int kTrialsOfAMethod = 7;

struct Tried {
  Setting setting;
  double error = kInfinity;
  double seconds = kInfinity;
  std::vector<double> errors{};  ///< of each sample
};

/// One way of moving on; its error falls with the step to the power of `order`, or with the
/// tolerance of its error control.
struct Method {
  Integrator integrator;
  double order;
  bool controlled = false;
};

constexpr Method kMethods[] = {{Integrator::dormandPrince, 1.0, true},
                               {Integrator::rungeKutta4, 4.0},
                               {Integrator::leapfrog, 2.0},
                               {Integrator::semiImplicitEuler, 1.0},
                               {Integrator::implicitMidpoint, 2.0},
                               {Integrator::implicit, 1.0},
                               {Integrator::leapfrog, 1.0, true}};

class Chooser {
 public:
  Chooser(double accuracy, const TrialScene& scene)
      : accuracy_(accuracy),
        scene_(scene),
        fewest_(std::max(1, static_cast<int>(std::ceil(scene.period / scene.longestStep - 1e-9)))),
        a_(*scene.model),
        b_(*scene.model) {}

  Choice choose() {
    Choice choice;
    choice.referenced = findReference();
    if (choice.referenced) {
      // Rows that never act change nothing, however long the step.
      if (!reference_.touches) fewest_ = 1;
      for (const Method& method : kMethods) {
        if (!method.controlled)
          searchSteps(method);
        else
          for (const int factor : {1, 2, 4}) searchTolerance(method, factor * fewest_);
      }
      choice.found = !good_.empty();
    }
    if (choice.found) {
      timeAgain();
      loosenSolver();
      choice.setting = good_.front().setting;
      choice.error = good_.front().error;
      choice.errors = good_.front().errors;
      choice.price = good_.front().seconds / scene_.simulated;
    } else {
      choice.late = late_;
      choice.error = nearest_;
      if (nearest_ == kInfinity) choice.lostAt = lostAt_;
    }
    choice.trials = trials_;
    choice.trialSeconds = spent_;
    return choice;
  }

 private:
  TrialRun run(const Setting& setting, double mostSeconds) {
    const double left = scene_.mostSeconds - spent_;
    if (left <= 0.0) {
      TrialRun none;
      none.late = true;
      return none;
    }
    ++trials_;
    TrialRun r = scene_.run(setting, std::min(mostSeconds, left));
    spent_ += r.seconds;
    return r;
  }

  /// How far two runs are apart: error ∞ where one of them did not come to its end.
  Tried compare(const Setting& setting, const TrialRun& x, const TrialRun& y) {
    Tried tried{setting, kInfinity, x.seconds};
    if (!x.finite || !y.finite || x.samples.empty()) return tried;
    double sum = 0.0;
    for (std::size_t k = 0; k < x.samples.size(); ++k) {
      a_.set(x.samples[k]);
      b_.set(y.samples[k]);
      tried.errors.push_back(a_.against(b_).total);
      sum += std::pow(tried.errors.back(), 2);
    }
    tried.error = std::sqrt(sum / static_cast<double>(x.samples.size()));
    return tried;
  }

  bool findReference() {
    const double tight = std::clamp(1e-4 * accuracy_, 1e-12, 1e-7);
    const Setting pairs[][2] = {{{Integrator::dormandPrince, 2 * fewest_, false, tight},
                                 {Integrator::dormandPrince, 5 * fewest_, false, 0.1 * tight}},
                                {{Integrator::dormandPrince, 8 * fewest_, false, 1e-10},
                                 {Integrator::dormandPrince, 16 * fewest_, false, 1e-12}},
                                {{Integrator::rungeKutta4, 128}, {Integrator::rungeKutta4, 256}},
                                {{Integrator::leapfrog, 512}, {Integrator::leapfrog, 1024}}};
    for (const Setting(&pair)[2] : pairs) {
      const TrialRun first = run(pair[0], kMostSeconds);
      late_ = late_ || first.late;
      lostAt_ = std::min(lostAt_, first.lostAt);
      if (!first.finite) continue;
      TrialRun second = run(pair[1], 3.0 * kMostSeconds);
      late_ = late_ || second.late;
      lostAt_ = std::min(lostAt_, second.lostAt);
      Tried coarse = compare(pair[0], first, second);
      nearest_ = std::min(nearest_, coarse.error);
      if (!(coarse.error <= kReferenceShare * accuracy_)) continue;
      reference_ = std::move(second);
      referenceError_ = coarse.error;
      // What the references cost is a bound: nothing dearer is looked at.
      Tried fine = coarse;
      fine.setting = pair[1];
      fine.seconds = reference_.seconds;
      note(std::move(coarse));
      note(std::move(fine));
      return true;
    }
    late_ = late_ && nearest_ == kInfinity;
    return false;
  }

  bool passes(double error) const { return error + referenceError_ <= accuracy_; }
  double aim() const { return kAimedShare * (accuracy_ - referenceError_); }

  void note(Tried tried) {
    if (!passes(tried.error)) return;
    best_ = std::min(best_, tried.seconds);
    good_.push_back(std::move(tried));
  }

  Tried attempt(const Setting& setting) {
    Tried tried = compare(setting, run(setting, 1.5 * best_), reference_);
    note(tried);
    return tried;
  }

  void searchSteps(const Method& method) {
    int tooFew = 0, n = fewest_;
    int enough = kMostSteps + 1;
    for (int i = 0; i < kTrialsOfAMethod; ++i) {
      Setting setting{method.integrator, n};
      const Tried tried = attempt(setting);
      const bool pass = passes(tried.error);
      // More steps are dearer still, or there are none.
      if (!pass && (tried.seconds > 1.2 * best_ || n >= kMostSteps)) return;
      (pass ? enough : tooFew) = n;
      double next = 4.0 * n;
      if (std::isfinite(tried.error)) {
        next = n * std::pow(tried.error / aim(), 1.0 / method.order);
      }
      n = static_cast<int>(std::ceil(std::clamp(next, 0.125 * n, 8.0 * n)));
      n = std::clamp(n, std::max(fewest_, tooFew + 1), kMostSteps);
      if (n >= enough || (pass && n > 0.9 * enough)) return;
    }
  }

  void searchTolerance(const Method& method, int steps) {
    const bool doubling = method.integrator == Integrator::leapfrog;
    double tolerance = 10.0 * accuracy_, loosest = kInfinity, tightest = 0.0;
    for (int i = 0; i < kTrialsOfAMethod; ++i) {
      const Tried tried = attempt({method.integrator, steps, doubling, tolerance});
      const bool pass = passes(tried.error);
      if (!pass && tried.seconds > 1.2 * best_) return;
      (pass ? tightest : loosest) = tolerance;
      const double wanted = std::isfinite(tried.error)
                                ? tolerance * std::pow(aim() / std::max(tried.error, 1e-300), 0.9)
                                : 1e-2 * tolerance;
      const double next = std::clamp(wanted, 1e-3 * tolerance, 1e2 * tolerance);
      // Looser makes no difference where no step is divided.
      if (pass && (next < 2.0 * tolerance || next >= loosest || tolerance > 1.0)) return;
      tolerance = pass ? next : std::min(next, 0.7 * tolerance);
      if (!pass && tightest > 0.0 && tolerance <= tightest) return;
    }
  }

  void sort() {
    std::sort(good_.begin(), good_.end(),
              [](const Tried& a, const Tried& b) { return a.seconds < b.seconds; });
  }

  /// Times vary: those near the best are measured twice more.
  void timeAgain() {
    sort();
    const double near = kNearlyAsFast * good_.front().seconds;
    for (Tried& tried : good_) {
      if (tried.seconds > near) break;
      for (int i = 0; i < 2; ++i) {
        const TrialRun r = run(tried.setting, kMostSeconds);
        if (r.finite) tried.seconds = std::min(tried.seconds, r.seconds);
      }
    }
    sort();
  }

  void loosenSolver() {
    for (const double tolerance : {1e-8, 1e-5}) {
      Setting setting = good_.front().setting;
      setting.tolerance = tolerance;
      Tried looser = compare(setting, run(setting, kMostSeconds), reference_);
      const TrialRun again = run(setting, kMostSeconds);
      if (again.finite) looser.seconds = std::min(looser.seconds, again.seconds);
      if (passes(looser.error) && looser.seconds < 0.97 * good_.front().seconds)
        good_.insert(good_.begin(), std::move(looser));
    }
  }

  double accuracy_;
  const TrialScene& scene_;
  int fewest_;
  LinkPoses a_, b_;
  TrialRun reference_;
  double referenceError_ = 0.0, best_ = kInfinity, spent_ = 0.0;
  int trials_ = 0;
  bool late_ = false;           ///< a reference took too long
  double lostAt_ = kInfinity;   ///< the earliest refusal in one of them [s]
  double nearest_ = kInfinity;  ///< the least by which two of them differ [m]
  std::vector<Tried> good_;
};

}  // namespace

void Setting::setOptions(double period, Options& options) const {
  options.integrator = integrator;
  options.timestep = period / steps;
  options.stepDoubling = doubling;
  if (integrationTolerance > 0.0) options.integrationTolerance = integrationTolerance;
  options.tolerance = tolerance;
}

std::string Setting::text(double period) const {
  return fmt::format(
      "{}{}{}, {:.4g} ms, solver to {:.0e}", integratorName(integrator),
      doubling ? " with step doubling" : "",
      integrationTolerance > 0.0 ? fmt::format(" to {:.1e}", integrationTolerance) : std::string(),
      1e3 * period / steps, tolerance);
}

Choice chooseSetting(double accuracy, const TrialScene& scene) {
  return Chooser(accuracy, scene).choose();
}

double longestStepFor(const Model& model) {
  double shortest = kInfinity;
  for (const JointRange& range : model.ranges)
    shortest = std::min(shortest, range.impedance.timeConstant);
  for (const Geometry& geometry : model.geometries)
    shortest = std::min(shortest, geometry.material.impedance.timeConstant);
  return 0.5 * shortest;
}

}  // namespace softgauss::app
