// SPDX-License-Identifier: Apache-2.0
/// Objects that are meshes: a mass needs a surface that encloses a volume.

#include "scene_folder.hpp"

namespace softgauss::test {
namespace {

/// The scene of one mesh, here the corner tetrahedron of 1/6 m³, moved far away.
io::SceneFile ofMesh(const std::string& faces, const std::string& keys) {
  const io::TempFolder folder;
  folder.write("w.obj", "v 10 0 0\nv 11 0 0\nv 10 1 0\nv 10 0 1\n" + faces);
  return io::readScene(folder.write(
      "scene.yaml", "ground: none\nobjects: [{name: w, mesh: {file: w.obj}, " + keys + "}]\n"));
}

std::string refusalOf(const std::string& faces, const std::string& keys) {
  try {
    ofMesh(faces, keys);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

const std::string kClosed = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST(SceneMesh, HasTheMassOfItsVolume) {
  EXPECT_NEAR(ofMesh(kClosed, "density: 600").builder.build().totalMass(), 100.0, 1e-3)
      << "coordinates are read with single precision";
}

TEST(SceneMesh, ThatEnclosesNoVolumeIsRefusedWhereItHasMass) {
  const std::string open = "f 1 3 2\nf 1 2 4\nf 1 4 3\n",
                    turned = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 4 3\n",
                    inside = "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
  for (const char* keys : {"density: 1000", "mass: 3", "color: [1, 0, 0]"}) {
    for (const auto& [faces, words] :
         {std::pair{open, "3 edges at holes"},
          {turned, "3 edges between triangles that face opposite sides"},
          {inside, "1 shell of triangles that face inwards"},
          {std::string("f 1 2 3\nf 1 3 2\n"), "triangles that enclose nothing"}}) {
      const std::string message = refusalOf(faces, keys);
      EXPECT_NE(message.find("scene.yaml:2: object 1: key 'mesh': found a mesh with "),
                std::string::npos)
          << message;
      EXPECT_NE(message.find(words), std::string::npos) << message;
    }
    EXPECT_EQ(refusalOf(kClosed, keys), "no error");
  }
  EXPECT_EQ(refusalOf(open, "fixed: true"), "no error") << "it needs no mass";
}

}  // namespace
}  // namespace softgauss::test
