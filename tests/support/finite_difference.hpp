// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Central differences, in vector spaces and on the configuration manifold.

#include "softgauss/engine/model/state.hpp"

namespace softgauss::test {

/// Step of a central difference: balances truncation ~ε² against rounding ~1e-16/ε.
inline constexpr double kDifferenceStep = 1e-6;

/// d/dt of f(q ⊕ t v) at t = 0. f takes a VectorX and returns anything that can be subtracted.
template <class F>
auto alongMotion(const Model& model, const VectorX& q, const VectorX& v, F&& f,
                 double step = kDifferenceStep) {
  VectorX ahead = q, behind = q;
  integratePosition(model, v, step, ahead);
  integratePosition(model, v, -step, behind);
  const auto plus = f(ahead);
  const auto minus = f(behind);
  using Value = std::decay_t<decltype(plus)>;
  const Value difference = plus - minus;
  return Value(difference / (2.0 * step));
}

/// d/dt of f(state(t)) at t = 0 where the state moves with velocity v and acceleration a.
template <class F>
auto alongTrajectory(const Model& model, const State& state, const VectorX& a, F&& f,
                     double step = kDifferenceStep) {
  State ahead = state, behind = state;
  // Second order in the path: q(t) = q ⊕ (t v ± …) has an error of t² alike at both ends.
  integratePosition(model, state.v, step, ahead.q);
  integratePosition(model, state.v, -step, behind.q);
  ahead.v += step * a;
  behind.v -= step * a;
  const auto plus = f(ahead);
  const auto minus = f(behind);
  using Value = std::decay_t<decltype(plus)>;
  const Value difference = plus - minus;
  return Value(difference / (2.0 * step));
}

/// (rows × nv) derivative of a vector-valued f(q) on the manifold.
template <class F>
MatrixX configurationGradient(const Model& model, const VectorX& q, F&& f,
                              double step = kDifferenceStep) {
  MatrixX J;
  for (int i = 0; i < model.nv; ++i) {
    const VectorX column = alongMotion(
        model, q, VectorX(VectorX::Unit(model.nv, i)),
        [&](const VectorX& x) { return VectorX(f(x)); }, step);
    if (i == 0) J.resize(column.size(), model.nv);
    J.col(i) = column;
  }
  return J;
}

/// Jacobian of g: Rⁿ → Rᵐ.
template <class G>
MatrixX gradient(const VectorX& x, G&& g, double step = kDifferenceStep) {
  MatrixX J;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    VectorX ahead = x, behind = x;
    ahead[i] += step;
    behind[i] -= step;
    const VectorX plus = g(ahead), minus = g(behind);
    if (i == 0) J.resize(plus.size(), x.size());
    J.col(i) = (plus - minus) / (ahead[i] - behind[i]);
  }
  return J;
}

}  // namespace softgauss::test
