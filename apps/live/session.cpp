// SPDX-License-Identifier: Apache-2.0
#include "apps/live/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/beast/core/buffers_to_string.hpp>
#include <chrono>

#include "apps/live/messages.hpp"

namespace softgauss::live {
namespace {

using std::chrono::steady_clock;

constexpr std::uint32_t kLongestHeader = 8192;  // [bytes]
constexpr std::size_t kMostAnswers = 64;        // that wait while messages are read
constexpr double kBurst = 0.5;                  // [s] of messages may come at once
constexpr long kAhead = 6;                      // frames and statuses on their way to a page
constexpr std::chrono::seconds kSilence{60};    // after which a page is asked whether it is there

template <class F>
auto guarded(std::shared_ptr<Session> self, F&& f) {
  return [self = std::move(self), f = std::forward<F>(f)](error_code error, auto... rest) {
    if (error)
      self->close();
    else
      f(rest...);
  };
}

steady_clock::duration seconds(double s) {
  return std::chrono::duration_cast<steady_clock::duration>(std::chrono::duration<double>(s));
}

}  // namespace

Session::Session(Server::Shared& shared, Tcp::socket socket)
    : shared_(shared),
      client_(shared.nextClient++),
      stream_(std::in_place, std::move(socket)),
      timer_(shared.context),
      allowance_(kBurst * shared.options.messagesPerSecond),
      allowedAt_(steady_clock::now()) {}

Session::~Session() {
  if (open_) --shared_.pages;
  if (shared_.writer != client_) return;
  shared_.writer = 0;
  if (acted_) shared_.inbox.letGo();
}

void Session::close() {
  error_code ignored;
  timer_.cancel();
  Tcp::socket& socket = socket_ ? beast::get_lowest_layer(*socket_).socket() : stream_->socket();
  socket.close(ignored);
}

void Session::start() {
  stream_->expires_after(seconds(shared_.options.requestSeconds));
  stream_->rate_policy().read_limit(shared_.options.bytesPerSecond);
  parser_.emplace();
  parser_->header_limit(kLongestHeader);
  parser_->body_limit(0);
  http::async_read(*stream_, buffer_, *parser_,
                   guarded(shared_from_this(), [this](std::size_t) { answerRequest(); }));
}

void Session::answerRequest() {
  const auto& request = parser_->get();
  const auto text = [&](http::field field) {
    const auto value = request[field];
    return std::string_view(value.data(), value.size());
  };
  const std::string_view target(request.target().data(), request.target().size());
  const std::string refused =
      refusal(shared_.options.access, {target, text(http::field::host), text(http::field::origin),
                                       request.find(http::field::origin) != request.end()});
  if (!refused.empty()) return respond(http::status::forbidden, "text/plain", refused + "\n");
  if (websocket::is_upgrade(request)) {
    if (pathOf(target) == "/run") return upgrade();
    return respond(http::status::not_found, "text/plain", "the run is at /run\n");
  }
  if (request.method() != http::verb::get)
    return respond(http::status::method_not_allowed, "text/plain", "only GET is answered\n");
  if (pathOf(target) != "/")
    return respond(http::status::not_found, "text/plain", "there is the page / alone\n");
  respond(http::status::ok, "text/html; charset=utf-8", shared_.options.page);
}

void Session::respond(http::status status, const std::string& type, const std::string& body) {
  response_ = {status, 11};
  response_.set(http::field::content_type, type);
  response_.set(http::field::cache_control, "no-store");
  response_.set("X-Content-Type-Options", "nosniff");
  response_.set("X-Frame-Options", "DENY");
  response_.set("Cross-Origin-Resource-Policy", "same-origin");
  response_.set("Referrer-Policy", "no-referrer");
  response_.body() = body;
  response_.keep_alive(false);
  response_.prepare_payload();
  serializer_.emplace(response_);
  writeSome();
}

/// A large page takes its time on a slow line; only a reader that stops is given up.
void Session::writeSome() {
  stream_->expires_after(seconds(shared_.options.requestSeconds));
  http::async_write_some(*stream_, *serializer_, guarded(shared_from_this(), [this](std::size_t) {
    if (!serializer_->is_done()) return writeSome();
    error_code ignored;
    stream_->socket().shutdown(Tcp::socket::shutdown_send, ignored);
  }));
}

void Session::upgrade() {
  stream_->expires_never();
  stream_->socket().set_option(Tcp::no_delay(true));
  socket_.emplace(std::move(*stream_));
  stream_.reset();
  buffer_.clear();  // who speaks before the handshake is not heard
  websocket::stream_base::timeout timeout;
  timeout.handshake_timeout = seconds(shared_.options.requestSeconds);
  timeout.idle_timeout = 2 * kSilence;
  timeout.keep_alive_pings = true;
  socket_->set_option(timeout);
  socket_->read_message_max(kLongestMessage);
  socket_->async_accept(parser_->get(), guarded(shared_from_this(), [this] { greet(); }));
}

void Session::greet() {
  parser_.reset();
  open_ = true;
  ++shared_.pages;
  if (shared_.writer == 0) shared_.writer = client_;
  sendText(fmt::format("{{\"writes\": {}}}", shared_.writer == client_));
  if (shared_.status) sendStatus(shared_.status);
  if (shared_.frame) sendFrame(shared_.frame);
  readNext();
}

/// Who asks and does not read the answers is not read either. The inbox bounds those that the
/// simulation still gives.
void Session::readNext() {
  waits_ = texts_.size() >= kMostAnswers;
  if (waits_) return;
  const auto now = steady_clock::now();
  const double rate = shared_.options.messagesPerSecond;
  allowance_ = std::min(
      kBurst * rate, allowance_ + rate * std::chrono::duration<double>(now - allowedAt_).count());
  allowedAt_ = now;
  if (allowance_ < 1.0) {
    timer_.expires_after(seconds((1.0 - allowance_) / rate));
    timer_.async_wait(guarded(shared_from_this(), [this] { readNext(); }));
    return;
  }
  socket_->async_read(buffer_,
                      guarded(shared_from_this(), [this](std::size_t bytes) { took(bytes); }));
}

void Session::took(std::size_t) {
  allowance_ -= 1.0;
  if (!socket_->got_text()) {
    sendText(answer(0, "this is no text"));
  } else {
    std::string reply = handle(beast::buffers_to_string(buffer_.data()));
    if (!reply.empty()) sendText(std::move(reply));
  }
  buffer_.consume(buffer_.size());
  readNext();
}

/// The answer, or nothing where the simulation will give it.
std::string Session::handle(const std::string& text) {
  const auto read = readMessage(text, shared_.names);
  if (const auto* refused = std::get_if<Refused>(&read))
    return answer(refused->id, refused->reason);
  const Asked& asked = std::get<Asked>(read);
  if (asked.seen) return countSeen(*asked.seen);
  if (asked.toWrite) {
    if (shared_.writer != 0 && shared_.writer != client_)
      return answer(asked.id, "another page writes");
    shared_.writer = client_;
    sendText("{\"writes\": true}");
    return answer(asked.id, "");
  }
  if (shared_.writer != client_) return answer(asked.id, "this page only watches");
  if (!shared_.inbox.put({client_, asked.id}, asked.event))
    return answer(asked.id, "too much is waiting");
  acted_ = true;
  return "";
}

std::string Session::countSeen(long seen) {
  if (seen < seen_ || seen > sent_)
    return answer(0, fmt::format("'seen': found {}, expected {} to {}", seen, seen_, sent_));
  seen_ = seen;
  send();
  return "";
}

void Session::sendFrame(const Message& frame) {
  frame_ = frame;
  send();
}

void Session::sendStatus(const Message& status) {
  status_ = status;
  send();
}

void Session::sendText(std::string text) {
  texts_.push_back(std::make_shared<const std::string>(std::move(text)));
  send();
}

/// Answers first, then the newest of the others. What has left can get no newer, and buffers on the
/// way hold minutes of it: little is on its way to who has not said that the last has come.
void Session::send() {
  if (sending_ || !open_) return;
  const bool isFrame = texts_.empty() && !status_ && frame_;
  if (!texts_.empty()) {
    sending_ = texts_.front();
    texts_.pop_front();
  } else if (sent_ - seen_ < kAhead) {
    sending_ = std::exchange(status_ ? status_ : frame_, nullptr);
    if (sending_) ++sent_;
  }
  if (!sending_) return;
  socket_->binary(isFrame);
  socket_->async_write(asio::buffer(*sending_), guarded(shared_from_this(), [this](std::size_t) {
                         sending_.reset();
                         send();
                         if (waits_) readNext();
                       }));
}

}  // namespace softgauss::live
