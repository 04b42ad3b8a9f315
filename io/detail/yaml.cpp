// SPDX-License-Identifier: Apache-2.0
#include "io/detail/yaml.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/core/check.hpp"
#include "io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

/// More is an alias that multiplies aliases, not a scene.
constexpr int kMostValues = 1000000;

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

/// Copies yaml-cpp's nodes into values.
class Copier {
 public:
  explicit Copier(const std::string& file) : file_(file) {}

  /// `depth`: of lists and maps around the node. An alias of what it stands in has no end.
  YamlValue copy(const YAML::Node& node, int depth = 0) {
    constexpr int kDeepest = 100;
    YamlValue value;
    value.line = node.Mark().line + 1;
    if (depth > kDeepest)
      throw ModelError({file_, value.line}, "YAML",
                       fmt::format("found lists and maps more than {} deep, or an alias inside of "
                                   "what it stands for; expected fewer",
                                   kDeepest));
    if (++values_ > kMostValues)
      throw ModelError(
          {file_, value.line}, "YAML",
          fmt::format("holds more than {} values once its aliases are replaced", kMostValues));
    switch (node.Type()) {
      case YAML::NodeType::Scalar:
        value.kind = YamlValue::Kind::text;
        value.isPlain = node.Tag() == "?";
        value.text = node.Scalar();
        break;
      case YAML::NodeType::Sequence:
        value.kind = YamlValue::Kind::list;
        for (const YAML::Node& item : node) value.items.push_back(copy(item, depth + 1));
        break;
      case YAML::NodeType::Map:
        value.kind = YamlValue::Kind::map;
        for (const auto& pair : node)
          value.pairs.push_back({copy(pair.first, depth + 1), copy(pair.second, depth + 1)});
        break;
      default:
        break;
    }
    return value;
  }

 private:
  const std::string& file_;
  int values_ = 0;
};

}  // namespace

YamlValue parseYaml(const std::string& file, const std::string& text, const std::string& expected) {
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
    if (document.IsNull()) throw ModelError({file, 1}, "file", "is empty, expected " + expected);
    return Copier(file).copy(document);
  } catch (const YAML::Exception& error) {
    throw ModelError(
        {file, error.mark.line + 1}, "YAML",
        fmt::format("cannot be read: {} (column {})", error.msg, error.mark.column + 1));
  }
}

std::string quotedText(std::string text) {
  constexpr std::size_t kMost = 60;
  if (text.size() > kMost) text = text.substr(0, kMost) + "…";
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return "'" + text + "'";
}

std::string YamlValue::described() const {
  switch (kind) {
    case Kind::text:
      return isPlain ? quotedText(text) : "the text " + quotedText(text);
    case Kind::list:
      return "a list of " + std::to_string(items.size());
    case Kind::map:
      return "a map";
    case Kind::nothing:
      break;
  }
  return "nothing";
}

std::optional<double> YamlValue::finiteNumber() const {
  if (kind != Kind::text || !isPlain) return std::nullopt;
  return parseNumber(text);
}

// ---- Maps ---------------------------------------------------------------------------------------

YamlMap::YamlMap(std::string file, std::string label, std::string prefix, const YamlValue& map,
                 double largest)
    : file_(std::move(file)),
      label_(std::move(label)),
      prefix_(std::move(prefix)),
      line_(map.line),
      largest_(largest) {
  for (const YamlValue::Pair& pair : map.pairs) {
    const int line = pair.key.line;
    if (pair.key.kind != YamlValue::Kind::text)
      throw ModelError({file_, line}, label_ + "key",
                       fmt::format("found {}, expected a name", pair.key.described()));
    const std::string& key = pair.key.text;
    if (const Entry* first = find(key))
      fail({key, {}, line},
           fmt::format("found a second time, first in line {}; expected once", first->line));
    entries_.push_back({key, pair.value, line});
  }
}

void YamlMap::expectOnly(const std::vector<std::string>& known) const {
  for (const Entry& entry : entries_)
    if (std::find(known.begin(), known.end(), entry.key) == known.end())
      fail(entry, fmt::format("found an unknown key, expected one of {}{}", listed(known, 40),
                              suggestion(entry.key, known)));
}

