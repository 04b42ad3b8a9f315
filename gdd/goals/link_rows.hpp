// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What goals of links are written in: the motion of a link's point and its rotation, as rows; and
/// the metric of section III of the paper for such rows.
///
///   y = J a + J̇ v,   y = (acceleration of the point [m/s²], angular acceleration [rad/s²])
///
/// In the consistent metric a residual e = J a − y* is weighted by the inertia that the rows feel:
///   ℓ(a) = ½ (W½ e)ᵀ (J M⁻¹ Jᵀ)⁻¹ (W½ e),   W diagonal, [-]                               (9.5)
/// With one weight w, and nothing else, the share w/(1 + w) of every wish comes true, in every
/// configuration. Directions in which the rows cannot move have no inertia to weigh: with rows
/// scaled to (J M⁻¹Jᵀ)_ii = 1, eigenvectors whose eigenvalue is below 10⁻⁶ of the largest are left
/// out of ℓ.

#include "softgauss/gdd/goal.hpp"

namespace softgauss::gdd {

/// How the residual of a goal of a link is measured.
enum class LinkMetric {
  euclidean,  ///< ½ w |e|², w in kg (points) and kg m² (rotations)
  consistent  ///< (9.5), w without unit
};

/// The rows of a point of a body and of the body's rotation, world axes.
struct LinkRows {
  GoalWorkspace::Rows& J;  ///< (6 × nv) of the point, then of the rotation
  Vector6 bias;            ///< J̇ v
  Vector6 velocity;        ///< J v

  /// Writes J into `work`.
  LinkRows(const GoalContext& context, int body, const Vector3& p_WP, GoalWorkspace& work);
};

/// Whether a link, by its index into Model::frames, is of a tree.
inline bool isOfTree(const Model& model, int frame, int tree) {
  return model.bodies[idx(model.frames[idx(frame)].body)].tree == tree;
}

/// How much a goal of a link weighs.
struct LinkWeights {
  double point;     ///< w [kg; - if consistent]
  double rotation;  ///< w_r [kg m²; - if consistent]
  LinkMetric metric = LinkMetric::euclidean;
};

/// Adds ½ w |p̈ − wished|², and with six numbers ½ w_r |ω̇ − wished|² for the last three, or both in
/// the consistent metric.
void addLinkCost(const GoalContext& context, const LinkRows& rows,
                 const Eigen::Ref<const VectorX>& wished, const LinkWeights& weights,
                 GoalCost& cost);

}  // namespace softgauss::gdd
