// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Strict access to the raw XML of a URDF: every attribute is read whole or refused, with its line.

#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/spatial.hpp"

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace softgauss::io::detail {

/// The line of the first element with more attributes than any has, 0 where there is none: tinyxml2
/// compares each with all before it.
int lineOfManyAttributes(std::string_view xml);
inline constexpr int kMostAttributes = 250;

/// An element of the file with what messages need to name it. Cheap to copy; valid as long as its
/// XmlFile. A null element stands for an absent optional one.
class XmlElement {
 public:
  XmlElement() = default;
  XmlElement(const std::string* file, const tinyxml2::XMLElement* element, std::string label)
      : file_(file), element_(element), label_(std::move(label)) {}

  explicit operator bool() const { return element_ != nullptr; }
  std::string tag() const;
  SourceLocation where() const;
  const std::string& label() const { return label_; }

  /// Throws a ModelError at this element.
  [[noreturn]] void fail(const std::string& problem) const;

  /// The only child of that name, or a null element. Throws if there are two.
  XmlElement child(const char* tag) const;
  /// The only child of that name. Throws if there is none or two.
  XmlElement requiredChild(const char* tag) const;
  /// All children, or all of that name, in the order of the file.
  std::vector<XmlElement> children(const char* tag = nullptr) const;

  /// Names of all attributes.
  std::vector<std::string> attributes() const;

  std::optional<std::string> text(const char* attribute) const;
  std::string content() const;  ///< the text between its tags
  /// What is no physics: "" where it is not there, the first where it is there twice.
  std::string firstText(const char* attribute) const;
  std::string requiredText(const char* attribute) const;  ///< not empty, and UTF-8
  /// Numbers are of size 10¹² at most, but where larger ones stand for no limit.
  enum class Size { bounded, any };
  std::optional<double> number(const char* attribute, Size size = Size::bounded) const;
  double requiredNumber(const char* attribute) const;
  std::optional<Vector3> vector3(const char* attribute) const;
  Vector3 requiredVector3(const char* attribute) const;

  /// The child `origin` with its xyz [m] and rpy [rad], or from URDF 1.1 on quat_xyzw; identity
  /// where absent.
  Transform origin() const;

  /// The file's version of URDF: y of 1.y, as its <robot> names it; 0 where it names none. Throws
  /// where it names one that is not known.
  int urdfMinorVersion() const;

  /// The same element, called `label` in messages.
  XmlElement named(std::string label) const { return {file_, element_, std::move(label)}; }

 private:
  Matrix3 quaternion(const std::string& text) const;
  void expectBounded(const char* attribute, double x) const;

  const std::string* file_ = nullptr;
  const tinyxml2::XMLElement* element_ = nullptr;
  std::string label_;
};

/// A file of XML in memory. Throws ModelError if it is no XML, or its outermost element is none of
/// `roots`, of which the first is the one to expect.
class XmlFile {
 public:
  XmlFile(const std::string& path, const std::string& text,
          std::initializer_list<std::string_view> roots = {"robot"});
  ~XmlFile();

  XmlElement robot() const;

  const tinyxml2::XMLElement& root() const;

 private:
  std::string path_;
  std::unique_ptr<tinyxml2::XMLDocument> document_;
};

}  // namespace softgauss::io::detail
