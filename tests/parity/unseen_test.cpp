// SPDX-License-Identifier: Apache-2.0
/// What only saves time is not seen: pruning of pairs, on every scene of the logs.

#include <algorithm>
#include <limits>

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/parity/comparison.hpp"
#include "tests/parity/reference_log.hpp"

namespace softgauss::test {
namespace {

class ParityScene : public testing::TestWithParam<std::string> {
 protected:
  const ReferenceLog& log_ = referenceLog(GetParam());
  const Model& model_ = log_.model;
  collision::SceneContacts contacts_{model_};
  Data data_{model_};
};

// Pairs that cannot come near are not tested, and the run is the same bit for bit, also where an
// integrator looks at the dynamics within the step.
TEST_P(ParityScene, PruningIsNotSeen) {
  const ReferenceTrajectory& reference = log_.trajectory("Euler", false);
  for (const Integrator integrator : {model_.options.integrator, Integrator::rungeKutta4}) {
    Model model = model_;
    model.options.integrator = integrator;
    collision::SceneContacts pruned(model);
    collision::SceneContacts all(model, std::numeric_limits<int>::max(), false);
    Data data(model), other(model);
    State state(model);
    state.q = reference.q[0];
    state.v = reference.v[0];
    State same = state;
    const Input input{log_.force, {}, {}, {}, {}};
    const double duration = reference.every * static_cast<double>(reference.q.size() - 1);
    for (double t = 0.0; t < duration; t += model.options.timestep) {
      const SolveStatus status = step(model, input, state, data, &pruned);
      ASSERT_EQ(step(model, input, same, other, &all), status);
      ASSERT_EQ(hash(state), hash(same)) << "at t = " << t;
      // Joint damping of the fingers is too stiff for it: it blows up.
      if (integrator == Integrator::rungeKutta4 &&
          (status == SolveStatus::notFinite || state.v.cwiseAbs().maxCoeff() > 1e50))
        break;
      ASSERT_EQ(status, SolveStatus::converged);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Mujoco, ParityScene, testing::ValuesIn(referenceLogNames()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace softgauss::test
