// SPDX-License-Identifier: Apache-2.0
#include "apps/live/access.hpp"

#include <fmt/format.h>

#include <random>

namespace softgauss::live {
namespace {

/// "localhost" of "localhost:8080", "[::1]" of "[::1]:8080".
std::string_view nameOf(std::string_view host) {
  const std::size_t bracket = host.find(']');
  const std::size_t colon = host.find(':', bracket == std::string_view::npos ? 0 : bracket);
  return host.substr(0, colon);
}

/// Takes the same time wherever they differ.
bool same(std::string_view a, std::string_view b) {
  unsigned differs = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
    differs |=
        static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return differs == 0;
}

std::string_view tokenOf(std::string_view target) {
  constexpr std::string_view kKey = "token=";
  const std::size_t question = target.find('?');
  if (question == std::string_view::npos) return {};
  std::string_view query = target.substr(question + 1);
  if (query.substr(0, kKey.size()) != kKey) return {};
  query.remove_prefix(kKey.size());
  return query.substr(0, query.find('&'));
}

}  // namespace

std::string refusal(const Access& access, const Request& request) {
  const std::string_view name = nameOf(request.host);
  const bool known =
      name == "localhost" || name == "127.0.0.1" || name == "[::1]" || name == access.host;
  if (access.loopback && (name.empty() || !known)) return "this host is not served";
  if (request.hasOrigin && request.origin != fmt::format("http://{}", request.host))
    return "pages of other origins are not served";
  if (!access.token.empty() && !same(tokenOf(request.target), access.token))
    return "the token is missing or wrong";
  return "";
}

std::string_view pathOf(std::string_view target) { return target.substr(0, target.find('?')); }

std::string makeToken() {
  std::random_device random;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", random());
  return token;
}

std::string hostOf(const std::string& address) {
  if (address == "localhost") return "127.0.0.1";
  return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

bool isLoopback(const std::string& address) {
  return address == "localhost" || address == "::1" || address.starts_with("127.");
}

}  // namespace softgauss::live
