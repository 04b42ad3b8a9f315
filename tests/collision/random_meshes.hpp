// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Seeded closed meshes, two bodies of which they are, and rays that tell what is inside.

#include <memory>

#include "softgauss/engine/core/index.hpp"
#include "tests/collision/random_pairs.hpp"
#include "tests/support/sample_models.hpp"
#include "tests/support/sample_surfaces.hpp"

namespace softgauss::test {

using collision::RandomPairs;

/// A closed surface about the origin whose radius is another in each direction: hollows and spikes.
inline MeshPointer bumpyBall(RandomPairs& random, double roughness) {
  const MeshPointer ball =
      ballSurface(1.0, 5 + int(random.uniform(0, 6)), 6 + int(random.uniform(0, 8)));
  auto bumpy = std::make_shared<Mesh>(*ball);
  const Vector3 stretch(random.uniform(0.08, 0.25), random.uniform(0.08, 0.25),
                        random.uniform(0.08, 0.25));
  for (Vector3& x : bumpy->vertices)
    x = x.cwiseProduct(stretch) * (1.0 + roughness * random.uniform(-1.0, 1.0));
  return bumpy;
}

inline MeshPointer closedMesh(RandomPairs& random) {
  switch (int(random.uniform(0, 7))) {
    case 0:
      return bumpyBall(random, 0.05);
    case 1:
      return bumpyBall(random, 0.4);
    case 2:
      return ringSurface(random.uniform(0.12, 0.2), random.uniform(0.02, 0.06), 12, 7);
    case 3: {
      const double outer = random.uniform(0.12, 0.25);
      return washerSurface(outer, outer * random.uniform(0.3, 0.8), random.uniform(0.015, 0.08));
    }
    case 4:
      return clampSurface({random.uniform(0.1, 0.2), random.uniform(0.05, 0.2), 0.15},
                          random.uniform(0.02, 0.05));
    case 5:
      return boxSurface({random.uniform(0.03, 0.2), random.uniform(0.03, 0.2), 0.1},
                        1 + int(random.uniform(0, 4)));
    default: {
      const MeshPart one{bumpyBall(random, 0.2), random.pose(0.0)};
      Transform aside = random.pose(0.0);
      aside.p = Vector3(0.6, 0.0, 0.0);
      return joined({one, {ringSurface(0.12, 0.03, 10, 6), aside}});
    }
  }
}

/// Whether the ray from x along r crosses a closed mesh an odd number of times.
inline bool insideMesh(const Mesh& mesh, const Vector3& x, const Vector3& r) {
  int crossings = 0;
  for (const auto& t : mesh.triangles) {
    const Vector3 &a = mesh.vertices[idx(t[0])], u = mesh.vertices[idx(t[1])] - a,
                  w = mesh.vertices[idx(t[2])] - a, h = r.cross(w), s = x - a, q = s.cross(u);
    const double determinant = u.dot(h), p = s.dot(h) / determinant, v = r.dot(q) / determinant;
    crossings += p > 0 && v > 0 && p + v < 1 && w.dot(q) / determinant > 0;
  }
  return crossings % 2 == 1;
}

/// A mesh and another shape, each a body of its own.
inline Model twoBodies(const Shape& a, const Shape& b) {
  ModelBuilder builder("two");
  for (const Shape* shape : {&a, &b}) {
    ModelBuilder one("one");
    one.base = BaseKind::floating;
    one.link(sphereLink("body", 1.0, 0.1));
    one.geometry(geometrySpec("body", *shape));
    builder.add(one, shape == &a ? "a" : "b");
  }
  return builder.build();
}

}  // namespace softgauss::test
