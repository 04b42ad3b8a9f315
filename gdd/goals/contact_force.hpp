// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contact force: the sum of the contact forces on a link seeks a given one.
///
///   ℓ_f(a) = ½ w |S (Σ_i ± R_WC,i f_i − f*)|²                                            (9.19)
/// over the contacts of the link with all else, with the world, or with one other link; S: the
/// chosen axes of the world. f is −∇s at a, as forward dynamics will give it for the control that
/// is found: no force is assumed that does not act. A link that touches nothing has no force,
/// whatever a is: the goal then asks for nothing, and does not look for contact.

#include <array>

#include "softgauss/gdd/goals/contact_selection.hpp"

namespace softgauss::gdd {

class ContactForce final : public Goal {
 public:
  std::string link;                            ///< for the name
  ContactSelection contacts;                   ///< on the link, by all else
  Vector3 force;                               ///< f*, on the link, world axes [N]
  std::array<bool, 3> axes{true, true, true};  ///< S: of x, y, z
  double weight;                               ///< w [1/kg]; default 2.5 over referenceMass()

  /// Throws ModelError when the model has no such link or the link cannot touch anything.
  ContactForce(const Model& model, const std::string& link, const Vector3& force);
  /// Counts contacts with `other` only: a link, or "world" for all that is fixed to the world.
  void countOnly(const Model& model, const std::string& other);

  std::string name() const override { return "contact_force " + link; }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override {
    return contacts.concerns(model, tree);
  }
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
  /// Of the rows' present forces: after a step, those that acted in it [N].
  Vector3 measured(const Data& data) const;
};

}  // namespace softgauss::gdd
