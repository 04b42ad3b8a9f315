// SPDX-License-Identifier: Apache-2.0
#pragma once

/// <worldbody>, <body> and <frame>: the tree, its poses as they are written, and its inertias.

#include <set>

#include "softgauss/io/mjcf/defaults.hpp"

namespace softgauss::io::mjcf {

/// A geom or a site, and the frame that it is written in.
template <class T>
struct Placed {
  T item;
  Transform X_BF;
};

struct Site {
  Element element;
  std::string name;
  Transform X_BS;
};

struct Body {
  Element element;
  std::string name;               ///< of its own, given or made; "world" for the first
  int parent = -1;                ///< index in the list of bodies
  Transform X_PB;                 ///< with all joints at their references
  Vector3 pos = Vector3::Zero();  ///< as it is written
  std::optional<Element> inertial;
  std::vector<Joint> joints;
  std::vector<Placed<Geom>> geoms;
  std::vector<Site> sites;
  LinkSpec link;              ///< mass and inertia, by weighBodies()
  std::vector<Solid> solids;  ///< of the geoms, by weighBodies()

  bool isFixed() const { return joints.empty(); }
};

/// Depth first, the world first. Every body, joint and geom has a name of its own.
std::vector<Body> readBodies(const std::vector<const Element*>& worldbodies,
                             const Compiler& compiler, const Defaults& defaults);

/// Works out geoms, masses and inertias. `paired`: geoms that a <pair> names.
void weighBodies(std::vector<Body>& bodies, const Compiler& compiler, Assets& assets,
                 const std::set<std::string>& paired);

}  // namespace softgauss::io::mjcf
