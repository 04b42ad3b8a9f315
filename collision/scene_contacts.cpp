// SPDX-License-Identifier: Apache-2.0
#include "collision/scene_contacts.hpp"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <map>

#include "collision/detail/broadphase.hpp"
#include "collision/detail/convex_pairs.hpp"
#include "collision/primitive_pairs.hpp"
#include "engine/constraints/contact.hpp"
#include "engine/model/state.hpp"

namespace softgauss::collision {
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

/// Everything that detect() reads and writes, in flat arrays by geometry and by pair.
struct SceneContacts::Scene {
  /// Of a pair: centres farther apart than `reach` do not touch. For a plane, the distance of the
  /// centre from it counts.
  struct Row {
    int a, b;
    double reach;   ///< bounding radii and margin together [m]
    double margin;  ///< sum of the two margins [m]
  };

  /// How much of a geometry's orientation is ever read.
  enum class Turn : std::uint8_t { none, axis, full };

  explicit Scene(const Model& model);
  void pose(const Kinematics& kinematics);
  void setPairs(const std::vector<GeometryPair>& pairs, int broadphasePairs);
  /// Exact test; false when it failed.
  bool test(int a, int b, double margin);
  void report(const Row& row, ContactSet& contacts);
  void testPlanes(ContactSet& contacts);
  void testAll(ContactSet& contacts);
  void testNear(ContactSet& contacts);

  const Model& model;
  std::map<const Mesh*, std::shared_ptr<const ConvexHull>> hulls;  ///< shared by equal meshes
  std::vector<const ConvexHull*> hullOf;                           ///< null unless a mesh
  std::vector<detail::Collider> colliders;
  std::vector<Vector3> centreInG;  ///< of the bounding sphere
  std::vector<double> radius;
  std::vector<Turn> turn;

  std::vector<Transform> X_WG;
  std::vector<Vector3> centre;  ///< of the bounding sphere, world

  std::vector<Row> planeRows;
  std::vector<Row> rows;
  PairContacts found;

  std::unique_ptr<detail::Broadphase> broadphase;  ///< null in small scenes
  std::vector<int> movable;                        ///< geometries that are no planes
  std::vector<Vector3> movableCentre;
  std::vector<std::pair<int, int>> near;
  std::vector<int> nearRows;
  std::vector<int> firstRow;  ///< rows of geometry a are [firstRow[a], firstRow[a + 1])
};

SceneContacts::Scene::Scene(const Model& m) : model(m) {
  const std::size_t count = model.geometries.size();
  X_WG.resize(count);
  centre.resize(count, Vector3::Zero());
  centreInG.resize(count, Vector3::Zero());
  colliders.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Shape& shape = model.geometries[i].shape;
    const ConvexHull* hull = nullptr;
    if (shape.kind == ShapeKind::mesh) {
      auto& shared = hulls[shape.mesh.get()];
      if (!shared) shared = std::make_shared<ConvexHull>(makeConvexHull(*shape.mesh));
      hull = shared.get();
      centreInG[i] = hull->centre;
    }
    hullOf.push_back(hull);
    turn.push_back(shape.kind == ShapeKind::sphere ? Turn::none : Turn::full);
    radius.push_back(boundingRadius(shape, hull));
    if (shape.kind != ShapeKind::plane) colliders[i] = detail::makeCollider(shape, hull);
  }
}

void SceneContacts::Scene::setPairs(const std::vector<GeometryPair>& pairs, int broadphasePairs) {
  for (std::size_t i = 0; i < turn.size(); ++i)
    if (model.geometries[i].shape.kind == ShapeKind::capsule) turn[i] = Turn::axis;
  for (const GeometryPair& pair : pairs) {
    const Geometry& a = model.geometries[static_cast<std::size_t>(pair.a)];
    const Geometry& b = model.geometries[static_cast<std::size_t>(pair.b)];
    const double margin = pairMaterial(model, pair.a, pair.b).margin;
    const double reach = radius[static_cast<std::size_t>(pair.a)] +
                         radius[static_cast<std::size_t>(pair.b)] + margin;
    (a.shape.kind == ShapeKind::plane ? planeRows : rows)
        .push_back({pair.a, pair.b, reach, margin});
    if (hasClosedForm(a.shape.kind, b.shape.kind)) continue;
    for (int g : {pair.a, pair.b})
      if (turn[static_cast<std::size_t>(g)] == Turn::axis)
        turn[static_cast<std::size_t>(g)] = Turn::full;
  }
  if (static_cast<int>(rows.size()) <= broadphasePairs) return;

  std::vector<double> radii;
  for (std::size_t i = 0; i < model.geometries.size(); ++i) {
    if (model.geometries[i].shape.kind == ShapeKind::plane) continue;
    movable.push_back(static_cast<int>(i));
    // At least half of each pair's margin: material margins add up.
    double margin = std::max(model.geometries[i].material.margin, 0.0);
    for (const ContactPair& pair : model.contactPairs)
      if (pair.geometryA == static_cast<int>(i) || pair.geometryB == static_cast<int>(i))
        margin = std::max(margin, 0.5 * pair.material.margin);
    radii.push_back(radius[i] + margin);
  }
  movableCentre.resize(movable.size());
  broadphase = std::make_unique<detail::Broadphase>(radii);
  firstRow.assign(model.geometries.size() + 1, static_cast<int>(rows.size()));
  for (int r = static_cast<int>(rows.size()) - 1; r >= 0; --r)
    firstRow[static_cast<std::size_t>(rows[static_cast<std::size_t>(r)].a)] = r;
  for (std::size_t g = model.geometries.size(); g-- > 0;)
    firstRow[g] = std::min(firstRow[g], firstRow[g + 1]);
}

