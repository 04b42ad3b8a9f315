// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <set>

#include "sample_log.hpp"
#include "softgauss/io/contact_log.hpp"
#include "softgauss/io/detail/csv.hpp"
#include "softgauss/io/detail/text.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {
namespace {

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
                                             "max_penetration_m",
                                             "error:reach hand [m]",
                                             "error:posture [rad]",
                                             "error:reach hand [m]#2",
                                             "com.x",
                                             "com.y",
                                             "com.z",
                                             "cop.x",
                                             "cop.y",
                                             "cop.z",
                                             "momentum.x",
                                             "momentum.y",
                                             "momentum.z",
                                             "angular_momentum.x",
                                             "angular_momentum.y",
                                             "angular_momentum.z",
                                             "f:arm.x",
                                             "f:arm.y",
                                             "f:arm.z"};
  EXPECT_EQ(logColumns(touchingLogModel(), {"reach hand [m]", "posture [rad]", "reach hand [m]"}),
            expected);
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
  const Model m = logModel();
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
    ASSERT_EQ(fields->size(), expected.size() + 24);
    for (std::size_t i = 0; i < expected.size(); ++i)
      ASSERT_EQ(std::bit_cast<std::uint64_t>(detail::parseNumber((*fields)[i]).value()),
                std::bit_cast<std::uint64_t>(expected[i]));
    EXPECT_EQ(detail::parseNumber((*fields)[expected.size()]), r.contacts);
    EXPECT_EQ(detail::parseNumber((*fields)[expected.size() + 11]), r.maxPenetration);
    EXPECT_EQ(detail::parseNumber(fields->back()), r.angularMomentum.z());
  }
  EXPECT_EQ(reader.next(), nullptr);
}

// A row of what touches: forces by link, action and reaction, and what has no value is empty.
TEST(Log, TellsForcesGoalsAndTheWhole) {
  const Model m = touchingLogModel();
  const TempFolder folder;
  const auto file = folder.path() / "log.csv";
  std::mt19937_64 random(7);
  StepRecord r = randomRecord(m, random);
  const Vector3 push(1.0, 2.0, 3.0);
  std::vector<Snapshot::ContactForce> contacts(3);
  contacts[0] = {1, 0, Vector3::Zero(), Vector3::UnitZ(), push};         // world on arm
  contacts[1] = {2, 1, Vector3::Zero(), Vector3::UnitZ(), 0.5 * push};   // arm on world
  contacts[2] = {0, 2, Vector3::Zero(), Vector3::UnitZ(), 10.0 * push};  // the arm on itself
  const ContactLinks links(m);
  ASSERT_EQ(links.names(), std::vector<std::string>{"arm"});
  links.forces(contacts, r.linkForces);
  EXPECT_EQ(r.linkForces, 0.5 * push);
  r.goalErrors = Eigen::Vector2d(0.25, NAN);
  r.momentum = push;
  LogWriter writer(file, m, {"a [m]", "b [N]"});
  writer.write(r);
  r.isEnd = true;
  writer.write(r);
  writer.close();

  const std::string text = detail::readFile(file.string()).value();
  detail::CsvReader reader(text);
  const std::vector<std::string> header = *reader.next();
  const auto fieldsOf = [&](const std::vector<std::string>& row) {
    std::map<std::string, std::string> fields;
    for (std::size_t i = 0; i < header.size(); ++i) fields[header[i]] = row.at(i);
    return fields;
  };
  auto row = fieldsOf(*reader.next());
  EXPECT_EQ(row["f:arm.y"], "1");
  EXPECT_EQ(row["error:a [m]"], "0.25");
  EXPECT_EQ(row["error:b [N]"], "") << "it has none now";
  EXPECT_EQ(row["cop.x"], "") << "the world carries nothing";
  EXPECT_EQ(row["momentum.z"], "3");
  EXPECT_NE(row["u:wrist"], "");
  row = fieldsOf(*reader.next());
  for (const char* column :
       {"a:base.vx", "u:wrist", "iterations", "physics_violation", "step_us", "f:arm.x", "cop.z"})
    EXPECT_EQ(row[column], "") << column << ": no step was taken from the state at the end";
  for (const char* column : {"time_s", "q:wrist", "contacts", "energy_J", "error:a [m]", "com.x"})
    EXPECT_NE(row[column], "") << column;
}

TEST(Log, EveryNthRowAndTheLastAreWritten) {
  const Model m = logModel();
  const TempFolder folder;
  const auto file = folder.path() / "log.csv";
  std::mt19937_64 random(7);
  LogWriter writer(file, m, {}, 10);
  for (int i = 0; i <= 25; ++i) {
    StepRecord r = randomRecord(m, random);
    r.time = i;
    r.isEnd = i == 25;
    writer.write(r);
  }
  writer.close();
  const std::string text = detail::readFile(file.string()).value();
  detail::CsvReader reader(text);
  reader.next();
  std::vector<std::string> times;
  while (const std::vector<std::string>* fields = reader.next()) times.push_back(fields->front());
  EXPECT_EQ(times, (std::vector<std::string>{"0", "10", "20", "25"}));
}

TEST(ContactLog, HasARowForEachContact) {
  const Model m = touchingLogModel();
  const TempFolder folder;
  const auto file = folder.path() / "contacts.csv";
  ContactLog log(file, m);
  log.write(0.5, {{1, 0, {1, 2, 3}, Vector3::UnitZ(), {3, 4, 12}}});
  log.write(1.0, {});
  log.close();
  EXPECT_EQ(detail::readFile(file.string()).value(),
            "time_s,link_a,link_b,shape_a,shape_b,x_m,y_m,z_m,nx,ny,nz,fx_N,fy_N,fz_N,normal_N,"
            "friction_N\n0.5,world,arm," +
                m.geometries[1].name + "," + m.geometries[0].name + ",1,2,3,0,0,1,3,4,12,12,5\n");
  EXPECT_THROW(ContactLog("no/such/folder/c.csv", m), ModelError);
}

TEST(Log, IsOnDiskAfterFlushAndAtTheEndOfTheWriter) {
  const Model m = logModel();
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
  EXPECT_THROW(LogWriter("no/such/folder/log.csv", logModel()), ModelError);
}

}  // namespace
}  // namespace softgauss::io
