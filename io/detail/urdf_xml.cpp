// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/urdf_xml.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/yaml.hpp"
#include "softgauss/io/inputs.hpp"

namespace softgauss::io::detail {
namespace {

/// What a reader of the message should look for.
std::string problemOf(const tinyxml2::XMLDocument& document, std::string_view root) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return fmt::format("is empty, expected a <{}>", root);
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "an element is closed by another name than it was opened with";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "broken attribute, expected name=\"value\"";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT:
      return "broken element, expected <name …>";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "a comment is not closed by -->";
    case tinyxml2::XML_ERROR_PARSING:
      return "an element is not closed, or is closed without having been opened";
    default:
      return fmt::format("cannot be read as XML ({})", document.ErrorName());
  }
}

/// A hint where the value seems to come from a template that was not expanded.
std::string hintFor(const std::string& value) {
  return value.find("${") == std::string::npos ? "" : " (a xacro expression: run xacro first)";
}

/// A tag, and what it becomes, takes some 500 bytes of memory: as many tags as a file that is as
/// large as allowed has of this length take less than 1 GB.
constexpr std::uintmax_t kBytesOfTag = 40;

}  // namespace

int lineOfManyAttributes(std::string_view xml) {
  int line = 1, quotes = 0;
  char open = 0;  // the quote, or the < of the tag, that is open
  const auto skipTo = [&](std::size_t i, std::string_view end) {
    const std::size_t at = std::min(xml.find(end, i), xml.size());
    line += static_cast<int>(std::count(xml.begin() + static_cast<std::ptrdiff_t>(i),
                                        xml.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    return at;
  };
  for (std::size_t i = 0; i < xml.size(); ++i) {
    const char c = xml[i];
    if (c == '\n') ++line;
    if (open == '"' || open == '\'') {
      if (c == open) open = '<';
    } else if (open == '<') {
      if (c == '"' || c == '\'') {
        open = c;
        if (++quotes > kMostAttributes) return line;
      } else if (c == '>') {
        open = 0;
      }
    } else if (c == '<') {
      if (xml.substr(i, 4) == "<!--")
        i = skipTo(i, "-->");
      else if (xml.substr(i, 9) == "<![CDATA[")
        i = skipTo(i, "]]>");
      else
        open = c, quotes = 0;
    }
  }
  return 0;
}

std::string XmlElement::tag() const { return element_->Name(); }

SourceLocation XmlElement::where() const { return {*file_, element_->GetLineNum()}; }

void XmlElement::fail(const std::string& problem) const {
  throw ModelError(where(), validUtf8(label_), validUtf8(problem));
}

XmlElement XmlElement::child(const char* tag) const {
  const tinyxml2::XMLElement* first = element_->FirstChildElement(tag);
  if (!first) return {};
  const XmlElement found(file_, first, fmt::format("{}: {}", label_, tag));
  if (const tinyxml2::XMLElement* second = first->NextSiblingElement(tag))
    throw ModelError(
        {*file_, second->GetLineNum()}, found.label(),
        fmt::format("is written twice, first in line {}; expected once", first->GetLineNum()));
  return found;
}

XmlElement XmlElement::requiredChild(const char* tag) const {
  const XmlElement found = child(tag);
  if (!found) fail(fmt::format("has no <{}>", tag));
  return found;
}

std::vector<XmlElement> XmlElement::children(const char* tag) const {
  std::vector<XmlElement> found;
  for (const tinyxml2::XMLElement* e = element_->FirstChildElement(tag); e;
       e = e->NextSiblingElement(tag))
    found.emplace_back(file_, e, fmt::format("{}: {}", label_, e->Name()));
  return found;
}

std::vector<std::string> XmlElement::attributes() const {
  std::vector<std::string> names;
  for (const tinyxml2::XMLAttribute* a = element_->FirstAttribute(); a; a = a->Next())
    names.emplace_back(a->Name());
  return names;
}

std::string XmlElement::content() const {
  const char* text = element_->GetText();
  return text ? text : "";
}

std::optional<std::string> XmlElement::text(const char* attribute) const {
  // Written twice, XML is not well formed and readers differ in which one they take.
  int count = 0;
  for (const tinyxml2::XMLAttribute* a = element_->FirstAttribute(); a; a = a->Next())
    count += std::string_view(a->Name()) == attribute ? 1 : 0;
  if (count == 0) return std::nullopt;
  if (count > 1) fail(fmt::format("attribute {} is written {} times", attribute, count));
  return element_->Attribute(attribute);
}

std::string XmlElement::firstText(const char* attribute) const {
  const char* const value = element_->Attribute(attribute);
  return value ? value : "";
}

std::string XmlElement::requiredText(const char* attribute) const {
  const std::optional<std::string> value = text(attribute);
  if (!value) fail(fmt::format("has no attribute '{}'", attribute));
  if (value->empty()) fail(fmt::format("attribute '{}' is empty", attribute));
  if (validUtf8(*value) != *value)
    fail(
        fmt::format("{} is {}, which is no UTF-8; expected a file in UTF-8 (iconv -f latin1 -t "
                    "utf8 makes one of most others)",
                    attribute, quotedText(*value)));
  return *value;
}

std::optional<double> XmlElement::number(const char* attribute, Size size) const {
  const std::optional<std::string> value = text(attribute);
  if (!value) return std::nullopt;
  const std::optional<double> x = parseNumber(*value);
  if (!x)
    fail(fmt::format("{} is {}, expected one finite number{}", attribute, quotedText(*value),
                     hintFor(*value)));
  if (size == Size::bounded) expectBounded(attribute, *x);
  return x;
}

double XmlElement::requiredNumber(const char* attribute) const {
  const std::optional<double> x = number(attribute);
  if (!x) fail(fmt::format("has no attribute '{}', expected a number", attribute));
  return *x;
}

std::optional<Vector3> XmlElement::vector3(const char* attribute) const {
  const std::optional<std::string> value = text(attribute);
  if (!value) return std::nullopt;
  const std::optional<std::vector<double>> x = parseNumbers(*value);
  if (!x || x->size() != 3)
    fail(fmt::format("{} is {}, expected three finite numbers{}", attribute, quotedText(*value),
                     hintFor(*value)));
  for (const double number : *x) expectBounded(attribute, number);
  return Vector3((*x)[0], (*x)[1], (*x)[2]);
}

Vector3 XmlElement::requiredVector3(const char* attribute) const {
  const std::optional<Vector3> x = vector3(attribute);
  if (!x) fail(fmt::format("has no attribute '{}', expected three numbers", attribute));
  return *x;
}

void XmlElement::expectBounded(const char* attribute, double x) const {
  if (std::abs(x) > kLargestNumber)
    fail(fmt::format("{} holds {}, expected numbers of size {:g} at most", attribute,
                     shortNumber(x), kLargestNumber));
}

Transform XmlElement::origin() const {
  const XmlElement origin = child("origin");
  if (!origin) return {};
  Transform X;
  X.p = origin.vector3("xyz").value_or(Vector3::Zero());
  const std::optional<Vector3> rpy = origin.vector3("rpy");
  const std::optional<std::string> quaternion = origin.text("quat_xyzw");
  if (rpy && quaternion) origin.fail("holds rpy and quat_xyzw, expected one of them");
  if (rpy) X.R = rpyRotation(*rpy);
  if (quaternion) X.R = origin.quaternion(*quaternion);
  for (const std::string& name : origin.attributes())
    if (name != "xyz" && name != "rpy" && name != "quat_xyzw")
      origin.fail(
          fmt::format("attribute '{}' is not known, and a pose that is not read moves the "
                      "robot; expected xyz and rpy, or quat_xyzw",
                      name));
  return X;
}

Matrix3 XmlElement::quaternion(const std::string& text) const {
  constexpr double kUnit = 1e-3;  // of the length: numbers of four digits are meant to be unit
  if (urdfMinorVersion() < 1)
    fail(
        "quat_xyzw is of URDF 1.1, and the file is of 1.0; expected rpy, or version=\"1.1\" in "
        "<robot>");
  const std::optional<std::vector<double>> x = parseNumbers(text);
  if (!x || x->size() != 4)
    fail(fmt::format("quat_xyzw is {}, expected four finite numbers x y z w{}", quotedText(text),
                     hintFor(text)));
  const Quaternion q((*x)[3], (*x)[0], (*x)[1], (*x)[2]);
  if (std::abs(q.norm() - 1.0) > kUnit)
    fail(fmt::format("quat_xyzw is '{}', of length {}, expected length 1", text,
                     shortNumber(q.norm())));
  return q.normalized().toRotationMatrix();
}

int XmlElement::urdfMinorVersion() const {
  const XmlElement robot(file_, element_->GetDocument()->RootElement(), "robot");
  const std::string version = robot.text("version").value_or("1.0");
  for (const int minor : {0, 1, 2})
    if (version == fmt::format("1.{}", minor)) return minor;
  robot.fail(fmt::format("version is {}, expected 1.0, 1.1 or 1.2", quotedText(version)));
}

XmlFile::XmlFile(const std::string& path, const std::string& text,
                 std::initializer_list<std::string_view> roots)
    : path_(path), document_(std::make_unique<tinyxml2::XMLDocument>()) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw ModelError({path_, 1}, "XML", "is UTF-16, expected UTF-8 (iconv -f utf16 -t utf8)");
  if (const std::size_t zero = text.find('\0'); zero != std::string::npos) {
    const auto line =
        1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n');
    throw ModelError({path_, static_cast<int>(line)}, "XML", "holds a zero byte, expected text");
  }
  if (const int line = lineOfManyAttributes(text); line > 0)
    throw ModelError({path_, line}, "XML",
                     fmt::format("an element has more than {} attributes", kMostAttributes));
  const std::uintmax_t most = inputLimits().text / kBytesOfTag;
  if (const auto tags = static_cast<std::uintmax_t>(std::count(text.begin(), text.end(), '<'));
      tags > most)
    throw ModelError(
        {path_, 1}, "XML",
        fmt::format("holds {} tags, expected at most {} (--largest-file allows more)", tags, most));
  if (document_->Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS)
    throw ModelError({path_, std::max(1, document_->ErrorLineNum())}, "XML",
                     problemOf(*document_, *roots.begin()));

  const tinyxml2::XMLElement* root = document_->RootElement();
  const std::string expected = fmt::format("<{}>", *roots.begin());
  if (!root) throw ModelError({path_, 1}, "XML", "has no element, expected " + expected);
  if (std::find(roots.begin(), roots.end(), std::string_view(root->Name())) == roots.end())
    throw ModelError({path_, root->GetLineNum()}, fmt::format("<{}>", root->Name()),
                     fmt::format("is the outermost element, expected {}{}", expected,
                                 *roots.begin() == "robot" ? " (a URDF)" : ""));
  if (const tinyxml2::XMLElement* second = root->NextSiblingElement())
    throw ModelError({path_, second->GetLineNum()}, fmt::format("<{}>", second->Name()),
                     fmt::format("follows </{}>, expected the end of the file", root->Name()));
}

XmlFile::~XmlFile() = default;

XmlElement XmlFile::robot() const { return {&path_, document_->RootElement(), "robot"}; }

const tinyxml2::XMLElement& XmlFile::root() const { return *document_->RootElement(); }

}  // namespace softgauss::io::detail
