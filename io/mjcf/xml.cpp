// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/xml.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/urdf_xml.hpp"
#include "softgauss/io/inputs.hpp"

namespace softgauss::io::mjcf {
namespace {

/// Reads a file and those that it includes.
class DocumentReader {
 public:
  explicit DocumentReader(const std::filesystem::path& file) : main_(file) {
    std::error_code ignored;
    folder_ = std::filesystem::weakly_canonical(std::filesystem::absolute(file, ignored), ignored)
                  .parent_path();
  }

  Document read() {
    Document document;
    document.root = readRoot(main_, "an MJCF file", {"mujoco"});
    document.files = files_;
    return document;
  }

 private:
  Element readRoot(const std::filesystem::path& file, const char* expected,
                   std::initializer_list<std::string_view> roots) {
    const std::string name = detail::inputName(file.string());
    const std::string text = detail::readInput(file.string(), expected);
    files_.push_back(file);
    size_ += text.size();
    if (size_ > inputLimits().text)
      throw ModelError({name, 0}, "file",
                       "is too large with all that it includes (--largest-file allows more)");
    const detail::XmlFile xml(name, text, roots);
    return elementOf(xml.root(), name, std::filesystem::path(file).parent_path());
  }

  Element elementOf(const tinyxml2::XMLElement& xml, const std::string& file,
                    const std::filesystem::path& folder) {
    Element element;
    element.tag = xml.Name();
    element.where = {file, xml.GetLineNum()};
    std::set<std::string_view> names;
    for (const tinyxml2::XMLAttribute* a = xml.FirstAttribute(); a; a = a->Next()) {
      if (!names.insert(a->Name()).second)
        element.fail(fmt::format("attribute {} is written twice", detail::quotedText(a->Name())));
      element.attributes.emplace_back(a->Name(), a->Value());
    }
    for (const tinyxml2::XMLElement* child = xml.FirstChildElement(); child;
         child = child->NextSiblingElement()) {
      Element read = elementOf(*child, file, folder);
      if (read.tag != "include")
        element.children.push_back(std::move(read));
      else
        for (Element& included : include(read, folder))
          element.children.push_back(std::move(included));
    }
    return element;
  }

  /// What stands in the place of an <include>: the children of the file's root.
  std::vector<Element> include(const Element& element, const std::filesystem::path& folder) {
    element.expectAttributes({"file"});
    element.expectChildren({});
    const std::string name = element.requiredText("file");
    if (main_ == kStandardInput)
      element.fail("is in standard input, which has no folder; expected a file in place of -");
    std::error_code ignored;
    // Beside the file itself, or else beside the one that includes it.
    std::filesystem::path path = main_.parent_path() / name;
    if (!std::filesystem::exists(path, ignored)) path = folder / name;
    const std::filesystem::path place =
        std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored), ignored);
    const std::filesystem::path relative = place.lexically_relative(folder_);
    if (relative.empty() || *relative.begin() == "..")
      element.fail(
          fmt::format("file {} lies outside of the folder of {}; expected it there or below",
                      detail::quotedText(name), main_.filename().string()));
    if (!std::filesystem::exists(path, ignored))
      element.fail(
          fmt::format("file {} not found, expected it as {} or beside the file that "
                      "includes it",
                      detail::quotedText(name), (main_.parent_path() / name).string()));
    if (!included_.insert(place).second ||
        place == std::filesystem::weakly_canonical(main_, ignored))
      element.fail(fmt::format("file {} is included a second time, expected once",
                               detail::quotedText(name)));
    Element root = readRoot(path.lexically_normal(), "an MJCF file", {"mujoco", "mujocoinclude"});
    return std::move(root.children);
  }

  std::filesystem::path main_, folder_;
  std::vector<std::filesystem::path> files_;
  std::set<std::filesystem::path> included_;
  std::uintmax_t size_ = 0;
};

std::string listOf(std::initializer_list<std::string_view> names) {
  std::vector<std::string> all;
  for (const std::string_view name : names) all.emplace_back(name);
  return detail::listed(all, 60);
}

void expectBounded(const Element& element, std::string_view attribute, double x) {
  if (std::abs(x) > detail::kLargestNumber)
    element.fail(fmt::format("{} holds {}, expected numbers of size {:g} at most", attribute,
                             detail::shortNumber(x), detail::kLargestNumber));
}

}  // namespace

std::string Element::label() const {
  const std::string* name = find("name");
  return name ? fmt::format("{} {}", tag, detail::quotedText(*name)) : tag;
}

void Element::fail(const std::string& problem) const {
  throw ModelError(where, detail::validUtf8(label()), detail::validUtf8(problem));
}

const std::string* Element::find(std::string_view attribute) const {
  for (const auto& [name, value] : attributes)
    if (name == attribute) return &value;
  return nullptr;
}

std::string Element::text(std::string_view attribute) const {
  const std::string* value = find(attribute);
  return value ? *value : std::string();
}

