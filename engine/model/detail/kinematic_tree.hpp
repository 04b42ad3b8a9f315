// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Orders the links of a description depth first, or says why they are not a forest.

#include <string>
#include <unordered_map>
#include <vector>

#include "softgauss/engine/model/model_builder.hpp"

namespace softgauss::detail {

/// A joint between two links, as indices; joint −1 and parent −1 for a root.
struct TreeEdge {
  int joint = -1;
  int parent = -1;
  int child = -1;
};

struct LinkOrder {
  std::vector<TreeEdge> visits;  ///< parents before children, subtrees contiguous
  std::unordered_map<std::string, int> indexOf;
  int find(const std::string& link) const {
    const auto it = indexOf.find(link);
    return it == indexOf.end() ? -1 : it->second;
  }
};

/// What the names of the three joints that a planar joint is made of end in.
inline constexpr const char* kPlanarParts[] = {".x", ".y", ".rz"};

/// Throws ModelError on duplicate names, unknown links, two parents, a cycle.
LinkOrder orderLinks(const std::string& modelName, const std::vector<LinkSpec>& links,
                     const std::vector<JointSpec>& joints);

}  // namespace softgauss::detail
