// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Builds a Model from links and joints, as a URDF lists them.
///
/// build() validates every input once, merges links on fixed joints (their names stay as frames),
/// splits a planar joint into two slides and a hinge, sorts bodies depth first and throws
/// ModelError naming file, line and element when the description cannot be simulated.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/model/model.hpp"

namespace softgauss {

struct LinkSpec {
  std::string name;
  double mass = 0.0;                ///< [kg]
  Vector3 com = Vector3::Zero();    ///< p_LoLcm_L [m]
  Matrix3 I_Lcm = Matrix3::Zero();  ///< central inertia in link axes [kg m²]
  SourceLocation where;
  double gravityCompensation = 0.0;  ///< share of its weight that is borne
};

enum class JointType : std::uint8_t { fixed, revolute, continuous, prismatic, floating, planar };

struct MimicSpec {
  std::string leader;
  double multiplier = 1.0;
  double offset = 0.0;
};

struct JointSpec {
  std::string name;
  JointType type = JointType::fixed;
  std::string parent;  ///< link names
  std::string child;
  Transform X_PC;                      ///< pose of the child link in the parent link at q = 0
  Vector3 axis = Vector3::UnitX();     ///< in the child link; normal of the plane for planar
  std::optional<double> lower, upper;  ///< range [rad or m]; both or neither
  std::optional<double> effort;        ///< |u| ≤ effort; absent: no box; 0: not actuated
  std::optional<double> velocity;      ///< [rad/s or m/s]
  bool actuated = true;                ///< false: never has a control, whatever its effort
  double reference = 0.0;              ///< q to start from, and of the rows' weights [rad or m]
  double limitMargin = 0.0;            ///< a limit makes a row where its distance < margin
  Impedance limitImpedance;
  double damping = 0.0;
  double dryFriction = 0.0;  ///< largest force [N m or N]
  Impedance frictionImpedance;
  double stiffness = 0.0;        ///< of a spring [N m/rad or N/m]; revolute, continuous, prismatic
  double springReference = 0.0;  ///< [rad or m]
  double armature = 0.0;
  Servo servo;  ///< revolute, continuous, prismatic; mimic joints have none
  std::optional<MimicSpec> mimic;
  SourceLocation where;
};

struct GeometrySpec {
  std::string name;
  std::string link;
  Transform X_LG;
  Shape shape;
  Material material;
  SourceLocation where;
  bool automaticMesh = false;  ///< as Geometry::automaticMesh
  CollisionBits bits = {};     ///< as Geometry::bits
};

/// Gives what touches each other a surface of its own. A name is that of a link, for all its
/// geometries, or else of a geometry.
struct PairSpec {
  std::string geometryA, geometryB;
  Material material;
  SourceLocation where;
  bool always = false;  ///< as ContactPair::always
};

/// Ties a point of link A to a point of link B; "world" is a link.
struct ConnectSpec {
  std::string linkA, linkB;
  Vector3 p_LAP = Vector3::Zero();  ///< in link A [m]
  Vector3 p_LBP = Vector3::Zero();  ///< in link B [m]
  Impedance impedance;
  SourceLocation where;
  std::optional<Vector3> comA = {}, comB = {};  ///< of TieCenters, in the links [m]
};

/// Ties a frame of link A to a frame of link B.
struct WeldSpec {
  std::string linkA, linkB;
  Transform X_LAF;
  Transform X_LBF;
  double torqueScale = 1.0;  ///< [m]
  Impedance impedance;
  SourceLocation where;
  std::optional<Vector3> comA = {}, comB = {};  ///< of TieCenters, in the links [m]
};

/// q_follower = c₀ + c₁ q_leader + … + c₄ q_leader⁴; without a leader q_follower = c₀.
struct CouplingSpec {
  std::string follower, leader;  ///< joints of one degree of freedom
  std::array<double, 5> polynomial{0, 1, 0, 0, 0};
  Impedance impedance;
  SourceLocation where;
};

struct VisualSpec {
  std::string link;
  Transform X_LG;
  Shape shape;
  Eigen::Vector4d rgba = Eigen::Vector4d(0.7, 0.7, 0.7, 1.0);
};

enum class BaseKind : std::uint8_t {
  automatic,  ///< fixed when the root link is called "world", else floating
  fixed,
  floating
};

class ModelBuilder {
 public:
  explicit ModelBuilder(std::string name = "model") : name_(std::move(name)) {}

  ModelBuilder& link(LinkSpec spec);
  ModelBuilder& joint(JointSpec spec);
  ModelBuilder& geometry(GeometrySpec spec);  ///< link "world" fixes it to the world
  ModelBuilder& pair(PairSpec spec);
  ModelBuilder& connect(ConnectSpec spec);
  ModelBuilder& weld(WeldSpec spec);
  ModelBuilder& couple(CouplingSpec spec);
  /// Shapes of the two links are never tested against each other; names that are none do no harm.
  ModelBuilder& keepApart(std::string linkA, std::string linkB);
  ModelBuilder& visual(VisualSpec spec);
  ModelBuilder& warning(std::string text);
  /// Puts another description beside this one, its links, joints and geometries called prefix/name
  /// (with an empty prefix, name). Its roots keep its `base` and `X_WRoot`, its joints its
  /// `zeroEffortIsUnlimited`; its options are not read. Its link "world", if it has one, becomes a
  /// link fixed at X_WRoot.
  ModelBuilder& add(const ModelBuilder& other, const std::string& prefix);

  const std::string& name() const { return name_; }
  /// The joint of that name, to be changed; null where there is none.
  JointSpec* findJoint(const std::string& name);
  /// Links that are no joint's child, in the order in which they were given.
  std::vector<std::string> rootLinks() const;

  Options options;
  BaseKind base = BaseKind::automatic;  ///< of every root link that was not added with another
  Transform X_WRoot;                    ///< initial (floating) or permanent (fixed) pose of those
  bool zeroEffortIsUnlimited = false;   ///< a limit with effort 0: actuated without a box

  /// Throws ModelError.
  Model build() const;

 private:
  /// How a root link meets the world, where it is not as `base` and `X_WRoot` say.
  struct Root {
    std::string link;
    BaseKind base;
    Transform X_WRoot;
    bool isWorld;  ///< called "world" in its own description
  };

  std::string name_;
  std::vector<Root> roots_;
  std::vector<LinkSpec> links_;
  std::vector<JointSpec> joints_;
  std::vector<GeometrySpec> geometries_;
  std::vector<PairSpec> pairs_;
  std::vector<ConnectSpec> connections_;
  std::vector<WeldSpec> welds_;
  std::vector<CouplingSpec> couplings_;
  std::vector<std::pair<std::string, std::string>> apart_;
  std::vector<VisualSpec> visuals_;
  std::vector<std::string> warnings_;
};

}  // namespace softgauss
