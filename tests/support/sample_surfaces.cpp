// SPDX-License-Identifier: Apache-2.0
#include "tests/support/sample_surfaces.hpp"

#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace softgauss::test {
namespace {

/// Corners (i, j) of a grid of n by m cells, the triangles facing ∂x/∂i × ∂x/∂j. Equal corners are
/// one vertex; triangles without area are left out.
template <class Place>
void addGrid(Mesh& mesh, int n, int m, Place&& place) {
  std::map<std::array<double, 3>, int> known;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    known.emplace(std::array{mesh.vertices[v].x(), mesh.vertices[v].y(), mesh.vertices[v].z()},
                  static_cast<int>(v));
  std::vector<int> corner;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) {
      const Vector3 x = place(i, j) + Vector3::Zero();  // one of the two zeros
      const auto [at, isNew] =
          known.try_emplace({x.x(), x.y(), x.z()}, static_cast<int>(mesh.vertices.size()));
      if (isNew) mesh.vertices.push_back(x);
      corner.push_back(at->second);
    }
  const auto add = [&](int a, int b, int c) {
    if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const auto at = [&](int di, int dj) {
        return corner[static_cast<std::size_t>((i + di) * (m + 1) + j + dj)];
      };
      if ((i + j) % 2 == 0) {
        add(at(0, 0), at(1, 0), at(1, 1));
        add(at(0, 0), at(1, 1), at(0, 1));
      } else {
        add(at(0, 0), at(1, 0), at(0, 1));
        add(at(1, 0), at(1, 1), at(0, 1));
      }
    }
}

std::shared_ptr<Mesh> emptyMesh(const char* name) {
  auto mesh = std::make_shared<Mesh>();
  mesh->file = name;
  return mesh;
}

}  // namespace

MeshPointer gridMesh(int nx, int ny, double cell, double jitter,
                     const std::function<double(double, double)>& height) {
  auto mesh = emptyMesh("grid");
  Random random(7);
  addGrid(*mesh, nx, ny, [&](int i, int j) {
    Vector3 x(cell * (i - 0.5 * nx), cell * (j - 0.5 * ny), 0.0);
    if (i > 0 && i < nx && j > 0 && j < ny) {
      x.x() += random.uniform(-jitter, jitter) * cell;
      x.y() += random.uniform(-jitter, jitter) * cell;
    }
    if (height) x.z() = height(x.x(), x.y());
    return x;
  });
  return mesh;
}

MeshPointer bowlMesh(double radius, int rings, int sectors) {
  auto mesh = emptyMesh("bowl");
  addGrid(*mesh, rings, sectors, [&](int i, int j) {
    const double polar = 0.5 * M_PI * i / rings, angle = 2 * M_PI * (j % sectors) / sectors;
    const double s = i == 0 ? 0.0 : radius * std::sin(polar);
    return Vector3(s * std::cos(angle), s * std::sin(angle), -radius * std::cos(polar));
  });
  return mesh;
}

MeshPointer grooveMesh(double angle, double width, double length, double cell) {
  auto mesh = emptyMesh("groove");
  const int n = static_cast<int>(std::ceil(width / cell)),
            m = static_cast<int>(std::ceil(length / cell));
  addGrid(*mesh, 2 * n, m, [&](int i, int j) {
    const double s = width * (i - n) / n;
    return Vector3(s * std::cos(angle), length * (static_cast<double>(j) / m - 0.5),
                   std::abs(s) * std::sin(angle));
  });
  return mesh;
}

MeshPointer boxSurface(const Vector3& h, int n) {
  auto mesh = emptyMesh("box");
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const int u = (axis + 1) % 3, w = (axis + 2) % 3;
      addGrid(*mesh, n, n, [&](int i, int j) {
        const double s = h[u] * ((2.0 * i - n) / n), t = h[w] * ((2.0 * j - n) / n);
        Vector3 x;
        x[axis] = side * h[axis];
        x[u] = side * s;  // turned over on the far side
        x[w] = t;
        return x;
      });
    }
  return mesh;
}

