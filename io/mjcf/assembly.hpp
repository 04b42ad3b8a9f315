// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Bodies, joints, geoms and contacts of the file as links, joints and geometries of a builder.

#include "softgauss/io/mjcf/body.hpp"
#include "softgauss/io/scene.hpp"

namespace softgauss::io::mjcf {

class Assembly {
 public:
  Assembly(const std::vector<Body>& bodies, const Compiler& compiler, SceneFile& scene)
      : bodies_(bodies), compiler_(compiler), scene_(scene) {
    for (const Body& body : bodies) names_.insert(body.name);
  }

  void addBodies();
  void addGeoms(Assets& assets, const std::set<std::string>& paired, MeshUse meshes);
  /// <contact>: pairs and excludes.
  void addPairs(const std::vector<Pair>& pairs);
  void addExclude(const Element& element);

 private:
  void addBody(const Body& body);
  void addSites(const Body& body);
  std::string ownName(std::string name);

  const std::vector<Body>& bodies_;
  const Compiler& compiler_;
  SceneFile& scene_;
  std::set<std::string> names_;                    ///< of links and geometries
  std::map<std::string, std::string> geometryOf_;  ///< geometry of a geom
};

}  // namespace softgauss::io::mjcf
