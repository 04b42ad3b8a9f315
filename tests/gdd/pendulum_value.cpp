// SPDX-License-Identifier: Apache-2.0
#include "tests/gdd/pendulum_value.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace softgauss::test {

double PendulumPlant::acceleration(double middle, double v, double u) const {
  return (u - gravity * std::sin(middle) - damping * v) / felt();
}

double PendulumPlant::running(double q, double v, double u) const {
  return 0.5 * u * u / felt() + angleCost * (1.0 + std::cos(q)) + 0.5 * speedCost * v * v;
}

/// Policy iteration: the best controls of the present V, then V of these
/// controls by sweeps.
PendulumValue::PendulumValue(const PendulumPlant &plant, int angles, int speeds, double largest)
    : plant_(plant),
      largest_(largest),
      step_(2.0 * largest / (speeds - 1)),
      V_(MatrixX::Zero(speeds, angles)) {
  struct Node {
    double cost;  ///< of this step
    Stencil q, v;
  };
  constexpr int kSweeps = 40;
  std::vector<Node> nodes(static_cast<std::size_t>(angles * speeds));
  const double turn = 2.0 * std::numbers::pi / angles;
  double change = 1.0;
  for (int round = 0; change > 1e-10 && round < 60; ++round) {
    const MatrixX before = V_;
    for (int j = 0; j < angles; ++j)
      for (int i = 0; i < speeds; ++i) {
        const double q = turn * j, v = -largest_ + step_ * i;
        double u = 0.0;
        backup(q, v, u);
        const double middle = plant_.middle(q, v);
        const double next = v + plant_.h * plant_.acceleration(middle, v, u);
        nodes[j * speeds + i] = {plant_.running(q, v, u), angle(plant_.middle(middle, next)),
                                 speed(next)};
      }
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      MatrixX V(speeds, angles);
      for (int k = 0; k < V.size(); ++k) {
        const Node &n = nodes[k];
        double sum = n.cost;
        for (int b = 0; b < 4; ++b)
          for (int a = 0; a < 4; ++a)
            sum += n.q.value[b] * n.v.value[a] * V_(n.v.node[a], n.q.node[b]);
        V.data()[k] = sum;
      }
      V_.swap(V);
    }
    change = (V_ - before).cwiseAbs().maxCoeff() / V_.cwiseAbs().maxCoeff();
  }
}

/// The cubic of Hermite with slopes by central differences, one-sided at the
/// ends of what does not go around. Derivatives are per step of the grid.
/// Beyond the ends V is constant.
PendulumValue::Stencil PendulumValue::stencil(double x, int count, bool around) {
  if (!around) x = std::clamp(x, 0.0, count - 1.0);
  int i = static_cast<int>(std::floor(x));
  if (!around) i = std::min(i, count - 2);
  const double t = x - i, s = 1.0 - t;
  // Of the nodes i and i + 1, and of the slopes there.
  const std::array<double, 3> y1 = {t * t * (3.0 - 2.0 * t), 6.0 * t * s, 6.0 - 12.0 * t};
  const std::array<double, 3> m0 = {t * s * s, s * (1.0 - 3.0 * t), 6.0 * t - 4.0};
  const std::array<double, 3> m1 = {-t * t * s, t * (3.0 * t - 2.0), 6.0 * t - 2.0};
  Stencil out;
  const bool first = !around && i == 0, last = !around && i == count - 2;
  for (int d = 0; d < 3; ++d) {
    const double y0 = (d == 0 ? 1.0 : 0.0) - y1[d];
    std::array<double, 4> w = {0.0, y0, y1[d], 0.0};
    const double half0 = first ? 1.0 : 0.5, half1 = last ? 1.0 : 0.5;
    w[2] += half0 * m0[d];
    w[first ? 1 : 0] -= half0 * m0[d];
    w[last ? 2 : 3] += half1 * m1[d];
    w[1] -= half1 * m1[d];
    (d == 0 ? out.value : d == 1 ? out.slope : out.curvature) = w;
  }
  for (int k = 0; k < 4; ++k) {
    const int node = i - 1 + k;
    out.node[k] = around ? (node % count + count) % count : std::clamp(node, 0, count - 1);
  }
  return out;
}

