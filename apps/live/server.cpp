// SPDX-License-Identifier: Apache-2.0
#include "apps/live/server.hpp"

#include <fmt/format.h>

#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <chrono>
#include <stdexcept>

#include "apps/live/session.hpp"

namespace softgauss::live {
namespace {

constexpr std::chrono::milliseconds kBreath{20};  // after a connection that was turned away

/// The live sessions, without those that are gone.
std::vector<std::shared_ptr<Session>> sessionsOf(Server::Shared& shared) {
  std::vector<std::shared_ptr<Session>> out;
  for (auto it = shared.sessions.begin(); it != shared.sessions.end();) {
    if (auto session = it->lock()) {
      out.push_back(std::move(session));
      ++it;
    } else {
      it = shared.sessions.erase(it);
    }
  }
  return out;
}

void acceptNext(Server::Shared& shared);

void acceptLater(Server::Shared& shared) {
  auto timer = std::make_shared<asio::steady_timer>(shared.context, kBreath);
  timer->async_wait([&shared, timer](error_code error) {
    if (!error) acceptNext(shared);
  });
}

/// Room for one more: where there is none, the oldest that has not become a page goes. False where
/// all are pages.
bool makeRoom(Server::Shared& shared) {
  const auto sessions = sessionsOf(shared);
  if (static_cast<int>(sessions.size()) < shared.options.mostConnections) return true;
  for (const auto& session : sessions)
    if (!session->watches()) {
      session->close();
      return true;
    }
  return false;
}

void acceptNext(Server::Shared& shared) {
  if (shared.stopping) return;
  shared.acceptor.async_accept([&shared](error_code error, Tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) return acceptLater(shared);
    if (!makeRoom(shared)) {
      error_code ignored;
      socket.close(ignored);
      return acceptLater(shared);
    }
    auto session = std::make_shared<Session>(shared, std::move(socket));
    shared.sessions.push_back(session);
    session->start();
    acceptNext(shared);
  });
}

void listen(Tcp::acceptor& acceptor, const ServerOptions& options) {
  error_code error;
  const asio::ip::address address =
      asio::ip::make_address(options.address == "localhost" ? "127.0.0.1" : options.address, error);
  if (error)
    throw std::runtime_error(fmt::format(
        "found '{}', expected an address such as 127.0.0.1 or 0.0.0.0", options.address));
  const Tcp::endpoint endpoint(address, options.port);
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(Tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error)
    throw std::runtime_error(fmt::format("{} port {} cannot be had: {}", options.address,
                                         options.port, error.message()));
}

}  // namespace

Server::Server(ServerOptions options, const Names& names)
    : shared_(std::make_shared<Shared>(std::move(options), names)) {
  listen(shared_->acceptor, shared_->options);
  acceptNext(*shared_);
  thread_ = std::thread([shared = shared_.get()] { shared->context.run(); });
}

Server::~Server() {
  shared_->context.stop();
  thread_.join();
  // What was on its way is called off.
  shared_->stopping = true;
  error_code ignored;
  shared_->acceptor.close(ignored);
  for (const auto& session : sessionsOf(*shared_)) session->close();
  shared_->context.restart();
  shared_->context.poll();
}

unsigned short Server::port() const { return shared_->acceptor.local_endpoint().port(); }
Inbox& Server::inbox() { return shared_->inbox; }
int Server::pages() const { return shared_->pages; }

void Server::publishFrame(Message frame) {
  asio::post(shared_->context, [shared = shared_.get(), frame = std::move(frame)] {
    shared->frame = frame;
    for (const auto& session : sessionsOf(*shared))
      if (session->watches()) session->sendFrame(frame);
  });
}

void Server::publishStatus(Message status) {
  asio::post(shared_->context, [shared = shared_.get(), status = std::move(status)] {
    shared->status = status;
    for (const auto& session : sessionsOf(*shared))
      if (session->watches()) session->sendStatus(status);
  });
}

void Server::answer(const Sender& sender, std::string text) {
  asio::post(shared_->context, [shared = shared_.get(), sender, text = std::move(text)]() mutable {
    for (const auto& session : sessionsOf(*shared))
      if (session->client() == sender.client && session->watches())
        session->sendText(std::move(text));
  });
}

}  // namespace softgauss::live
