// SPDX-License-Identifier: Apache-2.0
#pragma once

/// v̇ = M(q)⁻¹ (τ − b(q, v)) of one kinematic tree in O(n), from q and v alone: the articulated-body
/// algorithm [Featherstone 2008, section 7.3], in world axes about the origin O of its root body.
///
///   out   poses; A = A_P + Ṡ v from A_W = −g; what a body takes at v̇ = 0: f = I A + V ×* (I V)
///   in    U = I S, D = Sᵀ U + armature, u = (τ − Sᵀ f)/D;  I_P += I − U Uᵀ/D, f_P += f + U u
///   out   v̇ = u − Uᵀ A'_P/D,  A' = A'_P + S v̇
///
/// A' is what v̇ adds to A. For integrators that follow a tree; a step's own solve, with rows, is
/// ArticulatedFactor's.

#include <vector>

#include "softgauss/engine/core/six_vectors.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss {

class TreeAcceleration {
 public:
  /// Where a tree is and what acts on it. Arrays are by dof (nv); those of a floating root are its
  /// velocity and force as in State::v, with its moment about body axes.
  struct At {
    Matrix3 R_root;     ///< R_WB of a floating root
    const double* q;    ///< of joints [rad or m]
    const double* v;    ///< [rad/s or m/s]
    const double* tau;  ///< [N m or N]
    Vector3 gravity;    ///< [m/s²]
    bool coriolis;      ///< Coriolis and gyroscopic forces are there
  };

  TreeAcceleration() = default;
  /// Memory for the largest tree of the model.
  explicit TreeAcceleration(const Model& model);

  /// The tree that compute() is about.
  void take(const Model& model, const Tree& tree);
  /// `vdot` (nv), of the tree.
  void compute(const At& at, double* vdot);

  /// 2 K of the tree where compute() was [J].
  double twiceKinetic(const double* v) const;
  /// The fastest of its bodies [rad/s].
  double fastestTurn() const;
  std::size_t bytes() const;

 private:
  /// What does not change of a body and its joint; rotations by their columns, (x, y, z, 0).
  struct Link {
    JointKind joint = JointKind::revolute;
    bool massless = false;
    int parent = 0;  ///< in the tree; −1 of its root
    int v = 0;       ///< dof
    /// R_PB = fixed + sin q · sine + (1 − cos q) · versine
    Four fixed[3], sine[3], versine[3];
    Vector3 axis, place;  ///< of the joint, in P
    Vector3 com;
    Symmetric3 I_Bcm;
    double mass = 0.0;
  };
  struct Node {
    Four R[3];             ///< columns of R_WB
    double I[kSixMatrix];  ///< inertia about O, then that of the articulated body
    double U[kSixRow];
    Motion S;  ///< of a joint of one dof
    Motion V, A, added;
    Force f;
    Vector3 r;  ///< origin from O [m]
    double inversePivot = 0.0, u = 0.0;
    double twiceKinetic = 0.0;
  };

  static void placeRoot(const Link& link, const At& at, Node& n);
  static void place(const Link& link, const Node* parent, const At& at, Node& n);
  static void takeInertia(const Link& link, bool coriolis, Node& n);
  static void sweepOut(const Link* links, int count, const At& at, Node* nodes);
  static void sweepIn(const Link* links, int count, const double* armature, const double* tau,
                      Node* nodes);
  static void accelerate(const Link* links, int count, Node* nodes, double* vdot);
  void solveRoot(const At& at, double* vdot);

  std::vector<Link> links_;
  std::vector<Node> nodes_;
  std::vector<double> armature_;  ///< (nv)
  int first_ = 0, end_ = 0;       ///< dofs of the tree
};

}  // namespace softgauss
