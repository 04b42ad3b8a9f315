// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/replay/plot.hpp"

#include <cstdio>
#include <sstream>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/text.hpp"
#include "tests/io/replay/recorded_run.hpp"
#include "tests/io/temp_folder.hpp"

namespace softgauss::test {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// A hinge with a range of ± limit that turns at constant speed from one angle to another.
struct HingeRecording {
  HingeRecording(double from, double to, double limit, int steps = 100)
      : model(hinge(limit)),
        recording(
            std::make_unique<io::Recording>(model, std::vector<std::unique_ptr<gdd::Goal>>{},
                                            gdd::GoalContext{model, State(model), Data(model)})) {
    State state(model);
    Data data(model);
    io::StepRecord r;
    r.a = r.u = r.v = VectorX::Zero(1);
    for (int i = 0; i <= steps; ++i) {
      state.time = r.time = 0.002 * i;
      state.q[0] = from + (to - from) * i / steps;
      r.q = state.q;
      computeStages(model, {}, state, data, nullptr);
      if (i < steps)
        recording->addStep(r, data);
      else
        recording->finish(r, data);
    }
  }
  static Model hinge(double limit) {
    ModelBuilder builder = pendulum(0.5, 1.0, 0.1);
    JointSpec& joint = *builder.findJoint("hinge");
    joint.type = JointType::revolute;
    joint.lower = -limit;
    joint.upper = limit;
    return builder.build();
  }

  Model model;
  std::unique_ptr<io::Recording> recording;
};

TEST(Plot, OneFileHoldsEveryGroupWithItsUnit) {
  const RecordedRun run(200);
  const io::TempFolder folder;
  const std::string file = folder.path() / "run.svg";
  io::Plot(file).write(*run.recording);
  const std::string svg = *io::detail::readFile(file);
  EXPECT_EQ(svg.rfind("<?xml", 0), 0u);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  for (const io::CurveGroup& group : run.recording->plots()) {
    const std::string heading =
        group.unit.empty() ? group.name : group.name + " [" + group.unit + "]";
    EXPECT_EQ(count(svg, heading + " over time [s]"), 1u) << heading;
    for (const io::Curve& curve : group.curves) EXPECT_GE(count(svg, curve.name), 1u) << curve.name;
  }
}

TEST(Plot, AFolderGetsAFileForEachGroup) {
  const RecordedRun run(50);
  const io::TempFolder folder;
  io::Plot(folder.path() / "plots").write(*run.recording);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "plots")) {
    EXPECT_EQ(entry.path().extension(), ".svg");
    EXPECT_NE(io::detail::readFile(entry.path())->find("</svg>"), std::string::npos);
    ++files;
  }
  EXPECT_EQ(files, run.recording->plots().size());
}

// Names come from files: quotes and line breaks of a name stay in its text.
TEST(Plot, NamesCannotLeaveTheirQuotes) {
  RecordedRun run(20);
  run.recording->command = "it's 'quoted'\nand broken";
  const std::string script = io::plotScript(*run.recording, run.recording->plots());
  EXPECT_NE(script.find("'it''s ''quoted'' and broken'"), std::string::npos);
}

// A curve is drawn at its own scale: a limit far beyond it would make it a flat line, one that is
// near, or passed, is what one looks for.
TEST(Plot, LimitsAreMarkedWhereTheyAreNear) {
  const auto near = [](double lower, double upper, double least, double greatest) {
    const io::NearLimits n({"", 0, lower, upper}, least, greatest);
    return std::pair{n.lower, n.upper};
  };
  using Marks = std::pair<bool, bool>;
  EXPECT_EQ(near(-87.0, 87.0, -1.0, 3.0), Marks(false, false)) << "a strong motor at little work";
  EXPECT_EQ(near(-87.0, 87.0, -1.0, 87.0), Marks(true, true)) << "it saturates, over half its span";
  EXPECT_EQ(near(-87.0, 87.0, 60.0, 87.0), Marks(false, true));
  EXPECT_EQ(near(-1.0, 1.0, 1.0004, 1.0005), Marks(false, true)) << "it hangs in its limit";
  EXPECT_EQ(near(-1.0, 1.0, 0.97, 0.97), Marks(false, true)) << "within 2 % of the range";
  EXPECT_EQ(near(-1.0, 1.0, 0.0, 0.0), Marks(false, false)) << "it rests in the middle";
  EXPECT_EQ(near(-kInfinity, 2.0, 0.0, 1.5), Marks(false, true)) << "one limit alone";
  EXPECT_EQ(near(-kInfinity, kInfinity, 0.0, 1.5), Marks(false, false));
  const double none = kInfinity;
  EXPECT_EQ(near(-1.0, 1.0, none, -none), Marks(false, false)) << "no value at all";
}

// The drawing of a swing of 0.3 rad in a range of 6 is as tall as the swing.
TEST(Plot, ScalesToItsData) {
  const double low = -0.1, high = 0.2;
  const auto rangeOf = [&](double limit) {
    const HingeRecording run(low, high, limit);
    const std::string script = io::plotScript(*run.recording, run.recording->plots());
    double from = 0.0, to = 0.0;
    EXPECT_EQ(
        std::sscanf(script.c_str() + script.find("set yrange"), "set yrange [%lf:%lf]", &from, &to),
        2);
    return std::pair{from, to};
  };
  const auto [from, to] = rangeOf(3.0);
  EXPECT_NEAR(to - from, 1.12 * (high - low), 1e-3);
  const auto [lower, upper] = rangeOf(0.25);
  EXPECT_LE(lower, -0.25);
  EXPECT_GE(upper, 0.25);
}

// From least and greatest of a bucket to the drawing: what falls steadily falls on paper.
TEST(Plot, AFallingRampIsDrawnFalling) {
  const HingeRecording run(1.0, -1.0, 3.0, 25000);
  const std::string script = io::plotScript(*run.recording, run.recording->plots());
  std::istringstream data(script.substr(script.find('\n', script.find("$group0")) + 1));
  double time = 0.0, value = 0.0, lastTime = -1.0, last = kInfinity;
  int entries = 0;
  while (data >> time >> value) {
    EXPECT_GE(time, lastTime);
    EXPECT_LE(value, last) << "at " << time;
    lastTime = time;
    last = value;
    ++entries;
  }
  EXPECT_GT(entries, 600);
  EXPECT_LE(entries, 1202);
}

TEST(Plot, OtherFormatsAndPlacesAreRefused) {
  const io::TempFolder folder;
  EXPECT_THROW(io::Plot(folder.path() / "run.png"), ModelError);
  EXPECT_THROW(io::Plot(folder.path() / "no" / "folder" / "run.svg"), ModelError);
}

}  // namespace
}  // namespace softgauss::test
