// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A quadruped with links as those of robots that are sold, and the SRDF of its package.

#include <string>

#include "tests/io/temp_folder.hpp"

namespace softgauss::test {

/// Legs FL, FR, RL, RR of two links of 0.2 m, straight down at zero, each with a foot, a ball of
/// 2 cm fixed to the calf, and a ball of 3 cm about its knee.
inline std::string quadruped() {
  const auto link = [](const std::string& name, double mass, const std::string& shapes) {
    const std::string m = std::to_string(mass), i = std::to_string(0.004 * mass);
    return "<link name='" + name + "'><inertial><mass value='" + m + "'/><inertia ixx='" + i +
           "' iyy='" + i + "' izz='" + i + "' ixy='0' ixz='0' iyz='0'/></inertial>" + shapes +
           "</link>\n";
  };
  const auto ball = [](const std::string& radius) {
    return "<collision><geometry><sphere radius='" + radius + "'/></geometry></collision>";
  };
  const auto hinge = [](const std::string& name, const std::string& parent,
                        const std::string& child, const std::string& at, const std::string& range) {
    return "<joint name='" + name + "' type='revolute'><parent link='" + parent +
           "'/><child link='" + child + "'/><origin xyz='" + at + "'/><axis xyz='0 1 0'/><limit " +
           range + " effort='60' velocity='20'/></joint>\n";
  };
  std::string text =
      "<robot name='quadruped'>\n" +
      link("trunk", 8.0, "<collision><geometry><box size='0.5 0.2 0.1'/></geometry></collision>");
  for (const std::string leg : {"FL", "FR", "RL", "RR"}) {
    const std::string x = leg[0] == 'F' ? "0.22" : "-0.22", y = leg[1] == 'L' ? "0.14" : "-0.14";
    text += link(leg + "_thigh", 0.8, "") + link(leg + "_calf", 0.3, ball("0.03")) +
            link(leg + "_foot", 0.05, ball("0.02"));
    text +=
        hinge(leg + "_hip", "trunk", leg + "_thigh", x + " " + y + " 0", "lower='-1.5' upper='2'");
    text +=
        hinge(leg + "_knee", leg + "_thigh", leg + "_calf", "0 0 -0.2", "lower='-2.6' upper='0.1'");
    text += "<joint name='" + leg + "_ankle' type='fixed'><parent link='" + leg +
            "_calf'/><child link='" + leg + "_foot'/><origin xyz='0 0 -0.2'/></joint>\n";
  }
  return text + "</robot>\n";
}

/// States `standing`, `kneeling` and, of two groups, `mixed`; front thighs and calves never touch.
inline std::string quadrupedSrdf() {
  const auto state = [](const std::string& name, const std::string& group, const std::string& legs,
                        const std::string& hip, const std::string& knee) {
    std::string text = "<group_state name='" + name + "' group='" + group + "'>\n";
    if (group == "all") text += "<joint name='root_joint' value='0 0 0.3 0 0 0 1'/>\n";
    for (const char side : {'L', 'R'})
      for (const char end : legs)
        text += std::string("<joint name='") + end + side + "_hip' value='" + hip +
                "'/><joint name='" + end + side + "_knee' value='" + knee + "'/>\n";
    return text + "</group_state>\n";
  };
  return "<robot name='quadruped'>\n" + state("standing", "all", "FR", "0.7", "-1.4") +
         state("kneeling", "all", "FR", "0.3", "-2.5") +
         state("mixed", "front", "F", "0.7", "-1.4") + state("mixed", "rear", "R", "0.6", "-1.2") +
         "<disable_collisions link1='FL_calf' link2='FR_calf' reason='Never'/>\n"
         "<disable_collisions link1='FR_foot' link2='FL_foot'/>\n"
         "<disable_collisions link1='FL_foot' link2='tail'/>\n</robot>\n";
}

/// A package: urdf/quadruped.urdf and srdf/quadruped.srdf.
class QuadrupedPackage {
 public:
  QuadrupedPackage() {
    for (const char* name : {"urdf", "srdf"})
      std::filesystem::create_directory(folder.path() / name);
    urdf = folder.write("urdf/quadruped.urdf", quadruped());
    srdf = folder.write("srdf/quadruped.srdf", quadrupedSrdf());
  }
  io::TempFolder folder;
  std::filesystem::path urdf, srdf;
};

}  // namespace softgauss::test
