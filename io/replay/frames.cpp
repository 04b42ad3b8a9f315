// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/replay/frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "softgauss/io/replay/detail/fetch.hpp"

namespace softgauss::io {
namespace {

constexpr double kFar = 100.0;  // [m] a scene nearer than this keeps the world's origin

void write(const Vector3& x, float* out) {
  for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(x[i]);
}

/// Room for `count` more numbers.
float* extended(std::vector<float>& track, int count) {
  const std::size_t size = track.size();
  track.resize(size + static_cast<std::size_t>(count));
  return track.data() + size;
}

void append(std::vector<float>& track, const Vector3& x) { write(x, extended(track, 3)); }

/// Keeps the records of even frames; a frame has `size` entries.
void keepEven(std::vector<float>& track, std::size_t frames, std::size_t size) {
  for (std::size_t i = 0; i < frames; i += 2)
    std::copy_n(track.begin() + static_cast<std::ptrdiff_t>(i * size), size,
                track.begin() + static_cast<std::ptrdiff_t>(i / 2 * size));
  track.resize((frames + 1) / 2 * size);
}

}  // namespace

FrameTrack::FrameTrack(int bodies, int goals, std::size_t mostBytes)
    : contactStart{0}, bodies_(bodies), goals_(goals), mostBytes_(mostBytes) {}

void FrameTrack::reserve(double duration) {
  const auto numbers = static_cast<std::size_t>(13 * bodies_ + 6 * goals_);
  const auto frames = static_cast<std::size_t>(
      std::min(kFramesPerSecond * duration, static_cast<double>(mostBytes_ / 4 / numbers)) + 2);
  detail::fetch(pose, frames * static_cast<std::size_t>(7 * bodies_));
  detail::fetch(velocity, frames * static_cast<std::size_t>(6 * bodies_));
  for (std::vector<float>* track : {&goalPoint, &goalTarget})
    detail::fetch(*track, frames * static_cast<std::size_t>(3 * goals_));
}

void FrameTrack::appendPoint(std::vector<float>& track, const Vector3& p_W) const {
  append(track, p_W - origin);
}

void FrameTrack::add(const Snapshot& s, std::span<const std::optional<gdd::GoalMark>> marks) {
  if (!std::exchange(placed_, true))
    for (int i = 0; i < 3; ++i)
      origin[i] =
          std::abs(s.centerOfMass[i]) > kFar ? 10.0 * std::round(s.centerOfMass[i] / 10.0) : 0.0;
  const Vector3 nowhere = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());

  time.push_back(s.time);
  float* X = extended(pose, 7 * bodies_);
  float* V = extended(velocity, 6 * bodies_);
  for (int b = 0; b < bodies_; ++b, X += 7, V += 6) {
    const Quaternion q(s.X_WB[b].R);
    write(s.X_WB[b].p - origin, X);
    for (int i = 0; i < 4; ++i) X[3 + i] = static_cast<float>(q.coeffs()[(i + 3) % 4]);
    write(s.velocity[b], V);
    write(s.angularVelocity[b], V + 3);
  }
  appendPoint(centerOfMass, s.centerOfMass);
  appendPoint(centerOfPressure, s.centerOfPressure.value_or(nowhere));
  for (const std::optional<gdd::GoalMark>& mark : marks) {
    appendPoint(goalPoint, mark ? mark->p_WPoint : nowhere);
    appendPoint(goalTarget, mark ? mark->p_WTarget : nowhere);
  }
  for (const Snapshot::ContactForce& c : s.contacts) {
    appendPoint(contactPoint, c.p_WC);
    append(contactNormal, c.n_W);
    append(contactForce, c.force);
    contactGeometry.push_back(static_cast<std::uint32_t>(c.geometryA));
    contactGeometry.push_back(static_cast<std::uint32_t>(c.geometryB));
  }
  contactStart.push_back(static_cast<std::uint32_t>(contactPoint.size() / 3));

