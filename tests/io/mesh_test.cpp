// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mesh.hpp"

#include <gtest/gtest.h>

#include <cctype>
#include <cstring>

#include "sample_urdf.hpp"
#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/model/closed_surface.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {
namespace {

/// Signed volume of the closed surface.
double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](int k) {
      return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
    };
    sum += at(0).dot(at(1).cross(at(2))) / 6.0;
  }
  return sum;
}

/// The corner tetrahedron (0, e_x, e_y, e_z), volume 1/6, facing outwards.
const char* const kTetrahedronObj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

std::string asciiStl() {
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const char* corners[] = {"0 0 0", "1 0 0", "0 1 0", "0 0 1"};
  std::string text = "solid t\n";
  for (const auto& face : faces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : face) text += std::string("vertex ") + corners[corner] + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid t\n";
}

std::string inCapitals(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(c));
  return text;
}

std::string binaryStl() {
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::string bytes(80, ' ');
  const auto append = [&](const void* data, std::size_t n) {
    bytes.append(static_cast<const char*>(data), n);
  };
  const std::uint32_t count = 4;
  append(&count, 4);
  for (const auto& face : faces) {
    const float normal[3] = {0, 0, 0};
    append(normal, sizeof normal);
    for (const int corner : face) append(corners[corner], sizeof corners[corner]);
    bytes.append(2, '\0');
  }
  return bytes;
}

/// The tetrahedron in centimetres and a line, below a node that shifts by 100 cm along x.
std::string collada(const std::string& upAxis) {
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="centimeter" meter="0.01"/><up_axis>)" +
         upAxis + R"(</up_axis></asset>
  <library_geometries><geometry id="g" name="g"><mesh>
    <source id="p"><float_array id="pa" count="12">0 0 0 100 0 0 0 100 0 0 0 100</float_array>
      <technique_common><accessor source="#pa" count="4" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
      <p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
    <lines count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1</p></lines>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s"><node id="n">
    <translate>100 0 0</translate><instance_geometry url="#g"/>
  </node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";
}

