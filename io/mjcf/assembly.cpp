// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/assembly.hpp"

#include <fmt/format.h>

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::mjcf {

std::string Assembly::ownName(std::string name) {
  while (!names_.insert(name).second) name += '_';
  return name;
}

void Assembly::addBodies() {
  for (const Body& body : bodies_) {
    addBody(body);
    if (&body == bodies_.data()) continue;
    scene_.contents.linkNames.push_back(body.name);
    scene_.contents.places.emplace(body.name, body.element.where);
    scene_.contents.mass += body.link.mass;
    ++scene_.contents.links;
  }
  for (const Body& body : bodies_) addSites(body);
}

/// A body's joints, outermost first: each turns or slides the frame L of the joint before it, which
/// is at its anchor p in the body's frame, J = T(p) R(a, q − ref) T(−p).
void Assembly::addBody(const Body& body) {
  ModelBuilder& builder = scene_.builder;
  builder.link(body.link);
  if (body.parent < 0) return;
  JointSpec last;
  last.where = body.element.where;
  last.name = body.name + "_fixed";
  last.parent = bodies_[static_cast<std::size_t>(body.parent)].name;
  last.child = body.name;
  last.X_PC = body.X_PB;
  Vector3 anchor = Vector3::Zero();  // of the joint before, in the body's frame
  for (std::size_t k = 0; k < body.joints.size(); ++k) {
    const Joint& joint = body.joints[k];
    JointSpec spec = joint.spec(compiler_);
    spec.name = joint.name;
    spec.parent = last.parent;
    spec.X_PC = last.X_PC;
    ++scene_.contents.joints;
    if (joint.isScalar()) {
      scene_.contents.scalarJoints.push_back(joint.name);
      const bool turns = joint.type == Joint::Type::hinge;
      const Vector3 own = turns ? joint.pos : anchor;
      spec.X_PC = spec.X_PC * Transform{Matrix3::Identity(), own - anchor} *
                  (turns ? Transform{axisRotation(joint.axis, -joint.reference), Vector3::Zero()}
                         : Transform{Matrix3::Identity(), -joint.reference * joint.axis});
      anchor = own;
    }
    if (k + 1 == body.joints.size() && anchor.isZero(0.0)) {
      spec.child = body.name;
      builder.joint(spec);
      return;
    }
    LinkSpec link;
    link.name = spec.child = ownName(joint.name + "_link");
    link.where = joint.element.where;
    builder.link(link);
    builder.joint(spec);
    last.parent = link.name;
    last.X_PC = {Matrix3::Identity(), Vector3::Zero()};
    if (k + 1 == body.joints.size()) last.X_PC.p = -anchor;
  }
  builder.joint(last);
}

void Assembly::addSites(const Body& body) {
  for (const Site& site : body.sites) {
    if (site.name.empty() || !names_.insert(site.name).second) continue;
    LinkSpec link;
    link.name = site.name;
    link.where = site.element.where;
    JointSpec joint;
    joint.name = site.name + "_site";
    joint.parent = body.name;
    joint.child = site.name;
    joint.X_PC = site.X_BS;
    joint.where = link.where;
    scene_.builder.link(link).joint(joint);
  }
}

void Assembly::addGeoms(Assets& assets, const std::set<std::string>& paired, MeshUse meshes) {
  for (const Body& body : bodies_) {
    for (std::size_t i = 0; i < body.geoms.size(); ++i) {
      const Geom& geom = body.geoms[i].item;
      const Solid& solid = body.solids[i];
      VisualSpec visual;
      visual.link = body.name;
      visual.X_LG = solid.X_BG;
      visual.shape = solid.shape;
      std::optional<std::array<double, 4>> rgba = geom.rgba;
      if (!rgba && !geom.material.empty()) rgba = assets.colour(geom.material, geom.element);
      const std::array<double, 4> c = rgba.value_or(std::array<double, 4>{0.5, 0.5, 0.5, 1});
      visual.rgba = Eigen::Vector4d(c[0], c[1], c[2], c[3]);
      scene_.builder.visual(visual);
      if (geom.isVisual() && paired.count(geom.name) == 0) continue;
      GeometrySpec spec;
      spec.name = geometryOf_[geom.name] = ownName(geom.name);
      spec.link = body.name;
      spec.X_LG = solid.X_BG;
      spec.shape = solid.shape;
      spec.material = geom.surface();
      spec.where = geom.element.where;
      spec.bits = {static_cast<std::uint32_t>(geom.contype),
                   static_cast<std::uint32_t>(geom.conaffinity)};
      if (geom.type == Geom::Type::mesh) {
        spec.automaticMesh = meshes == MeshUse::automatic;
        if (meshes == MeshUse::triangles) spec.shape = Shape::surface(solid.shape.mesh);
        scene_.contents.meshPlaces.emplace(solid.shape.mesh->file,
                                           std::pair(geom.element.where, geom.element.label()));
      }
      scene_.builder.geometry(std::move(spec));
    }
  }
}

void Assembly::addPairs(const std::vector<Pair>& pairs) {
  std::vector<std::string> names;
  for (const Body& body : bodies_)
    for (const auto& geom : body.geoms) names.push_back(geom.item.name);
  for (const Pair& pair : pairs) {
    PairSpec spec;
    for (const auto& [given, name] :
         {std::pair(&pair.geom1, &spec.geometryA), {&pair.geom2, &spec.geometryB}}) {
      const auto found = geometryOf_.find(*given);
      if (found == geometryOf_.end())
        pair.element.fail(fmt::format("geom {} does not exist{}", detail::quotedText(*given),
                                      detail::offered(*given, names)));
      *name = found->second;
    }
    spec.material = pair.surface();
    spec.where = pair.element.where;
    spec.always = true;
    scene_.builder.pair(std::move(spec));
  }
}

void Assembly::addExclude(const Element& e) {
  e.expectAttributes({"name", "body1", "body2"});
  std::vector<std::string> names;
  for (const Body& body : bodies_) names.push_back(body.name);
  std::array<std::string, 2> bodies{e.requiredText("body1"), e.requiredText("body2")};
  for (const std::string& name : bodies)
    if (std::find(names.begin(), names.end(), name) == names.end())
      e.fail(fmt::format("body {} does not exist{}", detail::quotedText(name),
                         detail::offered(name, names)));
  scene_.builder.keepApart(bodies[0], bodies[1]);
}

}  // namespace softgauss::io::mjcf
