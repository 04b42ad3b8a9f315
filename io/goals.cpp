// SPDX-License-Identifier: Apache-2.0
#include "io/goals.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "engine/dynamics/kinematics.hpp"
#include "gdd/goals/posture.hpp"
#include "gdd/goals/reach.hpp"
#include "gdd/goals/virtual_damping.hpp"
#include "io/detail/text.hpp"

namespace softgauss::io {
namespace {

// ---- YAML, read strictly ------------------------------------------------------------------------

/// Text as messages show it: short, and without characters that move a terminal's cursor.
std::string quoted(std::string text) {
  constexpr std::size_t kMost = 60;
  if (text.size() > kMost) text = text.substr(0, kMost) + "…";
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return "'" + text + "'";
}

/// A scalar in quotes is text, even if it looks like a number.
bool isPlain(const YAML::Node& node) { return node.Tag() == "?"; }

/// What a message says was found.
std::string described(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return isPlain(node) ? quoted(node.Scalar()) : "the text " + quoted(node.Scalar());
    case YAML::NodeType::Sequence:
      return "a list of " + std::to_string(node.size());
    case YAML::NodeType::Map:
      return "a map";
    default:
      return "nothing";
  }
}

std::optional<double> finiteNumber(const YAML::Node& node) {
  if (!node.IsScalar() || !isPlain(node)) return std::nullopt;
  return detail::parseNumber(node.Scalar());
}

enum class Range { any, notNegative, positive };

/// A map of the file, and what messages need to name it. Its keys are distinct names.
class YamlMap {
 public:
  struct Entry {
    std::string key;
    YAML::Node value;
    int line = 0;
  };

  /// `label` is how messages begin, "goal 2 'reach': "; `prefix` what they put before keys.
  YamlMap(const std::string& file, std::string label, std::string prefix, const YAML::Node& map)
      : file_(&file), label_(std::move(label)), prefix_(std::move(prefix)) {
    for (const auto& pair : map) {
      const int line = pair.first.Mark().line + 1;
      if (!pair.first.IsScalar())
        throw ModelError({*file_, line}, label_ + "key",
                         fmt::format("found {}, expected a name", described(pair.first)));
      const std::string key = pair.first.Scalar();
      if (const Entry* first = find(key))
        fail({key, {}, line},
             fmt::format("found a second time, first in line {}; expected once", first->line));
      entries_.push_back({key, pair.second, line});
    }
  }

  const std::vector<Entry>& entries() const { return entries_; }

  void expectOnly(const std::vector<std::string>& known) const {
    for (const Entry& entry : entries_)
      if (std::find(known.begin(), known.end(), entry.key) == known.end())
        fail(entry, fmt::format("found an unknown key, expected one of {}{}", detail::listed(known),
                                detail::suggestion(entry.key, known)));
  }

  const Entry* find(const std::string& key) const {
    const auto it = std::find_if(entries_.begin(), entries_.end(),
                                 [&](const Entry& entry) { return entry.key == key; });
    return it == entries_.end() ? nullptr : &*it;
  }

  const Entry& required(const std::string& key, const std::string& expected, int mapLine) const {
    const Entry* entry = find(key);
    if (!entry) fail({key, {}, mapLine}, "found no such key, expected " + expected);
    return *entry;
  }

  /// The number of the entry.
  double number(const Entry& entry, Range range = Range::any) const {
    const std::optional<double> x = finiteNumber(entry.value);
    const bool inside =
        x && (range == Range::any || *x > 0.0 || (range == Range::notNegative && *x == 0.0));
    if (inside) return *x;
    const char* const bound = range == Range::notNegative ? " >= 0"
                              : range == Range::positive  ? " > 0"
                                                          : "";
    fail(entry, fmt::format("found {}, expected a finite number{}", described(entry.value), bound));
  }
  /// Sets x if the key is there.
  void read(const std::string& key, double& x, Range range) const {
    if (const Entry* entry = find(key)) x = number(*entry, range);
  }

  Vector3 vector3(const Entry& entry) const {
    const YAML::Node& list = entry.value;
    if (!list.IsSequence() || list.size() != 3)
      fail(entry, fmt::format("found {}, expected three numbers [x, y, z]", described(list)));
    Vector3 p;
    for (int i = 0; i < 3; ++i) {
      const YAML::Node item = list[static_cast<std::size_t>(i)];
      const std::optional<double> x = finiteNumber(item);
      if (!x)
        fail({entry.key, {}, item.Mark().line + 1},
             fmt::format("found {} as number {}, expected three finite numbers [x, y, z]",
                         described(item), i + 1));
      p[i] = *x;
    }
    return p;
  }

  std::string name(const Entry& entry) const {
    if (!entry.value.IsScalar())
      fail(entry, fmt::format("found {}, expected a name", described(entry.value)));
    return entry.value.Scalar();
  }

  /// The map that is the value of the entry; messages call its keys `key.…`.
  YamlMap map(const Entry& entry) const {
    if (!entry.value.IsMap())
      fail(entry, fmt::format("found {}, expected a map {{…}}", described(entry.value)));
    return {*file_, label_, prefix_ + entry.key + ".", entry.value};
  }