PendulumValue::Stencil PendulumValue::angle(double q) const {
  const int count = static_cast<int>(V_.cols());
  return stencil(q * count / (2.0 * std::numbers::pi), count, true);
}

PendulumValue::Stencil PendulumValue::speed(double v) const {
  return stencil((v + largest_) / step_, static_cast<int>(V_.rows()), false);
}

PendulumValue::Model PendulumValue::model(double q, double v) const {
  const Stencil around = angle(q), along = speed(v);
  const double dq = static_cast<double>(V_.cols()) / (2.0 * std::numbers::pi), dv = 1.0 / step_;
  Model m;
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) {
      const double y = V_(along.node[a], around.node[b]);
      m.value += along.value[a] * around.value[b] * y;
      m.slope[0] += dq * along.value[a] * around.slope[b] * y;
      m.slope[1] += dv * along.slope[a] * around.value[b] * y;
      m.curvature(0, 0) += dq * dq * along.value[a] * around.curvature[b] * y;
      m.curvature(1, 0) += dq * dv * along.slope[a] * around.slope[b] * y;
      m.curvature(1, 1) += dv * dv * along.curvature[a] * around.value[b] * y;
    }
  m.curvature(0, 1) = m.curvature(1, 0);
  return m;
}

double PendulumValue::at(double q, double v) const { return model(q, v).value; }

double PendulumValue::backup(double q, double v, double &u) const {
  const double middle = plant_.middle(q, v);
  const double free = v + plant_.h * plant_.acceleration(middle, v, 0.0);
  const double felt = plant_.felt();
  const double price = felt / (plant_.h * plant_.h);  // ½ u²/M̂ = ½ price (v⁺ − free)²
  const auto cost = [&](double w) {
    return 0.5 * price * (w - free) * (w - free) + at(plant_.middle(middle, w), w);
  };
  // A mesh over controls of up to four times the weight, then golden section to its root.
  const double reach = 4.0 * plant_.h * plant_.gravity / plant_.M;
  constexpr int kMesh = 10;
  double least = std::numeric_limits<double>::infinity(), best = free;
  for (int k = -kMesh; k <= kMesh; ++k) {
    const double w = free + reach * k / kMesh, value = cost(w);
    if (value < least) least = value, best = w;
  }
  double low = best - reach / kMesh, high = best + reach / kMesh;
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  double x1 = high - ratio * (high - low), x2 = low + ratio * (high - low);
  double f1 = cost(x1), f2 = cost(x2);
  while (high - low > 1e-9 * reach) {
    if (f1 < f2) {
      high = x2, x2 = x1, f2 = f1;
      x1 = high - ratio * (high - low), f1 = cost(x1);
    } else {
      low = x1, x1 = x2, f1 = f2;
      x2 = low + ratio * (high - low), f2 = cost(x2);
    }
  }
  // From there to rounding, by the sign of the slope.
  const auto slope = [&](double x) {
    const Model V = model(plant_.middle(middle, x), x);
    return price * (x - free) + V.slope[1] + 0.5 * plant_.h * V.slope[0];
  };
  const double found = 0.5 * (low + high);
  for (double near = 1e-7 * reach; near < 1e-2 * reach; near *= 2.0) {
    low = found - near, high = found + near;
    if (slope(low) < 0.0 && slope(high) > 0.0) break;
  }
  if (slope(low) < 0.0 && slope(high) > 0.0)
    for (int i = 0; i < 60; ++i)
      (slope(0.5 * (low + high)) < 0.0 ? low : high) = 0.5 * (low + high);
  const double w = 0.5 * (low + high);
  u = felt * (w - free) / plant_.h;
  return cost(w);
}

}  // namespace softgauss::test
