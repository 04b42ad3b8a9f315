// SPDX-License-Identifier: Apache-2.0
#include "tests/stability/trial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "softgauss/engine/step/substep_workspace.hpp"
#include "tests/stability/energy_watch.hpp"
#include "tests/support/same_contacts.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

constexpr int kNoBroadphase = std::numeric_limits<int>::max();

/// The model without the mechanism that SOFTGAUSS_WITHOUT names, if it is set.
Model asAsked(Model model) {
  const char* name = std::getenv("SOFTGAUSS_WITHOUT");
  if (!name) return model;
  const std::optional<Mechanism> mechanism = mechanismFromName(name);
  if (!mechanism)
    throw std::invalid_argument("SOFTGAUSS_WITHOUT: there is no mechanism " + std::string(name));
  model.options.mechanisms.remove(*mechanism);
  return model;
}

}  // namespace

Trial::Trial(std::string name, Model m)
    : model(asAsked(std::move(m))),
      state(model),
      contacts(std::make_unique<collision::SceneContacts>(model)),
      unpruned(std::make_unique<collision::SceneContacts>(model, kNoBroadphase, false)),
      data(std::make_unique<Data>(model)),
      name_(std::move(name)),
      energies_(std::make_unique<EnergyWatch>(model)) {
  input.tau = VectorX::Zero(model.nv);
}

/// The same run on a thread of its own, some steps behind, with the bits of the trial to compare.
class Trial::Twin {
 public:
  explicit Twin(const Trial& trial)
      : model_(trial.model), state_(trial.state), data_(model_), contacts_(model_) {
    thread_ = std::thread([this] { follow(); });
  }
  ~Twin() {
    if (thread_.joinable()) end();
  }
  /// The trial has taken a step with this input, and has come to this hash.
  void add(const Input& input, std::uint64_t hash) {
    const std::lock_guard lock(mutex_);
    steps_.push_back({input, hash});
    added_.notify_one();
  }
  /// Follows to the end. The time of the first step with other bits, or none.
  std::optional<double> end() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
      added_.notify_one();
    }
    thread_.join();
    return differs_;
  }

 private:
  struct Step {
    Input input;
    std::uint64_t hash;
  };
  void follow() {
    for (;;) {
      std::deque<Step> steps;
      {
        std::unique_lock lock(mutex_);
        added_.wait(lock, [this] { return ended_ || !steps_.empty(); });
        if (steps_.empty()) return;
        steps.swap(steps_);
      }
      for (const Step& s : steps) {
        step(model_, s.input, state_, data_, &contacts_);
        if (!differs_ && hash(state_) != s.hash) differs_ = state_.time;
      }
    }
  }

  const Model model_;
  State state_;
  Data data_;
  collision::SceneContacts contacts_;
  std::optional<double> differs_;
  std::mutex mutex_;  ///< of what follows
  std::condition_variable added_;
  std::deque<Step> steps_;
  bool ended_ = false;
  std::thread thread_;
};

Trial::~Trial() {
  writeBits(name_, state);
  if (!broken_ && energies_->rose > 0.0)
    expect("energy above its least", energies_->rose, energies_->allowedThere + mayRise, "J");
}

Energy Trial::energy() {
  computeKinematics(model, state, data->kinematics);
  return computeEnergy(model, data->kinematics, state.q, state.v);
}

Vector3 Trial::origin(const std::string& link) {
  computeKinematics(model, state, data->kinematics);
  const Frame& f = model.frames.at(model.findFrame(link));
  return data->kinematics.X_WB[f.body] * f.X_BF.p;
}

Matrix3 Trial::rotation(const std::string& link) {
  computeKinematics(model, state, data->kinematics);
  const Frame& f = model.frames.at(model.findFrame(link));
  return data->kinematics.X_WB[f.body].R * f.X_BF.R;
}

bool Trial::run(double seconds, const std::function<void()>& each) {
  if (!begun_) {
    startEnergy_ = energy().total();
    startOffset_ = energies_->offset(state, input);
    energies_->begin(state, input);
  }
  begun_ = true;
  const auto count = static_cast<int>(std::round(seconds / model.options.timestep));
  std::optional<Twin> twin;
  if (std::getenv("SOFTGAUSS_TWINS")) twin.emplace(*this);
  Input used;
  for (int i = 0; i < count && !broken_; ++i) {
    if (twin) used = input;
    before_ = state.v;
    broken_ = !watch(step(model, input, state, *data, contacts.get()));
    if (twin) twin->add(used, hash(state));
    ++steps;
    if (!broken_ && each) each();
  }
  const std::optional<double> differs = twin ? twin->end() : std::nullopt;
  EXPECT_FALSE(differs) << name_ << ": other bits on another thread at t = " << *differs;
  return !broken_;
}

