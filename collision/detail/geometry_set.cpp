// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/detail/geometry_set.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/collision/primitive_pairs.hpp"

namespace softgauss::collision::detail {
namespace {

double boundingRadius(const Shape& shape, const ConvexHull* hull, const TriangleMesh* surface) {
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
    case ShapeKind::ellipsoid:
      return shape.halfExtents.maxCoeff();
    case ShapeKind::mesh:
      return hull->boundingRadius;
    case ShapeKind::triangles:
      return surface->boundingRadius();
  }
  return 0.0;
}

/// Its hull is all that a hull has.
const Shape kHullShape = Shape::hull(nullptr);

}  // namespace

const PairContact* PairTest::deepest() const {
  const auto least = std::min_element(
      points->begin(), points->end(),
      [](const PairContact& x, const PairContact& y) { return x.distance < y.distance; });
  return least == points->end() ? nullptr : &*least;
}

GeometrySet::GeometrySet(const Model& m, PreparedMeshes& meshes) : model(m) {
  const std::size_t count = model.geometries.size();
  hull.resize(count);
  surface.resize(count);
  colliders.resize(count);
  centreInG.resize(count, Vector3::Zero());
  for (std::size_t i = 0; i < count; ++i) {
    const Shape& shape = model.geometries[i].shape;
    if (shape.kind == ShapeKind::mesh) {
      hull[i] = meshes.hull(shape.mesh);
      centreInG[i] = hull[i]->centre;
    } else if (shape.kind == ShapeKind::triangles) {
      surface[i] = meshes.surface(shape.mesh);
      centreInG[i] = surface[i]->centre();
    }
    // Against another surface.
    if (surface[i] && (model.geometries[i].body != 0 || surface[i]->isConvex())) {
      hull[i] = meshes.hull(shape.mesh);
      colliders[i] = makeCollider(kHullShape, hull[i].get());
    }
    radius.push_back(boundingRadius(shape, hull[i].get(), surface[i].get()));
    if (shape.kind != ShapeKind::plane && shape.kind != ShapeKind::triangles)
      colliders[i] = makeCollider(shape, hull[i].get());
  }
}

PreparedMeshes GeometrySet::meshes() const {
  PreparedMeshes meshes;
  for (std::size_t i = 0; i < model.geometries.size(); ++i) {
    const Mesh* mesh = model.geometries[i].shape.mesh.get();
    if (hull[i]) meshes.hulls[mesh] = hull[i];
    if (surface[i]) meshes.surfaces[mesh] = surface[i];
  }
  return meshes;
}

std::vector<double> GeometrySet::marginShares() const {
  std::vector<double> shares;
  for (const Geometry& g : model.geometries) shares.push_back(std::max(g.material.margin, 0.0));
  for (const ContactPair& pair : model.contactPairs)
    for (const int g : {pair.geometryA, pair.geometryB}) {
      double& share = shares[static_cast<std::size_t>(g)];
      share = std::max(share, 0.5 * pair.material.margin);
    }
  return shares;
}

bool GeometrySet::comesNear(int a, const Vector3& p_W, int b, const Transform& X_WB,
                            double reach) const {
  // What turns may come near with any of its triangles.
  const auto j = static_cast<std::size_t>(b);
  if (!surface[j] || geometry(b).body != 0) return true;
  return surface[j]->comesNear(X_WB.R.transpose() * (p_W - X_WB.p),
                               radius[static_cast<std::size_t>(a)] + reach);
}

int GeometrySet::hullOf(int a, int b) const {
  if (geometry(a).body == 0 || geometry(b).body == 0) return geometry(a).body == 0 ? b : a;
  return radius[static_cast<std::size_t>(b)] < radius[static_cast<std::size_t>(a)] ? b : a;
}

