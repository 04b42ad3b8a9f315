// SPDX-License-Identifier: Apache-2.0
/// What is looked at in a DAE before assimp, which follows instance_node without end.

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "softgauss/io/detail/mesh_file.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/urdf_xml.hpp"

namespace softgauss::io::detail {
namespace {

using tinyxml2::XMLElement;

constexpr double kMostNodes = 1e6;

/// The element after `element` in the order of the file, its children first.
const XMLElement* following(const XMLElement* element) {
  if (const XMLElement* child = element->FirstChildElement()) return child;
  for (; element; element = element->Parent() ? element->Parent()->ToElement() : nullptr)
    if (const XMLElement* next = element->NextSiblingElement()) return next;
  return nullptr;
}

std::string attribute(const XMLElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value ? value : "";
}

/// The nodes of a DAE, and what becomes of them when each stands where it is instanced.
class Nodes {
 public:
  Nodes(const MeshFile& file, const XMLElement& root) : file_(file) {
    for (const XMLElement* e = &root; e; e = following(e)) {
      if (std::string_view(e->Name()) != "node") continue;
      index_.emplace(e, all_.size());
      all_.emplace_back();
      all_.back().element = e;
      // As assimp seeks them: by id, and where none has it, by name.
      byId_.emplace(attribute(*e, "id"), all_.size() - 1);
      byName_.emplace(attribute(*e, "name"), all_.size() - 1);
    }
  }

  /// Depth first, without recursion.
  void check() {
    for (std::size_t start = 0; start < all_.size(); ++start) {
      std::vector<std::size_t> path;
      if (!all_[start].seen) enter(start, path);
      while (!path.empty()) {
        Node& node = all_[path.back()];
        if (node.next == node.parts.size()) {
          leave(path);
          continue;
        }
        const std::size_t part = node.parts[node.next++];
        if (all_[part].open) failCycle(path.back(), part);
        if (all_[part].seen)
          node.count += all_[part].count;
        else
          enter(part, path);
      }
    }
  }

 private:
  struct Node {
    const XMLElement* element = nullptr;
    std::vector<std::size_t> parts;  ///< nodes below it, and those that it instances
    std::size_t next = 0;            ///< of the parts, to be visited
    bool seen = false, open = false;
    double count = 1.0;  ///< nodes that it becomes
  };

  void enter(std::size_t index, std::vector<std::size_t>& path) {
    Node& node = all_[index];
    node.seen = node.open = true;
    for (const XMLElement* e = node.element->FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view tag = e->Name();
      if (tag == "node") node.parts.push_back(index_.at(e));
      if (tag != "instance_node") continue;
      std::string url = attribute(*e, "url");
      if (url.starts_with('#')) url.erase(0, 1);
      if (const auto id = byId_.find(url); id != byId_.end())
        node.parts.push_back(id->second);
      else if (const auto name = byName_.find(url); name != byName_.end())
        node.parts.push_back(name->second);
    }
    path.push_back(index);
  }

  void leave(std::vector<std::size_t>& path) {
    Node& node = all_[path.back()];
    node.open = false;
    path.pop_back();
    if (!path.empty()) all_[path.back()].count += node.count;
    if (node.count > kMostNodes)
      failMesh(file_.path,
               fmt::format("node '{}' becomes {:.3g} nodes when its instances are put in their "
                           "places, expected at most {:.0e}",
                           attribute(*node.element, "id"), node.count, kMostNodes),
               node.element->GetLineNum());
  }

  [[noreturn]] void failCycle(std::size_t from, std::size_t to) const {
    failMesh(file_.path,
             fmt::format("node '{}' contains itself, by an instance_node in node '{}'; expected "
                         "none that does",
                         attribute(*all_[to].element, "id"), attribute(*all_[from].element, "id")),
             all_[from].element->GetLineNum());
  }

  const MeshFile& file_;
  std::vector<Node> all_;
  std::map<const XMLElement*, std::size_t> index_;
  std::map<std::string, std::size_t> byId_, byName_;
};

/// A skin or morph of a controller is of a geometry or of another controller, and of no controller
/// that is its own source.
void checkControllers(const MeshFile& file, const XMLElement& root) {
  std::map<std::string, std::string> sources;
  std::map<std::string, int> lines;
  for (const XMLElement* e = &root; e; e = following(e)) {
    if (std::string_view(e->Name()) != "controller") continue;
    const XMLElement* part = e->FirstChildElement("skin");
    if (!part) part = e->FirstChildElement("morph");
    if (!part) continue;
    const std::string id = attribute(*e, "id"), source = attribute(*part, "source");
    sources.emplace(id, source.starts_with('#') ? source.substr(1) : source);
    lines.emplace(id, e->GetLineNum());
  }
  std::set<std::string> sound;  // they end at what is no controller
  for (const auto& entry : sources) {
    std::set<std::string> path;
    for (auto at = sources.find(entry.first); at != sources.end() && !sound.contains(at->first);
         at = sources.find(at->second))
      if (!path.insert(at->first).second)
        failMesh(file.path,
                 fmt::format("controller '{}' is its own source, expected none that is", at->first),
                 lines.at(at->first));
    sound.merge(path);
  }
}

/// Corners of the largest polygon of a <polylist> or <polygons>.
std::size_t mostCorners(const XMLElement& element) {
  std::size_t most = 0;
  if (const XMLElement* counts = element.FirstChildElement("vcount"))
    for (const std::string_view word : words(counts->GetText() ? counts->GetText() : "")) {
      std::size_t count = 0;
      std::from_chars(word.data(), word.data() + word.size(), count);
      most = std::max(most, count);
    }
  if (std::string_view(element.Name()) != "polygons") return most;
  std::size_t stride = 1;  // indices of a corner
  for (const XMLElement* e = element.FirstChildElement("input"); e;
       e = e->NextSiblingElement("input"))
    stride = std::max(stride, static_cast<std::size_t>(std::max(0, e->IntAttribute("offset")) + 1));
  for (const XMLElement* p = element.FirstChildElement("p"); p; p = p->NextSiblingElement("p"))
    most = std::max(most, words(p->GetText() ? p->GetText() : "").size() / stride);
  return most;
}

}  // namespace

void checkDae(const MeshFile& file) {
  if (const int line = lineOfManyAttributes(file.text); line > 0)
    failMesh(file.path, fmt::format("an element has more than {} attributes", kMostAttributes),
             line);
  tinyxml2::XMLDocument document;
  document.Parse(file.text.data(), file.text.size());
  if (document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED)
    failMesh(file.path,
             fmt::format("elements are nested more than {} deep", TINYXML2_MAX_ELEMENT_DEPTH));
  const XMLElement* root = document.RootElement();
  if (document.Error() || !root) return;  // assimp says what is wrong, within its limits
  for (const XMLElement* e = root; e; e = following(e)) {
    const std::string_view tag = e->Name();
    if (tag != "polylist" && tag != "polygons") continue;
    if (const std::size_t corners = mostCorners(*e); corners > kMostCorners)
      failMesh(file.path,
               fmt::format("holds a polygon of {} corners, expected at most {}; try a mesh tool "
                           "that makes triangles of it",
                           corners, kMostCorners),
               e->GetLineNum());
  }
  Nodes(file, *root).check();
  checkControllers(file, *root);
}

}  // namespace softgauss::io::detail
