// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/yaml.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

/// More would take gigabytes; an alias may multiply aliases.
constexpr std::size_t kMostValues = 3'000'000;
constexpr int kDeepest = 100;

/// Builds the value of a document from what a parser meets, aliases replaced. One pass, without
/// yaml-cpp's own tree: that takes ten times the memory, whatever the limits.
class ValueBuilder final : public YAML::EventHandler {
 public:
  explicit ValueBuilder(const std::string& file) : file_(file) {}

  YamlValue root;
  int start = 0;  ///< line in which the last document begins

  void OnDocumentStart(const YAML::Mark& mark) override { start = mark.line + 1; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(YamlValue{YamlValue::Kind::nothing, mark.line + 1, false, {}, {}, {}}, anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& text) override {
    add(YamlValue{YamlValue::Kind::text, mark.line + 1, tag == "?", text, {}, {}}, anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(YamlValue::Kind::list, mark.line + 1, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(YamlValue::Kind::map, mark.line + 1, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchored_.find(anchor);
    if (found == anchored_.end()) failDepth(mark.line + 1);  // what it stands in is still open
    expectRoom(found->second.size, found->second.depth, mark.line + 1);
    add(found->second.value, 0);
  }

 private:
  struct Anchored {
    YamlValue value;
    std::size_t size = 0;
    int depth = 0;
  };
  struct Open {
    YamlValue value;
    YAML::anchor_t anchor = 0;
    std::optional<YamlValue> key;  ///< of a map, while its value is awaited
  };

  [[noreturn]] void failDepth(int line) const {
    throw ModelError({file_, line}, "YAML",
                     fmt::format("found lists and maps more than {} deep, or an alias inside of "
                                 "what it stands for; expected fewer",
                                 kDeepest));
  }

  /// For a value that holds so many, so deep.
  void expectRoom(std::size_t size, int depth, int line) {
    if (static_cast<int>(open_.size()) + depth > kDeepest) failDepth(line);
    values_ += size;
    if (values_ > kMostValues)
      throw ModelError(
          {file_, line}, "YAML",
          fmt::format("holds more than {} values once its aliases are replaced", kMostValues));
  }

  static void measure(const YamlValue& value, int depth, Anchored& out) {
    ++out.size;
    out.depth = std::max(out.depth, depth);
    for (const YamlValue& item : value.items) measure(item, depth + 1, out);
    for (const YamlValue::Pair& pair : value.pairs) {
      measure(pair.key, depth + 1, out);
      measure(pair.value, depth + 1, out);
    }
  }

  void open(YamlValue::Kind kind, int line, YAML::anchor_t anchor) {
    expectRoom(0, 1, line);
    open_.push_back({YamlValue{kind, line, false, {}, {}, {}}, anchor, std::nullopt});
  }

  void close() {
    Open closed = std::move(open_.back());
    open_.pop_back();
    add(std::move(closed.value), closed.anchor);
  }

  void add(YamlValue value, YAML::anchor_t anchor) {
    const int line = value.line;
    expectRoom(1, 0, line);
    if (anchor != 0) {
      Anchored& known = anchored_[anchor];
      known = {};
      measure(value, 0, known);
      expectRoom(known.size, 0, line);
      known.value = value;
    }
    if (open_.empty()) {
      root = std::move(value);
    } else if (Open& around = open_.back(); around.value.kind == YamlValue::Kind::list) {
      around.value.items.push_back(std::move(value));
    } else if (!around.key) {
      around.key = std::move(value);
    } else {
      around.value.pairs.push_back({std::move(*around.key), std::move(value)});
      around.key.reset();
    }
  }

  const std::string& file_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Anchored> anchored_;
  std::size_t values_ = 0;
};

/// yaml-cpp takes some control characters for the end of the file.
void expectText(const std::string& file, const std::string& text) {
  const auto control = std::find_if(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t';
  });
  const auto lineOf = [&](std::string::const_iterator at) {
    return 1 + static_cast<int>(std::count(text.begin(), at, '\n'));
  };
  if (control != text.end())
    throw ModelError({file, lineOf(control)}, "YAML",
                     "found a control character, expected text in UTF-8");
  if (const std::size_t bad = invalidUtf8(text); bad != std::string::npos)
    throw ModelError({file, lineOf(text.begin() + static_cast<std::ptrdiff_t>(bad))}, "YAML",
                     fmt::format("found the byte 0x{:02x}, which is no UTF-8, expected text in "
                                 "UTF-8",
                                 static_cast<unsigned char>(text[bad])));
}

/// What to tell where the line is indented by a tab, which YAML does not take.
const char* tabAdvice(const std::string& text, int line) {
  std::size_t begin = 0;
  for (; line > 0 && begin < text.size(); --line) begin = text.find('\n', begin) + 1;
  const std::size_t first = text.find_first_not_of(" ", begin);
  return first != std::string::npos && text[first] == '\t'
             ? "; the line is indented by a tab, expected blanks"
             : "";
}

}  // namespace

YamlValue parseYaml(const std::string& file, const std::string& text, const std::string& expected) {
  expectText(file, text);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    ValueBuilder first(file);
    parser.HandleNextDocument(first);
    // Not all documents: what cannot be read a parser may meet again and again, for ever.
    if (ValueBuilder second(file); parser.HandleNextDocument(second))
      throw ModelError({file, second.start}, "YAML",
                       "found more behind the end of the document, expected the end of the file");
    if (first.root.kind == YamlValue::Kind::nothing)
      throw ModelError({file, 1}, "file", "is empty, expected " + expected);
    return std::move(first.root);
  } catch (const YAML::Exception& error) {
    throw ModelError({file, error.mark.line + 1}, "YAML",
                     fmt::format("cannot be read: {} (column {}){}", error.msg,
                                 error.mark.column + 1, tabAdvice(text, error.mark.line)));
  }
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

YamlMap::YamlMap(std::string file, std::string label, std::string prefix, const YamlValue& map)
    : file_(std::move(file)),
      label_(std::move(label)),
      prefix_(std::move(prefix)),
      line_(map.line) {
  entries_.reserve(map.pairs.size());
  for (const YamlValue::Pair& pair : map.pairs) {
    const int line = pair.key.line;
    if (pair.key.kind != YamlValue::Kind::text)
      throw ModelError({file_, line}, label_ + "key",
                       fmt::format("found {}, expected a name", pair.key.described()));
    const std::string& key = pair.key.text;
    if (const Entry* first = find(key))
      fail(key, line,
           fmt::format("found a second time, first in line {}; expected once", first->line));
    index_.emplace(key, entries_.size());
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
  const auto it = index_.find(key);
  return it == index_.end() ? nullptr : &entries_[it->second];
}

const YamlMap::Entry& YamlMap::required(const std::string& key, const std::string& expected) const {
  const Entry* entry = find(key);
  if (!entry) fail(key, line_, "found no such key, expected " + expected);
  return *entry;
}

double YamlMap::checked(const Entry& entry, const YamlValue& value, const std::string& which,
                        Range range) const {
  const std::optional<double> x = value.finiteNumber();
  const bool fromZero = range == Range::any || range == Range::notNegative;
  const bool inside = x && (range == Range::any || (range == Range::notZero && *x != 0.0) ||
                            *x > 0.0 || (range == Range::notNegative && *x == 0.0));
  const double size = inside ? std::abs(*x) : 0.0;
  if (inside && size <= kLargestNumber && (fromZero || size >= kSmallestNumber)) return *x;
  const char* const bound = range == Range::notNegative ? " >= 0"
                            : range == Range::positive  ? " > 0"
                            : range == Range::notZero   ? " other than 0"
                                                        : "";
  std::string limits;
  if (inside && fromZero) limits = fmt::format(" of size {:g} at most", kLargestNumber);
  if (inside && !fromZero)
    limits = fmt::format(" of a size from {:g} to {:g}", kSmallestNumber, kLargestNumber);
  // A number of a list may be in a line of its own; nothing has that of what follows it.
  fail(entry.key, value.kind == YamlValue::Kind::text ? value.line : entry.line,
       fmt::format("found {}{}, expected {}{}{}", value.described(), which,
                   which.empty() ? "a finite number" : "numbers", bound, limits));
}

double YamlMap::number(const Entry& entry, Range range) const {
  return checked(entry, entry.value, "", range);
}

std::vector<double> YamlMap::numbers(const Entry& entry, std::size_t fewest, std::size_t most,
                                     const std::string& expected, Range range) const {
  const std::vector<YamlValue>& items = entry.value.items;
  if (entry.value.kind != YamlValue::Kind::list || items.size() < fewest || items.size() > most)
    fail(entry, fmt::format("found {}, expected {}", entry.value.described(), expected));
  std::vector<double> numbers;
  for (const YamlValue& item : items) {
    const std::string which = fmt::format(" as number {}", numbers.size() + 1);
    const std::optional<double> x = item.finiteNumber();
    if (!x || (range == Range::positive && !(*x > 0.0)))
      fail(entry.key, item.line,
           fmt::format("found {}{}, expected {}", item.described(), which, expected));
    numbers.push_back(checked(entry, item, which, range));
  }
  return numbers;
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
  if (entry.value.kind != YamlValue::Kind::list || entry.value.items.size() != 3)
    fail(entry, fmt::format("found {}, expected three numbers [x, y, z]", entry.value.described()));
  const std::vector<double> p = numbers(entry, 3, 3, "three finite numbers [x, y, z]");
  return {p[0], p[1], p[2]};
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

std::string YamlMap::known(const Entry& entry, const std::set<std::string>& names,
                           const std::string& expected) const {
  const std::string found = name(entry);
  if (names.count(found) == 0)
    fail(entry, fmt::format("found {}, expected {}{}", entry.value.described(), expected,
                            offered(found, {names.begin(), names.end()})));
  return found;
}

YamlMap YamlMap::map(const Entry& entry) const {
  if (entry.value.kind != YamlValue::Kind::map)
    fail(entry, fmt::format("found {}, expected a map {{…}}", entry.value.described()));
  return {file_, label_, prefix_ + entry.key + ".", entry.value};
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

std::string YamlMap::element(const Entry& entry) const {
  return label_ + "key " + quotedText(prefix_ + entry.key);
}

void YamlMap::fail(const Entry& entry, const std::string& problem) const {
  fail(entry.key, entry.line, problem);
}

void YamlMap::fail(const std::string& key, int line, const std::string& problem) const {
  throw ModelError({file_, line}, label_ + "key " + quotedText(prefix_ + key), problem);
}

}  // namespace softgauss::io::detail
