// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/mcap_shapes.hpp"

#include <map>
#include <string>
#include <vector>

namespace softgauss::io::detail {
namespace {

const Eigen::Vector4d kGrey(0.7, 0.7, 0.7, 1.0);

/// A shape of a link, in the link's frame.
struct Drawn {
  const Shape* shape;
  Transform X;
  Eigen::Vector4d rgba;
};

/// What is drawn of the links, by name: visuals, and collision shapes of links that have none.
std::map<std::string, std::vector<Drawn>> drawnByLink(const Model& model) {
  std::map<std::string, Transform> X_FB;
  for (const Frame& link : model.frames) X_FB[link.name] = link.X_BF.inverse();
  std::map<std::string, std::vector<Drawn>> drawn, collisions;
  for (const Visual& visual : model.visuals)
    drawn[visual.link].push_back({&visual.shape, X_FB[visual.link] * visual.X_BG, visual.rgba});
  for (const Geometry& geometry : model.geometries)
    collisions[geometry.link].push_back(
        {&geometry.shape, X_FB[geometry.link] * geometry.X_BG, kGrey});
  drawn.merge(collisions);
  return drawn;
}

void writeSolid(const Transform& X, const Vector3& size, const Eigen::Vector4d& rgba,
                bool isCylinder, JsonText& json) {
  json.open('{').pose(X).point("size", size);
  if (isCylinder) json.number("bottom_scale", 1.0).number("top_scale", 1.0);
  writeColor(rgba, json);
  json.close('}');
}

void writeBox(const Drawn& d, JsonText& json) {
  if (d.shape->kind == ShapeKind::box)
    writeSolid(d.X, 2.0 * d.shape->halfExtents, d.rgba, false, json);
}

void writeSpheres(const Drawn& d, JsonText& json) {
  const Vector3 size = Vector3::Constant(2.0 * d.shape->radius);
  if (d.shape->kind == ShapeKind::sphere) writeSolid(d.X, size, d.rgba, false, json);
  if (d.shape->kind == ShapeKind::ellipsoid)
    writeSolid(d.X, 2.0 * d.shape->halfExtents, d.rgba, false, json);
  if (d.shape->kind != ShapeKind::capsule) return;
  for (const double end : {-d.shape->halfLength, d.shape->halfLength})
    writeSolid({d.X.R, d.X * Vector3(0.0, 0.0, end)}, size, d.rgba, false, json);
}

void writeCylinder(const Drawn& d, JsonText& json) {
  if (d.shape->kind != ShapeKind::cylinder && d.shape->kind != ShapeKind::capsule) return;
  const double width = 2.0 * d.shape->radius;
  writeSolid(d.X, {width, width, 2.0 * d.shape->halfLength}, d.rgba, true, json);
}

void writeMesh(const Drawn& d, JsonText& json) {
  if (!d.shape->mesh || d.shape->mesh->triangles.empty()) return;
  json.open('{').pose(d.X).open("points", '[');
  for (const Vector3& vertex : d.shape->mesh->vertices) json.point(vertex);
  json.close(']');
  writeColor(d.rgba, json);
  json.open("colors", '[').close(']').open("indices", '[');
  for (const std::array<int, 3>& triangle : d.shape->mesh->triangles)
    for (const int corner : triangle) json.element(corner);
  json.close(']').close('}');
}

}  // namespace

void writeColor(const Eigen::Vector4d& rgba, JsonText& json) {
  json.open("color", '{').number("r", rgba[0]).number("g", rgba[1]).number("b", rgba[2]);
  json.number("a", rgba[3]).close('}');
}

void beginEntity(const std::string& id, const std::string& frame, double time, JsonText& json) {
  json.open('{').time("timestamp", time).raw("frame_id", jsonName(frame)).raw("id", jsonName(id));
  json.time("lifetime", 0.0).raw("frame_locked", "true").raw("metadata", "[]");
}

void writeShapes(const Model& model, double time, JsonText& json) {
  const auto list = [&](const char* name, auto&& write, const std::vector<Drawn>& drawn) {
    json.open(name, '[');
    for (const Drawn& d : drawn) write(d, json);
    json.close(']');
  };
  json.open('{').raw("deletions", "[]").open("entities", '[');
  const std::map<std::string, std::vector<Drawn>> drawnOf = drawnByLink(model);
  for (const Frame& link : model.frames) {
    const auto found = drawnOf.find(link.name);
    if (found == drawnOf.end()) continue;
    const std::vector<Drawn>& drawn = found->second;
    beginEntity(link.name, link.name, time, json);
    list("cubes", writeBox, drawn);
    list("spheres", writeSpheres, drawn);
    list("cylinders", writeCylinder, drawn);
    list("triangles", writeMesh, drawn);
    for (const char* other : {"arrows", "lines", "texts", "models"}) json.raw(other, "[]");
    json.close('}');
  }
  json.close(']').close('}');
}

}  // namespace softgauss::io::detail
