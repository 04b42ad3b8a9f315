// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace softgauss::io {

/// A small arm on a floating base; lines 1 to 25.
inline const std::string kSampleUrdf = R"(<?xml version="1.0"?>
<robot name="sample">
  <material name="red"><color rgba="1 0 0 0.5"/></material>
  <link name="base">
    <inertial>
      <origin xyz="0.1 0.2 0.3" rpy="0 0 1.5707963267948966"/>
      <mass value="2"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.25"/>
    </inertial>
    <collision><origin xyz="1 2 3"/><geometry><box size="0.2 0.4 0.6"/></geometry></collision>
    <visual><geometry><sphere radius="0.3"/></geometry><material name="red"/></visual>
  </link>
  <link name="arm">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision><geometry><cylinder radius="0.1" length="0.5"/></geometry></collision>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/>
    <child link="arm"/>
    <origin xyz="0 0 0.5" rpy="0.1 0.2 0.3"/>
    <axis xyz="0 0 2"/>
    <limit lower="-1" upper="1.5" effort="5" velocity="3"/>
    <dynamics damping="0.5" friction="0.25"/>
  </joint>
</robot>
)";

/// The text with the only or first occurrence of `from` replaced.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "not in the sample: " << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace softgauss::io
