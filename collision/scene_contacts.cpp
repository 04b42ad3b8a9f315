// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/scene_contacts.hpp"

#include <algorithm>
#include <utility>

#include "softgauss/collision/detail/scene.hpp"
#include "softgauss/collision/primitive_pairs.hpp"
#include "softgauss/collision/reach.hpp"
#include "softgauss/engine/constraints/contact.hpp"
#include "softgauss/engine/core/memory.hpp"
#include "softgauss/engine/model/state.hpp"

namespace softgauss::collision {
namespace {

template <class T>
void release(std::vector<T>& v) {
  std::vector<T>().swap(v);
}

}  // namespace

SceneContacts::Scene::Scene(const Model& m, PreparedMeshes& meshes) : model(m), set(m, meshes) {
  const std::size_t count = model.geometries.size();
  X_WG.resize(count);
  centre.resize(count, Vector3::Zero());
  way.assign(count, 0.0);
  for (const Geometry& g : model.geometries)
    turn.push_back(g.shape.kind == ShapeKind::sphere ? Turn::none : Turn::full);
}

void SceneContacts::Scene::setPairs(const std::vector<GeometryPair>& pairs, int broadphasePairs) {
  for (std::size_t i = 0; i < turn.size(); ++i)
    if (model.geometries[i].shape.kind == ShapeKind::capsule) turn[i] = Turn::axis;
  int surfaces = 0;
  for (const GeometryPair& pair : pairs) {
    const Geometry& a = model.geometries[static_cast<std::size_t>(pair.a)];
    const Geometry& b = model.geometries[static_cast<std::size_t>(pair.b)];
    const double margin = pairMaterial(model, pair.a, pair.b).margin;
    const double reach = set.radius[static_cast<std::size_t>(pair.a)] +
                         set.radius[static_cast<std::size_t>(pair.b)] + margin;
    (a.shape.kind == ShapeKind::plane ? planeRows : rows)
        .push_back({pair.a, pair.b, reach, margin, a.shape.kind == ShapeKind::plane,
                    set.surface[static_cast<std::size_t>(pair.b)] ? surfaces++ : -1});
    if (hasClosedForm(a.shape.kind, b.shape.kind)) continue;
    for (int g : {pair.a, pair.b})
      if (turn[static_cast<std::size_t>(g)] == Turn::axis)
        turn[static_cast<std::size_t>(g)] = Turn::full;
  }
  reaches.resize(static_cast<std::size_t>(surfaces));
  for (auto* list : {&nearPlaneRows, &planeRowsAmong}) list->reserve(planeRows.size());
  for (auto* flags : {&among, &still}) flags->reserve(model.trees.size());
  if (static_cast<int>(rows.size()) <= broadphasePairs) {
    for (auto* list : {&nearRows, &rowsAmong}) list->reserve(rows.size());
    return;
  }

  std::vector<bool> paired(model.geometries.size(), false);
  for (const Row& row : rows)
    paired[static_cast<std::size_t>(row.a)] = paired[static_cast<std::size_t>(row.b)] = true;
  std::vector<double> radii, marginShares = set.marginShares();
  for (std::size_t i = 0; i < model.geometries.size(); ++i) {
    if (!paired[i]) continue;
    movable.push_back(static_cast<int>(i));
    radii.push_back(set.radius[i] + marginShares[i]);
  }
  movableCentre.resize(movable.size());
  broadphase = std::make_unique<detail::Broadphase>(radii);
  firstRow.assign(model.geometries.size() + 1, static_cast<int>(rows.size()));
  for (int r = static_cast<int>(rows.size()) - 1; r >= 0; --r)
    firstRow[static_cast<std::size_t>(rows[static_cast<std::size_t>(r)].a)] = r;
  for (std::size_t g = model.geometries.size(); g-- > 0;)
    firstRow[g] = std::min(firstRow[g], firstRow[g + 1]);
}

void SceneContacts::Scene::forget() {
  release(X_WG), release(centre), release(way), release(turn), release(posed), release(moving),
      release(fast);
  release(set.colliders), release(set.centreInG), release(set.radius);
  posedOf = {};
}

std::size_t SceneContacts::Scene::bytes() const {
  return bytesOfAll(turn, posed, X_WG, centre, planeRows, rows, movable, movableCentre, near,
                    nearPlaneRows, nearRows, planeRowsAmong, rowsAmong, reference, way, firstRow,
                    moving, fast, set.colliders, set.centreInG, set.radius) +
         posedOf.bytes();
}

/// A fifth of the mean radius of what may touch: small shapes keep few pairs near, and one that
/// moves a metre in a second is looked for again after some tens of steps.
void SceneContacts::Scene::chooseSlack(const std::vector<GeometryPair>& pairs) {
  constexpr double kShare = 0.2;
  double sum = 0.0;
  // Of a surface, which may be a landscape, the other shape counts.
  for (const GeometryPair& pair : pairs)
    sum += set.radius[static_cast<std::size_t>(
        set.surface[static_cast<std::size_t>(pair.b)] ? pair.a : pair.b)];
  slack = pairs.empty() ? 0.0 : kShare * sum / static_cast<double>(pairs.size());
}

/// Those of some pair, unless they are fixed to the world: their poses are known.
void SceneContacts::Scene::choosePosed() {
  std::vector<bool> paired(model.geometries.size(), false);
  for (const std::vector<Row>* some : {&planeRows, &rows})
    for (const Row& row : *some)
      paired[static_cast<std::size_t>(row.a)] = paired[static_cast<std::size_t>(row.b)] = true;
  for (std::size_t i = 0; i < paired.size(); ++i)
    if (paired[i] && model.geometries[i].body != 0) posed.push_back(static_cast<int>(i));
  posedOf.divide({0, static_cast<int>(posed.size())}, static_cast<int>(model.trees.size()),
                 [&](int i) {
                   const Geometry& g = model.geometries[idx(posed[idx(i)])];
                   return model.bodies[idx(g.body)].tree;
                 });
}

void SceneContacts::Scene::poseOne(const Kinematics& kinematics, std::size_t i) {
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
  if (set.hull[i] || set.surface[i]) centre[i].noalias() += X.R * set.centreInG[i];
}

void SceneContacts::Scene::placeInitially() {
  Kinematics kinematics(model);
  computeKinematics(model, State(model), kinematics);
  for (std::size_t i = 0; i < X_WG.size(); ++i) poseOne(kinematics, i);
}

double SceneContacts::Scene::distance(const GeometryPair& pair) {
  double deepest = kInfinity;
  const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
  if (set.test(pair.a, X_WG[a], pair.b, X_WG[b], 0.0, test))
    for (int i = 0; i < test.found.count; ++i) deepest = std::min(deepest, test.found[i].distance);
  return deepest;
}

bool SceneContacts::Scene::stayApart(int a, int b) const {
  // Far above the rounding of positions; a contact that is this far off has no force.
  constexpr double kRounding = 1e-9;
  const auto ball = [&](int g) {
    const auto i = static_cast<std::size_t>(g);
    return Ball{model.geometries[i].X_BG * set.centreInG[i], set.radius[i]};
  };
  return leastDistance(model, model.geometries[static_cast<std::size_t>(a)], ball(a),
                       model.geometries[static_cast<std::size_t>(b)],
                       ball(b)) > pairMaterial(model, a, b).margin + kRounding;
}

void SceneContacts::Scene::report(const Row& row, ContactSet& contacts) {
  const auto a = static_cast<std::size_t>(row.a), b = static_cast<std::size_t>(row.b);
  test.reach = row.surface < 0 ? nullptr : &reaches[static_cast<std::size_t>(row.surface)];
  const double margin = row.margin + wayOf(row) + touchingWithin(model.options, centre[b]);
  set.report(row.a, X_WG[a], row.b, X_WG[b], margin, test, contacts);
}

bool SceneContacts::Scene::within(const Row& row, double extra) const {
  const auto a = static_cast<std::size_t>(row.a), b = static_cast<std::size_t>(row.b);
  const double reach = row.reach + extra;
  if (row.plane) return X_WG[a].R.col(2).dot(centre[b] - X_WG[a].p) < reach;
  return (centre[b] - centre[a]).squaredNorm() < reach * reach;
}

bool SceneContacts::Scene::moved(const TreeSelection* trees) const {
  if (reference.empty()) return true;
  // A little less than half of it each: rounding of positions does not count.
  const double allowed = 0.499 * nearWithin;
  bool any = false;
  visitPosed(trees, [&](std::size_t i) {
    const double left = allowed - way[i];
    // Also where it is not finite.
    any = any || !(left >= 0.0 && (centre[i] - reference[i]).squaredNorm() <= left * left);
  });
  return any;
}

void SceneContacts::Scene::findAmong(const TreeSelection& trees) {
  if (sweepsAmong == sweeps && among == trees.flags() && still == trees.still()) return;
  sweepsAmong = sweeps;
  among = trees.flags();
  still = trees.still();
  const auto find = [&](const std::vector<int>& some, const std::vector<Row>& of,
                        std::vector<int>& found) {
    found.clear();
    for (const int r : some) {
      const Row& row = of[static_cast<std::size_t>(r)];
      if (trees.meets(model, model.geometries[static_cast<std::size_t>(row.a)].body,
                      model.geometries[static_cast<std::size_t>(row.b)].body))
        found.push_back(r);
    }
  };
  find(nearPlaneRows, planeRows, planeRowsAmong);
  find(nearRows, rows, rowsAmong);
}

void SceneContacts::Scene::findNear() {
  ++sweeps;
  // What goes far in a step goes so in the next ones too.
  double longest = 0.0;
  for (const int g : posed) longest = std::max(longest, way[static_cast<std::size_t>(g)]);
  nearWithin = std::max(slack, 4.0 * longest);
  nearPlaneRows.clear();
  for (std::size_t r = 0; r < planeRows.size(); ++r) {
    // A plane that moves may turn, which its own centre does not tell.
    const bool moves = model.geometries[static_cast<std::size_t>(planeRows[r].a)].body != 0;
    if (moves || within(planeRows[r], nearWithin)) nearPlaneRows.push_back(static_cast<int>(r));
  }
  nearRows.clear();
  if (broadphase)
    sweep();
  else
    for (std::size_t r = 0; r < rows.size(); ++r)
      if (within(rows[r], nearWithin) && surfaceWithin(rows[r], nearWithin))
        nearRows.push_back(static_cast<int>(r));
  if (slack > 0.0) reference = centre;
}

void SceneContacts::Scene::sweep() {
  for (std::size_t k = 0; k < movable.size(); ++k)
    movableCentre[k] = centre[static_cast<std::size_t>(movable[k])];
  near.clear();
  broadphase->findNear(movableCentre, 0.5 * nearWithin, near);

  // Near pairs become rows of the filter, in its order; the others are filtered out.
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
    if (row != last && row->b == b && within(*row, nearWithin) && surfaceWithin(*row, nearWithin))
      nearRows.push_back(static_cast<int>(row - rows.begin()));
  }
  std::sort(nearRows.begin(), nearRows.end());
}

