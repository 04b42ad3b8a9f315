// SPDX-License-Identifier: Apache-2.0
#pragma once

/// MuJoCo behind the calls that the comparison needs.

#include <memory>
#include <string>
#include <vector>

#include "softgauss/engine/constraints/contact_set.hpp"
#include "softgauss/engine/model/state.hpp"

namespace softgauss::app {

class Mujoco {
 public:
  /// Throws ModelError with MuJoCo's own message when it refuses the description.
  explicit Mujoco(const std::string& mjcf);
  ~Mujoco();

  static std::string version();
  /// The description with memory for thousands of contacts, where the library takes what it needs
  /// of it; otherwise as it is.
  static std::string withRoom(std::string mjcf);

  int nq() const;
  int nv() const;
  /// Tolerance of the solver; 0 lets it run until nothing improves.
  void setTolerance(double tolerance);
  /// State and applied force of the next call. Its warm start is left alone.
  void set(const State& state, const VectorX& tau);
  void setForce(const VectorX& tau);
  void setWarmStart(const VectorX& a);
  void setAcceleration(const VectorX& a);
  void forward();
  /// Largest |M a − τ + c − Jᵀf| after forward(), over the largest |τ − c| or 1.
  double imbalance() const;
  void inverse();
  void step();
  /// ∂(q⁺, v⁺)/∂(q, v) by its own forward differences. State and force stay.
  void differentiateStep();

  VectorX q() const;
  VectorX v() const;
  VectorX acceleration() const;  ///< of the last forward()
  VectorX inverseForce() const;  ///< of the last inverse()
  /// Contacts of the last forward(), inverse() or step(), as our engine takes them. Each of these
  /// finds them anew, with other rounding.
  std::vector<Contact> contacts(const Model& model) const;
  double deepestOverlap() const;     ///< of these [m], ≥ 0
  std::string firstWarning() const;  ///< empty when there was none

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace softgauss::app
