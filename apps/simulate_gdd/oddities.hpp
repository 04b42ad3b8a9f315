// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What no robot does, noticed while it runs: a joint far outside its range, a speed that no joint
/// has, energy that a scene gains which nothing drives.
///
///   range    more than 5 % of it outside, and 0.1 rad or 1 cm
///   speed    300 rad/s in a range, 3000 rad/s without one; 100 m/s
///   energy   above that of the start by 5 % of the largest kinetic energy yet, and by what lifts
///            all that moves by 1 mm
/// What contacts and ranges store is not counted as energy, so bodies that overlap at the start and
/// leave each other are told too: that energy came from nowhere.

#include <map>
#include <string>
#include <vector>

#include "softgauss/engine/model/state.hpp"

namespace softgauss::app {

class Oddities {
 public:
  /// `passive`: nothing drives the scene from outside.
  Oddities(const Model& model, bool passive);

  /// The state of a step's start or of the end, with its energies [J]. Returns what is to be told
  /// now: the first of each kind, with joint and what to try.
  std::vector<std::string> observe(const State& state, double time, double energy,
                                   double kineticEnergy);
  /// A sentence for each kind that was seen, with all joints and the worst.
  std::vector<std::string> sentences() const;
  template <class Archive>
  void archive(Archive& a) {
    a(outside_, fast_, started_, startEnergy_, mostKinetic_, gainTime_, gain_, fastest_);
    if constexpr (Archive::kReads) a.expect(fits());
  }

 private:
  struct Seen {
    double time;   ///< first
    double worst;  ///< [rad, m or their rates]

    template <class Archive>
    void archive(Archive& a) {
      a(time, worst);
    }
  };
  /// Notes a joint; true where it is the first of its kind.
  static bool note(std::map<int, Seen>& kind, int body, double time, double amount);
  /// `when`: nothing, or when it was first so.
  std::string rangeText(int body, const Seen& seen, const std::string& when) const;
  std::string speedText(int body, const Seen& seen, const std::string& when) const;
  std::string energyText(const std::string& when) const;
  int fastestBody(const State& state) const;
  bool fits() const;  ///< to the model

  const Model& model_;
  bool passive_;
  std::map<int, Seen> outside_, fast_;      ///< by the body that the joint carries
  std::vector<const JointRange*> rangeOf_;  ///< (bodies) or null
  bool started_ = false;
  double startEnergy_ = 0.0, mostKinetic_ = 0.0, lift_ = 0.0;
  double gainTime_ = -1.0, gain_ = 0.0;  ///< [s], the largest [J]
  int fastest_ = 0;                      ///< body, when energy was first gained
};

}  // namespace softgauss::app
