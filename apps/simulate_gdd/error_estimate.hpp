// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The error that a run's settings leave: beside each step of h two of h/2 are taken. For a method
/// of order p,
///
///   x_h − x ≈ (x_h − x_{h/2}) 2^p/(2^p − 1)
///
/// A method with error control takes its halves to a small share of the tolerance: there the
/// difference is the error. implicit-midpoint divides a step in which a contact begins at places
/// that its halves have too, and both err alike: its halves are those of dormand-prince, and its
/// own count where those are not finite, as with stiff damping.
///
/// What goals have found is held over both halves; a table of controls and wrenches are functions
/// of time, and each half asks them anew. Where that gives it another control p is 1, whatever the
/// method: the run holds a control from the start of a step.
///
/// Where shapes may pass through each other between two halves, the halves go in parts (7.7).
///
/// Without goals the halves go on by themselves, and the estimate is of the whole run: root mean
/// square over links and steps. With goals every pair of halves begins where its step does, for the
/// goals answer to what went before; the estimate is the sum of what the steps err by.

#include <memory>
#include <vector>

#include "apps/shared/pose_error.hpp"
#include "apps/simulate_gdd/outside_input.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/engine/model/saved_state.hpp"
#include "softgauss/io/summary.hpp"

namespace softgauss::app {

class ErrorEstimate {
 public:
  /// `model`, `start` and `outside`: of the run. The last has to live as long.
  ErrorEstimate(const Model& model, const State& start, const OutsideInput& outside,
                bool withGoals);

  /// A step of the run from `before` to `after`, under `input`, of `length` [s].
  void observe(const State& before, const Input& input, const State& after, double length);

  io::ErrorOutcome outcome() const;
  template <class Archive>
  void archive(Archive& a) {
    for (const auto& halves : halves_) a(*halves);
    a(steps_);
  }

 private:
  /// A run in half steps.
  struct Halves {
    Halves(const Model& halved, const State& start, double factor);

    /// Of the next part, where so much is left of a step: a half, or what is in sight [s].
    double tunnellingLengthBound(double half, double left);

    double factor;  ///< 2^p/(2^p − 1)
    Model model;
    collision::SceneContacts contacts;
    Data data;
    State state;
    LinkPoses poses;
    double total = 0.0, turned = 0.0;  ///< sums, of squares without goals
    bool lost = false;                 ///< not finite

    template <class Archive>
    void archive(Archive& a) {
      a(state, factor, total, turned, lost);
    }
  };
  void observe(Halves& halves, const State& before, const Input& input, double length);

  const OutsideInput& outside_;
  bool withGoals_;
  std::vector<std::unique_ptr<Halves>> halves_;  ///< the first that is not lost counts
  Input input_;                                  ///< of a half
  LinkPoses run_;
  long steps_ = 0;
};

}  // namespace softgauss::app