std::string Element::requiredText(std::string_view attribute) const {
  const std::string* value = find(attribute);
  if (!value || value->empty()) fail(fmt::format("has no attribute '{}'", attribute));
  if (detail::validUtf8(*value) != *value)
    fail(fmt::format("{} is {}, which is no UTF-8", attribute, detail::quotedText(*value)));
  return *value;
}

void Element::expectAttributes(std::initializer_list<std::string_view> known) const {
  for (const auto& [name, value] : attributes) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::vector<std::string> names(known.begin(), known.end());
    fail(fmt::format("attribute {} is not known{}; expected one of: {}", detail::quotedText(name),
                     detail::suggestion(name, names), listOf(known)));
  }
}

void Element::expectChildren(std::initializer_list<std::string_view> known) const {
  for (const Element& child : children) {
    if (std::find(known.begin(), known.end(), child.tag) != known.end()) continue;
    const std::vector<std::string> names(known.begin(), known.end());
    child.fail(fmt::format("is not read in <{}>{}; expected {}", tag,
                           detail::suggestion(child.tag, names),
                           known.size() == 0 ? "nothing there" : listOf(known)));
  }
}

bool Element::read(std::string_view attribute, double& x) const {
  return readInto(attribute, &x, 1, 1) > 0;
}

bool Element::read(std::string_view attribute, int& x) const {
  double number = 0.0;
  if (!read(attribute, number)) return false;
  if (number != std::floor(number) || std::abs(number) > 2147483647.0)
    fail(fmt::format("{} is {}, expected a whole number", attribute,
                     detail::quotedText(text(attribute))));
  x = static_cast<int>(number);
  return true;
}

bool Element::read(std::string_view attribute, bool& x) const {
  const std::optional<std::size_t> found = word(attribute, {"false", "true"});
  if (found) x = *found == 1;
  return found.has_value();
}

bool Element::read(std::string_view attribute, std::string& x) const {
  if (!has(attribute)) return false;
  x = requiredText(attribute);
  return true;
}

bool Element::read(std::string_view attribute, Vector3& x) const {
  return readInto(attribute, x.data(), 3, 3) > 0;
}

std::optional<std::vector<double>> Element::numbers(std::string_view attribute) const {
  const std::string* value = find(attribute);
  if (!value) return std::nullopt;
  std::optional<std::vector<double>> x = detail::parseNumbers(*value);
  if (!x)
    fail(fmt::format("{} is {}, expected finite numbers", attribute, detail::quotedText(*value)));
  for (const double number : *x) expectBounded(*this, attribute, number);
  return x;
}

std::optional<std::size_t> Element::word(std::string_view attribute,
                                         std::initializer_list<std::string_view> words) const {
  const std::string* value = find(attribute);
  if (!value) return std::nullopt;
  const auto found = std::find(words.begin(), words.end(), *value);
  if (found == words.end())
    fail(fmt::format("{} is {}, expected one of: {}", attribute, detail::quotedText(*value),
                     listOf(words)));
  return static_cast<std::size_t>(found - words.begin());
}

std::size_t Element::readInto(std::string_view attribute, double* x, std::size_t least,
                              std::size_t most) const {
  const std::string* value = find(attribute);
  if (!value) return 0;
  const std::optional<std::vector<double>> read = detail::parseNumbers(*value);
  if (!read || read->size() < least || read->size() > most)
    fail(fmt::format("{} is {}, expected {} finite number{}", attribute, detail::quotedText(*value),
                     least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most),
                     most == 1 ? "" : "s"));
  for (const double number : *read) expectBounded(*this, attribute, number);
  std::copy(read->begin(), read->end(), x);
  return read->size();
}

void readChoice(const Element& element, std::string_view attribute, Choice& choice) {
  if (const auto found = element.word(attribute, {"false", "true", "auto"}))
    choice = static_cast<Choice>(*found);
}

bool isLimited(const Element& element, std::string_view attribute, Choice choice,
               const std::array<double, 2>& range, bool autolimits) {
  const bool hasRange = range[0] != 0.0 || range[1] != 0.0;
  if (choice == Choice::automatic && hasRange && !autolimits)
    element.fail(
        fmt::format("has a range and no {}, and the compiler has autolimits=\"false\"; "
                    "expected {}=\"true\" or \"false\"",
                    attribute, attribute));
  return choice == Choice::yes || (choice == Choice::automatic && range[0] < range[1]);
}

Document readDocument(const std::filesystem::path& file) { return DocumentReader(file).read(); }

bool isMjcfText(std::string_view text) {
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at + 1)) {
    const std::string_view rest = text.substr(at);
    const char* const end = rest.starts_with("<!--") ? "-->"
                            : rest.starts_with("<?") ? "?>"
                            : rest.starts_with("<!") ? ">"
                                                     : nullptr;
    if (!end) {
      const std::string_view name = rest.substr(1, rest.find_first_of(" \t\r\n/>", 1) - 1);
      return name == "mujoco";
    }
    at = text.find(end, at);
    if (at == std::string_view::npos) break;
  }
  return false;
}

}  // namespace softgauss::io::mjcf
