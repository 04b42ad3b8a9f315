// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/replay/page.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/replay/detail/page_template.hpp"
#include "softgauss/io/replay/detail/payload.hpp"

namespace softgauss::io {
namespace {

using detail::Payload;
using Json = nlohmann::ordered_json;

Json toJson(const Vector3& x) { return {x.x(), x.y(), x.z()}; }

void addPose(Json& json, const Transform& X) {
  const Quaternion q(X.R);
  json["p"] = toJson(X.p);
  json["q"] = {q.w(), q.x(), q.y(), q.z()};
}

const char* nameOf(JointKind kind) {
  switch (kind) {
    case JointKind::world:
      return "world";
    case JointKind::revolute:
      return "revolute";
    case JointKind::prismatic:
      return "prismatic";
    case JointKind::floating:
      return "floating";
  }
  return "";
}

/// Writes every mesh once, however many shapes are made of it.
class MeshWriter {
 public:
  MeshWriter(const Recording& recording, Json& header, Payload& payload)
      : recording_(recording), header_(header), payload_(payload) {
    header["meshes"] = header["images"] = Json::array();
  }

  int place(const std::shared_ptr<const Mesh>& mesh) {
    const auto [it, isNew] = places_.try_emplace(mesh.get(), static_cast<int>(places_.size()));
    if (isNew) write(*mesh, fmt::format("mesh{}", it->second));
    return it->second;
  }

 private:
  void write(const Mesh& mesh, const std::string& name) {
    std::vector<float> vertices;
    for (const Vector3& v : mesh.vertices)
      for (int i = 0; i < 3; ++i) vertices.push_back(static_cast<float>(v[i]));
    std::vector<std::uint32_t> triangles;
    for (const std::array<int, 3>& t : mesh.triangles)
      for (const int i : t) triangles.push_back(static_cast<std::uint32_t>(i));
    payload_.array(name + ".vertices", vertices);
    payload_.array(name + ".triangles", triangles);
    Json parts = Json::array();
    for (const MeshPart& part : mesh.parts)
      parts.push_back({{"first", part.firstTriangle},
                       {"count", part.triangles},
                       {"rgba", {part.rgba[0], part.rgba[1], part.rgba[2], part.rgba[3]}}});
    Json json = {
        {"vertices", name + ".vertices"}, {"triangles", name + ".triangles"}, {"parts", parts}};
    if (const auto found = recording_.images.find(&mesh);
        found != recording_.images.end() && !found->second.places.empty())
      addImages(found->second, name + ".uv", json);
    header_["meshes"].push_back(json);
  }

  void addImages(const MeshImages& images, const std::string& name, Json& mesh) {
    std::vector<float> uv;
    for (const std::array<float, 2>& place : images.places)
      uv.insert(uv.end(), place.begin(), place.end());
    payload_.array(name, uv);
    mesh["uv"] = name;
    for (std::size_t part = 0; part < images.ofPart.size(); ++part)
      if (const int image = images.ofPart[part]; image >= 0)
        mesh["parts"][part]["image"] = placeImage(images.images[static_cast<std::size_t>(image)]);
  }

  /// Every image once, however many meshes it covers.
  int placeImage(const MeshImages::Image& image) {
    const auto [it, isNew] = images_.try_emplace(image.file, static_cast<int>(images_.size()));
    if (isNew) {
      const std::string name = fmt::format("image{}", it->second);
      payload_.array(name, std::vector<std::uint8_t>(image.bytes.begin(), image.bytes.end()));
      header_["images"].push_back({{"bytes", name}, {"type", imageType(image.bytes)}});
    }
    return it->second;
  }

