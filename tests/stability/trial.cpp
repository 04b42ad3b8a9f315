// SPDX-License-Identifier: Apache-2.0
#include "tests/stability/trial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>

#include "tests/support/same_contacts.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

constexpr int kNoBroadphase = std::numeric_limits<int>::max();

}  // namespace

Trial::Trial(std::string name, Model m)
    : model(std::move(m)),
      state(model),
      contacts(std::make_unique<collision::SceneContacts>(model)),
      unpruned(std::make_unique<collision::SceneContacts>(model, kNoBroadphase, false)),
      data(std::make_unique<Data>(model)),
      name_(std::move(name)) {
  input.tau = VectorX::Zero(model.nv);
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
  if (!begun_) startEnergy_ = energy().total();
  begun_ = true;
  const auto count = static_cast<int>(std::round(seconds / model.options.timestep));
  for (int i = 0; i < count && !broken_; ++i) {
    broken_ = !watch(step(model, input, state, *data, contacts.get()));
    ++steps;
    if (!broken_ && each) each();
  }
  return !broken_;
}

bool Trial::watch(SolveStatus status) {
  const StepStats& stats = data->stats;
  if (unpruned->mayTouch()) unpruned->detect(model, data->kinematics, all_);
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
  if (!state.q.allFinite() || !state.v.allFinite()) return breaks("a state that is not finite");
  if (stats.pairsSkipped > 0) return breaks("a pair of shapes was not tested");
  fastest = std::max(fastest, state.v.size() > 0 ? state.v.cwiseAbs().maxCoeff() : 0.0);
  gained = std::max(gained, energy().total() - startEnergy_);
  if (gained > mayGain)
    return breaks("more energy than at the start, by " + std::to_string(gained) + " J");
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
