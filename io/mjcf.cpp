// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/mjcf/assembly.hpp"
#include "softgauss/io/mjcf/equality.hpp"
#include "softgauss/io/mjcf/option.hpp"
#include "softgauss/io/mjcf/tendon.hpp"

namespace softgauss::io {
namespace {

using mjcf::Element;

/// Reads a file section by section, in the order in which MuJoCo does.
class MjcfReader {
 public:
  MjcfReader(const std::filesystem::path& file, const UrdfOptions& options)
      : file_(file),
        options_(options),
        document_(mjcf::readDocument(file)),
        assets_(file, compiler_, options.largestMesh, options.visualMeshes) {}

  MjcfFile read() {
    const Element& root = document_.root;
    root.expectAttributes({"model"});
    root.expectChildren({"compiler", "option", "size", "statistic", "visual", "default",
                         "extension", "asset", "worldbody", "deformable", "contact", "tendon",
                         "equality", "actuator", "sensor", "custom", "keyframe"});
    scene_.builder = ModelBuilder(root.has("model") ? root.text("model") : file_.stem().string());
    for (const Element* e : sections("compiler")) compiler_.read(*e);
    for (const Element* e : sections("option"))
      mjcf::readOption(*e, scene_.builder.options, optionsOfFile_);
    for (const Element* e : sections("default")) defaults_.read(*e);
    refuseSections();
    readAssets();
    bodies_ = mjcf::readBodies(sections("worldbody"), compiler_, defaults_);
    if (!scene_.builder.options.effects.has(Effect::spring) &&
        !scene_.builder.options.effects.has(Effect::damping))
      for (mjcf::Body& body : bodies_) body.link.gravityCompensation = 0.0;  // as MuJoCo
    readContacts();
    std::set<std::string> paired;
    for (const mjcf::Pair& pair : pairs_) paired.insert({pair.geom1, pair.geom2});
    mjcf::weighBodies(bodies_, compiler_, assets_, paired);
    mjcf::Assembly assembly(bodies_, compiler_, scene_);
    assembly.addBodies();
    assembly.addGeoms(assets_, paired, options_.meshes);
    assembly.addPairs(pairs_);
    for (const Element* exclude : excludes_) assembly.addExclude(*exclude);
    for (const Element* e : sections("equality"))
      inactive_ += mjcf::readEqualities(*e, defaults_, bodies_, scene_.builder);
    readTendons();
    readActuators();
    for (const Element* e : sections("keyframe"))
      for (const Element& key : e->children)
        result_.keyframes.push_back(mjcf::readKeyframe(key, result_.keyframes.size()));
    finish();
    return std::move(result_);
  }

 private:
  std::vector<const Element*> sections(std::string_view tag) const {
    std::vector<const Element*> found;
    for (const Element& e : document_.root.children)
      if (e.tag == tag) found.push_back(&e);
    return found;
  }

  void refuseSections() const {
    for (const Element* e : sections("deformable"))
      if (!e->children.empty())
        e->children.front().fail("is deformable, which is not simulated; expected rigid bodies");
    for (const Element* e : sections("extension"))
      if (!e->children.empty())
        e->children.front().fail("is a plugin, which is not run; expected none");
  }

  void readAssets() {
    for (const Element* section : sections("asset"))
      for (const Element& e : section->children) {
        const mjcf::DefaultClass& of = defaults_.of(e, defaults_.top());
        if (e.tag == "mesh")
          assets_.addMesh(e, of.mesh);
        else if (e.tag == "hfield")
          assets_.addHeightField(e);
        else if (e.tag == "material")
          assets_.addMaterial(e, of.material);
        else if (e.tag != "texture" && e.tag != "skin")
          e.fail("is an asset that is not read; expected mesh, hfield, material or texture");
      }
  }

  void readContacts() {
    for (const Element* section : sections("contact"))
      for (const Element& e : section->children) {
        if (e.tag == "exclude") {
          excludes_.push_back(&e);
        } else if (e.tag == "pair") {
          mjcf::Pair pair = defaults_.of(e, defaults_.top()).pair;
          pair.read(e);
          for (const char* name : {"geom1", "geom2"}) e.requiredText(name);
          pairs_.push_back(std::move(pair));
        } else {
          e.fail("is not read in <contact>; expected pair or exclude");
        }
      }
  }

  void readTendons() {
    for (const Element* section : sections("tendon"))
      for (const Element& e : section->children) {
        mjcf::Tendon tendon;
        tendon.read(e, defaults_.of(e, defaults_.top()).tendon);
        if (!tendon.name.empty() && !tendons_.emplace(tendon.name, tendon).second)
          e.fail("has the name of another tendon, expected one of its own");
      }
  }

