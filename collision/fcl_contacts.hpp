// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contacts through FCL: a second source, for a second opinion.
///
/// Pairs are those of SceneContacts. FCL's dynamic tree of boxes finds which are near, FCL's
/// collide() whether they touch and along which direction. It tells one point where a body needs
/// four to rest, so the points are made by ours: of that direction and the normals of the faces
/// that it meets, the one of least overlap, and on it the clipped faces (manifold.hpp). What
/// touches a half-space or a surface of triangles has its directions from ours too: FCL says
/// whether triangles of the surface touch, and of what lies within a closed surface, which FCL
/// takes for a sheet, rays say it.
///
/// FCL knows no margin: contacts begin where shapes touch, to touchingWithin(): it is asked about
/// convex shapes that are nearer by that. Its queries allocate. An exception of
/// FCL leaves the pair to our own test and is counted in pairsFailed(). Contacts come in the order
/// of the filter's pairs and depend on the poses alone.

#include <cstdint>
#include <memory>

#include "softgauss/collision/filter.hpp"
#include "softgauss/collision/prepared_meshes.hpp"
#include "softgauss/engine/step/contact_source.hpp"

namespace softgauss::collision {

class FclContacts final : public ContactSource {
 public:
  /// Throws ModelError when a mesh has no surface. The model must outlive this object.
  explicit FclContacts(const Model& model, PreparedMeshes* meshes = nullptr);
  ~FclContacts() override;
  FclContacts(const FclContacts&) = delete;
  FclContacts& operator=(const FclContacts&) = delete;

  /// `model` must be the one given to the constructor.
  void detect(const Model& model, const Kinematics& kinematics,
              ContactSet& contacts) noexcept override;
  double tunnellingTimeBound(const Model& model, const Kinematics& kinematics, double longest,
                             TimeDirection direction) noexcept override;

  const PairFilter& filter() const;
  /// Pairs that FCL gave up on since the start.
  std::int64_t pairsFailed() const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace softgauss::collision
