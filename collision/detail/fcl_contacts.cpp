// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/fcl_contacts.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <exception>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "softgauss/collision/detail/geometry_set.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/constraints/contact.hpp"
#include "softgauss/engine/core/index.hpp"

namespace softgauss::collision {
namespace {

// What both sides of the fence read is laid out alike whatever the processor.
static_assert(alignof(Transform) == alignof(double) && alignof(Geometry) == alignof(double));

using Geometries = std::shared_ptr<fcl::CollisionGeometryd>;

Geometries convexOf(const ConvexHull& hull) {
  auto vertices = std::make_shared<std::vector<Vector3>>(hull.vertices);
  auto faces = std::make_shared<std::vector<int>>();
  for (const HullFace& face : hull.faces) {
    faces->push_back(static_cast<int>(face.vertices.size()));
    faces->insert(faces->end(), face.vertices.begin(), face.vertices.end());
  }
  return std::make_shared<fcl::Convexd>(vertices, static_cast<int>(hull.faces.size()), faces);
}

/// Of a surface the box about it, which FCL's tree of boxes sees.
Geometries geometryOf(const Shape& s, const detail::GeometrySet& set, std::size_t i) {
  switch (s.kind) {
    case ShapeKind::plane:
      return std::make_shared<fcl::Halfspaced>(Vector3::UnitZ(), 0.0);
    case ShapeKind::sphere:
      return std::make_shared<fcl::Sphered>(s.radius);
    case ShapeKind::capsule:
      return std::make_shared<fcl::Capsuled>(s.radius, 2.0 * s.halfLength);
    case ShapeKind::cylinder:
      return std::make_shared<fcl::Cylinderd>(s.radius, 2.0 * s.halfLength);
    case ShapeKind::box:
      return std::make_shared<fcl::Boxd>(Vector3(2.0 * s.halfExtents));
    case ShapeKind::ellipsoid:
      return std::make_shared<fcl::Ellipsoidd>(s.halfExtents);
    case ShapeKind::mesh:
      return convexOf(*set.hull[i]);
    case ShapeKind::triangles:
      return std::make_shared<fcl::Boxd>(Vector3(2.0 * set.surface[i]->halfExtents()));
  }
  return nullptr;
}

/// The triangles of a surface.
Geometries trianglesOf(const TriangleMesh& surface) {
  std::vector<Vector3> vertices;
  for (int v = 0; v < surface.vertices(); ++v) vertices.push_back(surface.vertex(v));
  std::vector<fcl::Triangle> triangles;
  for (int t = 0; t < surface.size(); ++t) {
    const auto& [a, b, c] = surface[t].corners;
    triangles.emplace_back(idx(a), idx(b), idx(c));
  }
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  int result = model->beginModel(surface.size(), surface.vertices());
  if (result == fcl::BVH_OK) result = model->addSubModel(vertices, triangles);
  if (result == fcl::BVH_OK) result = model->endModel();
  if (result != fcl::BVH_OK)
    throw std::runtime_error("FCL builds no hierarchy of its triangles, code " +
                             std::to_string(result));
  return model;
}

fcl::Transform3d toFcl(const Transform& X) {
  fcl::Transform3d T = fcl::Transform3d::Identity();
  T.linear() = X.R;
  T.translation() = X.p;
  return T;
}

}  // namespace

/// What touches by rounding is a pair of the tree [m].
constexpr double kSlack = 1e-9;

struct FclContacts::Scene {
  Scene(const Model& model, PreparedMeshes& meshes);
  void pose(const Kinematics& kinematics);
  void findNear();
  void testPair(int pair, ContactSet& contacts);
  void makeSolids();
  /// Whether one of a pair, b's a surface, lies within the other and touches none of its triangles,
  /// which are all that FCL knows of a surface.
  bool isWithin(const GeometryPair& pair);
  /// FCL's answer for a pair, a convex one nearer by `within` [m]; false where it gives up.
  bool ask(const GeometryPair& pair, double within, bool& touch, Vector3& n_W);

  const Model& model;
  SceneContacts own;
  const detail::GeometrySet set;
  std::vector<Transform> X_WG;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
  std::vector<Geometries> solids;  ///< what is asked about: of a surface its triangles
  fcl::DynamicAABBTreeCollisionManagerd manager;
  std::vector<int> always;                           ///< pairs with a half-space, which has no box
  std::vector<std::pair<GeometryPair, int>> pairAt;  ///< the others, by their geometries in order
  std::vector<int> near;
  detail::PairTest test;
  std::int64_t left = 0;
};

FclContacts::Scene::Scene(const Model& m, PreparedMeshes& meshes)
    : model(m), own(m, SceneContacts::kBroadphasePairs, true, &meshes), set(m, meshes) {
  X_WG.resize(model.geometries.size());
  for (std::size_t i = 0; i < model.geometries.size(); ++i) {
    const Geometries geometry = geometryOf(model.geometries[i].shape, set, i);
    objects.push_back(std::make_unique<fcl::CollisionObjectd>(geometry));
    geometry->aabb_local.expand(Vector3(Vector3::Constant(kSlack)));
    geometry->aabb_radius += kSlack;
    objects.back()->setUserData(reinterpret_cast<void*>(i));
    if (!set.isPlane(static_cast<int>(i))) manager.registerObject(objects.back().get());
  }
  makeSolids();
  const std::vector<GeometryPair>& pairs = own.filter().pairs;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto [a, b] = pairs[p];
    if (set.isPlane(a))
      always.push_back(static_cast<int>(p));
    else
      pairAt.push_back({{std::min(a, b), std::max(a, b)}, static_cast<int>(p)});
  }
  std::sort(pairAt.begin(), pairAt.end(), [](const auto& x, const auto& y) {
    return std::pair(x.first.a, x.first.b) < std::pair(y.first.a, y.first.b);
  });
  manager.setup();
}

