// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/scene_constraints.hpp"

#include <fmt/format.h>

#include "softgauss/engine/constraints/contact.hpp"
#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/scene_parts.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

std::vector<std::string> with(std::vector<std::string> keys, const std::vector<std::string>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

std::string linkName(const YamlMap& map, const std::string& key, const SceneNames& names) {
  const YamlMap::Entry& entry = map.required(key, "the name of a link, or world");
  if (map.name(entry) == "world") return "world";
  return map.known(entry, names.links, "a link of the scene, or world");
}

/// A joint of one degree of freedom, or one of those that a planar joint is made of.
std::string jointName(const YamlMap& map, const YamlMap::Entry& entry, const SceneNames& names,
                      ModelBuilder& builder) {
  const std::string name = map.name(entry);
  if (names.joints.count(name) > 0 || builder.findJoint(name.substr(0, name.rfind('.'))))
    return name;
  return map.known(entry, names.joints, "a joint of one degree of freedom of the scene");
}

void readConnect(const YamlMap& map, const SceneNames& names, ModelBuilder& builder) {
  map.expectOnly(with({"link_a", "link_b", "point_a", "point_b"}, kSoftnessKeys));
  ConnectSpec spec;
  spec.where = {map.file(), map.line()};
  spec.linkA = linkName(map, "link_a", names);
  spec.linkB = linkName(map, "link_b", names);
  map.read("point_a", spec.p_LAP);
  map.read("point_b", spec.p_LBP);
  readSoftness(map, spec.impedance);
  builder.connect(std::move(spec));
}

Transform poseUnder(const YamlMap& map, const std::string& key) {
  const YamlMap::Entry* entry = map.find(key);
  if (!entry) return {};
  const YamlMap pose = map.map(*entry);
  pose.expectOnly(kPoseKeys);
  return readPose(pose);
}

void readWeld(const YamlMap& map, const SceneNames& names, ModelBuilder& builder) {
  map.expectOnly(with({"link_a", "link_b", "pose_a", "pose_b", "torque_scale"}, kSoftnessKeys));
  WeldSpec spec;
  spec.where = {map.file(), map.line()};
  spec.linkA = linkName(map, "link_a", names);
  spec.linkB = linkName(map, "link_b", names);
  spec.X_LAF = poseUnder(map, "pose_a");
  spec.X_LBF = poseUnder(map, "pose_b");
  map.read("torque_scale", spec.torqueScale, Range::positive);
  readSoftness(map, spec.impedance);
  builder.weld(std::move(spec));
}

void readCouple(const YamlMap& map, const SceneNames& names, ModelBuilder& builder) {
  map.expectOnly(with({"follower", "leader", "multiplier", "offset", "polynomial"}, kSoftnessKeys));
  CouplingSpec spec;
  spec.where = {map.file(), map.line()};
  spec.follower = jointName(map, map.required("follower", "the name of a joint"), names, builder);
  if (const auto* entry = map.find("leader")) spec.leader = jointName(map, *entry, names, builder);
  if (const auto* entry = map.find("polynomial")) {
    for (const char* key : {"multiplier", "offset"})
      if (const auto* other = map.find(key))
        map.fail(*other,
                 fmt::format("found beside polynomial in line {}, which says it all", entry->line));
    spec.polynomial.fill(0.0);
    const std::vector<double> c =
        map.numbers(*entry, 1, spec.polynomial.size(), "one to five finite numbers [c0, c1, …]");
    std::copy(c.begin(), c.end(), spec.polynomial.begin());
  } else {
    map.read("offset", spec.polynomial[0], Range::any);
    map.read("multiplier", spec.polynomial[1], Range::any);
  }
  readSoftness(map, spec.impedance);
  builder.couple(std::move(spec));
}

struct ConstraintKind {
  const char* name;
  void (*read)(const YamlMap& map, const SceneNames& names, ModelBuilder& builder);
};

constexpr ConstraintKind kConstraintKinds[] = {
    {"connect", readConnect}, {"weld", readWeld}, {"couple", readCouple}};

}  // namespace

