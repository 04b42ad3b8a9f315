// SPDX-License-Identifier: Apache-2.0
#include "tests/system/source_rules.hpp"

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>

namespace softgauss::test {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

constexpr std::size_t kMaxLines = 400;

// Files that may be longer, each with its reason.
const Names kLongFiles = {};

const Names kFolders = {"engine", "gdd", "collision", "io", "apps", "tests", "data", "docs"};
const Names kRootFiles = {"CMakeLists.txt",
                          "README.md",
                          "LICENSE",
                          "CHANGELOG.md",
                          "CITATION.cff",
                          "CONTRIBUTING.md",
                          "pyproject.toml",
                          "CMakePresets.json",
                          ".clang-format",
                          ".clang-tidy",
                          ".gitignore",
                          ".ci",
                          "dev"};
// Not part of the project: git's, the build's and the editor's own, and what .gitignore names.
const Names kLocal = {
    ".git",    "build", "compile_commands.json", "CMakeUserPresets.json", ".cache",
    ".vscode", ".idea"};

// Layers: which folders the files of a folder may include, besides their own.
const std::map<std::string, Names> kMayInclude = {
    {"engine/core", {}},
    {"engine/model", {"engine/core"}},
    {"engine/solver", {"engine/core"}},
    {"engine/dynamics", {"engine/core", "engine/model"}},
    {"engine/forces", {"engine/core", "engine/model", "engine/dynamics"}},
    {"engine/constraints", {"engine/core", "engine/model", "engine/dynamics"}},
    {"engine/step", {"engine"}},
    {"engine", {"engine"}},
    {"gdd", {"engine"}},
    {"collision", {"engine"}},
    {"io", {"engine", "gdd"}},
    {"io/simulation", {"engine", "gdd", "collision", "io"}},
    {"apps", {"engine", "gdd", "collision", "io"}},
    {"tests", {"engine", "gdd", "collision", "io", "apps"}},
};

// Libraries that only the .cpp files of a folder may see; its headers see Eigen at most.
const std::map<std::string, std::regex> kLibraries = {
    {"collision", std::regex("(fcl|ccd|libqhull_r)/.*")},
    {"io", std::regex("(urdf_\\w+|console_bridge|assimp|yaml-cpp|nlohmann|fmt|sys)/"
                      ".*|(tinyxml2|zlib|spawn|unistd|fcntl|malloc)\\.h")},
};
const std::regex kStandardOrEigen("[a-z_]+|Eigen/.*");

std::string complaint(const SourceFile& file, std::size_t index, const std::string& text) {
  return file.path + ":" + std::to_string(index + 1) + ": " + text;
}

bool startsWith(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

// The layer of a path: `engine/model` of engine/model/detail/tree.cpp, `io` of io/urdf.cpp.
std::string layerOf(const std::string& path) {
  const std::string top = path.substr(0, path.find('/'));
  if (startsWith(path, "io/simulation/")) return "io/simulation";
  if (top != "engine") return top;
  const std::size_t end = path.find('/', top.size() + 1);
  return path.substr(0, end == std::string::npos ? top.size() : end);
}

// Headers of libraries are softgauss/…, as users name them, those of programs and tests are named
// from the root; only a test may name a header beside it by its bare name.
bool mayInclude(const std::string& from, const std::string& header) {
  const bool isSibling = header.find('/') == std::string::npos;
  if (isSibling) return from == "tests";
  const std::string prefix = "softgauss/";
  const bool isPublic = startsWith(header, prefix);
  const std::string to = layerOf(isPublic ? header.substr(prefix.size()) : header);
  if (isPublic == (to == "apps" || to == "tests")) return false;
  if (from == to) return true;
  const auto allowed = kMayInclude.find(from);
  if (allowed == kMayInclude.end()) return false;
  return allowed->second.count(to) > 0 || allowed->second.count(to.substr(0, to.find('/'))) > 0;
}

// Apps and tests take what they need; libraries keep what they use out of their headers.
bool mayUse(const SourceFile& file, const std::string& layer, const std::string& header) {
  if (layer == "apps" || layer == "tests") return true;
  if (header == "iostream") return false;
  if (std::regex_match(header, kStandardOrEigen)) return true;
  const auto library = kLibraries.find(layer.substr(0, layer == "io/simulation" ? 2 : layer.npos));
  return library != kLibraries.end() && file.path.ends_with(".cpp") &&
         std::regex_match(header, library->second);
}

}  // namespace

bool SourceFile::isCpp() const { return path.ends_with(".cpp") || path.ends_with(".hpp"); }
bool SourceFile::isPython() const { return path.ends_with(".py") || path.ends_with(".pyi"); }
bool SourceFile::isCode() const {
  return isCpp() || isPython() || path.ends_with(".mjs") || path.ends_with(".js");
}

std::vector<SourceFile> readTree(const std::string& root) {
  const Names kinds = {".cpp", ".hpp",  ".mjs",  ".js",   ".sh", ".css", ".txt", ".cmake",
                       ".in",  ".json", ".yaml", ".urdf", ".md", ".py",  ".pyi", ".toml"};
  std::vector<SourceFile> files;
  const auto read = [&](const fs::path& path) {
    SourceFile& file = files.emplace_back();
    file.path = fs::relative(path, root).generic_string();
    std::ifstream stream(path);
    for (std::string line; std::getline(stream, line);) file.lines.push_back(line);
  };
  for (const fs::directory_entry& entry : fs::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && kRootFiles.count(name) > 0) read(entry.path());
    if (!entry.is_directory() || (kFolders.count(name) == 0 && name != ".ci")) continue;
    for (const fs::directory_entry& inner : fs::recursive_directory_iterator(entry)) {
      const bool isText = name == ".ci" || kinds.count(inner.path().extension().string()) > 0;
      const bool isLog = inner.path().parent_path() == fs::path(root) / "data" / "reference";
      if (inner.is_regular_file() && isText && !isLog) read(inner.path());
    }
  }
  return files;
}