std::string errorOfMesh(const std::string& name, const std::string& text) {
  const TempFolder folder;
  try {
    readMesh(folder.write(name, text));
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Mesh, ReadsEveryFormatAsTheSameSolid) {
  const TempFolder folder;
  for (const auto& file : {folder.write("a.stl", asciiStl()), folder.write("b.STL", binaryStl()),
                           folder.write("d.stl", inCapitals(asciiStl())),
                           folder.write("e.stl", "\n  " + inCapitals(asciiStl())),
                           folder.write("f.stl", with(binaryStl(), "     ", "SOLID")),
                           folder.write("c.obj", kTetrahedronObj)}) {
    const Mesh mesh = readMesh(file);
    EXPECT_EQ(mesh.vertices.size(), 4u) << file << ": equal corners are one vertex";
    EXPECT_EQ(mesh.triangles.size(), 4u) << file;
    EXPECT_NEAR(volume(mesh), 1.0 / 6.0, 1e-12) << file;
    EXPECT_EQ(mesh.file, file.string());
  }
}

/// A pyramid over a square whose corner at (1, 0, 0) one of its faces has by `beside`.
std::string seamed(const std::string& beside) {
  return "v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 0 0 1\nv " + beside +
         "\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 6 5\nf 4 3 2\nf 4 2 1\n";
}

// sin 2π is −2.4e-17. Single numbers near 1 are 1.2e-7 apart.
TEST(Mesh, PointsThatDifferByRoundingAreOne) {
  const TempFolder folder;
  for (const char* beside : {"1 -2.4e-17 0", "1 0 1e-8", "1.00000006 0 0"}) {
    const Mesh mesh = readMesh(folder.write("seam.obj", seamed(beside)));
    EXPECT_EQ(mesh.vertices.size(), 5u) << beside;
    EXPECT_FALSE(surfaceDefects(mesh).any()) << beside;
    EXPECT_NEAR(volume(mesh), 2.0 / 3.0, 1e-6);
  }
  for (const char* beside : {"1 -1e-6 0", "1 0 3e-7"}) {
    const Mesh mesh = readMesh(folder.write("open.obj", seamed(beside)));
    EXPECT_EQ(mesh.vertices.size(), 6u) << beside;
    EXPECT_TRUE(surfaceDefects(mesh).any()) << beside;
  }
}

TEST(Mesh, TriangulatesPolygons) {
  const TempFolder folder;
  const Mesh mesh =
      readMesh(folder.write("q.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"));
  EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(Mesh, ScaleIsAppliedAndAMirrorKeepsTheOutside) {
  const TempFolder folder;
  const auto file = folder.write("c.obj", kTetrahedronObj);
  EXPECT_NEAR(volume(readMesh(file, Vector3(2, 3, 4))), 24.0 / 6.0, 1e-12);
  EXPECT_NEAR(volume(readMesh(file, Vector3(-1, 1, 1))), 1.0 / 6.0, 1e-12);
  EXPECT_EQ(readMesh(file, Vector3(-1, 1, 1)).vertices[1].x() +
                readMesh(file, Vector3(-1, 1, 1)).vertices[2].x(),
            -1.0);
}

TEST(Collada, UnitScalesUpAxisDoesNotTurnNodesMoveAndLinesAreLeftOut) {
  const TempFolder folder;
  for (const char* up : {"Z_UP", "Y_UP", "X_UP"}) {
    const Mesh mesh = readMesh(folder.write(std::string(up) + ".dae", collada(up)));
    ASSERT_EQ(mesh.vertices.size(), 4u) << up;
    EXPECT_EQ(mesh.triangles.size(), 4u) << up;
    EXPECT_NEAR(volume(mesh), 1.0 / 6.0, 1e-6) << up;
    Vector3 low = mesh.vertices[0], high = low;
    for (const Vector3& x : mesh.vertices) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    EXPECT_TRUE(low.isApprox(Vector3(1, 0, 0), 1e-6)) << up << " " << low.transpose();
    EXPECT_TRUE(high.isApprox(Vector3(2, 1, 1), 1e-6)) << up << " " << high.transpose();
  }
}

/// The corner tetrahedron as glTF 2 in a node that moves it by 1 m along x, red glass; its numbers
/// are in `buffer`, 48 bytes of corners and 24 of indices.
std::string gltf(const std::string& buffer) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
  "nodes": [{"mesh": 0, "translation": [1, 0, 0]}],
  "materials": [{"name": "glass", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.1, 0.2, 0.5]}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
    {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
  "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48},
    {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
  "buffers": [{)" +
         buffer + R"("byteLength": 72}]})";
}

std::string gltfNumbers() {
  const float corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::uint16_t indices[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  return std::string(reinterpret_cast<const char*>(corners), sizeof corners) +
         std::string(reinterpret_cast<const char*>(indices), sizeof indices);
}

/// One file of both: a header, the JSON, the numbers.
std::string glb() {
  std::string json = gltf("");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string numbers = gltfNumbers();
  std::string bytes;
  const auto append = [&](std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    bytes.append(reinterpret_cast<const char*>(&word), 4);
  };
  bytes += "glTF";
  append(2);
  append(12 + 8 + json.size() + 8 + numbers.size());
  append(json.size());
  bytes += "JSON" + json;
  append(numbers.size());
  bytes += std::string("BIN\0", 4) + numbers;
  return bytes;
}

// With its numbers beside it and within it; axes stay as they are.
TEST(Gltf, IsReadWithItsNodesAndColours) {
  const TempFolder folder;
  folder.write("t.bin", gltfNumbers());
  for (const auto& file :
       {folder.write("t.gltf", gltf("\"uri\": \"t.bin\", ")), folder.write("T.GLB", glb())}) {
    const Mesh mesh = readMesh(file);
    ASSERT_EQ(mesh.vertices.size(), 4u) << file;
    ASSERT_EQ(mesh.triangles.size(), 4u) << file;
    EXPECT_NEAR(volume(mesh), 1.0 / 6.0, 1e-6) << file;
    EXPECT_EQ(mesh.vertices[0], Vector3(1, 0, 0)) << file;
    ASSERT_EQ(mesh.parts.size(), 1u) << file;
    EXPECT_TRUE(mesh.parts[0].rgba.isApprox(Eigen::Vector4d(0.8, 0.1, 0.2, 0.5), 1e-6))
        << mesh.parts[0].rgba.transpose();
  }
  EXPECT_NE(errorOfMesh("a.gltf", gltf("\"uri\": \"none.bin\", ")).find("a.gltf: mesh: "),
            std::string::npos);
  EXPECT_NE(errorOfMesh("a.glb", "glTF").find("a.glb: mesh: "), std::string::npos);
}

TEST(Mesh, ThatCannotBeUsedIsNamed) {
  EXPECT_NE(errorOfMesh("a.stl", "nonsense").find("a.stl: mesh: "), std::string::npos);
  EXPECT_NE(errorOfMesh("a.step", "").find("expected .stl, .obj, .dae, .gltf or .glb"),
            std::string::npos);
  EXPECT_NE(errorOfMesh("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n").find("a.obj: mesh: "),
            std::string::npos);
  EXPECT_NE(errorOfMesh("a.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n").find("a.obj: mesh: "),
            std::string::npos);
  EXPECT_NE(errorOfMesh("a.dae", "<COLLADA/>").find("a.dae: mesh: "), std::string::npos);
}

TEST(MeshCache, ReadsAFileOncePerScale) {
  const TempFolder folder;
  const auto file = folder.write("c.obj", kTetrahedronObj);
  MeshCache cache;
  const auto first = cache.get(file, Vector3::Ones());
  std::filesystem::remove(file);
  EXPECT_EQ(cache.get(file, Vector3::Ones()), first);
  const auto scaled = cache.get(file, Vector3(2, 2, 2));
  EXPECT_EQ(cache.get(file, Vector3(2, 2, 2)), scaled);
  EXPECT_NEAR(volume(*scaled), 8.0 / 6.0, 1e-12);
}

// An OBJ of two colours: each part has its triangles; an STL has none.
TEST(Mesh, PartsHaveTheColoursOfTheFile) {
  const TempFolder folder;
  folder.write("two.mtl", "newmtl red\nKd 0.8 0.1 0.2\nnewmtl glass\nKd 0 0 1\nd 0.5\n");
  const Mesh mesh = readMesh(folder.write(
      "two.obj",
      "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 2 3\nf 1 2 4\n"
      "usemtl glass\nf 2 3 4\n"));
  ASSERT_EQ(mesh.parts.size(), 2u);
  int triangles = 0;
  for (const MeshPart& part : mesh.parts) {
    EXPECT_EQ(part.firstTriangle, triangles);
    triangles += part.triangles;
    const bool red = part.triangles == 2;
    const Eigen::Vector4d expected =
        red ? Eigen::Vector4d(0.8, 0.1, 0.2, 1.0) : Eigen::Vector4d(0.0, 0.0, 1.0, 0.5);
    EXPECT_LT((part.rgba - expected).norm(), 1e-6) << part.rgba.transpose();
  }
  EXPECT_EQ(triangles, 3);
  EXPECT_TRUE(readMesh(folder.write("plain.obj", kTetrahedronObj)).parts.empty());
}

}  // namespace
}  // namespace softgauss::io
