// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Small scenes decoded from bytes: any bytes give one, or numbers that a builder refuses.

#include <cstdint>
#include <optional>
#include <random>

#include "softgauss/engine/engine.hpp"

namespace softgauss::fuzz {

/// Draws that bytes decide. After their end a generator goes on that they seed, so that a short
/// input gives a whole scene too.
class Draws {
 public:
  Draws(const std::uint8_t* data, std::size_t size);

  /// 0 … count − 1.
  int index(int count) { return static_cast<int>(word() % static_cast<unsigned>(count)); }
  bool chance(double probability) { return unit() < probability; }
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  /// 10^low … 10^high.
  double power(double low, double high);
  /// The number, or seldom one that no user means: 0, a tiny, a huge, none at all.
  double odd(double usual);
  Vector3 vector(double scale);
  Matrix3 rotation();

 private:
  std::uint16_t word();
  double unit() { return word() / 65536.0; }

  const std::uint8_t* data_;
  std::size_t left_;
  std::mt19937 after_;
  double oddness_;
};

struct SmallScene {
  Model model;
  State state;
  Input input;
  /// Nothing drives it and nothing ties its joints: its energy does not grow, but for what contacts
  /// and ranges have stored at the start.
  bool passive = false;
};

/// Nothing where the mass matrix is singular at the start: loaders refuse that. Throws ModelError.
std::optional<SmallScene> decodeScene(const std::uint8_t* data, std::size_t size);

}  // namespace softgauss::fuzz