SceneContacts::SceneContacts(const Model& model, int broadphasePairs, bool pruning,
                             PreparedMeshes* meshes)
    : scene_(makeScene(model, meshes)) {
  scene_->placeInitially();
  filter_ = makePairFilter(
      model, [&](const GeometryPair& pair) { return scene_->distance(pair); },
      [&](const GeometryPair& pair) { return scene_->stayApart(pair.a, pair.b); });
  setUp(broadphasePairs, pruning);
}

std::unique_ptr<SceneContacts::Scene> SceneContacts::makeScene(const Model& model,
                                                               PreparedMeshes* meshes) {
  PreparedMeshes own;
  return std::make_unique<Scene>(model, meshes ? *meshes : own);
}

void SceneContacts::setUp(int broadphasePairs, bool pruning) {
  if (pruning) scene_->chooseSlack(filter_.pairs);
  scene_->setPairs(filter_.pairs, broadphasePairs);
  scene_->choosePosed();
  scene_->makeMovingShapes();
  mayTouch_ = !filter_.pairs.empty();
  if (!mayTouch_) scene_->forget();
}

std::size_t SceneContacts::bytes() const noexcept {
  return bytesOf(filter_.pairs) + scene_->bytes();
}

SceneContacts::~SceneContacts() = default;

void SceneContacts::prepare(const Model& model, const Kinematics& kinematics,
                            const TreeSelection* trees) {
  Scene& scene = *scene_;
  const bool goes = model.options.hasRowLaw();
  const double time = model.options.timeToNextRows();
  scene.visitPosed(trees, [&](std::size_t g) {
    scene.poseOne(kinematics, g);
    if (goes) scene.setWay(kinematics, time, g);
  });
  if (scene.moved(trees)) scene.findNear();
}

