// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Friction of contacts that does not creep: a second problem, with the normal forces held.
///
/// A soft friction force needs a slip of its reference to exist, so contacts creep under load. Here
/// the normal forces f_n of a first solve are constants, and the tangential rows of every contact
/// are kStiffer times as hard, still bounded by f_n (T.34):
///   x_k = y_k − a_ref,k,   a_ref,k = −b ẏ_k,   D_k = kStiffer × that of the sticking contact
///   pyramid:  s = Σ_k Huber(x_k; D_k, μ_k (f₊ + f₋)_k)         each pair of edges by itself
///   cone:     s = Huber(|U|; D_k/μ_k², f_n),  U_k = μ_k x_k     all directions together
/// The result no longer minimises (T.1): inverse dynamics give other forces than went in.

#include <array>
#include <vector>

#include "engine/constraints/elliptic_contact.hpp"
#include "engine/constraints/pyramidal_contact.hpp"

namespace softgauss {

class StickingFriction {
 public:
  static constexpr double kStiffer = 1e4;

  std::vector<double> reference;  ///< a_ref
  std::vector<double> x;          ///< residual at the present acceleration
  std::vector<double> dx;         ///< J d
  std::vector<double> f;          ///< force −∇s(x)

  /// Forgets all contacts.
  void clear();
  /// Takes all contacts with their present forces; false where none has friction.
  bool take(PyramidalContact& pyramids, EllipticContact& cones);
  /// tau ← tau + Jᵀ (normal forces).
  void addNormalForce(VectorX& tau) const;

  int rowCount() const { return static_cast<int>(x.size()); }
  void multiply(const VectorX& a, std::vector<double>& y) const;
  double evaluate(bool& cellChanged);
  void along(double alpha, Jet& sum) const;
  void advance(double alpha);
  void addForce(VectorX& tau) const;
  void addCurvature(TreeMatrix& P);

  /// Force on body B at contact i of those taken, pyramids first, world [N].
  Vector3 force(int i) const;

 private:
  /// One contact, with dim rows of friction.
  struct Patch {
    ContactBlocks* contacts = nullptr;
    int contact = 0;  ///< among them
    int dim = 0;
    int row = 0;          ///< first
    double normal = 0.0;  ///< f_n
    bool round = false;   ///< one bound, f_n, for all directions
    std::array<double, 5> friction{};
    std::array<double, 5> D{};
    std::array<double, 5> limit{};  ///< where not round

    /// s; writes f and, unless null, H (dim × dim); says whether every direction sticks.
    double at(const double* x, double* f, double* H, bool& sticks) const;
    double atRound(const double* x, double* f, double* H, bool& sticks) const;
    /// (normal, friction rows) of y, or zero in place of the normal.
    ContactBlocks::FrameVector inFrame(double normal, const double* y) const;
  };

  std::vector<Patch> patches_;
  std::vector<bool> sticks_;
};

}  // namespace softgauss
