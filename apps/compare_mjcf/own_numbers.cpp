// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "apps/compare_mjcf/numbers.hpp"
#include "softgauss/engine/dynamics/inertia.hpp"
#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/step.hpp"
#include "softgauss/io/mjcf.hpp"

namespace softgauss::app {
namespace {

MjcfState evaluate(const Model& model, const MjcfState& given, Data& data) {
  State state(model);
  state.q = given.q;
  state.v = given.v;
  computeStages(model, {}, state, data, nullptr);
  forwardDynamics(model, state, data);
  MassMatrix inertia(model);
  computeMassMatrix(model, data.kinematics, inertia);
  MjcfState result = given;
  result.M = inertia.M.dense();
  result.bias = data.forces.bias;
  result.passive = data.forces.bias - data.forces.c;
  result.a = data.forward.a;
  return result;
}

VectorX jointForces(const Model& model, const io::SceneActuator& actuator, double u) {
  VectorX tau = VectorX::Zero(model.nv);
  for (const auto& [joint, coefficient] : actuator.joints) {
    const Body& body = model.bodies[static_cast<std::size_t>(model.findJoint(joint))];
    tau[body.v] += coefficient * u;
  }
  return tau;
}

double apart(double a, double b) { return std::abs(a - b) / std::max(1.0, std::abs(b)); }

template <class A, class B>
double apart(const A& a, const B& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return kInfinity;
  if (a.size() == 0) return 0.0;
  const double difference = (a - b).cwiseAbs().maxCoeff();
  return std::isfinite(difference) ? difference / std::max(1.0, b.cwiseAbs().maxCoeff())
                                   : kInfinity;
}

/// Of bounds, of which those without end are alike whatever they are.
double boundsApart(const std::vector<VectorX>& a, const std::vector<VectorX>& b) {
  if (a.size() != b.size()) return kInfinity;
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].allFinite() != b[i].allFinite()) return kInfinity;
    if (a[i].allFinite()) most = std::max(most, apart(a[i], b[i]));
  }
  return most;
}

}  // namespace

MjcfNumbers ownNumbers(const std::filesystem::path& file, const std::vector<MjcfState>& given) {
  io::MjcfFile mjcf = io::readMjcf(file);
  mjcf.scene.builder.options.useMujocoModel();
  const Model model = mjcf.scene.builder.build();
  MjcfNumbers numbers;
  numbers.nq = model.nq;
  numbers.nv = model.nv;
  numbers.mass = mjcf.scene.contents.mass;
  for (const Body& body : model.bodies)
    if (body.mass > 0.0) numbers.bodyMasses.push_back(body.mass);
  Data data(model);
  for (const MjcfState& state : given) {
    if (state.q.size() != model.nq || state.v.size() != model.nv) return numbers;
    numbers.states.push_back(evaluate(model, state, data));
  }
  for (const io::SceneActuator& actuator : mjcf.scene.actuators) {
    numbers.least.push_back(jointForces(model, actuator, actuator.lower));
    numbers.most.push_back(jointForces(model, actuator, actuator.upper));
  }
  return numbers;
}

std::vector<MjcfDifference> differences(const MjcfNumbers& own, const MjcfNumbers& other) {
  std::vector<MjcfDifference> all;
  all.push_back({"size", own.nq == other.nq && own.nv == other.nv ? 0.0 : kInfinity});
  all.push_back({"mass", apart(own.mass, other.mass)});
  const auto list = [](const std::vector<double>& x) {
    return Eigen::Map<const VectorX>(x.data(), static_cast<Eigen::Index>(x.size()));
  };
  all.push_back({"masses", apart(list(own.bodyMasses), list(other.bodyMasses))});
  MjcfDifference M{"M"}, bias{"bias"}, passive{"passive"}, a{"acceleration"};
  const bool fits = own.states.size() == other.states.size();
  for (MjcfDifference* d : {&M, &bias, &passive, &a}) d->size = fits ? 0.0 : kInfinity;
  for (std::size_t i = 0; fits && i < own.states.size(); ++i) {
    const MjcfState &x = own.states[i], &y = other.states[i];
    M.size = std::max(M.size, apart(x.M, y.M));
    bias.size = std::max(bias.size, apart(x.bias, y.bias));
    passive.size = std::max(passive.size, apart(x.passive, y.passive));
    a.size = std::max(a.size, apart(x.a, y.a));
  }
  for (const MjcfDifference& d : {M, bias, passive, a}) all.push_back(d);
  all.push_back({"actuators",
                 std::max(boundsApart(own.least, other.least), boundsApart(own.most, other.most))});
  return all;
}

}  // namespace softgauss::app
