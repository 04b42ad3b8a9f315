// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/urdf_copy.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <string_view>

#include "softgauss/engine/core/check.hpp"

namespace softgauss::app {
namespace {

using tinyxml2::XMLElement;

constexpr const char* kWorld = "world";

std::string attribute(const XMLElement* element, const char* name) {
  const char* const text = element ? element->Attribute(name) : nullptr;
  return text ? text : "";
}

/// Deletes all children but those of the given tags.
void keepOnly(XMLElement& element, const std::set<std::string_view>& tags) {
  for (XMLElement* child = element.FirstChildElement(); child;) {
    XMLElement* const next = child->NextSiblingElement();
    if (!tags.count(child->Name())) element.DeleteChild(child);
    child = next;
  }
}

template <class F>
void forEach(XMLElement& parent, const char* tag, F&& f) {
  for (XMLElement* child = parent.FirstChildElement(tag); child;
       child = child->NextSiblingElement(tag))
    f(*child);
}

/// Binary STL: 80 bytes, the number of triangles, then normal, corners and two bytes for each.
std::string stl(const Mesh& mesh) {
  std::string out(80, ' ');
  const auto append = [&](const auto& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto point = [&](const Vector3& p) {
    for (int i = 0; i < 3; ++i) append(static_cast<float>(p[i]));
  };
  append(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    point(Vector3::Zero());
    for (const int corner : triangle) point(mesh.vertices[static_cast<std::size_t>(corner)]);
    append(std::uint16_t{0});
  }
  return out;
}

class Copier {
 public:
  Copier(XMLElement& robot, const Model& model) : robot_(robot), model_(model) {
    for (const Geometry& geometry : model.geometries) geometries_[geometry.name] = &geometry;
  }

  UrdfCopy copy(tinyxml2::XMLDocument& document) {
    keepOnly(robot_, {"link", "joint"});
    forEach(robot_, "link", [&](XMLElement& link) { copyLink(link); });
    forEach(robot_, "joint", [&](XMLElement& joint) { noteJoint(joint); });
    addWorld();
    addExtension();
    tinyxml2::XMLPrinter printer;
    document.Print(&printer);
    copy_.urdf = printer.CStr();
    return std::move(copy_);
  }

 private:
  void copyLink(XMLElement& link) {
    keepOnly(link, {"inertial", "collision"});
    noteInertia(link);
    int index = 0;
    forEach(link, "collision", [&](XMLElement& collision) {
      keepOnly(collision, {"origin", "geometry"});
      const std::string name = fmt::format("{}/{}", attribute(&link, "name"), index++);
      XMLElement* const geometry = collision.FirstChildElement("geometry");
      XMLElement* const mesh = geometry ? geometry->FirstChildElement("mesh") : nullptr;
      const auto found = geometries_.find(name);
      if (!mesh || found == geometries_.end()) return;
      mesh->DeleteAttribute("scale");
      mesh->SetAttribute("filename", fileOf(found->second->shape.mesh.get()).c_str());
    });
  }

  /// MuJoCo refuses an inertia that breaks A + B >= C, even where it is merged, and merges by mass.
  void noteInertia(const XMLElement& link) {
    const XMLElement* const inertial = link.FirstChildElement("inertial");
    const XMLElement* const inertia = inertial ? inertial->FirstChildElement("inertia") : nullptr;
    const XMLElement* const mass = inertial ? inertial->FirstChildElement("mass") : nullptr;
    if (!inertia || !mass) return;
    const auto entry = [&](const char* name) { return inertia->DoubleAttribute(name); };
    const Symmetric3 I{entry("ixx"), entry("iyy"), entry("izz"),
                       entry("ixy"), entry("ixz"), entry("iyz")};
    const Vector3 moments = Eigen::SelfAdjointEigenSolver<Matrix3>(I.matrix()).eigenvalues();
    if (moments.isZero(0.0)) return;
    const std::string name = attribute(&link, "name");
    if (mass->DoubleAttribute("value") == 0.0) {
      copy_.notRead.push_back(fmt::format("inertia of link '{}', which has no mass", name));
    } else if (moments[0] + moments[1] < moments[2]) {
      copy_.notRead.push_back(
          fmt::format("inertia of link '{}', which breaks A + B >= C: the mean is taken", name));
      balance_ = true;
    }
  }

  std::string fileOf(const Mesh* mesh) {
    const auto [at, isNew] = meshes_.try_emplace(mesh, fmt::format("m{}.stl", meshes_.size()));
    if (isNew) copy_.meshes.emplace_back(at->second, stl(*mesh));
    return at->second;
  }

  void noteJoint(const XMLElement& joint) {
    const std::string name = attribute(&joint, "name");
    if (joint.FirstChildElement("mimic"))
      copy_.notRead.push_back(
          fmt::format("mimic of joint '{}': carried over as an equality", name));
  }

  /// A root link that is not the world itself hangs from it.
  void addWorld() {
    std::set<std::string> children, joints;
    forEach(robot_, "joint", [&](XMLElement& joint) {
      joints.insert(attribute(&joint, "name"));
      children.insert(attribute(joint.FirstChildElement("child"), "link"));
    });
    std::string root;
    forEach(robot_, "link", [&](XMLElement& link) {
      if (const std::string name = attribute(&link, "name"); !children.count(name)) root = name;
    });
    if (root == kWorld) return;
    const Frame& frame = model_.frames[static_cast<std::size_t>(model_.findFrame(root))];
    std::string name = "world_" + root;
    while (joints.count(name)) name += "_";
    robot_.InsertNewChildElement("link")->SetAttribute("name", kWorld);
    XMLElement* const joint = robot_.InsertNewChildElement("joint");
    joint->SetAttribute("name", name.c_str());
    joint->SetAttribute("type", frame.body == 0 ? "fixed" : "floating");
    joint->InsertNewChildElement("parent")->SetAttribute("link", kWorld);
    joint->InsertNewChildElement("child")->SetAttribute("link", root.c_str());
  }

  void addExtension() {
    XMLElement* const extension = robot_.InsertNewChildElement("mujoco");
    robot_.InsertFirstChild(extension);
    XMLElement* const compiler = extension->InsertNewChildElement("compiler");
    for (const char* on : {"fusestatic", "strippath", "discardvisual"})
      compiler->SetAttribute(on, "true");
    compiler->SetAttribute("inertiafromgeom", "false");
    if (std::any_of(model_.bodies.begin() + 1, model_.bodies.end(),
                    [](const Body& body) { return body.massless; }))
      for (const char* bound : {"boundmass", "boundinertia"})
        compiler->SetAttribute(bound, fmt::format("{:g}", kLeastInertia).c_str());
    if (balance_) compiler->SetAttribute("balanceinertia", "true");
    const Vector3& g = model_.options.gravity;
    extension->InsertNewChildElement("option")->SetAttribute(
        "gravity", fmt::format("{:.17g} {:.17g} {:.17g}", g.x(), g.y(), g.z()).c_str());
  }

  XMLElement& robot_;
  const Model& model_;
  std::map<std::string, const Geometry*> geometries_;
  std::map<const Mesh*, std::string> meshes_;
  bool balance_ = false;  ///< an inertia would be refused otherwise
  UrdfCopy copy_;
};

void writeFile(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw ModelError({file.string(), 0}, "file", "cannot be written");
}

}  // namespace

UrdfCopy copyUrdf(const std::filesystem::path& file, const Model& model) {
  tinyxml2::XMLDocument document;
  document.LoadFile(file.c_str());
  XMLElement* const robot = document.FirstChildElement("robot");
  if (!robot) throw ModelError({file.string(), 0}, "file", "holds no <robot>");
  return Copier(*robot, model).copy(document);
}

void writeCopy(const UrdfCopy& copy, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  writeFile(folder / "robot.urdf", copy.urdf);
  for (const auto& [name, bytes] : copy.meshes) writeFile(folder / name, bytes);
}

}  // namespace softgauss::app