bool Trial::watch(SolveStatus status) {
  const StepStats& stats = data->stats;
  if (unpruned->mayTouch()) {
    // Near-rigid contacts are found within the way from where the rows of what was stepped last
    // were made, to where those of the next step are: in a part of a step, unless islands took
    // theirs by themselves.
    const Options whole = model.options;
    const bool inPart = stats.parts > 1 && !data->parts->leavesAny();
    if (inPart) {
      model.options.nextTimestep = whole.timestep;
      model.options.timestep /= stats.parts;
    }
    unpruned->detect(model, data->kinematics, all_);
    model.options = whole;
  }
  const auto breaks = [&](const std::string& law) {
    ADD_FAILURE() << name_ << ": " << law << " at t = " << state.time;
    return false;
  };
  deepest = std::max(deepest, stats.maxPenetration);
  worstResidual = std::max(worstResidual, stats.residual);
  mostIterations = std::max(mostIterations, stats.iterations);
  if (status == SolveStatus::notFinite)
    return breaks("not finite, dof " + std::to_string(stats.badDof));
  if (status != SolveStatus::converged && ++stalls > mayStall)
    return breaks("the solve ended short, residual " + std::to_string(stats.residual));
  if (unpruned->mayTouch() && !sameContacts(data->contacts, all_))
    return breaks("contacts that pruning has changed");
  if (status == SolveStatus::converged && stats.residual > 1e3 * model.options.tolerance)
    return breaks("a solve that is called converged has the residual " +
                  std::to_string(stats.residual));
  if (!state.q.allFinite() || !state.v.allFinite()) return breaks("a state that is not finite");
  if (stats.invalidWarmStarts + stats.abandonedTrees + stats.minimumStepsAccepted > 0)
    return breaks("something done in place of what was asked");
  if (stats.pairsSkipped > 0) return breaks("a pair of shapes was not tested");
  fastest = std::max(fastest, state.v.size() > 0 ? state.v.cwiseAbs().maxCoeff() : 0.0);
  work += 0.5 * model.options.timestep * input.tau.dot(before_ + state.v);
  gained = std::max(gained, energy().total() - startEnergy_ - work);
  // Of an energy the integrator knows Δ (energy_watch.hpp), here and where it began.
  if (gained > mayGain && gained > mayGain + startOffset_ + energies_->offset(state, input))
    return breaks("more energy than at the start and by work, by " + std::to_string(gained) + " J");
  const double rise = energies_->check(state, input, *data, work, perStep);
  rises = std::max(rises, rise);
  if (rise > mayRise)
    return breaks("more energy than at an earlier step, by " + std::to_string(rise - mayRise) +
                  " J");
  return true;
}

void Trial::expect(const std::string& quantity, double value, double bound,
                   const std::string& unit) {
  std::printf("  %-34s h %4.1f ms %-5s %-24s %10.3g of %10.3g %s\n", name_.c_str(),
              1e3 * model.options.timestep, model.options.cone == Cone::elliptic ? "cone" : "pyr.",
              quantity.c_str(), value, bound, unit.c_str());
  EXPECT_SMALL(value, bound) << name_ << ", " << quantity << " [" << unit << "], h "
                             << model.options.timestep;
}

void writeBits(const std::string& name, const State& state) {
  const char* file = std::getenv("SOFTGAUSS_BITS");
  if (!file) return;
  std::FILE* out = std::fopen(file, "a");
  ASSERT_NE(out, nullptr) << file;
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  std::fprintf(out, "%016llx %s.%s, %s\n", static_cast<unsigned long long>(hash(state)),
               test.test_suite_name(), test.name(), name.c_str());
  std::fclose(out);
}

void expectSameBits(const std::function<std::uint64_t()>& trial) {
  const std::uint64_t first = trial();
  EXPECT_EQ(trial(), first);
  std::array<std::uint64_t, 2> atOnce{};
  std::thread other([&] { atOnce[1] = trial(); });
  atOnce[0] = trial();
  other.join();
  EXPECT_EQ(atOnce[0], first);
  EXPECT_EQ(atOnce[1], first);
}

}  // namespace softgauss::test
