// SPDX-License-Identifier: Apache-2.0
/// Meshes. STL files are read whole. The files that assimp reads in a child process are looked at
/// as softgauss does before that; the child, which takes a hundred times as long, reads one in 64.
/// What was read becomes a hull and a surface, or is refused.

#include <functional>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/io/detail/mesh_file.hpp"
#include "softgauss/io/mesh.hpp"
#include "tests/fuzz/input_folder.hpp"

namespace softgauss::fuzz {
namespace {

constexpr std::size_t kMostTriangles = 500;  // of what becomes a shape: time is for files
constexpr std::size_t kShare = 64;

const char* extensionOf(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string_view::npos) return ".obj";
  if (text[first] == '<') return ".dae";
  return text.substr(first).starts_with("solid") || text.find('\0') < 84 ? ".stl" : ".obj";
}

void expectSound(const Mesh& mesh) {
  for (const Vector3& vertex : mesh.vertices)
    if (!vertex.allFinite()) throw Finding("a vertex that is not finite");
  for (const auto& triangle : mesh.triangles)
    for (const int i : triangle)
      if (i < 0 || static_cast<std::size_t>(i) >= mesh.vertices.size())
        throw Finding("a triangle of a vertex that is none");
}

void collide(const Mesh& mesh) {
  const auto shared = std::make_shared<const Mesh>(mesh);
  for (const Shape& shape : {Shape::hull(shared), Shape::surface(shared)}) {
    ModelBuilder builder;
    LinkSpec link;
    link.name = "link";
    link.mass = 1.0;
    link.I_Lcm.setIdentity();
    builder.link(link);
    builder.base = BaseKind::floating;
    GeometrySpec geometry;
    geometry.link = "link";
    geometry.shape = shape;
    builder.geometry(geometry);
    const Model model = builder.build();
    collision::SceneContacts contacts(model);
  }
}

void read(const std::filesystem::path& file, bool whole) {
  try {
    const io::detail::MeshFile looked = io::detail::loadMeshFile(file, io::kLargestMesh);
    if (looked.format == ".obj") io::detail::checkObj(looked);
    if (looked.format == ".dae") io::detail::checkDae(looked);
    if (!whole) return;
    const Mesh mesh = io::readMesh(file);
    expectSound(mesh);
    if (mesh.triangles.size() <= kMostTriangles) collide(mesh);
  } catch (const ModelError& error) {
    expectMessage(error.what());
  }
}

}  // namespace
}  // namespace softgauss::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace softgauss::fuzz;
  static const InputFolder folder;
  const std::string_view text = textOf(data, size);
  const std::string extension = extensionOf(text);
  const bool whole = extension == ".stl" || std::hash<std::string_view>{}(text) % kShare == 0;
  read(folder.write("mesh" + extension, text), whole);
  return 0;
}