  // The next frame is due on the grid of the interval, however long the steps are.
  next_ = (std::floor(s.time / interval_ * (1.0 + 1e-12)) + 1.0) * interval_ - 1e-9;
  if (bytes() > mostBytes_) dropEverySecond();
}

bool FrameTrack::fits() const {
  const std::size_t frames = time.size(), contacts = contactPoint.size() / 3;
  const auto bodies = static_cast<std::size_t>(bodies_), goals = static_cast<std::size_t>(goals_);
  return pose.size() == frames * 7 * bodies && velocity.size() == frames * 6 * bodies &&
         centerOfMass.size() == frames * 3 && centerOfPressure.size() == frames * 3 &&
         goalPoint.size() == frames * 3 * goals && goalTarget.size() == frames * 3 * goals &&
         contactStart.size() == frames + 1 && contactStart.front() == 0 &&
         std::is_sorted(contactStart.begin(), contactStart.end()) &&
         contactStart.back() == contacts && contactPoint.size() == 3 * contacts &&
         contactNormal.size() == 3 * contacts && contactForce.size() == 3 * contacts &&
         contactGeometry.size() == 2 * contacts && interval_ > 0.0 && std::isfinite(interval_);
}

void FrameTrack::rewind(double from) {
  const auto first = std::lower_bound(time.begin(), time.end(), from);
  const auto frames = static_cast<std::size_t>(first - time.begin());
  const auto bodies = static_cast<std::size_t>(bodies_), goals = static_cast<std::size_t>(goals_);
  time.resize(frames);
  pose.resize(frames * 7 * bodies);
  velocity.resize(frames * 6 * bodies);
  for (std::vector<float>* track : {&centerOfMass, &centerOfPressure}) track->resize(frames * 3);
  for (std::vector<float>* track : {&goalPoint, &goalTarget}) track->resize(frames * 3 * goals);
  contactStart.resize(frames + 1);
  const std::size_t contacts = contactStart.back();
  for (std::vector<float>* track : {&contactPoint, &contactNormal, &contactForce})
    track->resize(3 * contacts);
  contactGeometry.resize(2 * contacts);
  next_ = std::min(next_, from);
}

void FrameTrack::forget() { rewind(-std::numeric_limits<double>::infinity()); }

std::size_t FrameTrack::bytes() const {
  return 4 * (pose.size() + velocity.size() + goalPoint.size() + goalTarget.size() +
              contactPoint.size() + contactNormal.size() + contactForce.size());
}

void FrameTrack::dropEverySecond() {
  const auto frames = static_cast<std::size_t>(count());
  const auto bodies = static_cast<std::size_t>(bodies_), goals = static_cast<std::size_t>(goals_);
  keepEven(pose, frames, 7 * bodies);
  keepEven(velocity, frames, 6 * bodies);
  keepEven(centerOfMass, frames, 3);
  keepEven(centerOfPressure, frames, 3);
  keepEven(goalPoint, frames, 3 * goals);
  keepEven(goalTarget, frames, 3 * goals);

  std::vector<std::uint32_t> start = {0};
  std::size_t kept = 0;
  for (std::size_t i = 0; i < frames; i += 2) {
    time[i / 2] = time[i];
    for (std::size_t c = contactStart[i]; c < contactStart[i + 1]; ++c, ++kept) {
      for (std::size_t k = 0; k < 3; ++k) {
        contactPoint[3 * kept + k] = contactPoint[3 * c + k];
        contactNormal[3 * kept + k] = contactNormal[3 * c + k];
        contactForce[3 * kept + k] = contactForce[3 * c + k];
      }
      for (std::size_t k = 0; k < 2; ++k)
        contactGeometry[2 * kept + k] = contactGeometry[2 * c + k];
    }
    start.push_back(static_cast<std::uint32_t>(kept));
  }
  time.resize((frames + 1) / 2);
  contactStart = std::move(start);
  contactPoint.resize(3 * kept);
  contactNormal.resize(3 * kept);
  contactForce.resize(3 * kept);
  contactGeometry.resize(2 * kept);
  interval_ *= 2.0;
}

}  // namespace softgauss::io
