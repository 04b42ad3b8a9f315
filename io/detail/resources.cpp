// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/resources.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <utility>

namespace softgauss::io::detail {
namespace {

namespace fs = std::filesystem;

bool isFile(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Notes the path as searched; true if the file is there.
bool lookAt(const fs::path& path, FoundFile& found) {
  found.searched.push_back(path.string());
  if (!isFile(path)) return false;
  found.path = path;
  return true;
}

/// With / for each back-slash, and the byte XY for each %XY.
std::string plainUri(const std::string& uri) {
  std::string plain;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned char byte = 0;
    const char* const hex = uri.data() + i + 1;
    if (uri[i] == '%' && i + 2 < uri.size() &&
        std::from_chars(hex, hex + 2, byte, 16).ptr == hex + 2) {
      plain += static_cast<char>(byte);
      i += 2;
    } else {
      plain += uri[i] == '\\' ? '/' : uri[i];
    }
  }
  return plain;
}

/// The package of a file and its path in there, both empty where it is of none.
std::pair<std::string, std::string> inPackage(const std::string& uri) {
  for (const std::string_view scheme : {"package://", "model://"}) {
    if (!uri.starts_with(scheme)) continue;
    std::string rest = uri.substr(scheme.size());
    rest.erase(0, rest.find_first_not_of('/'));  // package:///name/…, as some write it
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    return {rest.substr(0, slash), rest.substr(std::min(slash + 1, rest.size()))};
  }
  return {};
}

std::vector<fs::path> rosPackagePath() {
  std::vector<fs::path> folders;
  const char* variable = std::getenv("ROS_PACKAGE_PATH");
  std::string rest = variable ? variable : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    if (end > 0) folders.emplace_back(rest.substr(0, end));
    rest.erase(0, end + 1);
  }
  return folders;
}

}  // namespace

ResourceFinder::ResourceFinder(const fs::path& urdf, const std::vector<fs::path>& packagePaths)
    : packagePaths_(packagePaths) {
  std::error_code failed;
  folder_ = fs::absolute(urdf, failed).lexically_normal().parent_path();
  const std::vector<fs::path> ros = rosPackagePath();
  packagePaths_.insert(packagePaths_.end(), ros.begin(), ros.end());
  for (fs::path folder = folder_; !folder.empty(); folder = folder.parent_path()) {
    packagePaths_.push_back(folder);
    if (folder == folder.root_path()) break;
  }
}

FoundFile ResourceFinder::find(const std::string& uri) const {
  FoundFile found = findAsWritten(uri);
  const std::string plain = plainUri(uri);
  if (found.path.empty() && plain != uri) {
    FoundFile other = findAsWritten(plain);
    other.searched.insert(other.searched.begin(), found.searched.begin(), found.searched.end());
    found = std::move(other);
  }
  if (found.path.empty()) findByItsEnd(plain, found);
  return found;
}

FoundFile ResourceFinder::findAsWritten(const std::string& uri) const {
  if (const auto [package, path] = inPackage(uri); !package.empty())
    return findInPackage(package, path);
  FoundFile found;
  fs::path path = uri;
  for (const std::string_view file : {"file:", "file://"})
    if (uri.starts_with(file) && uri.find("/") == 5) path = uri.substr(file.size());
  lookAt(path.is_absolute() ? path : (folder_ / path).lexically_normal(), found);
  return found;
}

FoundFile ResourceFinder::findInPackage(const std::string& package, const std::string& path) const {
  FoundFile found;
  for (const fs::path& entry : packagePaths_) {
    const fs::path folder = entry.has_filename() ? entry : entry.parent_path();
    if (folder.filename() == package && lookAt(folder / path, found)) return found;
    if (lookAt(folder / package / path, found)) return found;
  }
  return found;
}

/// Whether one of the folders is that of a package, or holds it.
bool ResourceFinder::knows(const std::string& package) const {
  std::error_code ignored;
  return std::any_of(packagePaths_.begin(), packagePaths_.end(), [&](const fs::path& entry) {
    const fs::path folder = entry.has_filename() ? entry : entry.parent_path();
    return folder.filename() == package || fs::is_directory(folder / package, ignored);
  });
}

void ResourceFinder::findByItsEnd(const std::string& uri, FoundFile& found) const {
  const auto [package, path] = inPackage(uri);
  if (package.empty() || knows(package)) return;
  for (std::string_view end = path; !end.empty();) {
    for (const fs::path& entry : packagePaths_) {
      if (!isFile(entry / end)) continue;
      found.path = (entry / end).lexically_normal();
      found.package = package;
      found.folder = entry.has_filename() ? entry : entry.parent_path();
      return;
    }
    const std::size_t slash = end.find('/');
    end = slash == std::string_view::npos ? std::string_view() : end.substr(slash + 1);
  }
}

}  // namespace softgauss::io::detail
