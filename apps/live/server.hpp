// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The live page's server: the page by HTTP, the run by WebSocket, in a thread of its own.
///
/// It never makes the simulation wait. Each page has the newest frame alone on its way to it, so
/// one that reads slowly, or not at all, gets fewer and costs nothing. What pages send is read no
/// faster than a person can mean it. Several may watch; the first to come writes.

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "apps/live/access.hpp"
#include "apps/live/inbox.hpp"
#include "apps/live/names.hpp"

namespace softgauss::live {

struct ServerOptions {
  std::string address = "127.0.0.1";
  unsigned short port = 8080;  ///< 0: any that is free
  Access access;
  std::string page;  ///< what / gives
  int mostConnections = 16;
  double messagesPerSecond = 240.0;  ///< of one connection; more are read later
  std::size_t bytesPerSecond = 1 << 17;
  double requestSeconds = 10.0;  ///< for a whole request, and for any part of what it gives
};

/// A text or bytes on their way to several pages.
using Message = std::shared_ptr<const std::string>;

class Server {
 public:
  /// Listens. The names outlive the server. Throws std::runtime_error where the address or the port
  /// cannot be had.
  Server(ServerOptions options, const Names& names);
  ~Server();

  unsigned short port() const;
  Inbox& inbox();
  int pages() const;  ///< that watch

  // From any thread, at once:
  void publishFrame(Message frame);
  void publishStatus(Message status);
  void answer(const Sender& sender, std::string text);

  struct Shared;

 private:
  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace softgauss::live
