// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/torque_table.hpp"

#include <gtest/gtest.h>

#include "sample_log.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {
namespace {

TEST(TorqueTable, ReadsALogAndHoldsEachRow) {
  const Model m = logModel();
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
      // Any bits, of a size that tables may have.
      while (!(std::abs(r.u[6]) <= 1e12)) r.u[6] = randomRecord(m, random).u[6];
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

std::string torqueErrorOf(const std::string& text) {
  const TempFolder folder;
  const std::string file = folder.write("u.csv", text).string();
  try {
    TorqueTable::read(file, logModel());
  } catch (const ModelError& error) {
    return std::string(error.what()).substr(file.size() - 5);
  }
  return "no error";
}

// A log ends in a state that no control was found for: none acts from there on.
TEST(TorqueTable, EndsWhereALogDoes) {
  const TempFolder folder;
  const TorqueTable table = TorqueTable::read(
      folder.write("u.csv", "time_s,u:wrist,\"u:left, \"\"elbow\"\"\"\n0,0,3\n1,,\n"), logModel());
  VectorX u;
  table.controlAt(0.9, u);
  EXPECT_EQ(u[6], 3.0);
  table.controlAt(1.0, u);
  EXPECT_TRUE(u.isZero(0.0));
  EXPECT_EQ(torqueErrorOf("time_s,u:wrist\n0,\n1,0\n"),
            "u.csv:2: row: has no control, expected only of the last row");
}

TEST(TorqueTable, MayBeginWithAByteOrderMark) {
  const TempFolder folder;
  const TorqueTable table = TorqueTable::read(
      folder.write("u.csv", "\xEF\xBB\xBFtime_s,\"u:left, \"\"elbow\"\"\"\n0,3\n"), logModel());
  VectorX u;
  table.controlAt(0.0, u);
  EXPECT_EQ(u[6], 3.0);
}

TEST(TorqueTable, ErrorsNameFileLineAndColumn) {
  EXPECT_EQ(torqueErrorOf(""), "u.csv:1: header: is missing, expected time_s and u:<joint>");
  EXPECT_EQ(torqueErrorOf("u:wrist\n"), "u.csv:1: header: has no column time_s");
  EXPECT_EQ(torqueErrorOf("time_s,q:wrist\n"), "u.csv:1: header: has no column u:<joint>");
  EXPECT_EQ(torqueErrorOf("time_s,u:wirst\n"),
            "u.csv:1: column 'u:wirst': model 'log' has no joint 'wirst' with a control, did you "
            "mean 'wrist'? there are: left, \"elbow\", wrist");
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
