// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mcap_log.hpp"

#include <algorithm>
#include <cctype>

#include "softgauss/engine/core/bytes.hpp"
#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/json_text.hpp"
#include "softgauss/io/detail/mcap_file.hpp"
#include "softgauss/io/detail/mcap_schemas.hpp"
#include "softgauss/io/detail/mcap_shapes.hpp"

namespace softgauss::io {
namespace {

using detail::JsonText;
using detail::McapChannel;
using detail::NumberField;

/// In the order of McapLog::Writer::channels().
enum Topic { transforms, shapes, contacts, joints, bases, step, balance, goals, forces };

constexpr const char* kWorld = "world";
constexpr double kArrowPerWeight = 0.5;  // [m] of an arrow for the weight of all that moves
constexpr double kArrowWidth = 0.01;     // [m]
const Eigen::Vector4d kArrowColor(0.9, 0.3, 0.1, 1.0);

const std::vector<std::string> kCoordinates = {"x", "y", "z"};
const std::vector<std::string> kTwistParts = {"vx", "vy", "vz", "wx", "wy", "wz"};

std::vector<std::string> jsonNames(const std::vector<std::string>& names) {
  std::vector<std::string> quoted;
  for (const std::string& name : names) quoted.push_back(detail::jsonName(name));
  return quoted;
}

/// Columns that begin and end so, without that.
std::vector<std::string> columnsOf(const std::vector<std::string>& columns,
                                   const std::string& beginning, const std::string& ending) {
  std::vector<std::string> names;
  for (const std::string& column : columns)
    if (column.starts_with(beginning) && column.ends_with(ending))
      names.push_back(
          column.substr(beginning.size(), column.size() - beginning.size() - ending.size()));
  return names;
}

std::vector<NumberField> fieldsOf(const std::vector<std::string>& names,
                                  const std::vector<std::string>& parts) {
  std::vector<NumberField> fields;
  for (const std::string& name : names) fields.push_back({name, parts});
  return fields;
}

}  // namespace

bool isMcap(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending == ".mcap";
}

struct McapLog::Writer {
  Writer(const std::filesystem::path& file, const Model& theModel,
         const std::vector<std::string>& goalNames, const std::optional<detail::McapEnd>& after)
      : model(theModel), kinematics(theModel) {
    const std::vector<std::string> columns = logColumns(model, goalNames);
    goalErrors = columnsOf(columns, "error:", "");
    links = columnsOf(columns, "f:", ".x");
    for (int b = 1; b < model.bodyCount(); ++b)
      (isBase(b) ? baseNames : jointNames).push_back(columnName(model, b));
    for (const Frame& frame : model.frames) frames.push_back(frame.name);
    mcap.emplace(file, std::string("softgauss ") + SOFTGAUSS_VERSION, channels(), after);
    for (auto* names : {&goalErrors, &links, &baseNames, &jointNames, &frames})
      *names = jsonNames(*names);
    weight = std::max(model.totalMass() * model.options.gravity.norm(), 1e-9);
  }

  std::vector<McapChannel> channels() const {
    return {{"/tf", "foxglove.FrameTransforms", detail::transformsSchema()},
            {"/shapes", "foxglove.SceneUpdate", detail::sceneSchema()},
            {"/contacts", "foxglove.SceneUpdate", detail::sceneSchema()},
            {"/joints", "foxglove.JointStates", detail::jointStatesSchema()},
            own("/bases", "softgauss.Bases", fieldsOf(baseNames, kTwistParts)),
            own("/step", "softgauss.Step",
                fieldsOf({"contacts", "constraints", "iterations", "dual_updates",
                          "physics_violation", "gdd_violation", "stationarity", "forward_us",
                          "gdd_us", "step_us", "energy_J", "max_penetration_m"},
                         {})),
            own("/balance", "softgauss.Balance",
                fieldsOf({"com", "cop", "momentum", "angular_momentum"}, kCoordinates)),
            own("/goal_errors", "softgauss.GoalErrors", fieldsOf(goalErrors, {})),
            own("/contact_forces", "softgauss.ContactForces", fieldsOf(links, kCoordinates))};
  }
  static McapChannel own(const char* topic, const char* name,
                         const std::vector<NumberField>& fields) {
    return {topic, name, detail::numbersSchema(name, fields)};
  }

  bool isBase(int body) const {
    return model.bodies[static_cast<std::size_t>(body)].joint == JointKind::floating;
  }
  /// Links of the world stand still: they are told once.
  bool isFixed(std::size_t frame) const { return model.frames[frame].body == 0; }

  void send(Topic topic, double time) {
    mcap->write(topic, time, json.text());
    json.clear();
  }
  JsonText& begin(double time) { return json.open('{').time("timestamp", time); }
  void finish(Topic topic, double time) {
    json.close('}');
    send(topic, time);
  }

  void writeTransforms(double time, bool first) {
    json.open('{').open("transforms", '[');
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (model.frames[i].name == kWorld || (isFixed(i) && !first)) continue;
      const Transform X = framePose(model, kinematics, static_cast<int>(i));
      begin(time).raw("parent_frame_id", "\"world\"").raw("child_frame_id", frames[i]);
      json.point("translation", X.p).quaternion("rotation", Quaternion(X.R)).close('}');
    }
    json.close(']');
    finish(transforms, time);
  }

