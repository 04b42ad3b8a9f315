// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Who may talk to the run, told by what a request says of itself.
///
/// A page of another site cannot read the answers of this server, but it can send requests to it:
/// `Origin` tells of them. A name that a foreign DNS server turns into 127.0.0.1 is told by `Host`.

#include <string>
#include <string_view>

namespace softgauss::live {

struct Access {
  bool loopback = true;  ///< listens on this machine alone
  std::string token;     ///< that every request must bring; empty: none
  std::string host;      ///< a name of a loopback address beside the usual ones, "[::1]"
};

/// What a request says. A header that is missing is empty.
struct Request {
  std::string_view target;  ///< "/?token=…"
  std::string_view host, origin;
  bool hasOrigin = false;
};

/// Why the request is refused; empty where it is not.
std::string refusal(const Access& access, const Request& request);

/// The path of a target, without what follows "?".
std::string_view pathOf(std::string_view target);

/// 128 random bits in hexadecimal. Throws std::runtime_error where the system has none.
std::string makeToken();

/// The address as a URL has it: "[::1]" of "::1", "127.0.0.1" of "localhost".
std::string hostOf(const std::string& address);

/// Whether the address is one that only this machine reaches.
bool isLoopback(const std::string& address);

}  // namespace softgauss::live
