// SPDX-License-Identifier: Apache-2.0
#include "tests/gdd/pendulum_value.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace softgauss::test {

double PendulumPlant::acceleration(double q, double v, double u) const {
  return (u - gravity * std::sin(q) - damping * v) / felt();
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
        const double next = v + plant_.h * plant_.acceleration(q, v, u);
        nodes[j * speeds + i] = {plant_.running(q, v, u), angle(q + plant_.h * v), speed(next)};
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

void PendulumValue::at(double q, double v, double &value, double &slope, double &curvature) const {
  const Stencil angle_ = angle(q), speed_ = speed(v);
  value = slope = curvature = 0.0;
  for (int a = 0; a < 4; ++a) {
    double y = 0.0;
    for (int b = 0; b < 4; ++b) y += angle_.value[b] * V_(speed_.node[a], angle_.node[b]);
    value += speed_.value[a] * y;
    slope += speed_.slope[a] * y / step_;
    curvature += speed_.curvature[a] * y / (step_ * step_);
  }
}

double PendulumValue::at(double q, double v) const {
  double value = 0.0, slope = 0.0, curvature = 0.0;
  at(q, v, value, slope, curvature);
  return value;
}

double PendulumValue::backup(double q, double v, double &u) const {
  const double free = v + plant_.h * plant_.acceleration(q, v, 0.0);
  const double felt = plant_.felt();
  const double price = felt / (plant_.h * plant_.h);  // ½ u²/M̂ = ½ price (v⁺ − free)²
  const double next = q + plant_.h * v;
  const auto cost = [&](double w) { return 0.5 * price * (w - free) * (w - free) + at(next, w); };
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
    double value = 0.0, rises = 0.0, bends = 0.0;
    at(next, x, value, rises, bends);
    return price * (x - free) + rises;
  };
  const double middle = 0.5 * (low + high);
  for (double near = 1e-7 * reach; near < 1e-2 * reach; near *= 2.0) {
    low = middle - near, high = middle + near;
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
