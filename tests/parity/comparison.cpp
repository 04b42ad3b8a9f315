// SPDX-License-Identifier: Apache-2.0
#include "tests/parity/comparison.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

namespace softgauss::test {
namespace {

constexpr double kSmallRow = 1e-3;  // of J: rows of zeros, in mechanisms of a plane

/// The index of the nearest item that is not taken; npos when all are.
template <class Distance>
std::size_t takeNearest(std::vector<bool>& taken, const Distance& distance) {
  std::size_t nearest = taken.size();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (const double d = taken[i] ? least : distance(i); d < least) nearest = i, least = d;
  if (nearest < taken.size()) taken[nearest] = true;
  return nearest;
}

std::string counts(const char* what, std::size_t ours, std::size_t theirs) {
  return std::to_string(ours) + " " + what + ", the log has " + std::to_string(theirs);
}

}  // namespace

double relativeDifference(const MatrixX& a, const MatrixX& b, double floor) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return kInfinity;
  if (a.size() == 0) return 0.0;
  return (a - b).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() /
         std::max(floor, b.cwiseAbs().maxCoeff());
}

double smallForce(const ReferenceState& state) {
  return state.M.cwiseAbs().maxCoeff() * kSmallAcceleration;
}

std::vector<Contact> loggedContacts(const Model& model, const std::vector<ReferenceContact>& log) {
  const auto geometry = [&](const std::string& name) {
    const auto found = std::find_if(model.geometries.begin(), model.geometries.end(),
                                    [&](const Geometry& g) { return g.name == name; });
    if (found == model.geometries.end()) throw std::runtime_error("no geometry " + name);
    return static_cast<int>(found - model.geometries.begin());
  };
  std::vector<Contact> contacts;
  for (const ReferenceContact& theirs : log) {
    Contact& c = contacts.emplace_back();
    c.geometryA = geometry(theirs.geometries[0]);
    c.geometryB = geometry(theirs.geometries[1]);
    c.bodyA = model.geometries[static_cast<std::size_t>(c.geometryA)].body;
    c.bodyB = model.geometries[static_cast<std::size_t>(c.geometryB)].body;
    c.p_WC = theirs.position;
    c.n_W = theirs.normal;
    c.tangent_W = theirs.tangent;
    c.distance = theirs.distance;
  }
  return contacts;
}

std::vector<Row> rowsOf(const Model& model, const Data& data) {
  std::vector<Row> rows;
  const auto add = [&](const auto& effect, int i, double D, bool eitherWay) {
    const auto at = static_cast<std::size_t>(i);
    Row row{VectorX::Zero(model.nv), D, effect.reference[at], effect.f[at], eitherWay};
    effect.addRow(i, 1.0, row.J);
    rows.push_back(std::move(row));
  };
  data.constraints.visit([&](const auto& effect) {
    if constexpr (requires { effect.D; })
      for (int i = 0; i < effect.rowCount(); ++i)
        add(effect, i, effect.D[static_cast<std::size_t>(i)], false);
  });
  // A cone's rows are as stiff as where it sticks.
  const EllipticContact& cones = data.constraints.ellipticContact;
  for (std::size_t i = 0; i < cones.contactsWithRows().size(); ++i) {
    const EllipticCone& cone = cones.cone(static_cast<int>(i));
    const int first = cones.contactsWithRows()[i].row;
    add(cones, first, cone.D, false);
    for (std::size_t k = 0; k + 1 < static_cast<std::size_t>(cone.dim); ++k) {
      const double share = cone.friction[k] / cone.mu;
      add(cones, first + 1 + static_cast<int>(k), cone.D * share * share, true);
    }
  }
  return rows;
}