  void readActuators() {
    for (const Element* section : sections("actuator"))
      for (const Element& e : section->children) {
        mjcf::Actuator actuator = defaults_.of(e, defaults_.top()).actuator;
        actuator.read(e);
        actuator.check();
        addActuator(actuator);
      }
  }

  void addActuator(const mjcf::Actuator& actuator) {
    SceneActuator out;
    out.name =
        actuator.name.empty() ? fmt::format("actuator{}", scene_.actuators.size()) : actuator.name;
    out.where = actuator.element.where;
    std::tie(out.lower, out.upper) = actuator.forces(compiler_.autolimits);
    for (const auto& [name, coefficient] : pulls(actuator)) {
      const mjcf::Joint& joint = scalarJoint(actuator.element, name);
      if (coefficient == 0.0) continue;
      out.joints.emplace_back(name, coefficient * actuator.gear[0]);
      scene_.builder.findJoint(name)->actuated = true;
      boundByJoint(joint, actuator, out);
    }
    result_.servos.push_back(mjcf::servoOf(actuator, {out.lower, out.upper}, compiler_.autolimits));
    expectOneServo(actuator);
    if (actuator.isServo() && !result_.servos.back()) ++stillServos_;
    scene_.actuators.push_back(std::move(out));
  }

  /// A joint has one servo; what others do with it is not simulated.
  void expectOneServo(const mjcf::Actuator& actuator) {
    auto& servo = result_.servos.back();
    if (servo && !servoed_.insert(actuator.joint).second) servo.reset();
  }

  std::vector<std::pair<std::string, double>> pulls(const mjcf::Actuator& actuator) const {
    if (!actuator.joint.empty()) return {{actuator.joint, 1.0}};
    const auto found = tendons_.find(actuator.tendon);
    if (found == tendons_.end())
      actuator.element.fail(
          fmt::format("tendon {} does not exist", detail::quotedText(actuator.tendon)));
    if (found->second.joints.empty())
      actuator.element.fail(
          fmt::format("pulls the spatial tendon {}, which is not simulated; "
                      "expected a <fixed> one, or a joint",
                      detail::quotedText(actuator.tendon)));
    return found->second.joints;
  }

  const mjcf::Joint& scalarJoint(const Element& e, const std::string& name) const {
    for (const mjcf::Body& body : bodies_)
      for (const mjcf::Joint& joint : body.joints)
        if (joint.name == name && joint.isScalar()) return joint;
    e.fail(fmt::format("joint {} is no hinge and no slide{}", detail::quotedText(name),
                       detail::offered(name, scene_.contents.scalarJoints)));
  }

  /// actuatorfrcrange: of all actuators of a joint together, which is that of one.
  void boundByJoint(const mjcf::Joint& joint, const mjcf::Actuator& actuator, SceneActuator& out) {
    const bool isDriven = !driven_.insert(joint.name).second;
    if (!mjcf::isLimited(joint.element, "actuatorfrclimited", joint.forceLimited, joint.forceRange,
                         compiler_.autolimits))
      return;
    if (isDriven || !actuator.tendon.empty())
      joint.element.fail(
          "has an actuatorfrcrange and several actuators, or a tendon's, which is not "
          "simulated; expected one actuator");
    const double gear = out.joints.back().second;
    const auto [low, high] = std::minmax({joint.forceRange[0] / gear, joint.forceRange[1] / gear});
    out.lower = std::clamp(out.lower, low, high);
    out.upper = std::clamp(out.upper, low, high);
  }

  void finish() {
    scene_.noGround = true;
    scene_.timestepWhere = optionsOfFile_.timestepWhere;
    scene_.contents.files = document_.files;
    for (const auto& mesh : assets_.files()) scene_.contents.files.push_back(mesh);
    for (const Element* e : sections("option"))
      result_.namesIntegrator = result_.namesIntegrator || e->has("integrator");
    result_.integrator = optionsOfFile_.integrator;
    tellActuators();
    tellReadPast();
    result_.givesSoftness = givesSoftness(document_.root);
    result_.scene = std::move(scene_);
  }

  void tellActuators() {
    if (stillServos_ > 0)
      scene_.notes.push_back(fmt::format(
          "{} of the file: goals choose {} within forcerange; set points, kp and kv do not act, "
          "which they do of one joint with kp, kv of 0 or more and the same force either way",
          detail::counted(static_cast<std::size_t>(stillServos_), "servo"),
          stillServos_ == 1 ? "its force" : "their forces"));
  }