void FclContacts::Scene::makeSolids() {
  std::map<const TriangleMesh*, Geometries> known;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const TriangleMesh* surface = set.surface[i].get();
    Geometries& triangles = known[surface];
    if (surface && !triangles) triangles = trianglesOf(*surface);
    solids.push_back(surface ? triangles
                             : std::const_pointer_cast<fcl::CollisionGeometryd>(
                                   objects[i]->collisionGeometry()));
  }
}

void FclContacts::Scene::pose(const Kinematics& kinematics) {
  for (std::size_t i = 0; i < X_WG.size(); ++i) {
    const Geometry& g = model.geometries[i];
    X_WG[i] = kinematics.X_WB[idx(g.body)] * g.X_BG;
    Transform X = X_WG[i];
    if (set.surface[i]) X.p = X * set.surface[i]->centre();
    objects[i]->setTransform(toFcl(X));
    objects[i]->computeAABB();
  }
}

void FclContacts::Scene::findNear() {
  near = always;
  manager.update();
  manager.collide(this, [](fcl::CollisionObjectd* x, fcl::CollisionObjectd* y, void* data) {
    auto& scene = *static_cast<Scene*>(data);
    const auto i = static_cast<int>(reinterpret_cast<std::size_t>(x->getUserData())),
               j = static_cast<int>(reinterpret_cast<std::size_t>(y->getUserData()));
    const GeometryPair wanted{std::min(i, j), std::max(i, j)};
    const auto at = std::lower_bound(scene.pairAt.begin(), scene.pairAt.end(), wanted,
                                     [](const auto& entry, const GeometryPair& pair) {
                                       return std::pair(entry.first.a, entry.first.b) <
                                              std::pair(pair.a, pair.b);
                                     });
    if (at != scene.pairAt.end() && at->first == wanted) scene.near.push_back(at->second);
    return false;  // go on
  });
  std::sort(near.begin(), near.end());
}

bool FclContacts::Scene::ask(const GeometryPair& pair, double within, bool& touch, Vector3& n_W) {
  const Transform& X_WA = X_WG[idx(pair.a)];
  const Vector3 apart = X_WG[idx(pair.b)].p - X_WA.p;
  Transform nearer = X_WA;
  if (!set.surface[idx(pair.b)])
    nearer.p += within * (set.isPlane(pair.a) ? Vector3(X_WA.R.col(2)) : apart.stableNormalized());
  fcl::CollisionRequestd request(1, true);
  fcl::CollisionResultd result;
  try {
    touch = fcl::collide(solids[idx(pair.a)].get(), toFcl(nearer), solids[idx(pair.b)].get(),
                         toFcl(X_WG[idx(pair.b)]), request, result) > 0;
  } catch (const std::exception&) {
    return false;
  }
  if (touch) n_W = result.getContact(0).normal;
  return !touch || (n_W.allFinite() && n_W.norm() > 0.5);
}

void FclContacts::Scene::testPair(int p, ContactSet& contacts) {
  const GeometryPair& pair = own.filter().pairs[idx(p)];
  const Transform &X_WA = X_WG[idx(pair.a)], &X_WB = X_WG[idx(pair.b)];
  const double within = touchingWithin(model.options, X_WB.p);
  bool touch = true;
  Vector3 n;
  if (!ask(pair, within, touch, n)) {
    ++left;
    touch = true;
    n.setZero();
  }
  const bool isSurface = set.surface[idx(pair.b)] != nullptr;
  if (!touch && !(isSurface && isWithin(pair))) {
    ++contacts.pairsTested;
    return;
  }
  const bool isOurs = set.isPlane(pair.a) || isSurface || n.isZero(0.0);
  if (isOurs) return set.report(pair.a, X_WA, pair.b, X_WB, within, test, contacts);
  set.reportAlong(pair.a, X_WA, pair.b, X_WB, n.normalized(), within, test, contacts);
}

bool FclContacts::Scene::isWithin(const GeometryPair& pair) {
  const Transform &X_WA = X_WG[idx(pair.a)], &X_WB = X_WG[idx(pair.b)];
  const TriangleMesh &b = *set.surface[idx(pair.b)], *a = set.surface[idx(pair.a)].get();
  if (!a)
    return b.isClosed() && !set.isPlane(pair.a) &&
           b.encloses(X_WB.inverse() * (X_WA * set.centreInG[idx(pair.a)]), test.scratch);
  return (b.isClosed() && b.holds(X_WB, *a, X_WA, test.scratch)) ||
         (a->isClosed() && a->holds(X_WA, b, X_WB, test.scratch));
}

FclContacts::FclContacts(const Model& model, PreparedMeshes* meshes) {
  PreparedMeshes own;
  scene_ = std::make_unique<Scene>(model, meshes ? *meshes : own);
  mayTouch_ = !scene_->own.filter().pairs.empty();
}

FclContacts::~FclContacts() = default;

void FclContacts::detect(const Model&, const Kinematics& kinematics,
                         ContactSet& contacts) noexcept {
  contacts.clear();
  scene_->pose(kinematics);
  scene_->findNear();
  for (const int pair : scene_->near) scene_->testPair(pair, contacts);
}

double FclContacts::tunnellingTimeBound(const Model& model, const Kinematics& kinematics,
                                        double longest, TimeDirection direction) noexcept {
  return scene_->own.tunnellingTimeBound(model, kinematics, longest, direction);
}

const PairFilter& FclContacts::filter() const { return scene_->own.filter(); }
std::int64_t FclContacts::pairsFailed() const { return scene_->left; }

}  // namespace softgauss::collision
