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

std::optional<ContactSelection> contactsWithin(const ContactSelection& contacts,
                                               const SubModel& island, const std::string& goal) {
  ContactSelection part;
  bool any = false;
  for (std::size_t g = 0; g < island.geometries.size(); ++g) {
    const auto ofWhole = static_cast<std::size_t>(island.geometries[g]);
    part.on.push_back(contacts.on[ofWhole]);
    part.by.push_back(contacts.by[ofWhole]);
    if (!part.on.back()) continue;
    any = true;
    if (island.model.geometries[g].body == 0)
      throw ModelError({}, "goal '" + goal + "'",
                       "counts forces on the world, expected forces on moving bodies where islands "
                       "are solved separately");
  }
  if (!any) return std::nullopt;
  return part;
}

}  // namespace softgauss::gdd
