// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The instants of a run that a replay shows: at most 60 a second, in bounded memory.
///
/// Arrays in the layout of docs/replay_format.md. Positions are single precision relative to
/// `origin`, which lies near the scene, so they are good to a micrometre however far out the scene
/// is. A long run drops every second frame whenever the track is full.

#include <cstdint>
#include <span>

#include "softgauss/engine/step/snapshot.hpp"
#include "softgauss/gdd/goal.hpp"

namespace softgauss::io {

class FrameTrack {
 public:
  static constexpr double kFramesPerSecond = 60.0;

  FrameTrack(int bodies, int goals, std::size_t mostBytes = std::size_t{48} << 20);

  /// Fetches the memory of a run of that duration [s] now, so that adding frames is cheap.
  void reserve(double duration);
  /// Whether the next frame is due `now` [s].
  bool due(double now) const { return count() == 0 || now >= next_; }
  /// Appends a frame, whether due or not. `marks`: one a goal, nothing where it is no place now.
  void add(const Snapshot& snapshot, std::span<const std::optional<gdd::GoalMark>> marks);

  /// Forgets frames from `time` [s] on: the run goes on from there.
  void rewind(double time);
  /// Forgets all frames. The origin stays, and the next frame is due at once.
  void forget();

  template <class Archive>
  void archive(Archive& a) {
    a(origin, time, pose, velocity, centerOfMass, centerOfPressure, goalPoint, goalTarget,
      contactStart, contactPoint, contactNormal, contactForce, contactGeometry, interval_, next_,
      placed_);
    if constexpr (Archive::kReads) a.expect(fits());
  }

  int count() const { return static_cast<int>(time.size()); }

  Vector3 origin = Vector3::Zero();                ///< [m] set by the first frame of all
  std::vector<double> time;                        ///< (frames) [s]
  std::vector<float> pose;                         ///< (frames, bodies, 7) x y z qw qx qy qz
  std::vector<float> velocity;                     ///< (frames, bodies, 6) linear, angular
  std::vector<float> centerOfMass;                 ///< (frames, 3)
  std::vector<float> centerOfPressure;             ///< (frames, 3) NaN: none
  std::vector<float> goalPoint, goalTarget;        ///< (frames, goals, 3) NaN: none
  std::vector<std::uint32_t> contactStart;         ///< (frames + 1)
  std::vector<float> contactPoint, contactNormal;  ///< (contacts, 3)
  std::vector<float> contactForce;                 ///< (contacts, 3) on geometry B [N]
  std::vector<std::uint32_t> contactGeometry;      ///< (contacts, 2) A, B

 private:
  bool fits() const;  ///< what was read, together
  std::size_t bytes() const;
  void dropEverySecond();
  void appendPoint(std::vector<float>& track, const Vector3& p_W) const;

  int bodies_, goals_;
  std::size_t mostBytes_;
  double interval_ = 1.0 / kFramesPerSecond;  ///< [s]
  double next_ = 0.0;                         ///< [s]
  bool placed_ = false;                       ///< the origin is chosen
};

}  // namespace softgauss::io