void SceneContacts::Scene::pose(const Kinematics& kinematics) {
  for (std::size_t i = 0; i < X_WG.size(); ++i) {
    const Geometry& g = model.geometries[i];
    const Transform& X_WB = kinematics.X_WB[static_cast<std::size_t>(g.body)];
    Transform& X = X_WG[i];
    X.p.noalias() = X_WB.R * g.X_BG.p;
    X.p += X_WB.p;
    if (turn[i] == Turn::axis)
      X.R.col(2).noalias() = X_WB.R * g.X_BG.R.col(2);
    else if (turn[i] == Turn::full)
      X.R.noalias() = X_WB.R * g.X_BG.R;
    centre[i] = X.p;
    if (hullOf[i] != nullptr) centre[i].noalias() += X.R * centreInG[i];
  }
}

bool SceneContacts::Scene::test(int a, int b, double margin) {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  const Shape &shapeA = model.geometries[i].shape, &shapeB = model.geometries[j].shape;
  found.clear();
  if (hasClosedForm(shapeA.kind, shapeB.kind)) {
    collideInOrder(shapeA, X_WG[i], shapeB, X_WG[j], hullOf[j], margin, found);
    return true;
  }
  return detail::convexConvex(colliders[i], X_WG[i], colliders[j], X_WG[j], margin, found);
}

void SceneContacts::Scene::report(const Row& row, ContactSet& contacts) {
  ++contacts.pairsTested;
  if (!test(row.a, row.b, row.margin)) {
    ++contacts.pairsSkipped;
    return;
  }
  if (found.count == 0) return;
  Contact contact;
  contact.geometryA = row.a;
  contact.geometryB = row.b;
  contact.bodyA = model.geometries[static_cast<std::size_t>(row.a)].body;
  contact.bodyB = model.geometries[static_cast<std::size_t>(row.b)].body;
  contact.tangent_W = found.tangent_W;
  for (int i = 0; i < found.count; ++i) {
    contact.p_WC = found[i].p_WC;
    contact.n_W = found[i].n_W;
    contact.distance = found[i].distance;
    contacts.add(contact);
  }
}

void SceneContacts::Scene::testPlanes(ContactSet& contacts) {
  for (const Row& row : planeRows) {
    const Transform& X_WP = X_WG[static_cast<std::size_t>(row.a)];
    const double height = X_WP.R.col(2).dot(centre[static_cast<std::size_t>(row.b)] - X_WP.p);
    if (height < row.reach) report(row, contacts);
  }
}

void SceneContacts::Scene::testAll(ContactSet& contacts) {
  for (const Row& row : rows) {
    const Vector3& a = centre[static_cast<std::size_t>(row.a)];
    const Vector3& b = centre[static_cast<std::size_t>(row.b)];
    if ((b - a).squaredNorm() < row.reach * row.reach) report(row, contacts);
  }
}

void SceneContacts::Scene::testNear(ContactSet& contacts) {
  for (std::size_t k = 0; k < movable.size(); ++k)
    movableCentre[k] = centre[static_cast<std::size_t>(movable[k])];
  near.clear();
  broadphase->findNear(movableCentre, near);

  // Near pairs become rows of the filter, in its order; the others are filtered out.
  nearRows.clear();
  for (const auto& [i, j] : near) {
    int a = movable[static_cast<std::size_t>(i)], b = movable[static_cast<std::size_t>(j)];
    const auto kind = [&](int g) {
      return model.geometries[static_cast<std::size_t>(g)].shape.kind;
    };
    if (kind(b) < kind(a)) std::swap(a, b);
    const auto first = rows.begin() + firstRow[static_cast<std::size_t>(a)];
    const auto last = rows.begin() + firstRow[static_cast<std::size_t>(a) + 1];
    const auto row =
        std::lower_bound(first, last, b, [](const Row& r, int value) { return r.b < value; });
    if (row != last && row->b == b) nearRows.push_back(static_cast<int>(row - rows.begin()));
  }
  std::sort(nearRows.begin(), nearRows.end());
  for (int r : nearRows) {
    const Row& row = rows[static_cast<std::size_t>(r)];
    const Vector3& a = centre[static_cast<std::size_t>(row.a)];
    const Vector3& b = centre[static_cast<std::size_t>(row.b)];
    if ((b - a).squaredNorm() < row.reach * row.reach) report(row, contacts);
  }
}

SceneContacts::SceneContacts(const Model& model, int broadphasePairs)
    : scene_(std::make_unique<Scene>(model)) {
  State initial(model);
  Kinematics kinematics(model);
  computeKinematics(model, initial, kinematics);
  scene_->pose(kinematics);
  filter_ = makePairFilter(model, [&](const GeometryPair& pair) {
    double deepest = kInfinity;
    if (scene_->test(pair.a, pair.b, 0.0))
      for (int i = 0; i < scene_->found.count; ++i)
        deepest = std::min(deepest, scene_->found[i].distance);
    return deepest;
  });
  scene_->setPairs(filter_.pairs, broadphasePairs);
}

SceneContacts::~SceneContacts() = default;

void SceneContacts::detect(const Model&, const Kinematics& kinematics,
                           ContactSet& contacts) noexcept {
  contacts.clear();
  scene_->pose(kinematics);
  scene_->testPlanes(contacts);
  if (scene_->broadphase)
    scene_->testNear(contacts);
  else
    scene_->testAll(contacts);
}

const ConvexHull* SceneContacts::hull(int geometry) const {
  return scene_->hullOf[static_cast<std::size_t>(geometry)];
}

}  // namespace softgauss::collision
