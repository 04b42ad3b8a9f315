// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/defaults.hpp"

#include <fmt/format.h>

#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::mjcf {

void Pair::read(const Element& e) {
  e.expectAttributes({"name", "class", "geom1", "geom2", "condim", "friction", "solref",
                      "solreffriction", "solimp", "gap", "margin", "adhesion"});
  e.expectChildren({});
  element = e;
  e.read("geom1", geom1);
  e.read("geom2", geom2);
  e.read("condim", condim);
  if (condim != 1 && condim != 3 && condim != 4 && condim != 6)
    e.fail(fmt::format("condim is {}, expected 1, 3, 4 or 6", condim));
  e.read("friction", friction, 1);
  e.read("solreffriction", solrefFriction, 1);
  softness.read(e, "solref", "solimp");
  e.read("margin", margin);
  e.read("adhesion", adhesion);
}

Material Pair::surface() const {
  if (adhesion != 0.0) element.fail("has adhesion, which is not simulated; expected none");
  if (solrefFriction != std::array<double, 2>{})
    element.fail("has solreffriction, which is not simulated; expected solref alone");
  if (friction[0] != friction[1] || friction[3] != friction[4])
    element.fail(
        fmt::format("has frictions that differ by direction ({:g} and {:g}, {:g} and {:g}), "
                    "which is not simulated; expected equal ones",
                    friction[0], friction[1], friction[3], friction[4]));
  for (const double mu : friction)
    if (!(mu >= 0.0)) element.fail(fmt::format("friction holds {:g}, expected 0 or more", mu));
  Material m;
  m.slidingFriction = friction[0];
  m.torsionalFriction = friction[2];
  m.rollingFriction = friction[3];
  m.condim = condim;
  m.margin = margin;
  m.impedance = softness.impedance(element);
  return m;
}

Defaults::Defaults() { classes_["main"]; }

void Defaults::read(const Element& element) {
  const std::string name = element.text("class");
  if (!name.empty() && name != "main")
    element.fail(fmt::format("class is {}, expected main, or none, for the outermost default",
                             detail::quotedText(name)));
  readClass(element, "main");
}

void Defaults::readClass(const Element& element, const std::string& name) {
  element.expectAttributes({"class"});
  element.expectChildren({"default",     "joint",   "geom",       "site",     "pair",
                          "equality",    "mesh",    "tendon",     "material", "camera",
                          "light",       "general", "motor",      "position", "velocity",
                          "intvelocity", "damper",  "cylinder",   "muscle",   "adhesion",
                          "dcmotor",     "pid",     "orientation"});
  DefaultClass& own = classes_[name];
  for (const Element& e : element.children) {
    if (e.tag == "default") continue;
    if (e.tag == "joint") {
      own.joint.read(e);
    } else if (e.tag == "geom") {
      own.geom.read(e);
    } else if (e.tag == "site") {
      own.site.read(e);
    } else if (e.tag == "pair") {
      own.pair.read(e);
    } else if (e.tag == "equality") {
      own.equality.read(e, "solref", "solimp");
    } else if (e.tag == "mesh") {
      own.mesh.read(e);
    } else if (e.tag == "tendon") {
      own.tendon.push_back(e);
    } else if (e.tag == "material") {
      if (std::array<double, 4> rgba; e.readAll("rgba", rgba)) own.material = rgba;
    } else if (e.tag != "camera" && e.tag != "light") {
      own.actuator.read(e);
    }
  }
  for (const Element& e : element.children) {
    if (e.tag != "default") continue;
    const std::string inner = e.text("class");
    if (inner.empty()) e.fail("has no class, expected a name of its own");
    if (!classes_.emplace(inner, classes_.at(name)).second)
      e.fail(fmt::format("class {} is given a second time, expected a name of its own",
                         detail::quotedText(inner)));
    readClass(e, inner);
  }
}

const DefaultClass& Defaults::of(const Element& element, const DefaultClass& otherwise,
                                 const char* attribute) const {
  const std::string* name = element.find(attribute);
  if (!name) return otherwise;
  const auto found = classes_.find(*name);
  if (found != classes_.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, value] : classes_) names.push_back(known);
  element.fail(fmt::format("{} {} does not exist{}", attribute, detail::quotedText(*name),
                           detail::offered(*name, names)));
}

}  // namespace softgauss::io::mjcf
