// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/center_of_pressure.hpp"

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::gdd {
namespace {

constexpr double kWeightPerInverseMass = 10.0;  // [1/m²], as of MomentumGoal::angularWeight

}  // namespace

CenterOfPressure::CenterOfPressure(const Model& model, int robot, const Vector3& target)
    : p_WTarget(target), weight(kWeightPerInverseMass / massOfRobot(model, robot)) {
  const Vector3& gravity = model.options.gravity;
  n_W = gravity.norm() > 0.0 ? Vector3(-gravity.normalized()) : Vector3(Vector3::UnitZ());
  for (const Geometry& g : model.geometries)
    contacts.on.push_back(g.body != 0 && model.bodies[g.body].robot == robot);
  contacts.by = geometriesOfWorld(model);
}

void CenterOfPressure::countOnly(const Model& model, const std::vector<std::string>& links) {
  contacts.on.assign(contacts.on.size(), 0);
  for (const std::string& link : links) {
    const std::vector<char> chosen = geometriesOf(model, link, name());
    for (std::size_t g = 0; g < chosen.size(); ++g)
      contacts.on[g] = contacts.on[g] || (chosen[g] && !contacts.by[g]);
  }
}

void CenterOfPressure::addCost(const GoalContext& context, GoalCost& cost) const {
  const Matrix3 across = Matrix3::Identity() - n_W * n_W.transpose();
  cost.forces().add(weight, Vector3::Zero());
  contacts.visit(context.data, [&](const auto& rows, int i, const Contact& c, double sign) {
    const Matrix3& R_WC = rows.contactsWithRows()[i].R_WC;
    ContactForceCost::Map C;
    C.leftCols<3>() = sign * across * skew(c.p_WC - p_WTarget) * R_WC;
    C.rightCols<3>() = sign * across * R_WC;
    cost.forces().addContact(rows.kCone, i, C);
  });
}

std::optional<Vector3> CenterOfPressure::measured(const Data& data) const {
  Vector3 moment = Vector3::Zero();  // about p*
  double load = 0.0;
  contacts.visit(data, [&](const auto& rows, int i, const Contact& c, double sign) {
    const Vector3 force = sign * rows.force(i);
    moment += (c.p_WC - p_WTarget).cross(force) + sign * rows.moment(i);
    load += n_W.dot(force);
  });
  if (!(load > 0.0)) return std::nullopt;
  // Π m = (p − p*) × n f_n, so p − p* = n × m / f_n.
  return Vector3(p_WTarget + n_W.cross(moment) / load);
}

}  // namespace softgauss::gdd
