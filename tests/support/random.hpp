// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Seeded random numbers that are the same with every standard library.

#include <cstdint>
#include <random>

#include "softgauss/engine/core/types.hpp"

namespace softgauss::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    const double unit = static_cast<double>(engine_() >> 11) * 0x1p-53;
    return low + (high - low) * unit;
  }
  /// 0 … count − 1.
  int index(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

  /// Entries in [−scale, scale].
  Vector3 vector3(double scale) {
    const double x = uniform(-scale, scale), y = uniform(-scale, scale);
    return {x, y, uniform(-scale, scale)};
  }
  VectorX vector(Eigen::Index size, double scale) {
    VectorX x(size);
    for (double& entry : x) entry = uniform(-scale, scale);
    return x;
  }
  Vector3 direction() {
    for (;;) {
      const Vector3 x = vector3(1.0);
      if (x.norm() > 0.1 && x.norm() < 1.0) return x.normalized();
    }
  }
  Quaternion quaternion() {
    for (;;) {
      const double w = uniform(-1.0, 1.0);
      const Vector3 x = vector3(1.0);
      const Quaternion q(w, x.x(), x.y(), x.z());
      if (q.norm() > 0.1 && q.norm() < 1.0) return q.normalized();
    }
  }
  Matrix3 rotation() { return quaternion().toRotationMatrix(); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace softgauss::test
