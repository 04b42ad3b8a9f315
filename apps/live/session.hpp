// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the sessions of a server share, and one session: a connection from its first byte to its
/// last. All of it runs in the server's thread, but for what is atomic.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/rate_policy.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <list>
#include <optional>

#include "apps/live/server.hpp"

namespace softgauss::live {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using Tcp = asio::ip::tcp;

class Session;

/// Connections are read at a bounded rate, whatever is in what they send.
using Stream = beast::basic_stream<Tcp, asio::any_io_executor, beast::simple_rate_policy>;

/// Sessions, which refer to it, end with its context, which is therefore the first to go.
struct Server::Shared {
  Shared(ServerOptions o, const Names& n) : options(std::move(o)), names(n), acceptor(context) {}

  ServerOptions options;
  const Names& names;
  Inbox inbox;
  std::atomic<int> pages{0};
  long nextClient = 1;
  long writer = 0;        ///< the client that writes; 0: none
  Message frame, status;  ///< the newest, for pages that come
  bool stopping = false;
  std::list<std::weak_ptr<Session>> sessions;
  asio::io_context context{1};
  Tcp::acceptor acceptor;
};

class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(Server::Shared& shared, Tcp::socket socket);
  ~Session();

  void start();
  void close();
  long client() const { return client_; }
  bool watches() const { return socket_ && open_; }
  void sendFrame(const Message& frame);
  void sendStatus(const Message& status);
  void sendText(std::string text);

 private:
  void answerRequest();
  void respond(http::status status, const std::string& type, const std::string& body);
  void writeSome();
  void upgrade();
  void greet();
  void readNext();
  void took(std::size_t bytes);
  void send();
  std::string handle(const std::string& text);
  std::string countSeen(long seen);

  Server::Shared& shared_;
  long client_;
  std::optional<Stream> stream_;  ///< until it is a WebSocket
  std::optional<websocket::stream<Stream>> socket_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  http::response<http::string_body> response_;
  std::optional<http::response_serializer<http::string_body>> serializer_;
  beast::flat_buffer buffer_;
  asio::steady_timer timer_;
  double allowance_;  ///< messages that may be read at once
  std::chrono::steady_clock::time_point allowedAt_;
  std::deque<Message> texts_;  ///< answers that wait; few
  Message frame_, status_;     ///< the newest that wait
  Message sending_;
  long sent_ = 0, seen_ = 0;  ///< frames and statuses that left, and that the page says it has had
  bool open_ = false;
  bool acted_ = false;  ///< something that it asked for reached the inbox
  bool waits_ = false;  ///< reads on when answers have left
};

}  // namespace softgauss::live
