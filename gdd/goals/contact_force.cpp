// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/contact_force.hpp"

#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::gdd {

ContactForce::ContactForce(const Model& model, const std::string& linkName, const Vector3& wished)
    : link(linkName),
      force(wished),
      weight(kReachWeightPerMass / referenceMass(model, model.findFrame(linkName))) {
  contacts.on = geometriesOf(model, link, name());
  for (const char on : contacts.on) contacts.by.push_back(!on);
}

void ContactForce::countOnly(const Model& model, const std::string& other) {
  const std::vector<char> chosen =
      other == "world" ? geometriesOfWorld(model) : geometriesOf(model, other, name());
  for (std::size_t g = 0; g < chosen.size(); ++g) contacts.by[g] = chosen[g] && !contacts.on[g];
}

void ContactForce::addCost(const GoalContext& context, GoalCost& cost) const {
  const Vector3 chosen(axes[0], axes[1], axes[2]);
  cost.forces().add(weight, chosen.cwiseProduct(force));
  contacts.visit(context.data, [&](const auto& rows, int i, const Contact&, double sign) {
    ContactForceCost::Map C = ContactForceCost::Map::Zero();
    C.leftCols<3>() = sign * chosen.asDiagonal() * rows.contactsWithRows()[i].R_WC;
    cost.forces().addContact(rows.kCone, i, C);
  });
}

Vector3 ContactForce::measured(const Data& data) const {
  Vector3 sum = Vector3::Zero();
  contacts.visit(data, [&](const auto& rows, int i, const Contact&, double sign) {
    sum += sign * rows.force(i);
  });
  return sum;
}

}  // namespace softgauss::gdd