ContactDifference compareContacts(const Model& model, const ContactSet& contacts,
                                  const std::vector<ReferenceContact>& reference) {
  ContactDifference worst;
  if (contacts.contacts.size() != reference.size()) {
    worst.unmatched = counts("contacts", contacts.contacts.size(), reference.size());
    return worst;
  }
  std::vector<bool> taken(reference.size(), false);
  for (const ReferenceContact& theirs : reference) {
    // Which of the two geometries comes first is the engine's choice; the normal turns with it.
    const auto turned = [&](const Contact& ours) {
      return model.geometries[static_cast<std::size_t>(ours.geometryA)].name !=
             theirs.geometries[0];
    };
    const auto otherPair = [&](const Contact& ours) {
      const bool t = turned(ours);
      const auto name = [&](int g) { return model.geometries[static_cast<std::size_t>(g)].name; };
      return name(ours.geometryA) != theirs.geometries[t ? 1 : 0] ||
             name(ours.geometryB) != theirs.geometries[t ? 0 : 1];
    };
    const std::size_t nearest = takeNearest(taken, [&](std::size_t i) {
      const Contact& ours = contacts.contacts[i];
      return otherPair(ours) ? kInfinity : (ours.p_WC - theirs.position).norm();
    });
    if (nearest == taken.size()) {
      worst.unmatched = "no contact of " + theirs.geometries[0] + " and " + theirs.geometries[1];
      return worst;
    }
    const Contact& ours = contacts.contacts[nearest];
    const double sign = turned(ours) ? -1.0 : 1.0;
    worst.position = std::max(worst.position, (ours.p_WC - theirs.position).cwiseAbs().maxCoeff());
    worst.normal = std::max(worst.normal, (sign * ours.n_W - theirs.normal).cwiseAbs().maxCoeff());
    worst.distance = std::max(worst.distance, std::abs(ours.distance - theirs.distance));
  }
  return worst;
}

/// Rows that differ by less are the same row.
constexpr double kAlike = 1e-10;

RowDifference compareRows(const std::vector<Row>& rows, const std::vector<Row>& reference,
                          double smallForce) {
  RowDifference worst;
  if (rows.size() != reference.size()) {
    worst.unmatched = counts("rows", rows.size(), reference.size());
    return worst;
  }
  double largestForce = smallForce;
  for (const Row& row : reference) largestForce = std::max(largestForce, std::abs(row.force));

  std::vector<bool> taken(rows.size(), false);
  for (const Row& theirs : reference) {
    const auto signOf = [&](std::size_t i) {
      return rows[i].eitherWay && rows[i].J.dot(theirs.J) < 0.0 ? -1.0 : 1.0;
    };
    const auto differenceOf = [&](std::size_t i) {
      const Row& ours = rows[i];
      const double sign = signOf(i);
      return std::array{relativeDifference(sign * ours.J, theirs.J, kSmallRow),
                        std::abs(sign * ours.reference - theirs.reference) /
                            std::max(kSmallAcceleration, std::abs(theirs.reference)),
                        std::abs(ours.D - theirs.D) / theirs.D};
    };
    const std::size_t nearest = takeNearest(taken, [&](std::size_t i) {
      const auto d = differenceOf(i);
      // Rows that are alike to rounding, such as those of spin, are told apart by their force.
      const double force = std::abs(signOf(i) * rows[i].force - theirs.force) / largestForce;
      return d[0] + d[1] + d[2] + kAlike * force;
    });
    if (nearest == taken.size()) {
      worst.unmatched = "a row is not finite";
      return worst;
    }
    const auto d = differenceOf(nearest);
    worst.J = std::max(worst.J, d[0]);
    worst.reference = std::max(worst.reference, d[1]);
    worst.D = std::max(worst.D, d[2]);
    worst.force = std::max(
        worst.force, std::abs(signOf(nearest) * rows[nearest].force - theirs.force) / largestForce);
  }
  return worst;
}

double stateDifference(const Model& model, const VectorX& q, const VectorX& v, const VectorX& qRef,
                       const VectorX& vRef) {
  return std::max(positionDifference(model, qRef, q).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
                  (v - vRef).cwiseAbs().maxCoeff<Eigen::PropagateNaN>());
}

}  // namespace softgauss::test
