// SPDX-License-Identifier: Apache-2.0
#include "collision/detail/geometry_set.hpp"

#include <algorithm>
#include <cmath>

#include "collision/primitive_pairs.hpp"

namespace softgauss::collision::detail {
namespace {

double boundingRadius(const Shape& shape, const ConvexHull* hull) {
  switch (shape.kind) {
    case ShapeKind::plane:
      return 0.0;
    case ShapeKind::sphere:
      return shape.radius;
    case ShapeKind::capsule:
      return shape.radius + shape.halfLength;
    case ShapeKind::cylinder:
      return std::hypot(shape.radius, shape.halfLength);
    case ShapeKind::box:
      return shape.halfExtents.norm();
    case ShapeKind::mesh:
      return hull->boundingRadius;
  }
  return 0.0;
}

}  // namespace

GeometrySet::GeometrySet(const Model& m, HullCache& hulls) : model(m) {
  const std::size_t count = model.geometries.size();
  hull.resize(count);
  colliders.resize(count);
  centreInG.resize(count, Vector3::Zero());
  for (std::size_t i = 0; i < count; ++i) {
    const Shape& shape = model.geometries[i].shape;
    if (shape.kind == ShapeKind::mesh) {
      auto& shared = hulls[shape.mesh.get()];
      if (!shared) shared = std::make_shared<ConvexHull>(makeConvexHull(*shape.mesh));
      hull[i] = shared;
      centreInG[i] = shared->centre;
    }
    radius.push_back(boundingRadius(shape, hull[i].get()));
    if (shape.kind != ShapeKind::plane) colliders[i] = makeCollider(shape, hull[i].get());
  }
}

double GeometrySet::marginShare(int g) const {
  double margin = std::max(geometry(g).material.margin, 0.0);
  for (const ContactPair& pair : model.contactPairs)
    if (pair.geometryA == g || pair.geometryB == g)
      margin = std::max(margin, 0.5 * pair.material.margin);
  return margin;
}

bool GeometrySet::test(int a, const Transform& X_WA, int b, const Transform& X_WB, double margin,
                       PairContacts& found) const {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  const Shape &shapeA = model.geometries[i].shape, &shapeB = model.geometries[j].shape;
  found.clear();
  if (hasClosedForm(shapeA.kind, shapeB.kind)) {
    collideInOrder(shapeA, X_WA, shapeB, X_WB, hull[j].get(), margin, found);
    return true;
  }
  return convexConvex(colliders[i], X_WA, colliders[j], X_WB, margin, found);
}

void GeometrySet::report(int a, const Transform& X_WA, int b, const Transform& X_WB, double margin,
                         PairContacts& found, ContactSet& contacts) const {
  ++contacts.pairsTested;
  if (!test(a, X_WA, b, X_WB, margin, found)) {
    ++contacts.pairsSkipped;
    return;
  }
  if (found.count == 0) return;
  Contact contact;
  contact.geometryA = a;
  contact.geometryB = b;
  contact.bodyA = geometry(a).body;
  contact.bodyB = geometry(b).body;
  contact.tangent_W = found.tangent_W;
  for (int i = 0; i < found.count; ++i) {
    contact.p_WC = found[i].p_WC;
    contact.n_W = found[i].n_W;
    contact.distance = found[i].distance;
    contacts.add(contact);
  }
}

}  // namespace softgauss::collision::detail