  void tellReadPast() {
    std::map<std::string, std::size_t> counts;
    countReadPast(document_.root, counts);
    std::vector<std::string> parts;
    for (const auto& [tag, count] : counts) parts.push_back(fmt::format("{} {}", count, tag));
    for (const std::string& option : optionsOfFile_.readPast) parts.push_back(option);
    if (inactive_ > 0) parts.push_back(fmt::format("{} inactive equality", inactive_));
    if (!parts.empty())
      scene_.notes.push_back("read past, as it changes no motion here: " +
                             detail::listed(parts, 30));
  }

  static void countReadPast(const Element& e, std::map<std::string, std::size_t>& counts) {
    for (const Element& child : e.children) {
      const bool isSection = child.tag == "sensor" || child.tag == "custom";
      if (isSection)
        counts[child.tag] += child.children.size();
      else if (child.tag == "camera" || child.tag == "light" || child.tag == "texture" ||
               child.tag == "skin" || child.tag == "visual" || child.tag == "statistic" ||
               child.tag == "size")
        ++counts[child.tag];
      else if (child.tag != "default")
        countReadPast(child, counts);
      if (child.text("mocap") == "true") ++counts["mocap body, which stands still"];
    }
  }

  static bool givesSoftness(const Element& e) {
    return std::any_of(e.attributes.begin(), e.attributes.end(),
                       [](const auto& a) {
                         return a.first.starts_with("solref") || a.first.starts_with("solimp");
                       }) ||
           std::any_of(e.children.begin(), e.children.end(), givesSoftness);
  }

  std::filesystem::path file_;
  const UrdfOptions& options_;
  mjcf::Document document_;
  mjcf::Compiler compiler_;
  mjcf::FileOptions optionsOfFile_;
  mjcf::Defaults defaults_;
  mjcf::Assets assets_;
  std::vector<mjcf::Body> bodies_;
  std::vector<mjcf::Pair> pairs_;
  std::vector<const Element*> excludes_;
  std::map<std::string, mjcf::Tendon> tendons_;
  std::set<std::string> servoed_;  ///< joints that have a servo
  std::set<std::string> driven_;   ///< joints that have an actuator
  int inactive_ = 0, stillServos_ = 0;
  SceneFile scene_;
  MjcfFile result_;
};

}  // namespace

const mjcf::Keyframe* MjcfFile::find(const std::string& keyframe) const {
  if (keyframe.empty()) return nullptr;
  const auto key = std::find_if(keyframes.begin(), keyframes.end(),
                                [&](const mjcf::Keyframe& k) { return k.name == keyframe; });
  if (key == keyframes.end()) {
    std::vector<std::string> names;
    for (const mjcf::Keyframe& k : keyframes) names.push_back(k.name);
    throw ModelError(
        {scene.contents.files.front().string(), 0}, fmt::format("state '{}'", keyframe),
        names.empty() ? "the file has no keyframe"
                      : "is no keyframe of the file" + detail::offered(keyframe, names));
  }
  return &*key;
}

void MjcfFile::setServos(Model& model, const std::string& keyframe) const {
  const mjcf::Keyframe* key = find(keyframe);
  if (key && key->ctrl && key->ctrl->size() != servos.size())
    throw ModelError(
        key->where, fmt::format("key '{}'", key->name),
        fmt::format("ctrl has {} numbers, expected {}", key->ctrl->size(), servos.size()));
  mjcf::setServos(servos, key && key->ctrl ? *key->ctrl : std::vector<double>{}, model);
}

State MjcfFile::initialState(const Model& model, const std::string& keyframe) const {
  State state(model);
  const mjcf::Keyframe* key = find(keyframe);
  if (!key) return state;
  const std::string element = fmt::format("key '{}'", key->name);
  const auto set = [&](const std::optional<std::vector<double>>& values, const char* what,
                       VectorX& x) {
    if (!values) return;
    if (static_cast<int>(values->size()) != x.size())
      throw ModelError(
          key->where, element,
          fmt::format("{} has {} numbers, expected {}", what, values->size(), x.size()));
    x = Eigen::Map<const VectorX>(values->data(), x.size());
  };
  set(key->qpos, "qpos", state.q);
  set(key->qvel, "qvel", state.v);
  for (const softgauss::Body& body : model.bodies) {
    if (body.joint != JointKind::floating) continue;
    auto quaternion = state.q.segment<4>(body.q + 3);
    if (!(quaternion.norm() > 0.0))
      throw ModelError(key->where, element, "has a quaternion that is zero, expected another");
    quaternion.normalize();
  }
  return state;
}

MjcfFile readMjcf(const std::filesystem::path& file, const UrdfOptions& options) {
  return MjcfReader(file, options).read();
}

bool isMjcf(const std::filesystem::path& file) {
  return mjcf::isMjcfText(detail::readInput(file.string(), "a URDF, an MJCF or a .yaml scene"));
}

}  // namespace softgauss::io
