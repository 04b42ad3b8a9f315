// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where the files that a URDF names are found.
///
/// package://NAME/x, or model://NAME/x, is sought as folder/NAME/x, or folder/x in a folder itself
/// called NAME, in
///  1. the folders given by the caller, 2. those of ROS_PACKAGE_PATH, 3. the URDF's own folder and
///  its parents, nearest first.
/// file://x is the path x, any other path is relative to the URDF's folder. What is not found as it
/// is written is sought with / for each back-slash, and the byte XY for each %XY.

#include <filesystem>
#include <string>
#include <vector>

namespace softgauss::io::detail {

struct FoundFile {
  std::filesystem::path path;         ///< empty if not found
  std::vector<std::string> searched;  ///< paths tried, in order
  std::string package;                ///< that has no folder, where the file was found by its end
  std::filesystem::path folder;       ///< in which that end is
};

class ResourceFinder {
 public:
  ResourceFinder(const std::filesystem::path& urdf,
                 const std::vector<std::filesystem::path>& packagePaths);

  FoundFile find(const std::string& uri) const;

 private:
  FoundFile findAsWritten(const std::string& uri) const;
  FoundFile findInPackage(const std::string& package, const std::string& path) const;

  /// Where the longest end of a package's path is a file.
  void findByItsEnd(const std::string& uri, FoundFile& found) const;
  bool knows(const std::string& package) const;

  std::filesystem::path folder_;                     ///< of the URDF
  std::vector<std::filesystem::path> packagePaths_;  ///< 1. to 3.
};

}  // namespace softgauss::io::detail