const YamlMap::Entry* YamlMap::find(const std::string& key) const {
  const auto it = std::find_if(entries_.begin(), entries_.end(),
                               [&](const Entry& entry) { return entry.key == key; });
  return it == entries_.end() ? nullptr : &*it;
}

const YamlMap::Entry& YamlMap::required(const std::string& key, const std::string& expected) const {
  const Entry* entry = find(key);
  if (!entry) fail({key, {}, line_}, "found no such key, expected " + expected);
  return *entry;
}

double YamlMap::number(const Entry& entry, Range range) const {
  const std::optional<double> x = entry.value.finiteNumber();
  const bool inside =
      x && (range == Range::any || *x > 0.0 || (range == Range::notNegative && *x == 0.0));
  if (inside && std::abs(*x) <= largest_) return *x;
  const char* const bound = range == Range::notNegative ? " >= 0"
                            : range == Range::positive  ? " > 0"
                                                        : "";
  const std::string size = inside ? fmt::format(" of size {:g} at most", largest_) : "";
  fail(entry,
       fmt::format("found {}, expected a finite number{}{}", entry.value.described(), bound, size));
}

bool YamlMap::boolean(const Entry& entry) const {
  if (entry.value.isPlain && entry.value.text == "true") return true;
  if (entry.value.isPlain && entry.value.text == "false") return false;
  fail(entry, fmt::format("found {}, expected true or false", entry.value.described()));
}

int YamlMap::integer(const Entry& entry, const std::vector<int>& allowed) const {
  const std::optional<double> x = entry.value.finiteNumber();
  std::vector<std::string> names;
  for (const int i : allowed) {
    if (x && *x == i) return i;
    names.push_back(std::to_string(i));
  }
  fail(entry, fmt::format("found {}, expected one of {}", entry.value.described(), listed(names)));
}

Vector3 YamlMap::vector3(const Entry& entry) const {
  const YamlValue& value = entry.value;
  if (value.kind != YamlValue::Kind::list || value.items.size() != 3)
    fail(entry, fmt::format("found {}, expected three numbers [x, y, z]", value.described()));
  Vector3 p;
  for (int i = 0; i < 3; ++i) {
    const YamlValue& item = value.items[static_cast<std::size_t>(i)];
    const std::optional<double> x = item.finiteNumber();
    if (!x)
      fail({entry.key, {}, item.line},
           fmt::format("found {} as number {}, expected three finite numbers [x, y, z]",
                       item.described(), i + 1));
    if (std::abs(*x) > largest_)
      fail({entry.key, {}, item.line},
           fmt::format("found {} as number {}, expected numbers of size {:g} at most",
                       item.described(), i + 1, largest_));
    p[i] = *x;
  }
  return p;
}

std::string YamlMap::name(const Entry& entry) const {
  if (entry.value.kind != YamlValue::Kind::text)
    fail(entry, fmt::format("found {}, expected a name", entry.value.described()));
  return entry.value.text;
}

std::string YamlMap::choice(const Entry& entry, const std::vector<std::string>& names) const {
  if (entry.value.kind == YamlValue::Kind::text)
    for (const std::string& name : names)
      if (entry.value.text == name) return name;
  fail(entry, fmt::format("found {}, expected one of {}{}", entry.value.described(),
                          listed(names, 40), suggestion(entry.value.text, names)));
}

YamlMap YamlMap::map(const Entry& entry) const {
  if (entry.value.kind != YamlValue::Kind::map)
    fail(entry, fmt::format("found {}, expected a map {{…}}", entry.value.described()));
  return {file_, label_, prefix_ + entry.key + ".", entry.value, largest_};
}

const std::vector<YamlValue>& YamlMap::list(const Entry& entry) const {
  if (entry.value.kind != YamlValue::Kind::list)
    fail(entry, fmt::format("found {}, expected a list", entry.value.described()));
  return entry.value.items;
}

void YamlMap::read(const std::string& key, double& x, Range range) const {
  if (const Entry* entry = find(key)) x = number(*entry, range);
}

void YamlMap::read(const std::string& key, Vector3& x) const {
  if (const Entry* entry = find(key)) x = vector3(*entry);
}

void YamlMap::fail(const Entry& entry, const std::string& problem) const {
  throw ModelError({file_, entry.line}, label_ + "key " + quotedText(prefix_ + entry.key), problem);
}

}  // namespace softgauss::io::detail
