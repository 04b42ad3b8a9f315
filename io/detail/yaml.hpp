// SPDX-License-Identifier: Apache-2.0
#pragma once

/// YAML read strictly: a tree of values with lines, and maps whose every key is accounted for.

#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/types.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {

/// A value of the file. Aliases have been replaced by what they stand for.
struct YamlValue {
  enum class Kind { nothing, text, list, map };
  struct Pair;

  Kind kind = Kind::nothing;
  int line = 0;
  bool isPlain = false;          ///< a text without quotes, so it may be a number
  std::string text;              ///< of a text
  std::vector<YamlValue> items;  ///< of a list
  std::vector<Pair> pairs;       ///< of a map, in order

  /// What a message says was found.
  std::string described() const;
  std::optional<double> finiteNumber() const;
};

struct YamlValue::Pair {
  YamlValue key, value;
};

/// The only document of a file. Throws ModelError; `expected` says what an empty file should hold.
YamlValue parseYaml(const std::string& file, const std::string& text, const std::string& expected);

/// Numbers of every range lie within ±kLargestNumber; what is not to be zero has at least the size
/// kSmallestNumber.
enum class Range { any, notNegative, positive, notZero };

/// A map of the file, and what messages need to name it. Its keys are distinct names. It refers to
/// the value that it is made of. Everything throws ModelError
/// `file:line: <label>key 'key': found …, expected …`.
class YamlMap {
 public:
  struct Entry {
    std::string key;
    const YamlValue& value;
    int line = 0;
  };

  /// `label` is how messages begin, "goal 2 'reach': "; `prefix` what they put before keys.
  YamlMap(std::string file, std::string label, std::string prefix, const YamlValue& map);

  const std::string& file() const { return file_; }
  int line() const { return line_; }  ///< in which it begins
  const std::vector<Entry>& entries() const { return entries_; }

  void expectOnly(const std::vector<std::string>& known) const;
  const Entry* find(const std::string& key) const;
  const Entry& required(const std::string& key, const std::string& expected) const;

  double number(const Entry& entry, Range range = Range::any) const;
  bool boolean(const Entry& entry) const;
  int integer(const Entry& entry, const std::vector<int>& allowed) const;
  Vector3 vector3(const Entry& entry) const;
  /// A list of at least `fewest` and at most `most` numbers; `expected` says so in words.
  std::vector<double> numbers(const Entry& entry, std::size_t fewest, std::size_t most,
                              const std::string& expected, Range range = Range::any) const;
  std::string name(const Entry& entry) const;
  /// One of the names.
  std::string choice(const Entry& entry, const std::vector<std::string>& names) const;
  /// One of the names of a scene, which may be many; `expected` says what they are.
  std::string known(const Entry& entry, const std::set<std::string>& names,
                    const std::string& expected) const;
  /// The map that is the value of the entry; messages call its keys `key.…`.
  YamlMap map(const Entry& entry) const;
  /// The list that is the value of the entry.
  const std::vector<YamlValue>& list(const Entry& entry) const;

  /// These set x if the key is there.
  void read(const std::string& key, double& x, Range range) const;
  void read(const std::string& key, Vector3& x) const;

  /// What messages call the entry: "robot 1: key 'joints.elbow'".
  std::string element(const Entry& entry) const;
  [[noreturn]] void fail(const Entry& entry, const std::string& problem) const;
  /// Where something is that has no value here: a key that is missing, say.
  [[noreturn]] void fail(const std::string& key, int line, const std::string& problem) const;

 private:
  double checked(const Entry& entry, const YamlValue& value, const std::string& which,
                 Range range) const;

  std::string file_, label_, prefix_;
  int line_ = 0;
  std::vector<Entry> entries_;
  std::unordered_map<std::string, std::size_t> index_;  ///< of entries, by key
};

}  // namespace softgauss::io::detail
