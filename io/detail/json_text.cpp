// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/json_text.hpp"

#include <nlohmann/json.hpp>

namespace softgauss::io::detail {

std::string jsonName(const std::string& name) { return nlohmann::json(validUtf8(name)).dump(); }

}  // namespace softgauss::io::detail
