// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace softgauss::fuzz {

/// A law that does not hold. Nothing but a test catches it, so a fuzz target ends by it.
class Finding : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

}  // namespace softgauss::fuzz