  void writeContacts(double time, const std::vector<Snapshot::ContactForce>& touching) {
    json.open('{').raw("deletions", "[]").open("entities", '[');
    detail::beginEntity("contacts", kWorld, time, json);
    json.open("arrows", '[');
    for (const Snapshot::ContactForce& contact : touching) {
      const double length = contact.force.norm() / weight * kArrowPerWeight;
      if (length <= 0.0) continue;
      const Quaternion turn = Quaternion::FromTwoVectors(Vector3::UnitX(), contact.force);
      json.open('{').pose({turn.toRotationMatrix(), contact.p_WC});
      json.number("shaft_length", 0.8 * length).number("shaft_diameter", kArrowWidth);
      json.number("head_length", 0.2 * length).number("head_diameter", 2.0 * kArrowWidth);
      detail::writeColor(kArrowColor, json);
      json.close('}');
    }
    json.close(']');
    for (const char* other :
         {"cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models"})
      json.raw(other, "[]");
    json.close('}').close(']').close('}');
    send(contacts, time);
  }

  void writeJoints(const StepRecord& r) {
    begin(r.time).open("joints", '[');
    auto name = jointNames.begin();
    for (int b = 1; b < model.bodyCount(); ++b) {
      const Body& body = model.bodies[static_cast<std::size_t>(b)];
      if (isBase(b)) continue;
      json.open('{').raw("name", *name++).number("position", r.q[body.q]);
      json.number("velocity", r.v[body.v]);
      if (!r.isEnd) json.number("acceleration", r.a[body.v]).number("effort", r.u[body.v]);
      json.close('}');
    }
    json.close(']');
    finish(joints, r.time);
  }

  /// Poses are among the transforms.
  void writeBases(const StepRecord& r) {
    begin(r.time);
    auto name = baseNames.begin();
    for (int b = 1; b < model.bodyCount(); ++b) {
      if (!isBase(b)) continue;
      json.open(*name++, '{');
      for (int i = 0; i < 6; ++i)
        json.number(kTwistParts[static_cast<std::size_t>(i)],
                    r.v[model.bodies[static_cast<std::size_t>(b)].v + i]);
      json.close('}');
    }
    finish(bases, r.time);
  }

  void writeStep(const StepRecord& r) {
    begin(r.time).number("contacts", r.contacts).number("constraints", r.constraints);
    if (!r.isEnd)
      json.number("iterations", r.iterations)
          .number("dual_updates", r.dualUpdates)
          .number("physics_violation", r.physicsViolation)
          .number("gdd_violation", r.gddViolation)
          .number("stationarity", r.stationarity)
          .number("forward_us", r.forwardUs)
          .number("gdd_us", r.gddUs)
          .number("step_us", r.stepUs);
    json.number("energy_J", r.energy).number("max_penetration_m", r.maxPenetration);
    finish(step, r.time);
  }

  void writeBalance(const StepRecord& r) {
    begin(r.time).point("com", r.centerOfMass);
    if (r.centerOfPressure && !r.isEnd) json.point("cop", *r.centerOfPressure);
    json.point("momentum", r.momentum).point("angular_momentum", r.angularMomentum);
    finish(balance, r.time);
  }

  void writeGoals(const StepRecord& r) {
    begin(r.time);
    const bool known = r.goalErrors.size() == static_cast<Eigen::Index>(goalErrors.size());
    for (std::size_t i = 0; known && i < goalErrors.size(); ++i)
      json.number(goalErrors[i], r.goalErrors[static_cast<Eigen::Index>(i)]);
    finish(goals, r.time);
  }

  void writeForces(const StepRecord& r) {
    begin(r.time);
    const bool known = r.linkForces.size() == 3 * static_cast<Eigen::Index>(links.size());
    for (std::size_t i = 0; known && i < links.size(); ++i)
      json.point(links[i], r.linkForces.segment<3>(3 * static_cast<Eigen::Index>(i)));
    finish(forces, r.time);
  }

  const Model& model;
  std::vector<std::string> frames, jointNames, baseNames, goalErrors, links;  ///< as JSON has them
  std::optional<detail::McapFile> mcap;
  Kinematics kinematics;
  double weight = 1.0;  ///< of all that moves [N]
  JsonText json;        ///< of the message that is being written
};

McapLog::McapLog(const std::filesystem::path& file, const Model& model,
                 const std::vector<std::string>& goalNames, long every, const std::string& after)
    : every_(every) {
  std::optional<detail::McapEnd> begun;
  if (!after.empty()) {
    ByteReader reader(after);
    reader(seen_, begun.emplace());
  }
  writer_ = std::make_unique<Writer>(file, model, goalNames, begun);
}

McapLog::~McapLog() = default;

void McapLog::write(const StepRecord& r, const std::vector<Snapshot::ContactForce>& touching) {
  const bool first = seen_ == 0;
  if (seen_++ % every_ != 0 && !r.isEnd) return;
  Writer& w = *writer_;
  computePoses(w.model, r.q, w.kinematics);
  w.writeTransforms(r.time, first);
  if (first) {
    detail::writeShapes(w.model, r.time, w.json);
    w.send(shapes, r.time);
  }
  if (!r.isEnd) w.writeContacts(r.time, touching);
  w.writeJoints(r);
  if (!w.baseNames.empty()) w.writeBases(r);
  w.writeStep(r);
  w.writeBalance(r);
  if (!w.goalErrors.empty()) w.writeGoals(r);
  if (!w.links.empty() && !r.isEnd) w.writeForces(r);
}

void McapLog::close() { writer_->mcap->close(); }

std::string McapLog::end() {
  ByteWriter bytes;
  bytes(seen_, writer_->mcap->end());
  return bytes.bytes();
}

}  // namespace softgauss::io
