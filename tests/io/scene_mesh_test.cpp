// SPDX-License-Identifier: Apache-2.0
/// Objects that are meshes: a mass needs a surface that encloses a volume.

#include "load_urdf.hpp"
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
         {std::pair{open, "3 edges at holes (the first from (10 1 0) to (11 0 0))"},
          {turned,
           "3 edges between triangles that face opposite sides (most of them about triangle 4, "},
          {inside, "1 shell of triangles that face inwards (one with triangle 1, "},
          {std::string("f 1 2 3\nf 1 3 2\n"), "triangles that enclose nothing"}}) {
      const std::string message = refusalOf(faces, keys);
      EXPECT_NE(message.find("scene.yaml:2: object 1: key 'mesh': found "), std::string::npos)
          << message;
      EXPECT_NE(message.find("w.obj' with "), std::string::npos) << message;
      EXPECT_NE(message.find(words), std::string::npos) << message;
    }
    EXPECT_EQ(refusalOf(kClosed, keys), "no error");
  }
  EXPECT_EQ(refusalOf(open, "fixed: true"), "no error") << "it needs no mass";
}

// ---- Hull or triangles

const Geometry& onlyShape(const Model& model) {
  EXPECT_EQ(model.geometries.size(), 1u);
  return model.geometries[0];
}

TEST(SceneMesh, CollidesAsTheSceneSays) {
  const auto shapeOf = [](const std::string& keys) {
    return onlyShape(ofMesh(kClosed, keys).builder.build());
  };
  EXPECT_TRUE(shapeOf("fixed: true").automaticMesh);
  EXPECT_TRUE(shapeOf("density: 100").automaticMesh);
  for (const char* keys : {"fixed: true, collide_as: hull", "collide_as: hull"}) {
    EXPECT_EQ(shapeOf(keys).shape.kind, ShapeKind::mesh);
    EXPECT_FALSE(shapeOf(keys).automaticMesh);
  }
  for (const char* keys : {"fixed: true, collide_as: triangles", "collide_as: triangles"}) {
    EXPECT_EQ(shapeOf(keys).shape.kind, ShapeKind::triangles);
    EXPECT_FALSE(shapeOf(keys).automaticMesh);
  }
}

// A hull of an unsound mesh is defined, and told.
TEST(SceneMesh, HullOfAnUnsoundMeshIsTold) {
  const std::string open = "f 1 3 2\nf 1 2 4\nf 1 4 3\n",
                    turned = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 4 3\n";
  const auto isTold = [](const std::string& faces, const std::string& keys,
                         const std::string& words) {
    return io::hasWarning(ofMesh(faces, keys).builder.build(), words);
  };
  const std::string hull = "fixed: true, collide_as: hull";
  EXPECT_TRUE(isTold(open, hull, "object 'w' (w.obj: 3 edges at holes (the first from (10 1 0)"));
  EXPECT_TRUE(isTold(turned, hull, "about triangle 4"));
  EXPECT_FALSE(isTold(kClosed, hull, "convex hulls of meshes"));
  EXPECT_FALSE(isTold(open, "fixed: true, collide_as: triangles", "convex hulls of meshes"));
}

TEST(SceneMesh, RefusesMeshUseOfOtherShapes) {
  EXPECT_NE(refusalOf(kClosed, "fixed: true, collide_as: skin").find("'skin'"), std::string::npos);
  const io::TempFolder folder;
  try {
    io::readScene(
        folder.write("s.yaml", "objects: [{name: b, sphere: {radius: 1}, collide_as: hull}]\n"));
    FAIL();
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find("is for a mesh, and this is none"), std::string::npos)
        << error.what();
  }
}

TEST(SceneMesh, ARobotCollidesAsTheSceneSays) {
  const io::TempFolder folder;
  folder.write("w.obj", "v 10 0 0\nv 11 0 0\nv 10 1 0\nv 10 0 1\n" + kClosed);
  folder.write("r.urdf",
               "<robot name='r'><link name='world'><collision><geometry>"
               "<mesh filename='w.obj'/></geometry></collision></link></robot>\n");
  const auto kindOf = [&](const std::string& keys, io::MeshUse use) {
    io::UrdfOptions options;
    options.meshes = use;
    return onlyShape(
        io::readScene(
            folder.write("s.yaml", "ground: none\nrobots: [{urdf: r.urdf" + keys + "}]\n"), options)
            .builder.build());
  };
  EXPECT_TRUE(kindOf("", io::MeshUse::automatic).automaticMesh);
  EXPECT_EQ(kindOf("", io::MeshUse::triangles).shape.kind, ShapeKind::triangles);
  EXPECT_EQ(kindOf(", collide_as: hull", io::MeshUse::triangles).shape.kind, ShapeKind::mesh);
  EXPECT_EQ(kindOf(", collide_as: triangles", io::MeshUse::hull).shape.kind, ShapeKind::triangles);

  folder.write("w.obj", "v 10 0 0\nv 11 0 0\nv 10 1 0\nv 10 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  io::UrdfOptions asHulls;
  asHulls.meshes = io::MeshUse::hull;
  EXPECT_TRUE(io::hasWarning(io::loadUrdf(folder.path() / "r.urdf", asHulls),
                             "link 'world' (w.obj: 3 edges at holes"));
}

}  // namespace
}  // namespace softgauss::test
