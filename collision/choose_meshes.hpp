// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Whether a mesh collides as its convex hull or as its triangles, where nobody said.
///
/// A hull fills what is hollow: it is the mesh where both have nearly the same volume. So a
/// geometry with Geometry::automaticMesh collides as
///
///   its hull       where the hull's volume exceeds the mesh's by at most 5 %;
///   its triangles  else, where it is fixed to the world;
///   its hull       else, with a warning that names link, file and both volumes.
///
/// What is to collide as its triangles and is closed and convex is its hull too, and collides as
/// that: the same solid, with the same contacts.
///
/// A mesh that is not closed has no volume: fixed to the world it collides as its triangles, and
/// what moves as its hull, both with a warning. A mesh whose triangles face mixed sides collides as
/// its hull, with a warning. One that is fixed to the world and was asked for as its hull is told
/// where that fills more than 5 %.

#include "softgauss/collision/prepared_meshes.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss::collision {

/// How much more than the mesh its hull may enclose, for the two to be one.
inline constexpr double kHullExcess = 0.05;

/// Sets the kind of every such geometry; warnings are added to the model's. Hulls and surfaces that
/// it makes are left in `meshes`. Throws ModelError where a mesh has no surface.
void chooseMeshes(Model& model, PreparedMeshes& meshes);

}  // namespace softgauss::collision
