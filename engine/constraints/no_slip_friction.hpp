// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Friction of contacts that does not creep: a second problem, bounded by the forces of the first.
///
/// A soft friction force needs a slip of its reference to exist, so contacts creep under load. Here
/// the normal forces f_n of a first solve bound friction that is kStiffer times as hard (4.15):
///   normal    s = ½ D_n min(x_n, 0)²,  x_n = y_n − y_n¹ − f_n/D_n     f_n at the first solution y¹
///   friction  x_k = y_k − a_ref,k,  a_ref,k = −b ẏ_k,  U_k = μ_k x_k,  D = kStiffer × its
///   stiffness
///             f_k = μ_k F_k,  F = −D U projected onto  Σ |F_k| ≤ f_n (pyramid),  |F| ≤ f_n (cone)
/// F is minus the gradient of a convex, C¹ function of U. D_n is the stiffness of the contact's
/// normal: without it the normal would not answer to the change of friction within the step.
/// The result no longer minimises (1.1): inverse dynamics give other forces than went in.

#include <array>
#include <vector>

#include "softgauss/engine/constraints/elliptic_contact.hpp"
#include "softgauss/engine/constraints/pyramidal_contact.hpp"

namespace softgauss {

class NoSlipFriction {
 public:
  static constexpr double kStiffer = 1e4;

  std::vector<double> reference;  ///< a_ref
  std::vector<double> x;          ///< residual at the present acceleration
  std::vector<double> dx;         ///< J d
  std::vector<double> f;          ///< force −∇s(x)

  /// Forgets all contacts.
  void clear();
  /// Takes all contacts with their forces at the acceleration a; false where none has friction.
  bool take(PyramidalContact& pyramids, EllipticContact& cones, const VectorX& a);

  int rowCount() const { return static_cast<int>(x.size()); }
  void multiply(const VectorX& a, std::vector<double>& y) const;
  double evaluate(bool& cellChanged);
  void along(double alpha, Jet& sum) const;
  void advance(double alpha);
  void addForce(VectorX& tau) const;
  void addCurvature(TreeMatrix& P);

  /// Force on body B at contact i of those taken, pyramids first, world [N].
  Vector3 force(int i) const;
  /// What bounds the friction of that contact: the normal force of the first solve [N].
  double bound(int i) const { return patches_[static_cast<std::size_t>(i)].bound; }

 private:
  static constexpr int kMaxDim = 6;

  /// One contact: a normal row, then dim − 1 of friction.
  struct Patch {
    ContactBlocks* contacts = nullptr;
    int contact = 0;  ///< among them
    int dim = 1;
    int row = 0;         ///< first
    double Dn = 0.0;     ///< stiffness of the normal row
    double D = 0.0;      ///< of friction, in U
    double bound = 0.0;  ///< f_n
    bool round = false;  ///< |F| ≤ f_n, else Σ |F_k| ≤ f_n
    std::array<double, 5> friction{};

    /// s; writes f and, unless null, H (dim × dim). `piece` tells cells of constant H apart; −1
    /// where H bends.
    double at(const double* x, double* f, double* H, int& piece) const;
    double roundFriction(double* F, double* H, int& piece) const;
    double edgedFriction(double* F, double* H, int& piece) const;
  };
  void add(Patch patch, const VectorX& a, const double* aRef, int stride);

  std::vector<Patch> patches_;
  std::vector<int> pieces_;
};

}  // namespace softgauss
