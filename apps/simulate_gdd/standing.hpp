// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Whether robots with a floating base stood or fell, and how far their feet slid.
///
/// A robot stands on the links that touch the ground within 0.1 s of its first contact. It has
/// fallen where at the end links lie on the ground that did not stand there, and its base has come
/// down by a quarter of its height over the lowest point or has tilted by 20°, by 5° where it stood
/// on its root; or where the base itself lies on the ground and did not stand there, or has tilted
/// by 60° and touches it. It is falling where the base has come down or tilted so far and comes
/// down at 0.2 m/s, or has tilted by 60°. Ground is all that is fixed to the world.
///
/// What slides is the material of a link at its contacts with the ground: with v_t the mean
/// tangential velocity there, weighted by normal force, it slides by |∫ v_t dt|. A wheel that rolls
/// does not slide.

#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/step/snapshot.hpp"
#include "softgauss/io/contact_links.hpp"

namespace softgauss::app {

struct StandingOutcome {
  std::string base;       ///< the root link
  bool fell = false;      ///< at the end
  bool falling = false;   ///< at the end, on its way down
  bool inAir = false;     ///< it touches nothing at the end
  double cameDown = 0.0;  ///< of the base over the robot's lowest point [m]; negative: it rose
  double tilt = 0.0;      ///< of the base, against the start [rad]
  double speed = 0.0;     ///< at the end, downwards, of the base [m/s]
  std::vector<std::string> onGround;  ///< links that did not stand there
  std::optional<double> since;  ///< some of them are on the ground, a second apart at most [s]
  struct Slide {
    std::string link;
    double way;  ///< [m]
  };
  std::vector<Slide> slides;  ///< of links that stood on the ground, the farthest first
};

class Standing {
 public:
  Standing(const Model& model, const Kinematics& start);

  /// Whether there is a robot that could stand or fall.
  bool hasRobots() const { return !robots_.empty(); }
  /// A step of length `h` [s] from `time` [s], by its kinematics and contact forces.
  void observe(const Kinematics& kinematics, const std::vector<Snapshot::ContactForce>& contacts,
               double time, double h);
  std::vector<StandingOutcome> outcomes(const Kinematics& end, double time) const;
  template <class Archive>
  void archive(Archive& a) {
    a.sized(links_, robots_);
  }

 private:
  struct Link {
    int robot = -1;           ///< of robots_
    bool isBase = false;      ///< of the robot's root body
    bool stands = false;      ///< on the ground when the robot came to stand
    double lastTouch = -1.0;  ///< [s]; −1: never
    Vector3 slid = Vector3::Zero();
    // Of the present step:
    double load = 0.0;
    Vector3 drift = Vector3::Zero();

    template <class Archive>
    void archive(Archive& a) {
      a(stands, lastTouch, slid);
    }
  };
  struct Robot {
    int tree = 0;
    int body = 0;         ///< the root
    double height = 0.0;  ///< of the base over the lowest point, at the start [m]
    Vector3 up_B = Vector3::UnitZ();
    bool stoodOnRoot = false;  ///< looksBolted()
    double firstTouch = -1.0;  ///< [s]
    double lies = -1.0;        ///< links that do not stand touch from here on [s]; −1: none
    double lastLay = -1.0;     ///< one of them touched last [s]

    template <class Archive>
    void archive(Archive& a) {
      a(firstTouch, lies, lastLay);
    }
  };
  double heightOf(const Robot& robot, const Kinematics& k) const;

  const Model& model_;
  io::ContactLinks contactLinks_;
  std::vector<Robot> robots_;
  std::vector<Link> links_;  ///< those of contactLinks_
  Vector3 up_W;
};

}  // namespace softgauss::app
