// SPDX-License-Identifier: Apache-2.0
// What pages may say, and what becomes of everything else.

#include <gtest/gtest.h>

#include <random>

#include "apps/live/messages.hpp"
#include "softgauss/io/urdf.hpp"

namespace softgauss::live {
namespace {

class LiveMessages : public testing::Test {
 protected:
  LiveMessages()
      : model(io::readUrdf(SOFTGAUSS_SOURCE_DIR "/data/robots/arm.urdf", {}).build()),
        names(model, goals) {}

  std::string refusedOf(const std::string& text) const {
    const auto read = readMessage(text, names);
    const auto* refused = std::get_if<Refused>(&read);
    return refused ? refused->reason : "";
  }
  /// With \x27 for quotes.
  std::string refused(std::string text) const {
    for (char& c : text)
      if (c == '\'') c = '"';
    return refusedOf(text);
  }

  Model model;
  std::vector<std::unique_ptr<gdd::Goal>> goals;
  Names names;
};

TEST_F(LiveMessages, AreTaken) {
  EXPECT_EQ(refused("{'id': 3, 'pause': {'on': true}}"), "");
  EXPECT_EQ(refused("{'write': true}"), "");
  EXPECT_EQ(refused("{'release': {}}"), "");
  EXPECT_EQ(refused("{'seen': 18446744073709551615}"), "");
  const std::string link = names.links.back();
  EXPECT_EQ(
      refused("{'grab': {'link': '" + link + "', 'point': [0, 0, 0.1], 'target': [1, 2, 3]}}"), "");
  const auto read = readMessage("{\"id\": 9, \"advance\": {\"count\": 5}}", names);
  const Asked& asked = std::get<Asked>(read);
  EXPECT_EQ(asked.id, 9);
  EXPECT_EQ(asked.event.kind, EventKind::advance);
  EXPECT_EQ(asked.event.number("count"), 5.0);
}

TEST_F(LiveMessages, AreRefusedWithTheReason) {
  const std::string link = names.links.back();
  const std::pair<std::string, std::string> cases[] = {
      {"", "no JSON"},
      {"{", "no JSON"},
      {"[1]", "an object"},
      {"{}", "something to do"},
      {"{'fly': {}}", "fly"},
      {"{'pause': {'on': true}, 'reset': {}}", "one thing"},
      {"{'id': 1.5, 'reset': {}}", "whole number"},
      {"{'id': -1, 'reset': {}}", "whole number"},
      {"{'write': false}", "expected true"},
      {"{'write': 0}", "expected true"},
      {"{'write': {}}", "expected true"},
      {"{'seen': -1}", "number of messages"},
      {"{'seen': 1.5}", "number of messages"},
      {"{'seen': 1, 'reset': {}}", "one thing"},
      {"{'reset': {'x': 1}}", "expected {}"},
      {"{'pause': {}}", "missing"},
      {"{'pause': {'on': 1}}", "true or false"},
      {"{'pause': {'on': true, 'off': 1}}", "unknown field"},
      {"{'pause': true}", "an object of fields"},
      {"{'advance': {'count': 0}}", "from 1"},
      {"{'advance': {'count': 1e9}}", "to 1000"},
      {"{'factor': {'value': 1e999}}", ""},
      {"{'move': {'target': [0, 0]}}", "three numbers"},
      {"{'move': {'target': [0, 0, 1e300]}}", "three numbers"},
      {"{'move': {'target': [0, 0, null]}}", "three numbers"},
      {"{'grab': {'link': 'nobody', 'point': [0,0,0], 'target': [0,0,0]}}", "nobody"},
      {"{'push': {'link': '" + link + "', 'point': [0,0,0], 'force': [1e9,0,0]}}", "force"},
      {"{'joint': {'joint': '" + names.joints[0].name + "', 'position': 400}}", "range"},
      {"{'effect': {'effect': '../../etc/passwd', 'on': true}}", "effect"},
      {"{'goal': {'goal': 'none', 'on': true}}", "goal"},
      {std::string(5000, ' '), "too long"},
      {"{'a':" + std::string(500, '['), "too deep"},
  };
  for (const auto& [text, why] : cases) {
    const std::string reason = refused(text);
    EXPECT_NE(reason, "") << text;
    EXPECT_NE(reason.find(why), std::string::npos) << text << " -> " << reason;
  }
}

TEST_F(LiveMessages, OfAnyBytesAreAnswered) {
  // Half of them are bytes, half are true messages with some bytes changed.
  std::mt19937 random(7);
  const std::string link = names.links.back();
  const std::string whole = "{\"id\": 3, \"grab\": {\"link\": \"" + link +
                            "\", \"point\": [0, 0.5, -1e3], \"target\": [1, 2, 3]}}";
  int taken = 0;
  for (int i = 0; i < 100000; ++i) {
    std::string text;
    if (i % 2 == 0) {
      text.resize(random() % 200);
      for (char& c : text) c = static_cast<char>(random());
    } else {
      text = whole;
      for (unsigned k = random() % 3; k-- > 0;)
        text[random() % text.size()] = static_cast<char>(random());
      if (random() % 4 == 0) text.resize(random() % (text.size() + 1));
    }
    const auto read = readMessage(text, names);
    if (const auto* asked = std::get_if<Asked>(&read)) {
      ++taken;
      EXPECT_EQ(problemOf(asked->event, names), "");
      EXPECT_TRUE(asked->event.maybeVector("target").value_or(Vector3::Zero()).allFinite());
    } else {
      EXPECT_FALSE(std::get<Refused>(read).reason.empty());
    }
    EXPECT_FALSE(answer(1, text).empty());
  }
  EXPECT_GT(taken, 1000);  // those that were not changed
}

}  // namespace
}  // namespace softgauss::live
