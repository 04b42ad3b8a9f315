// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The contacts of a scene: the engine's ContactSource.
///
/// Once per model: hulls and surfaces of meshes, the pair filter, bounding spheres. Once per step:
/// poses of the geometries, then every pair of the filter is rejected by its bounding spheres (or
/// plane) or tested exactly. Pairs whose spheres are far apart are set aside until some shape has
/// moved half the slack between them, wherever the state that is asked about comes from: a step
/// looks at the near ones only, and the contacts are the same bit for bit (docs/decisions/0022).
/// Scenes with more than kBroadphasePairs pairs find the near ones by a sweep instead of a loop
/// over all.
///
/// Contacts appear in the order of the filter's pairs, A and B as there, and depend on the poses
/// alone. Once its buffers have grown, detect() allocates nothing. A pair whose poses are not
/// finite is counted in ContactSet::pairsSkipped.

#include <cstdint>
#include <memory>
#include <vector>

#include "softgauss/collision/filter.hpp"
#include "softgauss/collision/pair_contact.hpp"
#include "softgauss/collision/prepared_meshes.hpp"
#include "softgauss/engine/step/contact_source.hpp"

namespace softgauss::collision {

class SceneContacts final : public ContactSource {
 public:
  /// More pairs than this go through the broadphase.
  static constexpr int kBroadphasePairs = 2000;

  /// Throws ModelError when a mesh has no surface. The model must outlive this object.
  /// With `pruning` off every pair is looked at in every step.
  /// What `meshes` has is taken from there, the rest is added; null: made anew.
  explicit SceneContacts(const Model& model, int broadphasePairs = kBroadphasePairs,
                         bool pruning = true, PreparedMeshes* meshes = nullptr);
  ~SceneContacts() override;
  SceneContacts(const SceneContacts&) = delete;
  SceneContacts& operator=(const SceneContacts&) = delete;

  /// `model` must be the one given to the constructor.
  void detect(const Model& model, const Kinematics& kinematics,
              ContactSet& contacts) noexcept override;
  void detectAmong(const Model& model, const Kinematics& kinematics, const TreeSelection& trees,
                   ContactSet& contacts) noexcept override;
  void detectPair(const Model& model, const Kinematics& kinematics, int geometryA, int geometryB,
                  ContactSet& contacts) noexcept override;

  double tunnellingTimeBound(const Model& model, const Kinematics& kinematics, double longest,
                             TimeDirection direction) noexcept override;

  /// Rows of pairs, poses and bounds; nothing where no two shapes may touch.
  std::size_t bytes() const noexcept override;

  /// How often the near pairs were looked for since the start.
  std::int64_t sweeps() const;
  const PairFilter& filter() const { return filter_; }
  /// The hull that collides for a geometry that is a mesh; null for other shapes.
  const ConvexHull* hull(int geometry) const;
  /// The hulls and surfaces of the scene, to be shared.
  PreparedMeshes meshes() const;

 private:
  struct Scene;
  /// Poses, and near rows, of all trees or of these.
  void prepare(const Model& model, const Kinematics& kinematics, const TreeSelection* trees);
  void report(const std::vector<int>& planeRows, const std::vector<int>& rows,
              ContactSet& contacts);
  static std::unique_ptr<Scene> makeScene(const Model& model, PreparedMeshes* meshes);
  void setUp(int broadphasePairs, bool pruning);

  std::unique_ptr<Scene> scene_;
  PairFilter filter_;
};

}  // namespace softgauss::collision
