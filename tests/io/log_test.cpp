// SPDX-License-Identifier: Apache-2.0
#include "io/log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>

#include "engine/model/model_builder.hpp"
#include "io/detail/csv.hpp"
#include "io/detail/text.hpp"
#include "io/torque_table.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {
namespace {

/// A floating base with one hinge whose name needs quotes, and one that is not actuated.
Model sampleModel() {
  ModelBuilder builder("log");
  for (const char* name : {"base", "arm", "hand"}) {
    LinkSpec link;
    link.name = name;
    link.mass = 1.0;
    link.I_Lcm = Matrix3::Identity();
    builder.link(link);
  }
  JointSpec joint;
  joint.name = "left, \"elbow\"";
  joint.type = JointType::revolute;
  joint.parent = "base";
  joint.child = "arm";
  builder.joint(joint);
  joint.name = "wrist";
  joint.type = JointType::prismatic;
  joint.parent = "arm";
  joint.child = "hand";
  joint.effort = 0.0;
  builder.joint(joint);
  return builder.build();
}

StepRecord randomRecord(const Model& m, std::mt19937_64& random) {
  const auto number = [&] {
    for (;;) {
      const double x = std::bit_cast<double>(random());
      if (std::isfinite(x)) return x;
    }
  };
  StepRecord r;
  r.q = VectorX::NullaryExpr(m.nq, number);
  r.v = VectorX::NullaryExpr(m.nv, number);
  r.a = VectorX::NullaryExpr(m.nv, number);
  r.u = VectorX::NullaryExpr(m.nv, number);
  r.contacts = static_cast<int>(random() % 100);
  r.energy = number();
  r.maxPenetration = number();
  return r;
}

TEST(Log, ColumnsAreThoseOfTheInterface) {
  const std::vector<std::string> expected = {"time_s",
                                             "q:base.x",
                                             "q:base.y",
                                             "q:base.z",
                                             "q:base.qw",
                                             "q:base.qx",
                                             "q:base.qy",
                                             "q:base.qz",
                                             "q:left, \"elbow\"",
                                             "q:wrist",
                                             "v:base.vx",
                                             "v:base.vy",
                                             "v:base.vz",
                                             "v:base.wx",
                                             "v:base.wy",
                                             "v:base.wz",
                                             "v:left, \"elbow\"",
                                             "v:wrist",
                                             "a:base.vx",
                                             "a:base.vy",
                                             "a:base.vz",
                                             "a:base.wx",
                                             "a:base.wy",
                                             "a:base.wz",
                                             "a:left, \"elbow\"",
                                             "a:wrist",
                                             "u:left, \"elbow\"",
                                             "u:wrist",
                                             "contacts",
                                             "constraints",
                                             "iterations",
                                             "dual_updates",
                                             "physics_violation",
                                             "gdd_violation",
                                             "stationarity",
                                             "forward_us",
                                             "gdd_us",
                                             "step_us",
                                             "energy_J",
                                             "max_penetration_m"};
  EXPECT_EQ(logColumns(sampleModel()), expected);
}

/// A floating link "a" that carries another on a joint "a".
ModelBuilder sameNames(JointType type) {
  ModelBuilder builder("names");
  for (const char* name : {"a", "b"}) {
    LinkSpec link;
    link.name = name;
    link.mass = 1.0;
    link.I_Lcm = Matrix3::Identity();
    builder.link(link);
  }
  JointSpec joint;
  joint.name = "a";
  joint.type = type;
  joint.parent = "a";
  joint.child = "b";
  return builder.joint(joint);
}

TEST(Log, ColumnsHaveNamesOfTheirOwn) {
  for (const JointType type : {JointType::planar, JointType::revolute}) {
    const Model model = sameNames(type).build();
    const std::vector<std::string> columns = logColumns(model);
    EXPECT_EQ(std::set<std::string>(columns.begin(), columns.end()).size(), columns.size());
    const auto has = [&](const char* name) {
      return std::find(columns.begin(), columns.end(), name) != columns.end();
    };
    EXPECT_TRUE(has(type == JointType::planar ? "q:a(floating).x" : "q:a.x"));
    EXPECT_TRUE(has(type == JointType::planar ? "q:a.x" : "q:a"));
  }
  EXPECT_EQ(sameNames(JointType::revolute).build().findJoint("a"), 2)
      << "the joint, not the link that floats";
}

TEST(Log, ReadsBackBitForBit) {
  const Model m = sampleModel();
  const TempFolder folder;
  const auto file = folder.path() / "log.csv";
  std::mt19937_64 random(7);
  std::vector<StepRecord> records;
  LogWriter writer(file, m);
  for (int i = 0; i < 500; ++i) {
    records.push_back(randomRecord(m, random));
    records.back().time = 0.002 * i;
    writer.write(records.back());
  }
  writer.close();

  const std::string text = detail::readFile(file.string()).value();
  detail::CsvReader reader(text);
  EXPECT_EQ(*reader.next(), logColumns(m));
  for (const StepRecord& r : records) {
    const std::vector<std::string>* fields = reader.next();
    ASSERT_NE(fields, nullptr);
    std::vector<double> expected = {r.time};
    expected.insert(expected.end(), r.q.begin(), r.q.end());
    expected.insert(expected.end(), r.v.begin(), r.v.end());
    expected.insert(expected.end(), r.a.begin(), r.a.end());
    expected.insert(expected.end(), r.u.begin() + 6, r.u.end());
    ASSERT_EQ(fields->size(), expected.size() + 12);
    for (std::size_t i = 0; i < expected.size(); ++i)
      ASSERT_EQ(std::bit_cast<std::uint64_t>(detail::parseNumber((*fields)[i]).value()),
                std::bit_cast<std::uint64_t>(expected[i]));
    EXPECT_EQ(detail::parseNumber((*fields)[expected.size()]), r.contacts);
    EXPECT_EQ(detail::parseNumber(fields->back()), r.maxPenetration);
  }
  EXPECT_EQ(reader.next(), nullptr);
}

TEST(Log, IsOnDiskAfterFlushAndAtTheEndOfTheWriter) {
  const Model m = sampleModel();
  const TempFolder folder;
  const auto file = folder.path() / "log.csv";
  const auto lines = [&] {
    const std::string text = detail::readFile(file.string()).value();
    return std::count(text.begin(), text.end(), '\n');
  };
  std::mt19937_64 random(7);
  {
    LogWriter writer(file, m);
    writer.write(randomRecord(m, random));
    writer.flush();
    EXPECT_EQ(lines(), 2);
    writer.write(randomRecord(m, random));
  }
  EXPECT_EQ(lines(), 3);
}

TEST(Log, ThatCannotBeWrittenIsRefused) {
  EXPECT_THROW(LogWriter("no/such/folder/log.csv", sampleModel()), ModelError);
}

TEST(TorqueTable, ReadsALogAndHoldsEachRow) {
  const Model m = sampleModel();
  const TempFolder folder;
  const auto file = folder.path() / "log.csv";
  std::mt19937_64 random(3);
  std::vector<double> torques;
  double time = 0.0;
  {
    LogWriter writer(file, m);
    for (int i = 0; i < 200; ++i, time += 0.002) {
      StepRecord r = randomRecord(m, random);
      r.time = time;
      r.u[7] = 0.0;
      torques.push_back(r.u[6]);
      writer.write(r);
    }
  }
  const TorqueTable table = TorqueTable::read(file, m);
  ASSERT_EQ(table.rows(), torques.size());
  VectorX u;
  for (std::size_t i = 0; i < torques.size(); ++i) {
    const double t = 0.002 * static_cast<double>(i);  // other rounding than the sum above
    table.controlAt(t, u);
    ASSERT_EQ(u.size(), m.nv);
    EXPECT_EQ(u[6], torques[i]);
    table.controlAt(t + 0.0019, u);
    EXPECT_EQ(u[6], torques[i]);
  }
  table.controlAt(-1.0, u);
  EXPECT_TRUE(u.isZero(0.0));
  table.controlAt(1e6, u);
  EXPECT_EQ(u[6], torques.back());
}

TEST(TorqueTable, MayBeginWithAByteOrderMark) {
  const TempFolder folder;
  const TorqueTable table = TorqueTable::read(
      folder.write("u.csv", "\xEF\xBB\xBFtime_s,\"u:left, \"\"elbow\"\"\"\n0,3\n"), sampleModel());
  VectorX u;
  table.controlAt(0.0, u);
  EXPECT_EQ(u[6], 3.0);
}

std::string torqueErrorOf(const std::string& text) {
  const TempFolder folder;
  const std::string file = folder.write("u.csv", text).string();
  try {
    TorqueTable::read(file, sampleModel());
  } catch (const ModelError& error) {
    return std::string(error.what()).substr(file.size() - 5);
  }
  return "no error";
}

TEST(TorqueTable, ErrorsNameFileLineAndColumn) {
  EXPECT_EQ(torqueErrorOf(""), "u.csv:1: header: is missing, expected time_s and u:<joint>");
  EXPECT_EQ(torqueErrorOf("u:wrist\n"), "u.csv:1: header: has no column time_s");
  EXPECT_EQ(torqueErrorOf("time_s,q:wrist\n"), "u.csv:1: header: has no column u:<joint>");
  EXPECT_EQ(torqueErrorOf("time_s,u:wirst\n"),
            "u.csv:1: column 'u:wirst': model 'log' has no joint 'wirst' with a control, did you "
            "mean 'wrist'?");
  EXPECT_EQ(torqueErrorOf("time_s,u:wrist\n"), "u.csv:1: file: has no row below the header");
  EXPECT_EQ(torqueErrorOf("time_s,u:wrist\n\n0,1,2\n"),
            "u.csv:3: row: has 3 fields, expected 2 as the header");
  EXPECT_EQ(torqueErrorOf("time_s,u:wrist\n0,1e\n"),
            "u.csv:2: column 'u:wrist': '1e' is not a finite number");
  EXPECT_EQ(torqueErrorOf("time_s,u:wrist\n0,nan\n"),
            "u.csv:2: column 'u:wrist': 'nan' is not a finite number");
  EXPECT_EQ(torqueErrorOf("time_s,u:wrist\n0,0\n0,0\n"),
            "u.csv:3: column 'time_s': 0 follows 0, expected rising times");
  EXPECT_EQ(torqueErrorOf("time_s,u:wrist\n0,2\n"),
            "u.csv:2: column 'u:wrist': is 2, but the joint is not actuated, expected 0");
  EXPECT_EQ(torqueErrorOf("time_s,u:wrist,u:wrist\n0,0,0\n"),
            "u.csv:1: column 'u:wrist': is there twice");
}

}  // namespace
}  // namespace softgauss::io
