// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What SceneContacts keeps: shapes, pairs, and which pairs are near each other.

#include <memory>
#include <utility>
#include <vector>

#include "softgauss/collision/detail/broadphase.hpp"
#include "softgauss/collision/detail/geometry_set.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/collision/tunnelling.hpp"

namespace softgauss::collision {

/// Everything that detect() reads and writes, in flat arrays by geometry and by pair.
struct SceneContacts::Scene {
  /// Of a pair: centres farther apart than `reach` do not touch. For a plane, the distance of the
  /// centre from it counts.
  struct Row {
    int a, b;
    double reach;   ///< bounding radii and margin together [m]
    double margin;  ///< sum of the two margins [m]
    bool plane;     ///< a is one
    int surface;    ///< place in `reaches`, −1 where b is no surface
  };

  /// How much of a geometry's orientation is ever read.
  enum class Turn : std::uint8_t { none, axis, full };

  Scene(const Model& model, PreparedMeshes& meshes);
  /// f(geometry) of those of some pair that move, of all trees or of these.
  template <class F>
  void visitPosed(const TreeSelection* trees, F&& f) const {
    if (!trees) {
      for (const int g : posed) f(static_cast<std::size_t>(g));
      return;
    }
    if (posed.empty()) return;
    for (const int t : trees->trees())
      for (const Segment s : posedOf[t])
        for (int i = s.begin; i < s.end; ++i)
          f(static_cast<std::size_t>(posed[static_cast<std::size_t>(i)]));
  }
  void poseOne(const Kinematics& kinematics, std::size_t geometry);
  void choosePosed();
  void makeMovingShapes();
  void chooseSlack(const std::vector<GeometryPair>& pairs);
  void setPairs(const std::vector<GeometryPair>& pairs, int broadphasePairs);
  bool stayApart(int a, int b) const;
  /// Poses of all geometries in the initial configuration.
  void placeInitially();
  /// Signed distance [m] of a pair that overlaps, anything ≥ 0 of others.
  double distance(const GeometryPair& pair);
  void report(const Row& row, ContactSet& contacts);
  /// Whether the bounding sphere of row.b is within the reach of row.a and `extra` [m].
  bool within(const Row& row, double extra) const;
  /// The same, of a surface that is fixed, for any of its triangles.
  bool surfaceWithin(const Row& row, double extra) const {
    const auto a = static_cast<std::size_t>(row.a), b = static_cast<std::size_t>(row.b);
    return row.plane || set.comesNear(row.a, centre[a], row.b, X_WG[b], row.margin + extra);
  }
  /// Whether the rows that are not near may have come near since findNear(), where these trees have
  /// moved.
  bool moved(const TreeSelection* trees) const;
  void findNear();
  void sweep();
  /// Finds the near rows of shapes that meet (TreeSelection::meets()), where they are not known.
  void findAmong(const TreeSelection& trees);
  /// How far a shape goes in `time` [s], where rows begin before they touch (3.16).
  void setWay(const Kinematics& kinematics, double time, std::size_t geometry);
  /// By how much nearer a pair may be at the end of the step [m].
  double wayOf(const Row& row) const {
    return way[static_cast<std::size_t>(row.a)] + way[static_cast<std::size_t>(row.b)];
  }
  /// (7.7) over all pairs, with `sign` times the velocities.
  double tunnellingTimeBound(const Kinematics& kinematics, double longest, double sign);
  /// Sets `moving` and which of them are fast; false where none is.
  bool setMotion(const Kinematics& kinematics, double longest, double sign);

  /// Keeps the hulls and surfaces alone.
  void forget();
  std::size_t bytes() const;

  const Model& model;
  detail::GeometrySet set;
  std::vector<Turn> turn;
  std::vector<int> posed;  ///< geometries whose pose a step needs anew
  SegmentSets posedOf;     ///< (trees) of which of them each has

  std::vector<Transform> X_WG;
  std::vector<Vector3> centre;  ///< of the bounding sphere, world

  std::vector<Row> planeRows;
  std::vector<Row> rows;
  detail::PairTest test;
  std::vector<detail::SurfaceReach> reaches;

  std::unique_ptr<detail::Broadphase> broadphase;  ///< null in small scenes
  std::vector<int> movable;                        ///< geometries that are no planes
  std::vector<Vector3> movableCentre;
  std::vector<std::pair<int, int>> near;
  std::vector<int> nearPlaneRows, nearRows;  ///< within reach and slack at `reference`
  // Those that meet among some trees, and of which, of what findNear() has found how often.
  std::vector<int> planeRowsAmong, rowsAmong;
  std::vector<std::uint8_t> among, still;
  std::int64_t sweepsAmong = -1;
  double slack = 0.0;              ///< [m]; 0: near rows are found at every step
  double nearWithin = 0.0;         ///< within which near rows were found [m]
  std::vector<Vector3> reference;  ///< centres when they were found; empty: never
  std::vector<double> way;         ///< of each shape in a step, 0 where none counts [m]
  std::int64_t sweeps = 0;
  std::vector<MovingShape> moving;  ///< of all geometries; those of posed ones are setMotion()'s
  std::vector<std::uint8_t> fast;   ///< may pass through something as thin as itself
  std::vector<int> firstRow;        ///< rows of geometry a are [firstRow[a], firstRow[a + 1])
};

}  // namespace softgauss::collision
