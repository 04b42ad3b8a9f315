// SPDX-License-Identifier: Apache-2.0
#include "engine/model/detail/contact_pairs.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "engine/model/detail/spec_checks.hpp"

namespace softgauss::detail {
namespace {

/// All geometries of the link of that name, or else the only geometry of that name.
std::vector<int> findGeometries(const Model& model, const std::string& name,
                                const SourceLocation& where, const std::string& element) {
  std::vector<int> ofLink, ofName;
  for (int i = 0; i < static_cast<int>(model.geometries.size()); ++i) {
    const Geometry& geometry = model.geometries[static_cast<std::size_t>(i)];
    if (geometry.link == name) ofLink.push_back(i);
    if (geometry.name == name) ofName.push_back(i);
  }
  if (!ofLink.empty()) return ofLink;
  if (ofName.size() == 1) return ofName;
  throw ModelError(where, element,
                   ofName.empty()
                       ? "geometry '" + name +
                             "' does not exist, and no link of that name has a "
                             "collision shape"
                       : "geometry '" + name + "' is the name of " + std::to_string(ofName.size()) +
                             " geometries, expected one");
}

}  // namespace

void addContactPairs(Model& model, const std::vector<PairSpec>& specs) {
  const auto order = [](const ContactPair& a, const ContactPair& b) {
    return std::tie(a.geometryA, a.geometryB) < std::tie(b.geometryA, b.geometryB);
  };
  std::vector<ContactPair>& pairs = model.contactPairs;
  for (const PairSpec& spec : specs) {
    const std::string element = "pair '" + spec.geometryA + "' - '" + spec.geometryB + "'";
    checkMaterial(spec.material, model.options, spec.where, element);
    const std::vector<int> second = findGeometries(model, spec.geometryB, spec.where, element);
    for (const int a : findGeometries(model, spec.geometryA, spec.where, element)) {
      for (const int b : second) {
        if (a == b) throw ModelError(spec.where, element, "is one geometry, expected two");
        const ContactPair pair{std::min(a, b), std::max(a, b), spec.material};
        const auto at = std::lower_bound(pairs.begin(), pairs.end(), pair, order);
        if (at != pairs.end() && !order(pair, *at))
          throw ModelError(spec.where, element, "is given twice");
        pairs.insert(at, pair);
      }
    }
  }
}

}  // namespace softgauss::detail
