// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Errors and contracts.
///
/// Load time: exceptions (ModelError) that name file, line, element, what was found and what was
/// expected. Step time: no exceptions; a status is returned. Contracts between functions are
/// asserted in checked builds only (SOFTGAUSS_CHECKED).

#include <cstdio>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>

namespace softgauss {

/// Where an element of a model was written: file name and line (0 when unknown).
struct SourceLocation {
  std::string file;
  int line = 0;
};

/// A model or scene that cannot be simulated. what() reads
/// `file:line: element: what is wrong, what was expected`.
class ModelError : public std::runtime_error {
 public:
  ModelError(const SourceLocation& where, const std::string& element, const std::string& problem)
      : std::runtime_error(format(where, element, problem)) {}

 private:
  static std::string format(const SourceLocation& where, const std::string& element,
                            const std::string& problem) {
    std::string text = where.file.empty() ? std::string("model") : where.file;
    if (where.line > 0) text += ":" + std::to_string(where.line);
    return text + ": " + element + ": " + problem;
  }
};

namespace detail {
[[noreturn]] inline void assertionFailed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: contract broken: %s\n", file, line, condition);
  std::abort();
}
}  // namespace detail

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace softgauss

#if defined(SOFTGAUSS_CHECKED) && SOFTGAUSS_CHECKED
namespace softgauss {
inline constexpr bool kChecked = true;
}
#define SOFTGAUSS_ASSERT(condition) \
  ((condition) ? (void)0 : ::softgauss::detail::assertionFailed(#condition, __FILE__, __LINE__))
#else
namespace softgauss {
inline constexpr bool kChecked = false;  ///< in checked builds: what is not computed is NaN
}
#define SOFTGAUSS_ASSERT(condition) ((void)0)
#endif
