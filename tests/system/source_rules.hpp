// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The rules of the source tree that a compiler does not know: who may include whom, how long a
/// file may be, and what every file must or must not say.
///
/// Each rule is a function from text to complaints, one line each and empty when all is well, so
/// that the tests can show that every rule is able to fail.

#include <set>
#include <string>
#include <vector>

namespace softgauss::test {

/// A text file of the tree: its path from the root, with forward slashes, and its lines.
struct SourceFile {
  std::string path;
  std::vector<std::string> lines;

  bool isCpp() const;     ///< .cpp or .hpp
  bool isPython() const;  ///< .py or .pyi
  bool isCode() const;    ///< C++, Python or JavaScript
};

using Complaints = std::vector<std::string>;  ///< `path:line: what is wrong`

/// Every text file of the project: sources, build files, documents, scripts and scenes, but not
/// the recorded logs.
std::vector<SourceFile> readTree(const std::string& root);

/// The tree that these tests were built from, read once.
const std::vector<SourceFile>& tree();

/// The directions of inclusion, and which libraries a folder may see.
Complaints checkIncludes(const SourceFile& file);

/// FCL is seen by collision/detail/fcl_*.cpp and by tests alone, and nobody asks it for a signed
/// distance: that search of FCL 0.7 aborts, throws or never ends on some pairs.
Complaints checkFcl(const SourceFile& file);

/// At most 400 lines, for what fits into one head is one file.
Complaints checkLength(const SourceFile& file);

/// First line of C++, Python, JavaScript and CMake files: the licence.
Complaints checkLicence(const SourceFile& file);

/// No path of somebody's machine, and no note of work left over.
Complaints checkWords(const SourceFile& file);

/// Numbers c.n, chapter and equation, of all (c.n) in a file; of C++ in its comments.
std::set<std::string> equationsIn(const SourceFile& file);

/// A chapter of docs/theory, and those numbers in it that are its own.
bool isChapterOfTheory(const SourceFile& file);
std::set<std::string> equationsOfChapter(const SourceFile& file);

/// Every (c.n) that C++ cites is in the theory.
Complaints checkEquations(const SourceFile& file, const std::set<std::string>& theory);

/// Nothing at the root but what belongs there.
Complaints checkRoot(const std::set<std::string>& entries);

}  // namespace softgauss::test
