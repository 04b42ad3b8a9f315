// SPDX-License-Identifier: Apache-2.0
// The server alone, against pages that are no pages.

#include "apps/live/server.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <boost/asio/write.hpp>
#include <random>

#include "softgauss/io/urdf.hpp"
#include "tests/live/live_process.hpp"

namespace softgauss::live {
namespace {

using test::Client;
using test::exchange;

class LiveServer : public testing::Test {
 protected:
  LiveServer()
      : model(io::readUrdf(SOFTGAUSS_SOURCE_DIR "/data/robots/arm.urdf", {}).build()),
        names(model, goals) {
    options.port = 0;
    options.page = "<!doctype html>the page";
  }
  void start() { server = std::make_unique<Server>(options, names); }
  std::string get(const std::string& target, const std::string& headers,
                  double seconds = 5.0) const {
    return exchange(server->port(), "GET " + target + " HTTP/1.1\r\n" + headers + "\r\n", seconds);
  }
  std::string host() const { return "Host: localhost:" + std::to_string(server->port()) + "\r\n"; }
  std::string upgrade(const std::string& target, const std::string& headers) const {
    return get(target,
               headers +
                   "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: "
                   "13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n",
               1.0);
  }
  /// Whether it still answers.
  bool lives() const { return get("/", host()).find("200 OK") != std::string::npos; }

