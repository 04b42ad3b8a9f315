// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A live run as a process of its own, and a page that is no browser.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace softgauss::test {

using Tcp = boost::asio::ip::tcp;

/// simulate_gdd ARGUMENTS --live 0, until stop().
class LiveProcess {
 public:
  explicit LiveProcess(const std::vector<std::string>& arguments);
  ~LiveProcess();

  unsigned short port() const { return port_; }
  const std::string& address() const { return address_; }  ///< that it has told
  int pid() const { return pid_; }
  /// SIGINT; the exit code. What it printed is in out() then.
  int stop();
  const std::string& out() const { return out_; }

 private:
  bool readSome();

  int pid_ = -1, pipe_ = -1;
  unsigned short port_ = 0;
  std::string out_, address_;
};

/// A connection to /run.
class Client {
 public:
  explicit Client(unsigned short port, const std::string& path = "/run");

  void send(const std::string& text);
  /// Asks for something; "" when it is done, else why it was refused.
  std::string ask(const std::string& what);
  /// The next message with that member.
  nlohmann::json next(const std::string& member);
  /// The next status for which `holds`; fails the test after `seconds`.
  template <class F>
  nlohmann::json until(F&& holds, double seconds = 20.0) {
    const auto start = std::chrono::steady_clock::now();
    for (;;) {
      const nlohmann::json status = next("status");
      if (holds(status)) return status;
      if (std::chrono::steady_clock::now() - start > std::chrono::duration<double>(seconds))
        throw std::runtime_error("it did not come to that: " + status.dump());
    }
  }
  /// Frames that came beside what was waited for, and the last of them.
  int frames() const { return frames_; }
  const std::string& frame() const { return frame_; }
  boost::beast::websocket::stream<Tcp::socket>& socket() { return socket_; }

  bool acknowledges = true;  ///< frames and statuses, as a page does

 private:
  void acknowledge();

  boost::asio::io_context context_;
  boost::beast::websocket::stream<Tcp::socket> socket_;
  boost::beast::flat_buffer buffer_;
  int frames_ = 0, id_ = 0;
  long seen_ = 0;
  std::string frame_;
};

/// A connection that sends these bytes and gives what comes back until it is closed or `seconds`
/// have passed.
std::string exchange(unsigned short port, const std::string& bytes, double seconds = 5.0);

/// Resident memory of a process [bytes].
long residentMemory(int pid);

}  // namespace softgauss::test
