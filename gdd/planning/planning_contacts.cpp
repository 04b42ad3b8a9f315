// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/planning_contacts.hpp"

namespace softgauss::planning {

void PlanningContacts::check() const {
  const auto expect = [](bool holds, const char* name, double value, const char* range) {
    if (!holds)
      throw ModelError({}, "planning contacts",
                       std::string(name) + " is " + std::to_string(value) + ", expected " + range);
  };
  const auto isShare = [](double d) { return d > 0.0 && d < 1.0; };
  expect(margin >= 0.0 && margin < kInfinity, "margin", margin, "≥ 0");
  expect(width > 0.0 && width < kInfinity, "width", width, "> 0");
  expect(isShare(dMin), "dMin", dMin, "between 0 and 1");
  expect(isShare(dMax), "dMax", dMax, "between 0 and 1");
}

Material PlanningContacts::material(const Material& own, double share) const {
  Material m = own;
  m.margin = share * margin;
  m.spring.reset();
  m.impedance.dMin = dMin;
  m.impedance.dMax = dMax;
  m.impedance.width = width;
  return m;
}

}  // namespace softgauss::planning
