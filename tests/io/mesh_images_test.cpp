// SPDX-License-Identifier: Apache-2.0
// Images that cover meshes: where each corner is in them, and what is done about those that are
// missing or none.

#include "softgauss/io/mesh_images.hpp"

#include <gtest/gtest.h>

#include "tests/io/temp_folder.hpp"

namespace softgauss::io {
namespace {

const std::string kPng = std::string("\x89PNG\r\n\x1a\n", 8) + "the rest";

/// Two triangles: the first is painted, the second plain.
std::filesystem::path writeObj(const TempFolder& folder, const std::string& image) {
  folder.write("m.mtl", "newmtl painted\nKd 0.1 0.2 0.3\nmap_Kd " + image +
                            "\nnewmtl plain\nKd 0.4 0.5 0.6\n");
  return folder.write("m.obj",
                      "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.5\nvt 0.75 0.5\n"
                      "vt 0.25 1\nusemtl painted\nf 1/1 2/2 3/3\nusemtl plain\nf 3 2 1\n");
}

/// The part whose colour is that of the painted material, and the image that covers it.
std::pair<MeshPart, int> painted(const Mesh& mesh, const MeshImages& images) {
  for (std::size_t i = 0; i < mesh.parts.size(); ++i)
    if (std::abs(mesh.parts[i].rgba[0] - 0.1) < 1e-6) return {mesh.parts[i], images.ofPart[i]};
  throw std::runtime_error("there is no such part");
}

TEST(MeshImage, CornersHaveTheirPlaces) {
  const TempFolder folder;
  folder.write("paint/skin.png", kPng);
  const std::filesystem::path file = writeObj(folder, "paint/skin.png");
  // A mirrored mesh turns its triangles, and keeps what is where.
  for (const double side : {1.0, -1.0}) {
    const Mesh mesh = readMesh(file, Vector3(side, 1, 1));
    const MeshImages images = imagesOf(mesh);
    ASSERT_EQ(images.images.size(), 1u);
    EXPECT_EQ(images.images[0].bytes, kPng);
    EXPECT_TRUE(images.notShown.empty());
    ASSERT_EQ(images.ofPart.size(), 2u);
    EXPECT_EQ(images.ofPart[0] + images.ofPart[1], -1) << "one has an image, the other none";
    const auto [part, image] = painted(mesh, images);
    EXPECT_EQ(image, 0);
    ASSERT_EQ(images.places.size(), 6u);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto triangle = static_cast<std::size_t>(part.firstTriangle);
      const Vector3& vertex = mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle][k])];
      const std::array<float, 2>& place = images.places[3 * triangle + k];
      // As the file has them: u grows with x, v with y.
      EXPECT_EQ(place[0], side * vertex.x() > 0.5 ? 0.75f : 0.25f);
      EXPECT_EQ(place[1], vertex.y() > 0.5 ? 1.0f : 0.5f);
    }
  }
}

TEST(MeshImage, IsToldWhereItCannotBeShown) {
  const TempFolder folder;
  folder.write("page.png", "<!doctype html>");
  folder.write("large.png", kPng + std::string(5000, ' '));
  for (const auto& [image, why] :
       {std::pair<std::string, std::string>{"nowhere.png", "no regular file"},
        {"page.png", "neither PNG nor JPEG"},
        {"large.png", "larger"},
        {"/dev/zero", "no regular file"}}) {
    const Mesh mesh = readMesh(writeObj(folder, image));
    const MeshImages images = imagesOf(mesh, 4000);
    ASSERT_EQ(images.notShown.size(), 1u) << image;
    EXPECT_NE(images.notShown[0].find(why), std::string::npos) << images.notShown[0];
    EXPECT_NE(images.notShown[0].find(image), std::string::npos) << images.notShown[0];
    for (const int covered : images.ofPart) EXPECT_EQ(covered, -1);
  }
}

TEST(MeshImage, OfAMeshWithoutAnyIsNone) {
  const TempFolder folder;
  const MeshImages none =
      imagesOf(readMesh(folder.write("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")));
  EXPECT_TRUE(none.images.empty());
  EXPECT_TRUE(none.notShown.empty());
  EXPECT_TRUE(imagesOf(Mesh{}).images.empty());
}

TEST(MeshImage, OfAFileThatHasChangedIsNotShown) {
  const TempFolder folder;
  folder.write("skin.png", kPng);
  const std::filesystem::path file = writeObj(folder, "skin.png");
  Mesh mesh = readMesh(file);
  mesh.triangles.pop_back();
  EXPECT_NE(imagesOf(mesh).notShown.at(0).find("changed"), std::string::npos);
  std::filesystem::remove(file);
  EXPECT_EQ(imagesOf(mesh).notShown.size(), 1u);
}

TEST(MeshImage, TypeIsToldByTheFirstBytes) {
  EXPECT_STREQ(imageType(kPng), "image/png");
  EXPECT_STREQ(imageType("\xff\xd8\xff\xe0"), "image/jpeg");
  for (const char* none : {"", "PNG", "GIF89a", "<svg>", "\xff\xd8"})
    EXPECT_EQ(imageType(none), nullptr) << none;
}

}  // namespace
}  // namespace softgauss::io