  Model model;
  std::vector<std::unique_ptr<gdd::Goal>> goals;
  Names names;
  ServerOptions options;
  std::unique_ptr<Server> server;
};

TEST_F(LiveServer, GivesThePageAndNothingElse) {
  start();
  EXPECT_NE(get("/", host()).find("the page"), std::string::npos);
  // Through a tunnel the port is another.
  EXPECT_NE(get("/", "Host: localhost:9999\r\n").find("200 OK"), std::string::npos);
  for (const char* target : {"/etc/passwd", "/../../etc/passwd", "/%2e%2e/etc/passwd", "/run.html",
                             "//etc/passwd", "/index.html", "/run"})
    EXPECT_NE(get(target, host()).find("404"), std::string::npos) << target;
  EXPECT_NE(exchange(server->port(), "PUT / HTTP/1.1\r\n" + host() + "\r\n").find("405"),
            std::string::npos);
}

TEST_F(LiveServer, RefusesForeignHostsAndOrigins) {
  start();
  const std::string port = std::to_string(server->port());
  for (const std::string headers :
       {"Host: evil.example\r\n", "Host: evil.example:80\r\n", "Host: localhost.evil.example\r\n",
        "Host: 127.0.0.1.evil.example\r\n", "Host: \r\n", ""})
    EXPECT_EQ(get("/", headers).find("200 OK"), std::string::npos) << headers;
  for (const char* origin : {"http://evil.example", "null", "https://localhost", "", "file://"}) {
    const std::string headers = host() + "Origin: " + origin + "\r\n";
    EXPECT_NE(get("/", headers).find("403"), std::string::npos) << origin;
    EXPECT_NE(upgrade("/run", headers).find("403"), std::string::npos) << origin;
  }
  EXPECT_NE(upgrade("/run", host() + "Origin: http://localhost:" + port + "\r\n").find("101"),
            std::string::npos);
}

TEST_F(LiveServer, IsNamedByTheAddressWhereItListens) {
  options.access.host = hostOf("127.0.0.2");
  start();
  EXPECT_NE(get("/", "Host: 127.0.0.2:80\r\n").find("200 OK"), std::string::npos);
  EXPECT_NE(get("/", host()).find("200 OK"), std::string::npos);
  EXPECT_NE(get("/", "Host: 127.0.0.3\r\n").find("403"), std::string::npos);
  EXPECT_EQ(hostOf("::1"), "[::1]");
  EXPECT_EQ(hostOf("localhost"), "127.0.0.1");
  EXPECT_EQ(hostOf("0.0.0.0"), "0.0.0.0");
}

TEST_F(LiveServer, DemandsItsToken) {
  options.access = {false, "0123abcd", ""};
  start();
  EXPECT_NE(get("/", "Host: robot.example\r\n").find("403"), std::string::npos);
  EXPECT_NE(get("/?token=0123abce", host()).find("403"), std::string::npos);
  EXPECT_NE(get("/?token=", host()).find("403"), std::string::npos);
  EXPECT_NE(get("/?token=0123abcd", "Host: robot.example\r\n").find("200 OK"), std::string::npos);
  EXPECT_NE(upgrade("/run", host()).find("403"), std::string::npos);
  EXPECT_NE(upgrade("/run?token=0123abcd", host()).find("101"), std::string::npos);
  EXPECT_EQ(makeToken().size(), 32u);
  EXPECT_NE(makeToken(), makeToken());
}

TEST_F(LiveServer, LetsOneWriteAndOthersAfterIt) {
  start();
  auto first = std::make_unique<Client>(server->port());
  EXPECT_TRUE(first->next("writes")["writes"].get<bool>());
  Client second(server->port());
  EXPECT_FALSE(second.next("writes")["writes"].get<bool>());
  EXPECT_EQ(second.ask("\"reset\": {}"), "this page only watches");
  EXPECT_EQ(second.ask("\"write\": true"), "another page writes");
  first.reset();
  // The server hears of it in its own time.
  std::string refused = "-";
  for (int i = 0; i < 100 && !refused.empty(); ++i) {
    refused = second.ask("\"write\": true");
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(refused, "");
  second.send("{\"id\": 50, \"reset\": {}}");
  std::vector<std::pair<Sender, Event>> events;
  for (int i = 0; i < 500 && events.empty(); ++i) {
    server->inbox().take(events);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].second.kind, EventKind::reset);
  server->answer(events[0].first, "{\"re\": 50, \"done\": true}");
  EXPECT_TRUE(second.next("re")["done"].get<bool>());
}

TEST_F(LiveServer, HasNoMoreThanItsConnections) {
  options.mostConnections = 4;
  start();
  std::vector<std::unique_ptr<Client>> pages;
  for (int i = 0; i < 4; ++i) pages.push_back(std::make_unique<Client>(server->port()));
  for (auto& page : pages) page->next("writes");
  EXPECT_EQ(exchange(server->port(), "GET / HTTP/1.1\r\n" + host() + "\r\n"), "");
  // Who only opens a connection has to make room for who says something.
  pages.clear();
  boost::asio::io_context context;
  std::vector<test::Tcp::socket> halfOpen;
  for (int i = 0; i < 40; ++i) {
    halfOpen.emplace_back(context).connect(
        {boost::asio::ip::address_v4::loopback(), server->port()});
  }
  EXPECT_TRUE(lives());
}

TEST_F(LiveServer, EndsHalfARequestInTime) {
  options.requestSeconds = 0.2;
  start();
  // Closed by the server, long before the test gives up.
  const auto begun = std::chrono::steady_clock::now();
  exchange(server->port(), "GET / HTT", 20.0);
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(10));
  EXPECT_EQ(exchange(server->port(), "GET /" + std::string(100000, 'a')).find("200"),
            std::string::npos);
  EXPECT_TRUE(lives());
}

TEST_F(LiveServer, GivesALargePageOnASlowLine) {
  // It takes several times what a request may; who reads nothing for that long is given up.
  options.requestSeconds = 0.3;
  options.page = std::string(std::size_t{24} << 20, 'x');
  start();
  boost::asio::io_context context;
  test::Tcp::socket slow(context), stopped(context);
  const std::string request = "GET / HTTP/1.1\r\n" + host() + "\r\n";
  for (test::Tcp::socket* socket : {&slow, &stopped}) {
    socket->open(test::Tcp::v4());
    socket->set_option(boost::asio::socket_base::receive_buffer_size(1 << 16));
    socket->connect({boost::asio::ip::address_v4::loopback(), server->port()});
    boost::asio::write(*socket, boost::asio::buffer(request));
  }
  const auto readAll = [](test::Tcp::socket& socket, std::chrono::milliseconds pause) {
    std::string bytes(1 << 18, ' ');
    boost::system::error_code error;
    std::size_t read = 0;
    while (!error) {
      read += socket.read_some(boost::asio::buffer(bytes), error);
      std::this_thread::sleep_for(pause);
    }
    return read;
  };
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_GT(readAll(slow, std::chrono::milliseconds(5)), options.page.size());
  // The test is one of a line that is slower than the limit.
  EXPECT_GT(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(600));
  EXPECT_LT(readAll(stopped, std::chrono::milliseconds(0)), options.page.size());
}

TEST_F(LiveServer, AnswersAWholeBurst) {
  // As many as its allowance at once, before the first answer is read; and who goes on asking
  // without reading is not closed, but not read either.
  start();
  Client client(server->port());
  for (int i = 0; i < 120; ++i) client.send("{\"id\": " + std::to_string(i + 1) + "}");
  for (int i = 0; i < 120; ++i) EXPECT_EQ(client.next("re")["re"], i + 1);
  for (int i = 0; i < 110; ++i)
    client.send("{\"id\": " + std::to_string(i + 1) + ", \"release\": {}}");
  std::vector<std::pair<Sender, Event>> events;
  for (int taken = 0; taken < 110; taken += static_cast<int>(events.size())) {
    server->inbox().take(events);
    for (const auto& [sender, event] : events)
      server->answer(sender, "{\"re\": " + std::to_string(sender.id) + "}");
    if (events.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  for (int i = 0; i < 110; ++i) EXPECT_EQ(client.next("re")["re"], i + 1);
  EXPECT_TRUE(lives());
}

TEST_F(LiveServer, OutlivesHostileFrames) {
  options.messagesPerSecond = 1e9;
  options.bytesPerSecond = std::size_t{1} << 40;
  start();
  const std::string hello =
      "GET /run HTTP/1.1\r\n" + host() +
      "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n";
  const std::string frames[] = {
      std::string("\x81\x05hello", 7),                              // no mask
      std::string("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff", 10),  // 2⁶³ bytes to come
      std::string("\x81\xfe\xff\xff\0\0\0\0", 8),                   // 65,535
      std::string("\x83\x80\0\0\0\0", 6),                           // an operation that is none
      std::string("\x89\xfe\x01\x00\0\0\0\0", 8),                   // a ping of 256 bytes
      std::string("\xf1\x80\0\0\0\0", 6),                           // reserved bits
      std::string("\x80\x80\0\0\0\0", 6),                           // goes on with nothing
      std::string("\x81\x82\0\0\0\0\xff\xfe", 8),                   // no UTF-8
      std::string("\x88\x81\0\0\0\0\0", 7),                         // half a reason to close
      std::string(3000, '\0'),
  };
  std::mt19937 random(11);
  for (int i = 0; i < 60; ++i) {
    std::string bytes = hello + frames[static_cast<std::size_t>(i) % std::size(frames)];
    for (int k = 0; k < 50 && i >= 10; ++k)
      bytes[hello.size() + random() % (bytes.size() - hello.size())] = static_cast<char>(random());
    exchange(server->port(), bytes, 0.05);
  }
  // 10⁵ messages of one connection, right and wrong, all answered; no events but the first few
  // wait.
  Client client(server->port());
  std::vector<std::pair<Sender, Event>> events;
  constexpr int kBatch = 50;
  for (int i = 0; i < 100000 / kBatch; ++i) {
    std::string batch;
    for (int k = 0; k < kBatch; ++k) {
      const std::string text = k % 2 == 0 ? "{\"pause\": {\"on\": 3}}"
                                          : "{\"id\": 5, \"x\": " + std::to_string(random()) + "}";
      batch += '\x81';
      batch += static_cast<char>(0x80 | text.size());
      batch += std::string(4, '\0');
      batch += text;
    }
    boost::asio::write(client.socket().next_layer(), boost::asio::buffer(batch));
    for (int k = 0; k < kBatch; ++k) EXPECT_TRUE(client.next("re").contains("refused"));
  }
  server->inbox().take(events);
  EXPECT_TRUE(events.empty());
  EXPECT_TRUE(lives());
}

TEST_F(LiveServer, GivesASlowReaderTheNewestAlone) {
  start();
  Client slow(server->port()), quick(server->port());
  slow.next("writes");
  quick.next("writes");
  // 200 MB to who does not read: as much as the sockets hold is on its way, the rest is dropped.
  const long before = test::residentMemory(getpid());
  for (int i = 0; i < 2000; ++i) {
    std::string frame(100000, ' ');
    frame.replace(0, 10, std::to_string(1000000000 + i));
    server->publishFrame(std::make_shared<const std::string>(std::move(frame)));
    if (i % 50 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  server->publishStatus(std::make_shared<const std::string>("{\"status\": {\"last\": true}}"));
  EXPECT_TRUE(quick.next("status")["last"].get<bool>());
  EXPECT_LT(test::residentMemory(getpid()) - before, 60l << 20);
  slow.next("status");
  EXPECT_LT(slow.frames(), 1000);
}

TEST_F(LiveServer, HasLittleOnItsWayToWhoHasNotSaidThatItCame) {
  start();
  Client page(server->port());
  page.acknowledges = false;
  page.next("writes");
  const auto publish = [&](int first, int last) {
    for (int i = first; i <= last; ++i) {
      server->publishFrame(std::make_shared<const std::string>(fmt::format("{:04}", i)));
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  };
  publish(1, 200);
  EXPECT_NE(page.ask("\"fly\": {}"), "") << "answers come all the same";
  EXPECT_EQ(page.frames(), 6);
  EXPECT_EQ(page.frame(), "0006");
  // Then the newest comes, not the one that was next.
  page.send("{\"seen\": 6}");
  while (page.frames() < 7) page.ask("\"fly\": {}");
  EXPECT_EQ(page.frame(), "0200");
  // A page that says more than it can know, or less than it said, is told so, and nothing changes.
  for (const char* wrong : {"{\"seen\": 8}", "{\"seen\": 5}"}) {
    page.send(wrong);
    EXPECT_NE(page.next("refused")["refused"].get<std::string>().find("expected 6 to 7"),
              std::string::npos);
  }
  publish(201, 300);
  page.ask("\"fly\": {}");
  EXPECT_EQ(page.frames(), 12);
}

TEST_F(LiveServer, ReadsNoFasterThanItSays) {
  options.messagesPerSecond = 200.0;
  start();
  Client client(server->port());
  const auto begun = std::chrono::steady_clock::now();
  for (int i = 0; i < 300; ++i) client.send("{\"id\": 1}");
  for (int i = 0; i < 300; ++i) client.next("re");
  // Half a second's worth may come at once.
  EXPECT_GT(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(950));
}

TEST_F(LiveServer, SaysWhyAPortCannotBeHad) {
  start();
  options.port = server->port();
  try {
    Server other(options, names);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(std::to_string(options.port)), std::string::npos);
  }
  options.address = "the moon";
  EXPECT_THROW(Server(options, names), std::runtime_error);
}

}  // namespace
}  // namespace softgauss::live
