// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Meshes made in code: flat ground, bowls, grooves, boxes, balls, rings, and hollow bodies of
/// these.

#include <functional>
#include <memory>
#include <vector>

#include "softgauss/engine/core/spatial.hpp"
#include "softgauss/engine/model/shape.hpp"
#include "tests/support/random.hpp"

namespace softgauss::test {

using MeshPointer = std::shared_ptr<const Mesh>;

/// A height above each point of a grid of nx by ny cells about the origin, facing +z: 2 nx ny
/// triangles. Inner corners are moved about by up to `jitter` of a cell before their height is
/// taken.
MeshPointer gridMesh(int nx, int ny, double cell, double jitter = 0.0,
                     const std::function<double(double, double)>& height = nullptr);

/// The lower half of a sphere about the origin, facing its centre: rings of 90°/rings.
MeshPointer bowlMesh(double radius, int rings, int sectors);

/// Two planes that rise by `angle` [rad] from the y axis to both sides, `width` along the slope,
/// `length` along y, in cells of about `cell`; facing up.
MeshPointer grooveMesh(double angle, double width, double length, double cell);

/// A closed box whose edges have n cells each.
MeshPointer boxSurface(const Vector3& halfExtents, int n = 1);

/// Closed boxes in one mesh, a shell each.
struct BoxPart {
  Vector3 halfExtents, centre;
};
MeshPointer boxesSurface(const std::vector<BoxPart>& parts);

/// A closed ball of rings and sectors.
MeshPointer ballSurface(double radius, int rings, int sectors);

/// A closed ring about z: a circle of `tube` swept along a circle of `radius`.
MeshPointer ringSurface(double radius, double tube, int around, int across);

/// A closed cylinder about z.
MeshPointer cylinderSurface(double radius, double halfLength, int sectors);

/// A mug about z, one closed surface with a hollow and a handle on its +x side: outer radius, wall
/// and floor of `wall`. The middle line of the handle is half an ellipse in the plane y = 0, which
/// reaches kMugHandleReach out of the outer wall; its section is an octagon of kMugHandleRadius.
MeshPointer mugSurface(double radius, double halfHeight, double wall);
inline constexpr double kMugHandleReach = 0.03;    ///< [m]
inline constexpr double kMugHandleRadius = 0.005;  ///< [m]

/// A closed square plate with a square hole in its middle: half sides across, half thickness along
/// z.
MeshPointer washerSurface(double outer, double inner, double halfThickness);

/// A closed U of two walls on a floor, open towards +z: outer half extents, walls and floor of
/// `wall`.
MeshPointer clampSurface(const Vector3& halfExtents, double wall);

/// All of some meshes in one, each at its pose.
struct MeshPart {
  MeshPointer mesh;
  Transform X_GM;
};
MeshPointer joined(const std::vector<MeshPart>& parts);

}  // namespace softgauss::test
