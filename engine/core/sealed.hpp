// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Bytes that are kept for later: what they are, of which version, and a checksum.

#include <cstdint>
#include <string>
#include <string_view>

namespace softgauss {

/// `kind`, eight characters, and `version` before the content, its length and checksum after them.
std::string sealed(std::string_view kind, std::uint32_t version, std::string_view content);

/// The content of such bytes. Throws BytesError where they are of another kind or version, end
/// early, or were changed.
std::string_view unsealed(std::string_view kind, std::uint32_t version, std::string_view bytes);

}  // namespace softgauss
