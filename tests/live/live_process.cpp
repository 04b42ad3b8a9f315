// SPDX-License-Identifier: Apache-2.0
#include "tests/live/live_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <fstream>

namespace softgauss::test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;

Tcp::endpoint local(unsigned short port) { return {asio::ip::address_v4::loopback(), port}; }

}  // namespace

LiveProcess::LiveProcess(const std::vector<std::string>& arguments) {
  std::vector<std::string> all = {SOFTGAUSS_APP_DIR "/simulate_gdd"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  all.insert(all.end(), {"--live", "0"});
  std::vector<char*> argv;
  for (std::string& argument : all) argv.push_back(argument.data());
  argv.push_back(nullptr);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  pid_ = fork();
  if (pid_ == 0) {
    dup2(ends[1], STDOUT_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  close(ends[1]);
  pipe_ = ends[0];
  const std::string mark = "live: ";
  while (out_.find(mark) == std::string::npos ||
         out_.find('\n', out_.find(mark)) == std::string::npos)
    if (!readSome()) throw std::runtime_error("it has not told its address: " + out_);
  const std::size_t at = out_.find(mark) + mark.size();
  address_ = out_.substr(at, out_.find('\n', at) - at);
  port_ = static_cast<unsigned short>(std::stoi(address_.substr(address_.rfind(':') + 1)));
}

bool LiveProcess::readSome() {
  pollfd ready = {pipe_, POLLIN, 0};
  if (poll(&ready, 1, 120000) <= 0) return false;
  char bytes[4096];
  const ssize_t n = read(pipe_, bytes, sizeof bytes);
  if (n <= 0) return false;
  out_.append(bytes, static_cast<std::size_t>(n));
  return true;
}

int LiveProcess::stop() {
  if (pid_ < 0) return -1;
  kill(pid_, SIGINT);
  while (readSome()) continue;
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  close(pipe_);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

LiveProcess::~LiveProcess() { stop(); }

Client::Client(unsigned short port, const std::string& path) : socket_(context_) {
  socket_.next_layer().connect(local(port));
  socket_.next_layer().set_option(Tcp::no_delay(true));
  socket_.handshake("127.0.0.1:" + std::to_string(port), path);
}

void Client::send(const std::string& text) {
  socket_.text(true);
  socket_.write(asio::buffer(text));
}

nlohmann::json Client::next(const std::string& member) {
  for (;;) {
    buffer_.clear();
    socket_.read(buffer_);
    std::string bytes = beast::buffers_to_string(buffer_.data());
    if (socket_.got_binary()) {
      ++frames_;
      frame_ = std::move(bytes);
      acknowledge();
      continue;
    }
    const nlohmann::json message = nlohmann::json::parse(bytes);
    if (message.contains("status")) acknowledge();
    if (message.contains(member)) return member == "status" ? message[member] : message;
  }
}

void Client::acknowledge() {
  if (acknowledges) send("{\"seen\": " + std::to_string(++seen_) + "}");
}

std::string Client::ask(const std::string& what) {
  const int id = ++id_;
  send("{\"id\": " + std::to_string(id) + ", " + what + "}");
  for (;;) {
    const nlohmann::json reply = next("re");
    if (reply["re"] != id) continue;
    return reply.contains("refused") ? reply["refused"].get<std::string>() : "";
  }
}

std::string exchange(unsigned short port, const std::string& bytes, double seconds) {
  asio::io_context context;
  Tcp::socket socket(context);
  socket.connect(local(port));
  boost::system::error_code error;
  asio::write(socket, asio::buffer(bytes), error);
  std::string out;
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    const double left =
        seconds - std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    pollfd ready = {socket.native_handle(), POLLIN, 0};
    if (left <= 0.0 || poll(&ready, 1, static_cast<int>(1000 * left)) <= 0) break;
    char some[4096];
    const std::size_t n = socket.read_some(asio::buffer(some), error);
    if (error) break;
    out.append(some, n);
  }
  return out;
}

long residentMemory(int pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/statm");
  long total = 0, resident = 0;
  file >> total >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

}  // namespace softgauss::test
