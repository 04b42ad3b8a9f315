// SPDX-License-Identifier: Apache-2.0
#include "apps/rivals/engine.hpp"

namespace rivals {

Settings::Settings(const std::vector<std::string>& arguments) {
  for (const std::string& a : arguments) {
    const std::size_t equals = a.find('=');
    if (equals == std::string::npos) throw std::invalid_argument("'" + a + "': expected key=value");
    given_[a.substr(0, equals)] = a.substr(equals + 1);
  }
}

std::string Settings::word(const std::string& key, const std::string& otherwise) {
  known_.insert(key);
  const auto found = given_.find(key);
  return found == given_.end() ? otherwise : found->second;
}

double Settings::number(const std::string& key, double otherwise) {
  const std::string text = word(key, "");
  return text.empty() ? otherwise : std::stod(text);
}

bool Settings::flag(const std::string& key) { return number(key, 0.0) != 0.0; }

void Settings::expectAllTaken() const {
  for (const auto& [key, value] : given_) {
    if (known_.count(key) > 0) continue;
    std::string keys;
    for (const std::string& k : known_) keys += (keys.empty() ? "" : ", ") + k;
    throw std::invalid_argument("'" + key + "' is no setting of this engine; it has " + keys);
  }
}

}  // namespace rivals
