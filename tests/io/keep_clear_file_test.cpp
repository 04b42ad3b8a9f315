// SPDX-License-Identifier: Apache-2.0
/// keep_clear in a file of goals, and clearances in --explain.

#include <gtest/gtest.h>

#include "sample_goals.hpp"
#include "softgauss/engine/model/shape_distances.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/explain.hpp"
#include "softgauss/io/goals.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {
namespace {

/// A post on the world, and two links in a row that turn about it; a third without shapes.
const std::string kTwoLinks = R"(<?xml version="1.0"?>
<robot name="two">
  <link name="world"/>
  <link name="post">
    <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
  </link>
  <joint name="stands" type="fixed"><parent link="world"/><child link="post"/></joint>
  <link name="near">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <joint name="first" type="continuous"><parent link="post"/><child link="near"/></joint>
  <link name="far">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <joint name="second" type="continuous">
    <parent link="near"/><child link="far"/><origin xyz="0.5 0 0"/>
  </joint>
  <link name="bare">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <joint name="third" type="continuous"><parent link="far"/><child link="bare"/></joint>
</robot>
)";

class NoDistances final : public ShapeDistances {
 public:
  std::span<const NearPoints> between(int, const Transform&, int, const Transform&) noexcept final {
    return {};
  }
};

const Model& twoLinks() {
  static const Model model = [] {
    const TempFolder folder;
    return loadUrdf(folder.write("two.urdf", kTwoLinks));
  }();
  return model;
}

Goals readGoal(const std::string& item, bool withDistances = true) {
  const TempFolder folder;
  const DistancesMaker maker = [](const Model&) { return std::make_shared<NoDistances>(); };
  return readGoals(folder.write("goals.yaml", "goals:\n  - " + item + "\n"), twoLinks(),
                   State(twoLinks()), withDistances ? maker : DistancesMaker());
}

std::string errorOfItem(const std::string& item, bool withDistances = true) {
  try {
    readGoal(item, withDistances);
  } catch (const ModelError& error) {
    const std::string message = error.what(), start = "goal 1 'keep_clear': ";
    return message.substr(message.find(start) + start.size());
  }
  return "no error";
}

}  // namespace

TEST(KeepClearInFiles, ArrivesWithItsValues) {
  const Goals goals = readGoal(
      "keep_clear: {link: far, from: post, distance: 0.2, weight: 3, stiffness: 4, damping: 5}");
  const auto& goal = dynamic_cast<const gdd::KeepClear&>(*goals.at(0));
  EXPECT_EQ(goal.link, "far");
  EXPECT_EQ(goal.from, "post");
  EXPECT_EQ(goal.distance, 0.2);
  EXPECT_EQ(goal.weight, 3.0);
  EXPECT_EQ(goal.stiffness, 4.0);
  EXPECT_EQ(goal.damping, 5.0);
  ASSERT_EQ(goal.pairs.size(), 1u);
  EXPECT_EQ(twoLinks().geometries[static_cast<std::size_t>(goal.pairs[0].a)].link, "far");
  EXPECT_EQ(twoLinks().geometries[static_cast<std::size_t>(goal.pairs[0].b)].link, "post");
  const Goals other = readGoal("keep_clear: {link: far, from: world, distance: 0}");
  EXPECT_EQ(dynamic_cast<const gdd::KeepClear&>(*other.at(0)).pairs.size(), 1u);
}

TEST(KeepClearInFiles, BadOnesAreRefused) {
  EXPECT_EQ(errorOfItem("keep_clear: {link: far, distance: 0.1}"),
            "key 'from': found no such key, expected world or the name of a link");
  EXPECT_EQ(errorOfItem("keep_clear: {link: far, from: post}"),
            "key 'distance': found no such key, expected a number of metres");
  EXPECT_EQ(errorOfItem("keep_clear: {link: far, from: post, distance: -1}"),
            "key 'distance': found '-1', expected a finite number >= 0");
  EXPECT_EQ(errorOfItem("keep_clear: {link: far, from: near, distance: 0.1}"),
            "key 'from': found 'near', expected a link with shapes that move against those of "
            "'far', and that no joint joins to it");
  EXPECT_EQ(errorOfItem("keep_clear: {link: near, from: world, distance: 0.1}").substr(0, 20),
            "key 'from': found 'w")
      << "its own base";
  EXPECT_EQ(errorOfItem("keep_clear: {link: bare, from: post, distance: 0.1}").substr(0, 50),
            "key 'link': found 'bare', expected a link of model");
  EXPECT_EQ(errorOfItem("keep_clear: {link: far, from: pots, distance: 0.1}").substr(0, 25),
            "key 'from': found 'pots',");
  EXPECT_EQ(errorOfItem("keep_clear: {link: far, from: post, distance: 0.1}", false),
            "key 'link': found without a source of shape distances");
}

TEST(Explain, TellsHowFarLinksAreApart) {
  ExplainContext context;
  context.clearances = {{"far", "post", 0.0}, {"far", "table", 0.0125}};
  const std::string text = explain(twoLinks(), context);
  for (const char* part : {"clearance at the start", "post touches, table 12.5 mm", "far 12.5 mm"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  EXPECT_EQ(explain(twoLinks()).find("clearance"), std::string::npos);
}

}  // namespace softgauss::io
