// SPDX-License-Identifier: Apache-2.0
#pragma once

/// <replicate>: copies of what is in it, each turned and moved on from the one before.
///
/// Copy i is a <frame> of rotation R(i · euler) at Σ_{k<i} R(k · euler) · offset. Its names end in
/// sep and i, with zeros before it up to the digits of count; of one in another, in the inner
/// suffix and then the outer.

#include <vector>

#include "softgauss/io/mjcf/compiler.hpp"

namespace softgauss::io::mjcf {

/// The frames that stand in an element's place. `total`, the elements in copies of the file, which
/// it adds to, is bounded: throws beyond.
std::vector<Element> replicated(const Element& element, const Compiler& compiler,
                                std::size_t& total);

}  // namespace softgauss::io::mjcf
