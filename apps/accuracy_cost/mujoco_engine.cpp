// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "apps/accuracy_cost/engine_under_test.hpp"

#ifdef SOFTGAUSS_WITH_MUJOCO
#include "apps/compare_mujoco/mjcf.hpp"
#include "apps/compare_mujoco/mujoco.hpp"
#endif

namespace softgauss::app {

#ifdef SOFTGAUSS_WITH_MUJOCO
namespace {

/// The same model, written by us as MuJoCo's.
class MujocoEngine final : public EngineUnderTest {
 public:
  MujocoEngine(const Problem& problem, const Method& method, double h)
      : model_(build(problem, h)), mujoco_(description(model_, method)), state_(model_) {
    if (method.tolerance > 0.0) mujoco_.setTolerance(method.tolerance);
  }

  const Model& model() const override { return model_; }
  const State& state() override {
    state_.q = mujoco_.q();
    state_.v = mujoco_.v();
    return state_;
  }

  double deepestOverlap() const override { return mujoco_.deepestOverlap(); }

  void start(const State& state) override {
    const VectorX none = VectorX::Zero(model_.nv);
    mujoco_.set(state, none);
    mujoco_.setWarmStart(none);
  }

  bool advance(const VectorX& tau, int steps) override {
    if (tau.size() > 0) mujoco_.setForce(tau);
    for (int i = 0; i < steps; ++i) mujoco_.step();
    // It starts anew where it has found a state that is not finite, and warns.
    return mujoco_.firstWarning().empty() && mujoco_.q().allFinite();
  }

 private:
  /// With the integrator in it: MuJoCo lays out its memory by what a description says.
  static std::string description(const Model& model, const Method& method) {
    std::string text = mjcfOf(model, collision::SceneContacts(model).filter());
    const std::string option = "<option ";
    text.insert(text.find(option) + option.size(), "integrator=\"" + method.integrator + "\" ");
    // Its memory grows with the square of the rows that may be; these problems have fewer than 300.
    const std::size_t size = text.find("<size ");
    text.replace(size, text.find("/>", size) - size, "<size njmax=\"1000\" nconmax=\"250\"");
    return text;
  }
  static Model build(const Problem& problem, double h) {
    ModelBuilder builder = problem.build();
    builder.options.timestep = h;
    return builder.build();
  }

  Model model_;
  Mujoco mujoco_;
  State state_;
};

}  // namespace

std::vector<Method> mujocoMethods(const Problem& problem) {
  std::vector<Method> methods;
  if (!problem.inMujoco) return methods;
  for (const char* integrator : {"Euler", "RK4", "implicit"})
    methods.push_back({"mujoco", integrator, std::string("MuJoCo ") + integrator});
  return methods;
}

std::vector<Method> mujocoVariants(const Problem& problem) {
  std::vector<Method> methods;
  if (!problem.inMujoco) return methods;
  for (const auto& [tolerance, label] : {std::pair{1e-12, "MuJoCo Euler with solver to 1e-12"},
                                         {1e-2, "MuJoCo Euler with solver to 1e-02"}}) {
    Method method{"mujoco", "Euler", label};
    method.tolerance = tolerance;
    methods.push_back(std::move(method));
  }
  return methods;
}

std::unique_ptr<EngineUnderTest> makeMujoco(const Problem& problem, const Method& method,
                                            double h) {
  return std::make_unique<MujocoEngine>(problem, method, h);
}

#else

std::vector<Method> mujocoMethods(const Problem&) { return {}; }
std::vector<Method> mujocoVariants(const Problem&) { return {}; }

std::unique_ptr<EngineUnderTest> makeMujoco(const Problem&, const Method&, double) {
  throw std::logic_error("MuJoCo was not found when this was built");
}

#endif

}  // namespace softgauss::app
