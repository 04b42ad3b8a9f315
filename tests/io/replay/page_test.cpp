// SPDX-License-Identifier: Apache-2.0
/// The payload of a page is the run; the page is the template with the payload.

#include "softgauss/io/replay/page.hpp"

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/text.hpp"
#include "tests/io/replay/payload_reader.hpp"
#include "tests/io/replay/recorded_run.hpp"
#include "tests/io/temp_folder.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

PayloadReader payloadOf(const RecordedRun& run) {
  return PayloadReader(io::replayPayload(*run.recording, "softgauss test"));
}

Vector3 vectorAt(const std::vector<float>& track, std::size_t at) {
  return {track[at], track[at + 1], track[at + 2]};
}

/// A curve of the run, from the log's record.
std::pair<bool, double> valueOf(const std::string& curve, const io::StepRecord& r) {
  if (curve == "body.x") return {true, r.q[0]};
  if (curve == "total") return {true, r.energy};
  if (curve == "rows") return {true, r.constraints};
  if (curve == "reach body") return {true, (Vector3(1, 2, 3) - r.q.head<3>()).norm()};
  return {false, 0.0};
}

// Single precision near the origin of the frames: 1e-6 m, however far out the scene is.
TEST(ReplayPayload, PosesAreThoseOfTheStates) {
  for (const Vector3& place : {Vector3(0, 0, 0), Vector3(40003.0, -70001.0, 0.0)}) {
    const RecordedRun run(500, place);
    const PayloadReader payload = payloadOf(run);
    const auto times = payload.array<double>("frame_time");
    const auto poses = payload.array<float>("pose"), velocities = payload.array<float>("velocity");
    const std::vector<double> origin = payload.header["origin"];
    const Vector3 p_WOrigin(origin[0], origin[1], origin[2]);
    ASSERT_EQ(payload.header["frames"]["count"], times.size());
    std::size_t step = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      while (step + 1 < run.states.size() && run.states[step].time < times[i]) ++step;
      const State& state = run.states[step];
      ASSERT_EQ(state.time, times[i]) << "a frame is a recorded state";
      const std::size_t at = 7 * (2 * i + 1);  // two bodies, the second one moves
      EXPECT_SMALL((vectorAt(poses, at) + p_WOrigin - state.q.head<3>()).norm(), 1e-6);
      const Quaternion shown(poses[at + 3], poses[at + 4], poses[at + 5], poses[at + 6]);
      const Quaternion q(state.q[3], state.q[4], state.q[5], state.q[6]);
      EXPECT_SMALL(1.0 - std::abs(shown.dot(q)), 1e-6);
      EXPECT_APPROX(vectorAt(velocities, 6 * (2 * i + 1)), state.v.head<3>(), 1e-6);
      EXPECT_APPROX(vectorAt(velocities, 6 * (2 * i + 1) + 3), q * state.v.tail<3>(), 1e-6);
    }
  }
}

TEST(ReplayPayload, HasAFrameAtTheStartAtTheEndAndSixtyASecondBetween) {
  const RecordedRun run(500);
  const auto times = payloadOf(run).array<double>("frame_time");
  EXPECT_EQ(times.front(), 0.0);
  EXPECT_EQ(times.back(), run.states.back().time);
  EXPECT_EQ(times.size(), 61u);
  for (std::size_t i = 1; i + 1 < times.size(); ++i) EXPECT_LT(times[i] - i / 60.0, 0.002);
}

TEST(ReplayPayload, ContactsCarryTheBoxAndPointAtTheirGeometries) {
  const RecordedRun run(2000);
  const PayloadReader payload = payloadOf(run);
  const auto start = payload.array<std::uint32_t>("contact_start");
  const auto force = payload.array<float>("contact_force"),
             point = payload.array<float>("contact_point");
  const auto geometry = payload.array<std::uint32_t>("contact_geometry");
  const std::size_t frames = payload.header["frames"]["count"];
  ASSERT_EQ(start.size(), frames + 1);
  Vector3 last = Vector3::Zero();
  for (std::size_t c = start[frames - 1]; c < start[frames]; ++c) {
    const bool onBody = payload.header["geometries"][geometry[2 * c + 1]]["link"] == "body";
    last += (onBody ? 1.0 : -1.0) * vectorAt(force, 3 * c);
    EXPECT_NEAR(point[3 * c + 2], 0.0, 1e-3);
  }
  EXPECT_NEAR(last.z(), 2.0 * 9.81, 1e-3);  // at rest it is carried
}