bool GeometrySet::testSurfaces(int a, const Transform& X_WA, int b, const Transform& X_WB,
                               double margin, PairTest& test) const {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  int hulled = surface[i]->isConvex() ? a : surface[j]->isConvex() ? b : -1;
  if (hulled < 0) {
    if (!test.pairs.find(*surface[i], X_WA, *surface[j], X_WB, margin)) return false;
    const bool isWithin =
        !test.pairs.touch() && (surface[j]->holds(X_WB, *surface[i], X_WA, test.scratch) ||
                                surface[i]->holds(X_WA, *surface[j], X_WB, test.scratch));
    if (!isWithin) {
      test.take(test.pairs);
      return true;
    }
    hulled = hullOf(a, b);
  }
  const bool isA = hulled == a;
  const bool known =
      isA ? test.surface.find(colliders[i], X_WA, *surface[j], X_WB, margin, test.reach)
          : test.surface.find(colliders[j], X_WB, *surface[i], X_WA, margin, test.reach);
  if (!isA) test.surface.flip();
  test.take(test.surface);
  return known;
}

bool GeometrySet::testSurface(int a, const Transform& X_WA, int b, const Transform& X_WB,
                              double margin, PairTest& test) const {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  if (surface[i]) return testSurfaces(a, X_WA, b, X_WB, margin, test);
  const bool known =
      isPlane(a) ? test.surface.findOnPlane(X_WA, *surface[j], X_WB, margin)
                 : test.surface.find(colliders[i], X_WA, *surface[j], X_WB, margin, test.reach);
  test.take(test.surface);
  return known;
}

bool GeometrySet::test(int a, const Transform& X_WA, int b, const Transform& X_WB, double margin,
                       PairTest& test) const {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  const Shape &shapeA = model.geometries[i].shape, &shapeB = model.geometries[j].shape;
  test.found.clear();
  if (surface[j]) {
    const bool known = testSurface(a, X_WA, b, X_WB, margin, test);
    if (const PairContact* deepest = test.deepest(); known && deepest) test.found.add(*deepest);
    return known;
  }
  if (hasClosedForm(shapeA.kind, shapeB.kind)) {
    collideInOrder(shapeA, X_WA, shapeB, X_WB, hull[j].get(), margin, test.found);
    return true;
  }
  return convexConvex(colliders[i], X_WA, colliders[j], X_WB, margin, test.found);
}

void GeometrySet::report(int a, const Transform& X_WA, int b, const Transform& X_WB, double margin,
                         PairTest& pair, ContactSet& contacts) const {
  ++contacts.pairsTested;
  if (!test(a, X_WA, b, X_WB, margin, pair)) {
    ++contacts.pairsSkipped;
    return;
  }
  addFound(a, b, pair, contacts);
}

void GeometrySet::reportAlong(int a, const Transform& X_WA, int b, const Transform& X_WB,
                              const Vector3& n_W, double margin, PairTest& pair,
                              ContactSet& contacts) const {
  ++contacts.pairsTested;
  pair.found.clear();
  convexAlong(colliders[static_cast<std::size_t>(a)], X_WA, colliders[static_cast<std::size_t>(b)],
              X_WB, n_W, margin, pair.found);
  addFound(a, b, pair, contacts);
}

void GeometrySet::addFound(int a, int b, const PairTest& pair, ContactSet& contacts) const {
  if (pair.found.count == 0) return;
  Contact contact;
  contact.geometryA = a;
  contact.geometryB = b;
  contact.bodyA = geometry(a).body;
  contact.bodyB = geometry(b).body;
  contact.tangent_W = pair.found.tangent_W;
  const auto add = [&](const PairContact& point) {
    contact.p_WC = point.p_WC;
    contact.n_W = point.n_W;
    contact.distance = point.distance;
    contacts.add(contact);
  };
  if (surface[static_cast<std::size_t>(b)]) {
    for (const PairContact& point : *pair.points) add(point);
    contacts.pointsReduced += pair.reduced;
    return;
  }
  for (int i = 0; i < pair.found.count; ++i) add(pair.found[i]);
}

}  // namespace softgauss::collision::detail
