// SPDX-License-Identifier: Apache-2.0
/// Mesh files that would take assimp for ever, or crash it, are refused before it sees them, or by
/// the limits of the process that reads them.

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ctime>

#include "load_urdf.hpp"
#include "sample_urdf.hpp"
#include "softgauss/io/detail/child_process.hpp"
#include "softgauss/io/mesh.hpp"

namespace softgauss::io {
namespace {

/// What reading the mesh ends in, without the folder.
std::string errorOf(const std::filesystem::path& file, std::uintmax_t largest = kLargestMesh) {
  try {
    readMesh(file, Vector3::Ones(), largest);
  } catch (const ModelError& error) {
    const std::string message = error.what();
    return message.substr(file.parent_path().string().size() + 1);
  }
  return "no error";
}

/// A DAE of one triangle "t", and these nodes and library nodes.
std::string dae(const std::string& nodes, const std::string& library = "") {
  return "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n"
         "<library_geometries><geometry id=\"t\"><mesh><source id=\"p\"><float_array id=\"pa\" "
         "count=\"9\">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source=\"#pa\" "
         "count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" "
         "type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
         "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles "
         "count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p>"
         "</triangles></mesh></geometry></library_geometries>\n<library_nodes>" +
         library + "</library_nodes>\n<library_visual_scenes><visual_scene id=\"s\">" + nodes +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene>"
         "</COLLADA>";
}

const std::string kOneTriangle = "<instance_geometry url=\"#t\"/>";

std::string node(const std::string& id, const std::string& inner) {
  return "<node id=\"" + id + "\">" + inner + "</node>\n";
}
std::string instance(const std::string& id) { return "<instance_node url=\"#" + id + "\"/>"; }

TEST(MeshLimits, NodesThatContainThemselvesAreRefused) {
  const TempFolder folder;
  const std::string loops[] = {
      dae(node("n", instance("n") + kOneTriangle)),
      dae(node("a", node("b", instance("a")) + kOneTriangle)),
      dae(node("n", instance("x") + kOneTriangle),
          node("x", instance("y")) + node("y", instance("x"))),
      dae("<node name=\"by_name\">" + instance("by_name") + kOneTriangle + "</node>")};
  for (const std::string& text : loops) {
    const std::string message = errorOf(folder.write("loop.dae", text));
    EXPECT_TRUE(message.starts_with("loop.dae:")) << message;
    EXPECT_NE(message.find("contains itself"), std::string::npos) << message;
  }
}

TEST(MeshLimits, InstancesOfNodesAreRead) {
  const TempFolder folder;
  const std::string twice =
      dae(node("n", "<translate>5 0 0</translate>" + instance("x")) + node("m", instance("x")),
          node("x", kOneTriangle));
  EXPECT_EQ(readMesh(folder.write("twice.dae", twice)).triangles.size(), 2u);
}

// Each node instances the next one twice: 2⁴⁰ triangles of a few lines.
TEST(MeshLimits, NodesThatMultiplyAreRefused) {
  const TempFolder folder;
  std::string library = node("n40", kOneTriangle);
  for (int i = 0; i < 40; ++i) {
    const std::string next = instance("n" + std::to_string(i + 1));
    library += node("n" + std::to_string(i), next + next);
  }
  const std::string message =
      errorOf(folder.write("many.dae", dae(node("n", instance("n0")), library)));
  EXPECT_NE(message.find("nodes when its instances are put in their places"), std::string::npos)
      << message;
}

TEST(MeshLimits, DeepNestingIsRefused) {
  const TempFolder folder;
  std::string nodes = kOneTriangle;
  for (int i = 0; i < 5000; ++i) nodes = "<node>" + nodes + "</node>";
  EXPECT_TRUE(errorOf(folder.write("deep.dae", dae(nodes))).find("nested more than") !=
              std::string::npos);
}

TEST(MeshLimits, LargePolygonsAreRefused) {
  const TempFolder folder;
  const auto polygon = [](int corners, const char* separator) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
    for (int i = 0; i < corners; ++i) text += separator + std::to_string(1 + i % 3);
    return text + "\n";
  };
  for (const char* separator : {" ", " \\\n", "\t"}) {
    const std::string message = errorOf(folder.write("p.obj", polygon(300000, separator)));
    EXPECT_TRUE(
        message.starts_with("p.obj:4: mesh: holds a polygon of 300000 corners, expected at "
                            "most 10000"))
        << message;
  }
  std::string counts = dae(node("n", kOneTriangle));
  counts = with(counts, "<triangles count=\"1\">", "<polylist count=\"1\">");
  counts = with(counts, "</triangles>", "</polylist>");
  counts = with(counts, "<p>0 1 2</p>", "<vcount>20000</vcount><p>0 1 2</p>");
  EXPECT_NE(errorOf(folder.write("p.dae", counts)).find("a polygon of 20000 corners"),
            std::string::npos);
  // A disc of a few hundred corners is a usual cap of a cylinder.
  EXPECT_EQ(errorOf(folder.write("disc.obj", polygon(300, " "))).find("polygon of"),
            std::string::npos);
}

// A sparse file takes no room and, read, would take gigabytes.
TEST(MeshLimits, LargeFilesAreRefusedByTheirSize) {
  const TempFolder folder;
  for (const char* name : {"s.stl", "s.obj", "s.dae"}) {
    const auto file = folder.write(name, "solid");
    ASSERT_EQ(truncate(file.c_str(), off_t{2} << 30), 0);
    EXPECT_NE(errorOf(file).find("is larger than 64 MB"), std::string::npos) << errorOf(file);
    EXPECT_NE(errorOf(file).find("--largest-mesh 2049"), std::string::npos);
  }
  const auto small = folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_NE(errorOf(small, 20).find("is larger than"), std::string::npos);
  EXPECT_EQ(errorOf(small, 100), "no error");
}

TEST(MeshLimits, OnlyRegularFilesAreRead) {
  const TempFolder folder;
  const auto pipe = folder.path() / "p.stl";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(errorOf(pipe).find("no regular file"), std::string::npos);
  // Nor does a material library that has no end keep the mesh waiting.
  const auto material = folder.path() / "p.mtl";
  ASSERT_EQ(mkfifo(material.c_str(), 0600), 0);
  EXPECT_EQ(readMesh(folder.write("p.obj", "mtllib p.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))
                .triangles.size(),
            1u);
}

TEST(MeshLimits, AVisualThatIsRefusedStopsNothing) {
  const TempFolder folder;
  folder.write("loop.dae", dae(node("n", instance("n") + kOneTriangle)));
  const std::string mesh = "<mesh filename=\"loop.dae\"/>";
  UrdfOptions options;
  options.visualMeshes = true;
  const Model m = loadUrdf(
      folder.write("v.urdf", with(kSampleUrdf, "<sphere radius=\"0.3\"/>", mesh)), options);
  EXPECT_TRUE(hasWarning(m, "contains itself"));
  try {
    loadUrdf(folder.write("c.urdf", with(kSampleUrdf, "<box size=\"0.2 0.4 0.6\"/>", mesh)));
    FAIL();
  } catch (const ModelError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("c.urdf:10: link 'base': collision: "), std::string::npos) << message;
    EXPECT_NE(message.find("loop.dae"), std::string::npos) << message;
  }
}

TEST(Mesh, MayBeginWithAByteOrderMark) {
  const TempFolder folder;
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(readMesh(folder.write("m.obj", mark + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))
                .vertices.size(),
            3u);
  EXPECT_EQ(readMesh(folder.write("m.dae", mark + dae(node("n", kOneTriangle)))).triangles.size(),
            1u);
  EXPECT_EQ(readMesh(folder.write("m.stl", mark + "solid x\nfacet normal 0 0 1\nouter loop\n"
                                                  "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                                                  "endloop\nendfacet\nendsolid x\n"))
                .triangles.size(),
            1u);
}

// ---- The process that reads

TEST(ChildProcess, GivesWhatItsWorkReturns) {
  const std::string large(3 << 20, 'x');
  const detail::ChildResult result = detail::runInChild([&] { return large + '\0'; }, {});
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.bytes.size(), large.size() + 1);
}

TEST(ChildProcess, MayCrash) {
  const detail::ChildResult result = detail::runInChild([]() -> std::string { std::abort(); }, {});
  EXPECT_NE(result.failure.find("crashes"), std::string::npos) << result.failure;
  EXPECT_EQ(result.bytes, "");
}

TEST(ChildProcess, EndsWhenItsTimeIsUp) {
  detail::ChildLimits limits;
  limits.seconds = 1;
  const detail::ChildResult result = detail::runInChild(
      []() -> std::string {
        volatile bool forever = true;
        while (forever) {
        }
        return {};
      },
      limits);
  EXPECT_EQ(result.failure, "needs more than 1 s");
}

#if !defined(__SANITIZE_ADDRESS__)
TEST(ChildProcess, EndsWhenItsMemoryIsUp) {
  detail::ChildLimits limits;
  limits.bytes = 100u << 20;
  const auto take = [](std::size_t bytes) {
    return [bytes] { return std::string(bytes, 'x').substr(0, 1); };
  };
  EXPECT_EQ(detail::runInChild(take(10u << 20), limits).failure, "");
  EXPECT_EQ(detail::runInChild(take(200u << 20), limits).failure,
            "needs more than 100 MB of memory");
}
#endif

}  // namespace
}  // namespace softgauss::io