  [[noreturn]] void fail(const Entry& entry, const std::string& problem) const {
    throw ModelError({*file_, entry.line}, label_ + "key " + quoted(prefix_ + entry.key), problem);
  }

 private:
  const std::string* file_;
  std::string label_, prefix_;
  std::vector<Entry> entries_;
};

/// Notes where the document begins that a parser reads.
class DocumentStart final : public YAML::EventHandler {
 public:
  int line = 0;

  void OnDocumentStart(const YAML::Mark& mark) override { line = mark.line + 1; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

/// The only document of the file.
YAML::Node parseYaml(const std::string& file, const std::string& text) {
  // yaml-cpp takes some control characters for the end of the file.
  const auto control = std::find_if(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t';
  });
  if (control != text.end())
    throw ModelError({file, 1 + static_cast<int>(std::count(text.begin(), control, '\n'))}, "YAML",
                     "found a control character, expected text in UTF-8");
  try {
    const YAML::Node document = YAML::Load(text);
    // Not YAML::LoadAll: what it cannot read it may meet again and again, for ever.
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    DocumentStart start;
    const bool hasMore = parser.HandleNextDocument(start) && parser.HandleNextDocument(start);
    if (hasMore)
      throw ModelError({file, start.line}, "YAML",
                       "found more behind the end of the document, expected the end of the file");
    if (document.IsNull()) throw ModelError({file, 1}, "file", "is empty, expected goals: [...]");
    return document;
  } catch (const YAML::Exception& error) {
    throw ModelError(
        {file, error.mark.line + 1}, "YAML",
        fmt::format("cannot be read: {} (column {})", error.msg, error.mark.column + 1));
  }
}

// ---- One function for each kind of goal ---------------------------------------------------------

using GoalPointer = std::unique_ptr<gdd::Goal>;

/// What the goals are about.
struct Scene {
  const Model& model;
  const State& initial;
};

/// A goal as written: the line of its kind and the keys below it.
struct Written {
  int line = 0;
  const YamlMap& keys;
};

/// The link that the entry names; it must move.
std::string movingLink(const YamlMap& keys, const YamlMap::Entry& entry, const Model& model) {
  const std::string link = keys.name(entry);
  std::vector<std::string> links;
  for (const Frame& frame : model.frames)
    if (frame.body != 0) links.push_back(frame.name);
  const int frame = model.findFrame(link);
  if (frame < 0)
    keys.fail(entry, fmt::format("found {}, expected a link of model '{}'{}", quoted(link),
                                 model.name, detail::suggestion(link, links)));
  if (model.frames[static_cast<std::size_t>(frame)].body == 0)
    keys.fail(entry,
              fmt::format("found {}, which is fixed to the world, expected a link that moves",
                          quoted(link)));
  return link;
}

/// The line of Flash and Hogan from where the goal's point is at first.
gdd::MinimumJerk readMinimumJerk(const YamlMap& keys, const gdd::Reach& goal, const Scene& scene) {
  keys.expectOnly({"duration", "start"});
  gdd::MinimumJerk line;
  keys.read("duration", line.duration, Range::positive);
  keys.read("start", line.startTime, Range::any);
  Kinematics kinematics(scene.model);
  computeKinematics(scene.model, scene.initial, kinematics);
  line.p_start = framePose(scene.model, kinematics, goal.frame) * goal.p_FP;
  return line;
}

GoalPointer readReach(const Written& written, const Scene& scene) {
  const YamlMap& keys = written.keys;
  const std::string link =
      movingLink(keys, keys.required("link", "the name of a link", written.line), scene.model);
  const Vector3 target =
      keys.vector3(keys.required("target", "three numbers [x, y, z]", written.line));
  auto goal = std::make_unique<gdd::Reach>(scene.model, link, target);
  if (const auto* point = keys.find("point")) goal->p_FP = keys.vector3(*point);
  keys.read("weight", goal->weight, Range::notNegative);
  keys.read("stiffness", goal->stiffness, Range::notNegative);
  keys.read("damping", goal->damping, Range::notNegative);
  if (const auto* line = keys.find("minimum_jerk"))
    goal->minimumJerk = readMinimumJerk(keys.map(*line), *goal, scene);
  return goal;
}

/// Replaces the positions of the joints that the map names.
void readJoints(const YamlMap& joints, const Model& model, VectorX& q) {
  std::vector<std::string> names;
  for (int b = 1; b < model.bodyCount(); ++b)
    if (model.bodies[static_cast<std::size_t>(b)].dofs == 1)
      names.push_back(model.jointNames[static_cast<std::size_t>(b)]);

  for (const YamlMap::Entry& entry : joints.entries()) {
    const int body = model.findJoint(entry.key);
    if (body < 0)
      joints.fail(entry, fmt::format("found an unknown joint, expected one of model '{}'{}",
                                     model.name, detail::suggestion(entry.key, names)));
    const Body& carried = model.bodies[static_cast<std::size_t>(body)];
    if (carried.dofs != 1)
      joints.fail(entry, fmt::format("found a joint of {} degrees of freedom, expected a revolute, "
                                     "continuous or prismatic one",
                                     carried.dofs));
    q[carried.q] = joints.number(entry);
  }
}

GoalPointer readPosture(const Written& written, const Scene& scene) {
  const YamlMap& keys = written.keys;
  auto goal = std::make_unique<gdd::Posture>(scene.initial.q);
  keys.read("weight", goal->weight, Range::notNegative);
  keys.read("stiffness", goal->stiffness, Range::notNegative);
  keys.read("damping", goal->damping, Range::notNegative);
  if (const auto* joints = keys.find("joints")) readJoints(keys.map(*joints), scene.model, goal->q);
  return goal;
}

GoalPointer readDamping(const Written& written, const Scene&) {
  auto goal = std::make_unique<gdd::VirtualDamping>();
  written.keys.read("weight", goal->weight, Range::notNegative);
  written.keys.read("rate", goal->rate, Range::notNegative);
  return goal;
}

struct GoalKind {
  std::string name;
  std::vector<std::string> keys;
  GoalPointer (*read)(const Written& written, const Scene& scene);
};

/// To add a kind of goal: write its function above, name it and its keys here, and show it in
/// docs/goals.md.
const std::vector<GoalKind>& goalKinds() {
  static const std::vector<GoalKind> kinds = {
      {"reach",
       {"link", "target", "point", "weight", "stiffness", "damping", "minimum_jerk"},
       readReach},
      {"posture", {"weight", "stiffness", "damping", "joints"}, readPosture},
      {"damping", {"weight", "rate"}, readDamping},
  };
  return kinds;
}

// ---- The file -----------------------------------------------------------------------------------

/// The goal of one item of the list, `kind: {key: value, …}`.
GoalPointer readGoal(const std::string& file, const YAML::Node& item, std::size_t number,
                     const Scene& scene) {
  const std::string label = fmt::format("goal {}", number);
  std::vector<std::string> names;
  for (const GoalKind& kind : goalKinds()) names.push_back(kind.name);
  if (!item.IsMap())
    throw ModelError({file, item.Mark().line + 1}, label,
                     fmt::format("found {}, expected kind: {{…}}, the kind one of {}",
                                 described(item), detail::listed(names)));
  const YamlMap kinds(file, label + ": ", "", item);
  if (kinds.entries().size() != 1) {
    std::vector<std::string> found;
    for (const YamlMap::Entry& entry : kinds.entries()) found.push_back(entry.key);
    throw ModelError(
        {file, item.Mark().line + 1}, label,
        fmt::format("found {} ({}), expected one, the kind, whose own keys are in {{…}} "
                    "or indented below it",
                    detail::counted(found.size(), "key"), detail::listed(found)));
  }
  const YamlMap::Entry& only = kinds.entries().front();
  const auto kind = std::find_if(goalKinds().begin(), goalKinds().end(),
                                 [&](const GoalKind& k) { return k.name == only.key; });
  if (kind == goalKinds().end())
    throw ModelError(
        {file, only.line}, label,
        fmt::format("found the unknown kind {}, expected one of {}{}", quoted(only.key),
                    detail::listed(names), detail::suggestion(only.key, names)));
  const std::string named = fmt::format("{} '{}'", label, kind->name);
  if (!only.value.IsMap())
    throw ModelError({file, only.line}, named,
                     fmt::format("found {}, expected a map {{…}} with keys of {}",
                                 described(only.value), detail::listed(kind->keys)));
  const YamlMap keys(file, named + ": ", "", only.value);
  keys.expectOnly(kind->keys);
  return kind->read({only.line, keys}, scene);
}

}  // namespace

std::vector<std::unique_ptr<gdd::Goal>> readGoals(const std::filesystem::path& file,
                                                  const Model& model, const State& initial) {
  SOFTGAUSS_ASSERT(initial.q.size() == model.nq);
  const std::string path = file.string();
  const std::optional<std::string> text = detail::readFile(path);
  if (!text) throw ModelError({path, 0}, "file", "cannot be read, expected a YAML file of goals");
  const YAML::Node root = parseYaml(path, *text);
  if (!root.IsMap())
    throw ModelError({path, root.Mark().line + 1}, "file",
                     fmt::format("found {}, expected goals: [...]", described(root)));
  const YamlMap top(path, "", "", root);
  top.expectOnly({"goals"});
  const YamlMap::Entry& list = top.required("goals", "a list of goals", root.Mark().line + 1);
  if (!list.value.IsSequence() || list.value.size() == 0)
    top.fail(list,
             fmt::format("found {}, expected a list of at least one goal", described(list.value)));

  std::vector<std::unique_ptr<gdd::Goal>> goals;
  for (const YAML::Node& item : list.value)
    goals.push_back(readGoal(path, item, goals.size() + 1, {model, initial}));
  return goals;
}

}  // namespace softgauss::io
