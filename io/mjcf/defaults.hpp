// SPDX-License-Identifier: Apache-2.0
#pragma once

/// <default>: classes of attributes, each over those of the class that it is in.

#include <map>

#include "softgauss/io/mjcf/actuator.hpp"
#include "softgauss/io/mjcf/geom.hpp"
#include "softgauss/io/mjcf/joint.hpp"

namespace softgauss::io::mjcf {

/// Attributes of a <pair>, for which the file gives what the geoms have not.
struct Pair {
  Element element;
  std::string geom1, geom2;
  int condim = 3;
  std::array<double, 5> friction{1, 1, 0.005, 0.0001, 0.0001};
  Softness softness;
  std::array<double, 2> solrefFriction{};
  double margin = 0.0, adhesion = 0.0;

  void read(const Element& element);
  Material surface() const;
};

struct DefaultClass {
  Joint joint;
  Geom geom;
  PoseAttributes site;
  Pair pair;
  Softness equality;
  Actuator actuator;
  MeshAttributes mesh;
  std::optional<std::array<double, 4>> material;  ///< its rgba
  std::vector<Element> tendon;                    ///< outermost class first
};

class Defaults {
 public:
  Defaults();
  /// A <default> outside of others.
  void read(const Element& element);
  /// The class that an element names, or else `otherwise`.
  const DefaultClass& of(const Element& element, const DefaultClass& otherwise,
                         const char* attribute = "class") const;
  const DefaultClass& top() const { return classes_.at("main"); }

 private:
  void readClass(const Element& element, const std::string& name);
  std::map<std::string, DefaultClass> classes_;
};

}  // namespace softgauss::io::mjcf