void readConstraint(const std::string& file, const YamlValue& item, std::size_t number,
                    const SceneNames& names, ModelBuilder& builder) {
  const std::string label = fmt::format("constraint {}", number);
  std::vector<std::string> known;
  for (const ConstraintKind& kind : kConstraintKinds) known.push_back(kind.name);
  if (item.kind != YamlValue::Kind::map || item.pairs.size() != 1)
    throw ModelError({file, item.line}, label,
                     fmt::format("found {}, expected kind: {{…}}, the kind one of {}",
                                 item.described(), listed(known)));
  const YamlMap kinds(file, label + ": ", "", item);
  kinds.expectOnly(known);
  const YamlMap::Entry& only = kinds.entries().front();
  for (const ConstraintKind& kind : kConstraintKinds)
    if (only.key == kind.name) kind.read(kinds.map(only), names, builder);
}

void readPair(const YamlMap& map, const Materials& materials,
              const std::map<std::string, Material>& surfaces, const std::set<std::string>& links,
              ModelBuilder& builder) {
  const auto named = [&](const std::string& key) {
    const char* const expected = "the name of a link, of an object, or ground";
    return map.known(map.required(key, expected), links, expected);
  };
  PairSpec spec;
  spec.where = {map.file(), map.line()};
  spec.geometryA = named("a");
  spec.geometryB = named("b");
  if (spec.geometryA == spec.geometryB)
    map.fail(*map.find("b"),
             fmt::format("found {} as in a, expected another", quotedText(spec.geometryB)));
  spec.material = map.find("material")
                      ? materialOf(map, materials)
                      : mixMaterials(surfaces.at(spec.geometryA), surfaces.at(spec.geometryB));
  readSurface(map, spec.material);
  map.expectOnly(with({"a", "b", "material"}, kSurfaceKeys));
  if (map.entries().size() == 2)
    map.fail(*map.find("b"), "found nothing else, expected a material or what differs: one of " +
                                 listed(kSurfaceKeys, kSurfaceKeys.size()));
  builder.pair(std::move(spec));
}

TimedWrench readWrench(const YamlMap& map, const std::set<std::string>& links) {
  map.expectOnly({"link", "force", "moment", "point", "start", "end"});
  TimedWrench wrench;
  wrench.where = {map.file(), map.line()};
  wrench.link = map.known(map.required("link", "the name of a link"), links, "a link of the scene");
  if (!map.find("moment")) map.required("force", "a force [N] or a moment [N m]");
  map.read("force", wrench.force_W);
  map.read("moment", wrench.moment_W);
  map.read("point", wrench.p_LP);
  map.read("start", wrench.start, Range::notNegative);
  map.read("end", wrench.end, Range::notNegative);
  if (!(wrench.end > wrench.start))
    map.fail(*map.find("end"), fmt::format("found {}, expected more than the start, {:g} s",
                                           map.find("end")->value.described(), wrench.start));
  return wrench;
}

namespace {

Servo readServo(const YamlMap& map) {
  map.expectOnly({"kp", "kd", "effort", "set_point", "set_point_rate"});
  Servo servo;
  map.read("kp", servo.kp, Range::notNegative);
  map.read("kd", servo.kd, Range::notNegative);
  if (!servo.exists())
    map.fail("kp", map.line(),
             "found no gain, expected a kp [N m/rad or N/m] or a kd [N m s/rad or N s/m] above 0");
  map.read("effort", servo.effort, Range::positive);
  map.read("set_point", servo.setPoint, Range::any);
  map.read("set_point_rate", servo.setPointRate, Range::any);
  return servo;
}

}  // namespace

void readJointParameters(const YamlMap& joints, ModelBuilder& robot) {
  for (const YamlMap::Entry& entry : joints.entries()) {
    const YamlMap map = joints.map(entry);
    JointSpec& joint = *robot.findJoint(entry.key);
    map.expectOnly({"friction", "damping", "armature", "stiffness", "spring_reference", "servo"});
    map.read("friction", joint.dryFriction, Range::notNegative);
    map.read("damping", joint.damping, Range::notNegative);
    map.read("armature", joint.armature, Range::notNegative);
    map.read("stiffness", joint.stiffness, Range::notNegative);
    map.read("spring_reference", joint.springReference, Range::any);
    if (const auto* reference = map.find("spring_reference"); reference && joint.stiffness == 0.0)
      map.fail(*reference, "found without a stiffness above 0, expected both or neither");
    if (const auto* servo = map.find("servo")) joint.servo = readServo(map.map(*servo));
  }
}

}  // namespace softgauss::io::detail
