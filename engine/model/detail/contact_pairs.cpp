// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/detail/contact_pairs.hpp"

#include <algorithm>
#include <set>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "softgauss/engine/model/detail/spec_checks.hpp"

namespace softgauss::detail {
namespace {

/// Geometries by the name of their link, and by their own.
struct Names {
  explicit Names(const Model& model) {
    for (int i = 0; i < static_cast<int>(model.geometries.size()); ++i) {
      const Geometry& geometry = model.geometries[static_cast<std::size_t>(i)];
      ofLink[geometry.link].push_back(i);
      ofName[geometry.name].push_back(i);
    }
  }
  std::unordered_map<std::string_view, std::vector<int>> ofLink, ofName;
};

/// All geometries of the link of that name, or else the only geometry of that name.
const std::vector<int>& findGeometries(const Names& names, const std::string& name,
                                       const SourceLocation& where, const std::string& element) {
  if (const auto found = names.ofLink.find(name); found != names.ofLink.end()) return found->second;
  const auto found = names.ofName.find(name);
  if (found == names.ofName.end())
    throw ModelError(
        where, element,
        "geometry '" + name + "' does not exist, and no link of that name has a collision shape");
  if (found->second.size() > 1)
    throw ModelError(where, element,
                     "geometry '" + name + "' is the name of " +
                         std::to_string(found->second.size()) + " geometries, expected one");
  return found->second;
}

}  // namespace

void addContactPairs(Model& model, const std::vector<PairSpec>& specs) {
  if (specs.empty()) return;
  const Names names(model);
  std::set<std::pair<int, int>> given;
  for (const PairSpec& spec : specs) {
    const std::string element = "pair '" + spec.geometryA + "' - '" + spec.geometryB + "'";
    checkMaterial(spec.material, model.options, spec.where, element);
    const std::vector<int>& second = findGeometries(names, spec.geometryB, spec.where, element);
    for (const int a : findGeometries(names, spec.geometryA, spec.where, element)) {
      for (const int b : second) {
        if (a == b) throw ModelError(spec.where, element, "is one geometry, expected two");
        if (!given.emplace(std::min(a, b), std::max(a, b)).second)
          throw ModelError(spec.where, element, "is given twice");
        model.contactPairs.push_back({std::min(a, b), std::max(a, b), spec.material, spec.always});
      }
    }
  }
  std::sort(model.contactPairs.begin(), model.contactPairs.end(),
            [](const ContactPair& a, const ContactPair& b) {
              return std::tie(a.geometryA, a.geometryB) < std::tie(b.geometryA, b.geometryB);
            });
}

}  // namespace softgauss::detail
