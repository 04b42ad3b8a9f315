// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which pairs of geometries may collide, and which may not, with the reason.
///
/// A pair is left out when
///   rigid      both geometries are on one body, or both are fixed to the world;
///   adjacent   a joint connects their bodies. Intermediate bodies without mass and shapes are
///              looked through: a hip of three hinges still joins thigh and pelvis. The fixed base
///              of a robot is adjacent to the first body that moves on it. Scenery (the ground,
///              fixed objects, the shapes of a link called world and of links fixed to it that
///              carry no other) and the bases of other robots are adjacent to nothing;
///   overlap    they belong to two links of one robot, its fixed base among them, that overlap in
///              the initial configuration.
///              Designers let the shapes of neighbouring links run into each other; a contact there
///              would push the robot apart from the first step on. All geometries of two such links
///              are left out, since the ones beside the overlap mean as little;
///   disabled   Model::apart names their links;
///   disjoint   no bit of the category of one is in the mask of the other (Geometry::bits);
///   effect     the effect that the pair belongs to is switched off: self_collision (one robot),
///              ground_contact (one side fixed to the world), object_contact (two robots).
/// A pair that ContactPair::always names is left out as rigid or by its effect alone.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/model/model.hpp"

namespace softgauss::collision {

/// Indices into Model::geometries; kind(a) ≤ kind(b), and a < b when they are equal.
struct GeometryPair {
  int a = 0;
  int b = 0;
  bool operator==(const GeometryPair&) const = default;
};

enum class ExclusionReason : std::uint8_t { adjacent, overlapsInitially, disabled };

/// Two links whose geometries never collide.
struct ExcludedPair {
  std::string linkA;
  std::string linkB;
  ExclusionReason reason = ExclusionReason::adjacent;
  int geometryPairs = 0;  ///< how many pairs of geometries this concerns
  double depth = 0.0;     ///< deepest overlap in the initial configuration [m], ≥ 0
  bool withBase = false;  ///< one of the links is fixed to the world
};

struct PairFilter {
  std::vector<GeometryPair> pairs;     ///< to be tested: those with a plane first, then by (a, b)
  std::vector<ExcludedPair> excluded;  ///< adjacent and overlapping links, by link names
  std::int64_t rigidPairs = 0;         ///< left out as rigid
  std::int64_t effectOffPairs = 0;     ///< left out because their effect is off
  std::int64_t disjointPairs = 0;      ///< left out because their bits keep them apart
  std::int64_t unreachablePairs = 0;   ///< left out because no configuration brings them together
};

/// Overlap deeper than this [m] in the initial configuration counts. Fingers that are drawn closed
/// touch by less, and shall go on touching.
inline constexpr double kInitialOverlap = 1e-4;

/// Signed distance [m] of the two geometries in the initial configuration, if it is negative;
/// anything ≥ 0 otherwise.
using InitialDistance = std::function<double(const GeometryPair&)>;

/// Whether no configuration brings the two geometries within their margin.
using StayApart = std::function<bool(const GeometryPair&)>;

PairFilter makePairFilter(const Model& model, const InitialDistance& initialDistance,
                          const StayApart& stayApart = nullptr);

/// The pair of two geometries, ordered by kind.
GeometryPair inOrder(const Model& model, int i, int j);

/// The effect that makes contacts between two bodies, of which at least one moves.
Effect contactEffect(const Model& model, int bodyA, int bodyB);

/// One line such as "thigh – pelvis: joined by a joint (3 pairs)".
std::string describe(const ExcludedPair& pair);

/// Which parts of fixed bases are excluded, for those who expect a robot to be stopped by them.
std::optional<std::string> baseWarning(const PairFilter& filter);

}  // namespace softgauss::collision
