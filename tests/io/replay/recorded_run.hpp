// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A run recorded as simulate_gdd does it.

#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/replay/page.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {

/// A box that slides and comes to rest, and reaches for a point (it has no actuators).
class RecordedRun {
 public:
  explicit RecordedRun(int steps, const Vector3& place = Vector3::Zero())
      : scene_(model(place), std::make_shared<SampleContacts>()) {
    goals_.push_back(std::make_unique<gdd::Reach>(scene_.model, "body", place + Vector3(1, 2, 3)));
    goals_.push_back(std::make_unique<gdd::VirtualDamping>());
    scene_.state.v << 1.0, -0.5, 0.0, 0.2, 0.4, -0.6;
    scene_.stages();
    recording = std::make_unique<io::Recording>(
        scene_.model, goals_, gdd::GoalContext{scene_.model, scene_.state, *scene_.data});
    for (int i = 0; i < steps; ++i) step();
    scene_.stages();
    io::StepRecord last;
    last.time = scene_.state.time;
    last.q = scene_.state.q;
    last.v = scene_.state.v;
    last.a = last.u = VectorX::Zero(scene_.model.nv);
    recording->finish(last, *scene_.data);
    states.push_back(scene_.state);
  }

  const Model& model() const { return scene_.model; }

  std::unique_ptr<io::Recording> recording;
  std::vector<State> states;  ///< before each step, and the last
  std::vector<io::StepRecord> records;

 private:
  static Model model(const Vector3& place) {
    ModelBuilder builder = boxOnPlane({0.3, 0.2, 0.1}, 2.0, 0.4);
    builder.X_WRoot.p += place;
    return builder.build();
  }

  void step() {
    const State before = scene_.state;
    io::StepRecord r;
    r.time = before.time;
    r.q = before.q;
    r.v = before.v;
    scene_.step();
    Data& data = *scene_.data;
    computeKinematics(scene_.model, before, data.kinematics);  // of the record
    r.a = data.forward.a;
    r.u = VectorX::Zero(scene_.model.nv);
    r.contacts = data.stats.contacts;
    r.constraints = data.stats.rows;
    r.kineticEnergy = computeEnergy(scene_.model, data.kinematics, r.q, r.v).kinetic;
    r.energy = computeEnergy(scene_.model, data.kinematics, r.q, r.v).total();
    recording->addStep(r, data);
    states.push_back(before);
    records.push_back(r);
  }

  Scene scene_;
  std::vector<std::unique_ptr<gdd::Goal>> goals_;
};

}  // namespace softgauss::test