const std::vector<SourceFile>& tree() {
  static const std::vector<SourceFile> files = readTree(SOFTGAUSS_SOURCE_DIR);
  return files;
}

Complaints checkIncludes(const SourceFile& file) {
  static const std::regex pattern("^\\s*#\\s*include\\s*([\"<])([^\">]+)[\">].*");
  Complaints complaints;
  if (!file.isCpp() || startsWith(file.path, "tests/consume/")) return complaints;
  const std::string layer = layerOf(file.path);
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    std::smatch match;
    if (!std::regex_match(file.lines[i], match, pattern)) continue;
    const std::string header = match[2];
    const bool isOurs = match[1] == "\"";
    if (isOurs ? !mayInclude(layer, header) : !mayUse(file, layer, header))
      complaints.push_back(complaint(file, i, layer + " may not include " + header + " here"));
  }
  return complaints;
}

Complaints checkFcl(const SourceFile& file) {
  static const std::regex inclusion("^\\s*#\\s*include\\s*<(fcl|ccd)/.*");
  static const std::regex signedDistance("[sS]igned_?[dD]istance");
  Complaints complaints;
  if (!file.isCpp() || startsWith(file.path, "tests/system/source_rules")) return complaints;
  const bool maySee =
      startsWith(file.path, "tests/") ||
      (startsWith(file.path, "collision/detail/fcl_") && file.path.ends_with(".cpp"));
  bool sees = false;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const bool includes = std::regex_match(file.lines[i], inclusion);
    sees = sees || includes;
    if (includes && !maySee)
      complaints.push_back(complaint(file, i, "FCL is for collision/detail/fcl_*.cpp"));
    if (sees && std::regex_search(file.lines[i], signedDistance))
      complaints.push_back(complaint(file, i, "FCL's signed distance may not end"));
  }
  return complaints;
}

Complaints checkLength(const SourceFile& file) {
  if (!file.isCode() || file.lines.size() <= kMaxLines || kLongFiles.count(file.path) > 0)
    return {};
  return {complaint(file, kMaxLines, "longer than " + std::to_string(kMaxLines) + " lines")};
}

Complaints checkLicence(const SourceFile& file) {
  const bool isCMake = file.path.ends_with("CMakeLists.txt") || file.path.ends_with(".cmake");
  if (!file.isCode() && !isCMake) return {};
  const std::string licence = std::string(file.isCode() && !file.isPython() ? "//" : "#") +
                              " SPDX-License-Identifier: Apache-2.0";
  if (!file.lines.empty() && file.lines.front() == licence) return {};
  return {complaint(file, 0, "the first line must be " + licence)};
}

Complaints checkWords(const SourceFile& file) {
  static const std::regex machinePath(R"((^|[^\w.~/-])/(home|root|work|tmp|mnt|Users)/)");
  static const std::regex leftOver(R"(\b(TO)(DO)\b|\b(FIX)(ME)\b|\bXX(X)\b)");
  Complaints complaints;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    if (std::regex_search(file.lines[i], machinePath))
      complaints.push_back(complaint(file, i, "a path of one machine"));
    if (std::regex_search(file.lines[i], leftOver))
      complaints.push_back(complaint(file, i, "a note of work left over"));
  }
  return complaints;
}

std::set<std::string> equationsIn(const SourceFile& file) {
  // Chapter and number, neither 0: (0.5) is a number.
  static const std::regex pattern(R"(\(([1-9]\d?\.[1-9]\d?)\))");
  std::set<std::string> numbers;
  for (const std::string& line : file.lines) {
    // Of code the comments alone: sqrt(2.5) cites nothing.
    const std::size_t begin = file.isCpp() ? line.find("//") : 0;
    if (begin == std::string::npos) continue;
    const std::string text = line.substr(begin);
    for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it)
      numbers.insert((*it)[1]);
  }
  return numbers;
}

bool isChapterOfTheory(const SourceFile& file) {
  static const std::regex chapter(R"(docs/theory/\d\d-[a-z0-9-]+\.md)");
  return std::regex_match(file.path, chapter);
}

std::set<std::string> equationsOfChapter(const SourceFile& file) {
  constexpr std::size_t kFolder = sizeof("docs/theory/") - 1;
  const std::string chapter = std::to_string(std::stoi(file.path.substr(kFolder, 2))) + ".";
  std::set<std::string> own;
  for (const std::string& number : equationsIn(file))
    if (startsWith(number, chapter)) own.insert(number);
  return own;
}

Complaints checkEquations(const SourceFile& file, const std::set<std::string>& theory) {
  Complaints complaints;
  if (!file.isCpp()) return complaints;
  for (const std::string& number : equationsIn(file))
    if (theory.count(number) == 0)
      complaints.push_back(file.path + ": equation (" + number + ") is not in docs/theory");
  return complaints;
}

Complaints checkRoot(const std::set<std::string>& entries) {
  Complaints complaints;
  for (const std::string& name : entries)
    if (kFolders.count(name) + kRootFiles.count(name) + kLocal.count(name) == 0)
      complaints.push_back(name + ": does not belong at the root");
  return complaints;
}

}  // namespace softgauss::test
