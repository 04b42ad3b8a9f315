// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Whether the triangles of a mesh enclose a volume.
///
/// They do if each edge is run through as often one way as the other: then the signed sum over
/// triangles (mass_properties.hpp) is the same from any origin. A shell, triangles that hang
/// together by edges, must enclose a positive volume, unless it bounds a cavity within another.

#include "softgauss/engine/model/shape.hpp"

namespace softgauss {

struct SurfaceDefects {
  int openEdges = 0;        ///< of an odd number of triangles: the rim of a hole
  int turnedEdges = 0;      ///< whose triangles face opposite sides
  int insideOutShells = 0;  ///< closed, facing inwards, and within no other

  int openEdge[2] = {-1, -1};  ///< vertices of the first of the open edges
  int turnedTriangle = -1;  ///< the first of those with most turned edges: it faces the wrong way
  int insideOutTriangle = -1;  ///< one of the first such shell

  bool any() const { return openEdges + turnedEdges + insideOutShells > 0; }
};

SurfaceDefects surfaceDefects(const Mesh& mesh);

}  // namespace softgauss
