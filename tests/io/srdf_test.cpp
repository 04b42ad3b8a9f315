// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/srdf.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "temp_folder.hpp"

namespace softgauss::io {
namespace {

namespace fs = std::filesystem;

const char* const kSrdf = R"(<robot name="twin">
  <group name="arm"><joint name="a"/></group>
  <group_state name="home" group="arm">
    <joint name="a" value=" 0.5 "/>
    <joint name="root" value="0 0 1 0 0 0 1"/>
  </group_state>
  <group_state name="home" group="hand"><joint name="b" value="-1e-1"/></group_state>
  <group_state name="away" group="arm"><joint name="a" value="1"/></group_state>
  <disable_collisions link1="x" link2="y" reason="Never"/>
  <disable_collisions link1="y" link2="x"/>
  <disable_default_collisions link="z"/>
  <enable_collisions link1="z" link2="y"/>
  <end_effector name="tool" parent_link="x" group="hand"/>
</robot>
)";

using Positions = std::vector<std::pair<std::string, double>>;

class SrdfFile : public testing::Test {
 protected:
  Srdf read(const std::string& text) { return readSrdf(folder.write("robot.srdf", text)); }
  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const ModelError& error) {
      return error.what();
    }
    ADD_FAILURE() << "read without complaint:\n" << text;
    return {};
  }
  /// An SRDF for `robot` in the folder, below `path`.
  fs::path put(const std::string& path, const std::string& robot) {
    fs::create_directories((folder.path() / path).parent_path());
    return folder.write(path, "<robot name='" + robot + "'/>");
  }
  TempFolder folder;
};

TEST_F(SrdfFile, StatesOfOneNameAreOneAndOfAGroupTheGroups) {
  const Srdf srdf = read(kSrdf);
  EXPECT_EQ(srdf.stateNames(), (std::vector<std::string>{"home", "away"}));
  EXPECT_EQ(srdf.positions("home"), (Positions{{"a", 0.5}, {"b", -0.1}}));
  EXPECT_EQ(srdf.positions("hand/home"), (Positions{{"b", -0.1}}));
  EXPECT_EQ(srdf.positions("away"), (Positions{{"a", 1.0}}));
}

TEST_F(SrdfFile, PairsNeverCollideOnceAndOnlyOfLinksThatAreThere) {
  const Srdf srdf = read(kSrdf);
  EXPECT_EQ(srdf.apartAmong({"x", "y"}), (Srdf::LinkPairs{{"x", "y"}}));
  // z collides with none but y.
  EXPECT_EQ(srdf.apartAmong({"z", "y", "x", "w"}),
            (Srdf::LinkPairs{{"w", "z"}, {"x", "y"}, {"x", "z"}}));
  EXPECT_TRUE(srdf.apartAmong({"x", "w"}).empty());
}

TEST_F(SrdfFile, MistakesNameLineElementAndWhatIsExpected) {
  const auto says = [](const std::string& text, std::initializer_list<const char*> words) {
    for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << text;
  };
  says(refusal(
           "<robot>\n<group_state name='up'>\n<joint name='a' value='big'/></group_state></robot>"),
       {"robot.srdf:3: ", "group_state 'up': joint 'a'", "'big'", "expected"});
  says(refusal("<robot>\n<group_state name='up'>\n<joint name='a'/></group_state></robot>"),
       {"robot.srdf:3: ", "value"});
  says(refusal("<robot>\n<group_state><joint name='a' value='1'/></group_state></robot>"),
       {"robot.srdf:2: ", "group_state", "name"});
  says(refusal("<robot>\n<disable_collisions link1='a'/></robot>"),
       {"robot.srdf:2: ", "disable_collisions", "link2"});
  says(refusal("<semantics/>"), {"robot.srdf:1: ", "<semantics>", "expected <robot>"});
}

TEST_F(SrdfFile, IsFoundInThePackageByItsNameOrThatOfTheRobot) {
  const fs::path urdf = folder.path() / "urdf/arm_v2.urdf";
  fs::create_directories(urdf.parent_path());
  EXPECT_TRUE(findSrdfs(urdf, "arm").empty());
  put("srdf/leg.srdf", "leg");
  EXPECT_TRUE(findSrdfs(urdf, "arm").empty());
  const fs::path own = put("config/any.srdf", "arm");
  EXPECT_EQ(findSrdfs(urdf, "arm"), std::vector<fs::path>{own});
  const fs::path second = put("urdf/arm_with_tool.srdf", "arm");
  EXPECT_EQ(findSrdfs(urdf, "arm").size(), 2u);
  const fs::path named = put("srdf/arm_v2.srdf", "another name");
  EXPECT_EQ(findSrdfs(urdf, "arm"), std::vector<fs::path>{named});
  EXPECT_TRUE(findSrdfs("-", "arm").empty());
}

TEST_F(SrdfFile, WhatNobodyAskedForIsAWarningAndWhatWasAskedForARefusal) {
  const fs::path urdf = folder.path() / "arm.urdf";
  std::vector<std::string> warnings;
  const auto choose = [&](const SrdfChoice& choice) {
    warnings.clear();
    return chooseSrdf(urdf, "arm", choice, {"arm.urdf", 0}, "state", warnings);
  };
  const auto refused = [&](const SrdfChoice& choice, const char* word) {
    try {
      choose(choice);
      ADD_FAILURE() << "taken: " << choice.file << " " << choice.state;
    } catch (const ModelError& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  EXPECT_TRUE(choose({{}, "", true, "--srdf FILE"}).file.empty());
  EXPECT_TRUE(warnings.empty());
  refused({{}, "home", true, "--srdf FILE"}, "no SRDF in the package");

  const fs::path broken = folder.write("arm.srdf", "<robot name='arm'>");
  EXPECT_TRUE(choose({{}, "", true, "--srdf FILE"}).file.empty());
  EXPECT_EQ(warnings.size(), 1u);
  refused({{}, "home", true, "--srdf FILE"}, "arm.srdf:1: ");
  refused({broken, "", true, "--srdf FILE"}, "arm.srdf:1: ");
  EXPECT_TRUE(choose({"none", "", true, "--srdf FILE"}).file.empty());
  EXPECT_TRUE(warnings.empty());
  EXPECT_TRUE(choose({{}, "", false, "--srdf FILE"}).file.empty());
  EXPECT_TRUE(warnings.empty());

  fs::remove(broken);
  folder.write("one.srdf", kSrdf);
  folder.write("two.srdf", kSrdf);
  const auto chooseTwin = [&](const SrdfChoice& choice) {
    warnings.clear();
    return chooseSrdf(urdf, "twin", choice, {"arm.urdf", 0}, "state", warnings);
  };
  EXPECT_TRUE(chooseTwin({{}, "", true, "--srdf FILE"}).file.empty());
  ASSERT_EQ(warnings.size(), 1u);
  for (const char* word : {"one.srdf", "two.srdf", "--srdf FILE"})
    EXPECT_NE(warnings[0].find(word), std::string::npos) << warnings[0];
  EXPECT_THROW(chooseTwin({{}, "home", true, "--srdf FILE"}), ModelError);
  EXPECT_EQ(chooseTwin({folder.path() / "two.srdf", "home", true, ""}).states.size(), 3u);
  refused({folder.path() / "two.srdf", "hom", true, ""}, "did you mean 'home'?");
}

}  // namespace
}  // namespace softgauss::io