void SceneContacts::report(const std::vector<int>& planeRows, const std::vector<int>& rows,
                           ContactSet& contacts) {
  Scene& scene = *scene_;
  contacts.clear();
  for (const auto& [list, of] :
       {std::pair(&planeRows, &scene.planeRows), std::pair(&rows, &scene.rows)})
    for (const int r : *list) {
      const Scene::Row& row = (*of)[static_cast<std::size_t>(r)];
      if (scene.within(row, scene.wayOf(row))) scene.report(row, contacts);
    }
}

void SceneContacts::detect(const Model& model, const Kinematics& kinematics,
                           ContactSet& contacts) noexcept {
  ++fullDetections_;
  prepare(model, kinematics, nullptr);
  report(scene_->nearPlaneRows, scene_->nearRows, contacts);
}

void SceneContacts::detectAmong(const Model& model, const Kinematics& kinematics,
                                const TreeSelection& trees, ContactSet& contacts) noexcept {
  prepare(model, kinematics, &trees);
  scene_->findAmong(trees);
  report(scene_->planeRowsAmong, scene_->rowsAmong, contacts);
}

void SceneContacts::detectPair(const Model&, const Kinematics& kinematics, int geometryA,
                               int geometryB, ContactSet& contacts) noexcept {
  contacts.clear();
  Scene& scene = *scene_;
  for (const int g : {geometryA, geometryB})
    if (scene.model.geometries[static_cast<std::size_t>(g)].body != 0)
      scene.poseOne(kinematics, static_cast<std::size_t>(g));
  for (const auto& [list, of] :
       {std::pair(&scene.nearPlaneRows, &scene.planeRows), std::pair(&scene.nearRows, &scene.rows)})
    for (const int r : *list) {
      const Scene::Row& row = (*of)[static_cast<std::size_t>(r)];
      if (row.a == geometryA && row.b == geometryB) scene.report(row, contacts);
    }
}

double SceneContacts::tunnellingTimeBound(const Model&, const Kinematics& kinematics,
                                          double longest, TimeDirection direction) noexcept {
  return scene_->tunnellingTimeBound(kinematics, longest,
                                     direction == TimeDirection::forward ? 1.0 : -1.0);
}

std::int64_t SceneContacts::sweeps() const { return scene_->sweeps; }

const ConvexHull* SceneContacts::hull(int geometry) const {
  return scene_->set.collidingHull(geometry);
}

PreparedMeshes SceneContacts::meshes() const { return scene_->set.meshes(); }

}  // namespace softgauss::collision
