// SPDX-License-Identifier: Apache-2.0
#include "engine/model/detail/contact_pairs.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "engine/model/detail/spec_checks.hpp"

namespace softgauss::detail {
namespace {

/// The only geometry of that name.
int findGeometry(const Model& model, const std::string& name, const SourceLocation& where,
                 const std::string& element) {
  int found = -1, count = 0;
  for (std::size_t i = 0; i < model.geometries.size(); ++i)
    if (model.geometries[i].name == name) found = static_cast<int>(i), ++count;
  if (count == 1) return found;
  throw ModelError(
      where, element,
      "geometry '" + name + "' " +
          (count == 0 ? "does not exist"
                      : "is the name of " + std::to_string(count) + " geometries, expected one"));
}

}  // namespace

void addContactPairs(Model& model, const std::vector<PairSpec>& specs) {
  const auto order = [](const ContactPair& a, const ContactPair& b) {
    return std::tie(a.geometryA, a.geometryB) < std::tie(b.geometryA, b.geometryB);
  };
  for (const PairSpec& spec : specs) {
    const std::string element = "pair '" + spec.geometryA + "' - '" + spec.geometryB + "'";
    ContactPair pair;
    pair.geometryA = findGeometry(model, spec.geometryA, spec.where, element);
    pair.geometryB = findGeometry(model, spec.geometryB, spec.where, element);
    if (pair.geometryA == pair.geometryB)
      throw ModelError(spec.where, element, "is one geometry, expected two");
    if (pair.geometryA > pair.geometryB) std::swap(pair.geometryA, pair.geometryB);
    checkMaterial(spec.material, model.options, spec.where, element);
    pair.material = spec.material;
    const auto at =
        std::lower_bound(model.contactPairs.begin(), model.contactPairs.end(), pair, order);
    if (at != model.contactPairs.end() && !order(pair, *at))
      throw ModelError(spec.where, element, "is given twice");
    model.contactPairs.insert(at, pair);
  }
}

}  // namespace softgauss::detail
