// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/contact_selection.hpp"

#include <algorithm>

namespace softgauss::gdd {

std::vector<char> geometriesOf(const Model& model, const std::string& link,
                               const std::string& goal) {
  if (model.findFrame(link) < 0)
    throw ModelError({}, "goal '" + goal + "'", "the model has no link '" + link + "'");
  std::vector<char> chosen;
  for (const Geometry& g : model.geometries) chosen.push_back(g.link == link);
  if (std::find(chosen.begin(), chosen.end(), 1) == chosen.end())
    throw ModelError({}, "goal '" + goal + "'",
                     "link '" + link + "' has no collision geometry, so nothing touches it");
  return chosen;
}

std::vector<char> geometriesOfWorld(const Model& model) {
  std::vector<char> chosen;
  for (const Geometry& g : model.geometries) chosen.push_back(g.body == 0);
  return chosen;
}

bool ContactSelection::concerns(const Model& model, int tree) const {
  for (std::size_t g = 0; g < model.geometries.size(); ++g)
    if ((on[g] || by[g]) && model.bodies[idx(model.geometries[g].body)].tree == tree) return true;
  return false;
}

}  // namespace softgauss::gdd
