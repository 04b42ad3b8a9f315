// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The XML of an MJCF file with its <include>s in place, and strict access to attributes.
///
/// Attributes overlay: a read leaves alone what the element does not give, so that an element is
/// laid over its default class, and a class over the one that it is in.

#include <array>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/spatial.hpp"

namespace softgauss::io::mjcf {

class Element {
 public:
  std::string tag;
  SourceLocation where;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<Element> children;

  /// "geom 'foot'", or "geom" where it has no name.
  std::string label() const;
  [[noreturn]] void fail(const std::string& problem) const;

  bool has(std::string_view attribute) const { return find(attribute) != nullptr; }
  const std::string* find(std::string_view attribute) const;
  std::string text(std::string_view attribute) const;  ///< "" where it is not there
  std::string requiredText(std::string_view attribute) const;

  /// Throws where an attribute, or a child, is not in the list: what is not read would be a silent
  /// difference.
  void expectAttributes(std::initializer_list<std::string_view> known) const;
  void expectChildren(std::initializer_list<std::string_view> known) const;

  /// Each lays the attribute over a value, and says whether it is there.
  bool read(std::string_view attribute, double& x) const;
  bool read(std::string_view attribute, int& x) const;
  bool read(std::string_view attribute, bool& x) const;  ///< true or false
  bool read(std::string_view attribute, std::string& x) const;
  bool read(std::string_view attribute, Vector3& x) const;  ///< three numbers
  /// From `least` numbers on to as many as `x` has, over the first of them. Returns how many.
  template <std::size_t N>
  std::size_t read(std::string_view attribute, std::array<double, N>& x, std::size_t least) const {
    return readInto(attribute, x.data(), least, N);
  }
  /// All N numbers, or none.
  template <std::size_t N>
  bool readAll(std::string_view attribute, std::array<double, N>& x) const {
    return readInto(attribute, x.data(), N, N) > 0;
  }
  /// Any count of numbers; nothing where the attribute is not there.
  std::optional<std::vector<double>> numbers(std::string_view attribute) const;
  /// The place of the attribute's word in a list.
  std::optional<std::size_t> word(std::string_view attribute,
                                  std::initializer_list<std::string_view> words) const;

 private:
  std::size_t readInto(std::string_view attribute, double* x, std::size_t least,
                       std::size_t most) const;
};

/// true, false or auto.
enum class Choice { no, yes, automatic };
void readChoice(const Element& element, std::string_view attribute, Choice& choice);
/// Whether a range holds: as it is said, or, with auto, where there is one. Throws where auto is
/// given up by compiler autolimits="false" and there is one.
bool isLimited(const Element& element, std::string_view attribute, Choice choice,
               const std::array<double, 2>& range, bool autolimits);

struct Document {
  Element root;                              ///< <mujoco>
  std::vector<std::filesystem::path> files;  ///< that were read, the file itself first
};

/// Throws ModelError. Included files lie in the folder of the file or below it, and each is
/// included once at most.
Document readDocument(const std::filesystem::path& file);

/// Whether the outermost element of a text is <mujoco>.
bool isMjcfText(std::string_view text);

}  // namespace softgauss::io::mjcf
