// SPDX-License-Identifier: Apache-2.0
// Events in files: what is written is read, and what is wrong is named with its line and key.

#include "apps/live/event_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "softgauss/io/urdf.hpp"
#include "tests/io/temp_folder.hpp"

namespace softgauss::live {
namespace {

class LiveEventFile : public testing::Test {
 protected:
  LiveEventFile()
      : model(io::readUrdf(SOFTGAUSS_SOURCE_DIR "/data/robots/arm.urdf", {}).build()),
        names(model, goals),
        link(names.links.back()) {
    names.states = {"half sitting"};
  }

  std::string problemOf(const std::string& text) const {
    const std::string file = (folder.path() / "events.yaml").string();
    std::ofstream(file) << text;
    try {
      readEvents(file, names, 0.002);
    } catch (const ModelError& error) {
      return error.what();
    }
    return "";
  }

  Model model;
  std::vector<std::unique_ptr<gdd::Goal>> goals;
  Names names;
  std::string link;
  io::TempFolder folder;
};

Event event(EventKind kind, long step, std::vector<std::pair<std::string, FieldValue>> fields) {
  Event e;
  e.kind = kind;
  e.step = step;
  e.fields = std::move(fields);
  return e;
}

TEST_F(LiveEventFile, GivesBackEveryKindBitForBit) {
  // A value of each field of each kind, numbers that no short decimal holds.
  std::vector<Event> written;
  for (const EventType& type : eventTypes()) {
    Event e;
    e.kind = type.kind;
    e.step = 10 * static_cast<long>(type.kind);
    for (const Field& field : type.fields) {
      const double third = std::max(field.least, std::min(field.most, 1.0 / 3.0));
      switch (field.kind) {
        case FieldKind::link:
          e.fields.emplace_back(field.name, link);
          break;
        case FieldKind::joint:
          e.fields.emplace_back(field.name, names.joints[0].name);
          break;
        case FieldKind::effect:
          e.fields.emplace_back(field.name, names.effects.at(0));
          break;
        case FieldKind::state:
          e.fields.emplace_back(field.name, names.states.at(0));
          break;
        case FieldKind::goal:
          e.fields.emplace_back(field.name, std::string());
          break;
        case FieldKind::number:
          e.fields.emplace_back(field.name, third);
          break;
        case FieldKind::boolean:
          e.fields.emplace_back(field.name, true);
          break;
        case FieldKind::vector:
          e.fields.emplace_back(field.name, Vector3(1.0 / 3.0, -1e-17, 2.5));
          break;
      }
    }
    if (type.kind != EventKind::goal && type.kind != EventKind::target)
      written.push_back(e);  // the arm has none here
  }
  const std::string file = (folder.path() / "drag.yaml").string();
  names.modelName = "it's an arm: #1";
  EventWriter writer(file, names.modelName, 0.002);
  for (const Event& e : written) writer.write(e);
  writer.finish(777);

  const EventFile read = readEvents(file, names, 0.002);
  EXPECT_EQ(read.steps, 777);
  ASSERT_EQ(read.events.size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    EXPECT_EQ(read.events[i].kind, written[i].kind);
    EXPECT_EQ(read.events[i].step, written[i].step);
    EXPECT_TRUE(read.events[i].fields == written[i].fields) << eventText(written[i]);
  }
}

TEST_F(LiveEventFile, WithoutEventsIsOne) {
  const std::string file = (folder.path() / "drag.yaml").string();
  EventWriter writer(file, names.modelName, 0.002);
  writer.finish(5);
  const EventFile read = readEvents(file, names, 0.002);
  EXPECT_EQ(read.steps, 5);
  EXPECT_TRUE(read.events.empty());
}

TEST_F(LiveEventFile, NamesLineAndKeyOfWhatIsWrong) {
  const std::string head = "timestep: 0.002\nsteps: 100\nevents:\n";
  const std::pair<std::string, std::vector<std::string>> cases[] = {
      {"", {"is empty"}},
      {"- 1\n", {"expected steps"}},
      {"steps: 1\nevents: []\n", {"timestep"}},
      {"model: humanoid\ntimestep: 0.002\nsteps: 1\nevents: []\n",
       {":1:", "'model'", "humanoid", "'" + names.modelName + "'"}},
      {"timestep: 0.001\nsteps: 1\nevents: []\n", {":1:", "0.001", "0.002"}},
      {head + "  - {step: 3, fly: {}}\n", {":4:", "event 1", "fly"}},
      {head + "  - {step: 3}\n", {":4:", "event 1", "one"}},
      {head + "  - {step: 3, reset: {}, release: {}}\n", {":4:", "2 keys"}},
      {head + "  - {step: 3.5, reset: {}}\n", {":4:", "'step'", "whole"}},
      {head + "  - {step: -1, reset: {}}\n", {":4:", "'step'"}},
      {head + "  - {step: 9, reset: {}}\n  - {step: 8, reset: {}}\n",
       {":5:", "event 2", "9 or more"}},
      {head + "  - {step: 101, reset: {}}\n", {":2:", "'steps'"}},
      {head + "  - {step: 1, pause: {}}\n", {":4:", "pause.on"}},
      {head + "  - {step: 1, pause: {on: perhaps}}\n", {":4:", "pause.on"}},
      {head + "  - {step: 1, pause: {on: true, off: false}}\n", {":4:", "pause.off"}},
      {head + "  - {step: 1, move: {target: [0, 0, .inf]}}\n", {":4:", "move.target"}},
      {head + "  - {step: 1, move: {target: [0, 0, 1e9]}}\n", {":4:", "move.target", "[m]"}},
      {head + "  - step: 1\n    grab:\n      link: nobody\n      point: [0, 0, 0]\n      target: "
              "[0, 0, 0]\n",
       {":6:", "grab.link", "nobody"}},
      {head + "  - {step: 1, factor: {value: 0}}\n", {":4:", "factor.value", "0.01"}},
  };
  for (const auto& [text, parts] : cases) {
    const std::string problem = problemOf(text);
    EXPECT_NE(problem.find("events.yaml:"), std::string::npos) << text << " -> " << problem;
    for (const std::string& part : parts)
      EXPECT_NE(problem.find(part), std::string::npos) << text << " -> " << problem;
  }
}

TEST_F(LiveEventFile, TextIsWhatAFileHolds) {
  EXPECT_EQ(eventText(event(EventKind::move, 12, {{"target", Vector3(0.5, 0, -1)}})),
            "{step: 12, move: {target: [0.5, 0, -1]}}");
}

}  // namespace
}  // namespace softgauss::live