  const Recording& recording_;
  Json& header_;
  Payload& payload_;
  std::map<const Mesh*, int> places_;
  std::map<std::string, int> images_;  ///< by file
};

Json toJson(const Shape& shape, MeshWriter& meshes) {
  switch (shape.kind) {
    case ShapeKind::plane:
      return {{"kind", "plane"}};
    case ShapeKind::sphere:
      return {{"kind", "sphere"}, {"radius", shape.radius}};
    case ShapeKind::capsule:
      return {{"kind", "capsule"}, {"radius", shape.radius}, {"halfLength", shape.halfLength}};
    case ShapeKind::cylinder:
      return {{"kind", "cylinder"}, {"radius", shape.radius}, {"halfLength", shape.halfLength}};
    case ShapeKind::box:
      return {{"kind", "box"}, {"halfExtents", toJson(shape.halfExtents)}};
    case ShapeKind::ellipsoid:
      return {{"kind", "ellipsoid"}, {"halfExtents", toJson(shape.halfExtents)}};
    case ShapeKind::mesh:
    case ShapeKind::triangles:
      return {{"kind", "mesh"}, {"mesh", meshes.place(shape.mesh)}};
  }
  return {};
}

void writeScene(const Recording& recording, Json& header, Payload& payload) {
  const Model& model = recording.model();
  MeshWriter meshes(recording, header, payload);
  for (const char* list : {"bodies", "links", "geometries", "visuals", "goals"})
    header[list] = Json::array();
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    header["bodies"].push_back({{"name", model.bodyNames[b]},
                                {"parent", b == 0 ? -1 : model.bodies[b].parent},
                                {"joint", model.jointNames[b]},
                                {"kind", nameOf(model.bodies[b].joint)}});
  for (const Frame& frame : model.frames) {
    Json link = {{"name", frame.name}, {"body", frame.body}};
    addPose(link, frame.X_BF);
    header["links"].push_back(link);
  }
  for (std::size_t i = 0; i < model.geometries.size(); ++i) {
    const Geometry& geometry = model.geometries[i];
    Shape shape = geometry.shape;
    if (i < recording.hulls.size() && recording.hulls[i]) shape.mesh = recording.hulls[i];
    Json json = {{"name", geometry.name}, {"link", geometry.link}, {"body", geometry.body}};
    addPose(json, geometry.X_BG);
    json["shape"] = toJson(shape, meshes);
    header["geometries"].push_back(json);
  }
  for (const Visual& visual : model.visuals) {
    if (visual.shape.kind == ShapeKind::mesh && visual.shape.mesh->triangles.empty()) continue;
    Json json = {{"link", visual.link}, {"body", visual.body}};
    addPose(json, visual.X_BG);
    json["shape"] = toJson(visual.shape, meshes);
    json["rgba"] = {visual.rgba[0], visual.rgba[1], visual.rgba[2], visual.rgba[3]};
    header["visuals"].push_back(json);
  }
  for (const Recording::GoalLabel& goal : recording.goalLabels())
    header["goals"].push_back({{"name", goal.name}, {"link", goal.link}});
}

void writeFrames(const FrameTrack& frames, Json& header, Payload& payload) {
  header["frames"] = {{"count", frames.count()}};
  payload.array("frame_time", frames.time);
  payload.array("pose", frames.pose);
  payload.array("velocity", frames.velocity);
  payload.array("com", frames.centerOfMass);
  payload.array("cop", frames.centerOfPressure);
  payload.array("goal_point", frames.goalPoint);
  payload.array("goal_target", frames.goalTarget);
  payload.array("contact_start", frames.contactStart);
  payload.array("contact_point", frames.contactPoint);
  payload.array("contact_normal", frames.contactNormal);
  payload.array("contact_force", frames.contactForce);
  payload.array("contact_geometry", frames.contactGeometry);
}

void writeSeries(const Recording& recording, Json& header, Payload& payload) {
  payload.array("series_time", recording.series().times());
  Json groups = Json::array();
  for (const CurveGroup& group : recording.plots()) {
    Json curves = Json::array();
    for (const Curve& curve : group.curves) {
      const std::string name = fmt::format("series{}", curve.column);
      const std::vector<double> values = recording.series().column(curve.column);
      // Far from zero a position needs all its digits.
      if (group.name == "Floating bases")
        payload.array(name, values);
      else
        payload.array(name, std::vector<float>(values.begin(), values.end()));
      Json json = {{"name", curve.name}, {"values", name}};
      if (std::isfinite(curve.lower)) json["lower"] = curve.lower;
      if (std::isfinite(curve.upper)) json["upper"] = curve.upper;
      curves.push_back(json);
    }
    groups.push_back({{"name", group.name},
                      {"unit", group.unit},
                      {"scale", group.logarithmic ? "log" : "linear"},
                      {"curves", curves}});
  }
  header["series"] = {{"bucket", recording.series().samplesPerBucket()}, {"groups", groups}};
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                6) != Z_OK)
    throw std::runtime_error("replay page: out of memory");
  out.resize(size);
  return out;
}

