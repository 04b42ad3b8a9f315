// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/choose_meshes.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/model/closed_surface.hpp"
#include "softgauss/engine/model/mass_properties.hpp"

namespace softgauss::collision {
namespace {

/// What is known of a mesh, whatever its geometries.
struct MeshFacts {
  SurfaceDefects defects;
  double volume = 0.0, hullVolume = 0.0;  ///< [m³], of one without defects

  bool isHull() const { return !defects.any() && hullVolume <= (1.0 + kHullExcess) * volume; }
};

MeshFacts factsOf(const std::shared_ptr<const Mesh>& mesh, PreparedMeshes& meshes) {
  MeshFacts facts;
  facts.defects = surfaceDefects(*mesh);
  if (facts.defects.any()) return facts;
  const auto hull = std::make_shared<const Mesh>(triangulated(*meshes.hull(mesh)));
  facts.hullVolume = solidOf(Shape::hull(hull), 1.0).mass;
  facts.volume = solidOf(Shape::hull(mesh), 1.0).mass;
  return facts;
}

std::string liters(double volume) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g l", 1e3 * volume);
  return text;
}

std::string fileName(const std::string& path) {
  const std::size_t slash = path.find_last_of("/\\");
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

/// How many edges are open, and where the first is, as the shape has it.
std::string rimsOf(const Mesh& mesh, const SurfaceDefects& defects) {
  const Vector3 x = 0.5 * (mesh.vertices[static_cast<std::size_t>(defects.openEdge[0])] +
                           mesh.vertices[static_cast<std::size_t>(defects.openEdge[1])]);
  char text[128];
  std::snprintf(text, sizeof text, ", %d open edges, the first at %.4g, %.4g, %.4g m",
                defects.openEdges, x.x(), x.y(), x.z());
  return text;
}

/// Links of one kind, told in one warning.
class Told {
 public:
  void add(const Geometry& geometry, const std::string& what) {
    if (++count_ <= kMostTold)
      text_ += (count_ > 1 ? "; " : "") + ("link '" + geometry.link + "' (" +
                                           fileName(geometry.shape.mesh->file) + ")" + what);
  }
  void appendTo(std::vector<std::string>& warnings, const std::string& before,
                const std::string& after) const {
    if (count_ == 0) return;
    const std::string more =
        count_ > kMostTold ? " and " + std::to_string(count_ - kMostTold) + " more" : "";
    warnings.push_back(before + text_ + more + after);
  }

 private:
  static constexpr int kMostTold = 8;
  std::string text_;
  int count_ = 0;
};

}  // namespace

void chooseMeshes(Model& model, PreparedMeshes& meshes) {
  std::map<const Mesh*, MeshFacts> known;
  Told filled, openHulls, openSurfaces, turned, rooms, asked;
  for (Geometry& g : model.geometries) {
    if (g.shape.kind == ShapeKind::triangles) {
      if (meshes.surface(g.shape.mesh)->isConvex())
        g.shape.kind = ShapeKind::mesh;
      else if (const SurfaceDefects defects = surfaceDefects(*g.shape.mesh);
               defects.insideOutShells > 0 && defects.openEdges == 0)
        rooms.add(g, "");
    }
    const bool isFixed = g.body == 0, isAsked = !g.automaticMesh;
    if (isAsked && !(isFixed && g.shape.kind == ShapeKind::mesh)) continue;
    g.automaticMesh = false;
    const auto [at, isNew] = known.try_emplace(g.shape.mesh.get());
    if (isNew) at->second = factsOf(g.shape.mesh, meshes);
    const MeshFacts& facts = at->second;
    if (facts.isHull()) continue;
    if (isAsked) {  // open ones were told where they were read
      if (!facts.defects.any())
        asked.add(g, ": " + liters(facts.volume) + ", hull " + liters(facts.hullVolume));
      continue;
    }
    const bool isOpen = facts.defects.openEdges > 0;
    if (facts.defects.turnedEdges > 0 || facts.defects.insideOutShells > 0) {
      turned.add(g, facts.defects.turnedEdges > 0 ? "" : ", which faces inwards");
      continue;
    }
    const std::string rims = isOpen ? rimsOf(*g.shape.mesh, facts.defects) : "";
    if (!isFixed) {
      if (isOpen)
        openHulls.add(g, rims);
      else
        filled.add(g, ": " + liters(facts.volume) + ", hull " + liters(facts.hullVolume));
      continue;
    }
    try {
      meshes.surface(g.shape.mesh);
    } catch (const ModelError& error) {
      turned.add(g, std::string(": ") + error.what());
      continue;
    }
    g.shape.kind = ShapeKind::triangles;
    if (isOpen) openSurfaces.add(g, rims);
  }
  filled.appendTo(model.warnings, "collide as their convex hull, which fills the mesh: ",
                  "; collide_as: triangles, or --meshes triangles, keeps its hollows");
  asked.appendTo(model.warnings,
                 "collide as their convex hull, as asked for, which fills the mesh: ",
                 "; fixed to the world they would collide as their triangles");
  openHulls.appendTo(model.warnings, "collide as their convex hull, the mesh is not closed: ", "");
  openSurfaces.appendTo(model.warnings,
                        "collide from the side that their triangles face, not closed: ", "");
  rooms.appendTo(model.warnings,
                 "collide as the walls of a room, for their triangles face inwards: ",
                 "; try a mesh tool that orients faces, if it is a solid");
  turned.appendTo(model.warnings,
                  "collide as their convex hull, the triangles do not all face outwards: ",
                  "; try a mesh tool that orients faces");
}

}  // namespace softgauss::collision
