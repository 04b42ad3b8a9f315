// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/contact_links.hpp"

#include <map>
#include <utility>

namespace softgauss::io {

ContactLinks::ContactLinks(const Model& model) {
  std::map<std::pair<int, std::string>, int> known;
  for (const Geometry& geometry : model.geometries) {
    if (geometry.body == 0) {
      linkOf_.push_back(-1);
      continue;
    }
    const auto [place, isNew] = known.try_emplace({geometry.body, geometry.link}, size());
    if (isNew) names_.push_back(geometry.link);
    linkOf_.push_back(place->second);
  }
}

void ContactLinks::forces(const std::vector<Snapshot::ContactForce>& contacts, VectorX& out) const {
  out.setZero(3 * size());
  for (const Snapshot::ContactForce& c : contacts) {
    if (const int b = of(c.geometryB); b >= 0) out.segment<3>(3 * b) += c.force;
    if (const int a = of(c.geometryA); a >= 0) out.segment<3>(3 * a) -= c.force;
  }
}

}  // namespace softgauss::io