/// RFC 4648.
std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += k <= count ? kDigits[word >> (18 - 6 * k) & 63u] : '=';
  }
  return out;
}

std::string escapedHtml(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

/// `live`: JSON, or empty.
std::string payloadOf(const Recording& recording, const std::string& generator,
                      const std::string& live) {
  Payload payload;
  Json header;
  const FrameTrack& frames = recording.frames();
  header["model"] = recording.model().name;
  header["generator"] = generator;
  header["command"] = recording.command;
  header["outcome"] = {{"kind", recording.outcome.kind}, {"message", recording.outcome.message}};
  header["timestep"] = recording.model().options.timestep;
  header["duration"] = frames.count() > 0 ? frames.time.back() : 0.0;
  header["origin"] = toJson(frames.origin);
  header["warnings"] = recording.warnings;
  header["facts"] = recording.facts;
  if (!live.empty()) header["live"] = Json::parse(live);
  writeScene(recording, header, payload);
  writeFrames(frames, header, payload);
  writeSeries(recording, header, payload);
  header["arrays"] = Json::object();
  for (const Payload::Entry& entry : payload.entries())
    header["arrays"][entry.name] = {
        {"type", entry.type}, {"offset", entry.offset}, {"length", entry.length}};
  // Names that are no UTF-8 are shown with a replacement mark.
  return payload.pack(header.dump(-1, ' ', false, Json::error_handler_t::replace));
}

/// The template's text with the parts put in, piece by piece.
template <class Write>
void writePage(const Recording& recording, const std::string& payload, const std::string& beside,
               Write&& write) {
  const std::string run = base64(deflated(payload));
  std::string_view rest = detail::pageTemplate();
  for (const auto& [place, text] :
       {std::pair<std::string_view, std::string>{
            "@@SOFTGAUSS_TITLE@@", escapedHtml(detail::validUtf8(recording.model().name))},
        {"@@SOFTGAUSS_RUN@@", run},
        {"@@SOFTGAUSS_OTHER_RUN@@", beside}}) {
    const std::size_t at = rest.find(place);
    SOFTGAUSS_ASSERT(at != std::string_view::npos);
    write(rest.substr(0, at));
    write(text);
    rest.remove_prefix(at + place.size());
  }
  write(rest);
}

}  // namespace

std::string replayPayload(const Recording& recording, const std::string& generator) {
  return payloadOf(recording, generator, "");
}

std::string runText(const Recording& recording, const std::string& generator) {
  return base64(deflated(replayPayload(recording, generator)));
}

std::string livePage(const Recording& recording, const std::string& generator,
                     const std::string& live, const std::string& beside) {
  // A page in a file may ask nothing of any network; this one talks to where it came from.
  constexpr std::string_view kNothing = "default-src 'none'";
  std::string page;
  writePage(recording, payloadOf(recording, generator, live), beside,
            [&](std::string_view text) { page += text; });
  const std::size_t at = page.find(kNothing);
  SOFTGAUSS_ASSERT(at != std::string::npos);
  return page.insert(at + kNothing.size(), "; connect-src 'self'");
}

ReplayPage::ReplayPage(const std::filesystem::path& file, std::string beside)
    : file_(file, "replay page"), beside_(std::move(beside)) {}

void ReplayPage::write(const Recording& recording, const std::string& generator) {
  writePage(recording, replayPayload(recording, generator), beside_,
            [&](std::string_view text) { file_.write(text); });
  file_.commit();
}

}  // namespace softgauss::io