MeshPointer boxesSurface(const std::vector<BoxPart>& parts) {
  auto mesh = emptyMesh("boxes");
  for (const BoxPart& part : parts) {
    const MeshPointer box = boxSurface(part.halfExtents);
    const auto first = static_cast<int>(mesh->vertices.size());
    for (const Vector3& v : box->vertices) mesh->vertices.push_back(part.centre + v);
    for (const auto& t : box->triangles)
      mesh->triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return mesh;
}

MeshPointer ballSurface(double radius, int rings, int sectors) {
  auto mesh = emptyMesh("ball");
  addGrid(*mesh, rings, sectors, [&](int i, int j) {
    const double polar = M_PI * i / rings, angle = 2 * M_PI * (j % sectors) / sectors;
    const double s = i == 0 || i == rings ? 0.0 : radius * std::sin(polar);
    return Vector3(s * std::cos(angle), s * std::sin(angle), radius * std::cos(polar));
  });
  return mesh;
}

MeshPointer ringSurface(double radius, double tube, int around, int across) {
  auto mesh = emptyMesh("ring");
  addGrid(*mesh, around, across, [&](int i, int j) {
    const double a = 2 * M_PI * (i % around) / around, b = 2 * M_PI * (j % across) / across;
    const double s = radius + tube * std::cos(b);
    return Vector3(s * std::cos(a), s * std::sin(a), tube * std::sin(b));
  });
  return mesh;
}

MeshPointer cylinderSurface(double radius, double halfLength, int sectors) {
  auto mesh = emptyMesh("cylinder");
  addGrid(*mesh, 3, sectors, [&](int i, int j) {
    const double angle = 2 * M_PI * (j % sectors) / sectors;
    const double s = i == 0 || i == 3 ? 0.0 : radius;
    return Vector3(s * std::cos(angle), s * std::sin(angle), i < 2 ? halfLength : -halfLength);
  });
  return mesh;
}

MeshPointer washerSurface(double outer, double inner, double h) {
  auto mesh = emptyMesh("washer");
  for (const double z : {-h, h})
    for (const double r : {outer, inner})
      for (int k = 0; k < 4; ++k)
        mesh->vertices.push_back({k == 0 || k == 3 ? -r : r, k < 2 ? -r : r, z});
  const auto quad = [&](int a, int b, int c, int d) {
    mesh->triangles.push_back({a, b, c});
    mesh->triangles.push_back({a, c, d});
  };
  for (int k = 0; k < 4; ++k) {
    const int n = (k + 1) % 4;
    quad(8 + k, 8 + n, 12 + n, 12 + k);  // above
    quad(n, k, 4 + k, 4 + n);            // below
    quad(k, n, 8 + n, 8 + k);            // outside
    quad(4 + n, 4 + k, 12 + k, 12 + n);  // in the hole
  }
  return mesh;
}

MeshPointer clampSurface(const Vector3& h, double wall) {
  auto mesh = emptyMesh("clamp");
  const double outline[8][2] = {{-h.x(), -h.z()},
                                {h.x(), -h.z()},
                                {h.x(), h.z()},
                                {h.x() - wall, h.z()},
                                {h.x() - wall, wall - h.z()},
                                {wall - h.x(), wall - h.z()},
                                {wall - h.x(), h.z()},
                                {-h.x(), h.z()}};
  for (const double y : {-h.y(), h.y()})
    for (const auto& [x, z] : outline) mesh->vertices.push_back({x, y, z});
  for (int k = 0; k < 8; ++k) {
    const int n = (k + 1) % 8;
    mesh->triangles.push_back({k, 8 + n, n});
    mesh->triangles.push_back({k, 8 + k, 8 + n});
  }
  constexpr int kEnds[6][3] = {{0, 1, 4}, {1, 2, 3}, {1, 3, 4}, {0, 4, 5}, {0, 5, 7}, {5, 6, 7}};
  for (const auto& [a, b, c] : kEnds) {
    mesh->triangles.push_back({a, b, c});
    mesh->triangles.push_back({8 + a, 8 + c, 8 + b});
  }
  return mesh;
}

MeshPointer joined(const std::vector<MeshPart>& parts) {
  auto mesh = emptyMesh("joined");
  for (const MeshPart& part : parts) {
    const auto first = static_cast<int>(mesh->vertices.size());
    for (const Vector3& v : part.mesh->vertices) mesh->vertices.push_back(part.X_GM * v);
    for (const auto& t : part.mesh->triangles)
      mesh->triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return mesh;
}

}  // namespace softgauss::test