TEST(ReplayPayload, SeriesAreTheLogAndNamesAreTheModels) {
  const RecordedRun run(300);
  const PayloadReader payload = payloadOf(run);
  EXPECT_EQ(payload.header["bodies"][1]["name"], "body");
  EXPECT_EQ(payload.header["goals"].size(), 1u) << "virtual damping is no place";
  EXPECT_EQ(payload.header["goals"][0]["name"], "reach body");
  const auto times = payload.array<double>("series_time");
  ASSERT_EQ(times.size(), 301u) << "every step and the end";
  std::set<std::string> groups;
  int compared = 0;
  for (const auto& group : payload.header["series"]["groups"]) {
    groups.insert(group["name"]);
    for (const auto& curve : group["curves"]) {
      const bool isDouble =
          payload.header["arrays"][curve["values"].get<std::string>()]["type"] == "f64";
      std::vector<double> values;
      if (isDouble)
        values = payload.array<double>(curve["values"]);
      else
        for (const float x : payload.array<float>(curve["values"])) values.push_back(x);
      ASSERT_EQ(values.size(), times.size());
      for (std::size_t i = 0; i + 1 < times.size(); ++i) {
        const io::StepRecord& r = run.records[i];
        EXPECT_EQ(times[i], r.time);
        const auto [known, expected] = valueOf(curve["name"], r);
        if (!known) continue;
        EXPECT_EQ(static_cast<float>(values[i]), static_cast<float>(expected)) << curve["name"];
        ++compared;
      }
    }
  }
  for (const char* name : {"Floating bases", "Contact normal forces", "Goal errors", "Energy",
                           "Constraints and iterations"})
    EXPECT_EQ(groups.count(name), 1u) << name;
  EXPECT_EQ(compared, 4 * 300);
  EXPECT_EQ(groups.count("Controls"), 0u) << "nothing is controlled";
}

// A run may last for hours.
TEST(FrameTrack, HalvesItsRateWhenItIsFull) {
  Snapshot snapshot;
  snapshot.X_WB.resize(2);
  snapshot.velocity.assign(2, Vector3::Zero());
  snapshot.angularVelocity.assign(2, Vector3::Zero());
  io::FrameTrack track(2, 0, 10000);
  for (int i = 0; i < 20000; ++i) {
    snapshot.time = 0.002 * i;
    if (!track.due(snapshot.time)) continue;
    snapshot.X_WB[1].p.x() = snapshot.time;
    snapshot.contacts.assign(static_cast<std::size_t>(track.count() % 3), {});
    for (auto& c : snapshot.contacts) c.p_WC.x() = snapshot.time;
    track.add(snapshot, {});
  }
  EXPECT_LT(track.count(), 200);
  EXPECT_GT(track.count(), 30);
  ASSERT_EQ(track.contactStart.size(), track.time.size() + 1);
  EXPECT_EQ(track.contactStart.back(), track.contactGeometry.size() / 2);
  for (int i = 0; i < track.count(); ++i) {
    EXPECT_FLOAT_EQ(track.pose[static_cast<std::size_t>(14 * i + 7)], track.time[i]);
    for (std::uint32_t c = track.contactStart[i]; c < track.contactStart[i + 1]; ++c)
      EXPECT_FLOAT_EQ(track.contactPoint[3 * c], track.time[i]);
  }
  for (int i = 1; i < track.count(); ++i)
    EXPECT_NEAR(track.time[i] - track.time[i - 1], track.time[1] - track.time[0], 0.0021);
}

TEST(ReplayPage, HoldsThePayloadCompressed) {
  RecordedRun run(100);
  run.recording->command = "simulate_gdd <robot> & more";
  const io::TempFolder folder;
  const std::string file = folder.path() / "run.html";
  io::ReplayPage(file).write(*run.recording, "softgauss test");
  const std::string page = *io::detail::readFile(file);
  EXPECT_EQ(page.find("@@SOFTGAUSS"), std::string::npos) << "every place is filled";
  EXPECT_NE(page.find("<title>"), std::string::npos);
  EXPECT_TRUE(payloadOfPage(page) == io::replayPayload(*run.recording, "softgauss test"));
}

TEST(ReplayPage, IsRefusedWhereItCannotBeWritten) {
  const io::TempFolder folder;
  EXPECT_THROW(io::ReplayPage(folder.path() / "no" / "folder" / "run.html"), ModelError);
}

}  // namespace
}  // namespace softgauss::test
