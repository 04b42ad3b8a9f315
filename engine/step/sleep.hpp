// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Sleep: what has come to rest is left out of steps until something touches or pushes it.
///
/// A tree is at rest while none of its links is faster than Sleep::speed, none has changed its
/// velocity by more than a tenth of that since it came to rest, and the fastest is not faster than
/// it was then: slow is not at rest, what speeds up is not held. When all trees of an island, of
/// those that touch or that rows couple, have been at rest for Sleep::time, their velocity becomes
/// zero and they are still: no stage, solve or integrator has them (Data::active).
///
/// An island wakes, whole, when what is awake touches one of its trees, or may within the step;
/// when a force, a wrench, a new set point of a servo or a velocity is given to one; when what
/// controls it begins, ends or changes; and by wake(). A step in which that turns out begins again.
/// All of it is decided by the state and the input: a saved state goes on to the same bits.
///
/// What sleep leaves out: docs/decisions/0069-sleep.md.

#include <cstdint>
#include <vector>

#include "softgauss/engine/step/contact_source.hpp"
#include "softgauss/engine/step/saved_contacts.hpp"
#include "softgauss/engine/step/step_control.hpp"

namespace softgauss {

/// What a step has of who sleeps; null in Data where Options::sleep is off.
class Sleepers {
 public:
  /// Whether the integrator makes stages once a step: within it, others may meet who sleeps.
  static bool mayBeOf(const Options& options) {
    return (options.integrator == Integrator::semiImplicitEuler ||
            options.integrator == Integrator::leapfrog) &&
           !options.stepDoubling;
  }
  static constexpr const char* kIntegrators =
      "is for semi-implicit-euler and leapfrog without step doubling; others evaluate the dynamics "
      "within the step, where what moves may meet who sleeps";
  /// Throws ModelError where it may not.
  explicit Sleepers(const Model& model);

  /// data.active ← who is awake in this state.
  void select(const Model& model, const State& state, Data& data);
  /// The step begins, of an input that fits: wakes whom it wakes. What does not fit in the state of
  /// a sleeper is returned.
  BadInput begin(const Model& model, const Input& input, StepControl* control, State& state,
                 Data& data, ContactSource* contacts);
  /// Whether contacts of what is awake touch sleepers, who are to wake, by wakeMarked().
  bool touches(const Model& model, const ContactSet& contacts);
  /// Likewise whether there are some among these trees (1).
  bool mark(std::span<const std::uint8_t> trees);
  BadInput wakeMarked(const Model& model, State& state, Data& data, ContactSource* contacts);
  /// The step, which began at this time [s], was taken: who has rested for long falls asleep.
  void finish(const Model& model, const Input& input, const StepControl* control, double began,
              State& state, Data& data);
  /// The step was refused: they sleep as before.
  void undo(State& state) const;
  /// Stages of another state are made in the Data: who sleeps is to be placed anew.
  void forget(const Model& model, Data& data);
  /// Another run goes on in the Data, whose sleepers they have not seen fall asleep.
  void forgetSeen();

  int asleep() const { return static_cast<int>(still_.trees().size()); }
  /// Appends the contacts of who sleeps, with the forces of their last solve in these Data.
  void appendContacts(std::vector<Snapshot::ContactForce>& contacts) const;
  /// tau ← what acted on the dofs of who sleeps when they fell asleep, as appliedForces(), of whom
  /// these Data have seen fall asleep.
  void copyApplied(VectorX& tau) const;
  /// Those, for Data of another process.
  template <class Archive>
  void archive(Archive& a) {
    a(contacts_);
    a.sized(applied_, seenAt_);
    const auto isGeometry = [&](int g) { return g >= 0 && idx(g) < treeOf_.size(); };
    if constexpr (Archive::kReads)
      for (const auto& c : contacts_) a.expect(isGeometry(c.geometryA) && isGeometry(c.geometryB));
  }

 private:
  void mark(int tree) { marked_[idx(tree)] = 1, anyMarked_ = true; }
  void markPushed(const Model& model, const Input& input, const State& state);
  void markServoed(const Model& model, const Input& input, const SleepState& sleep);
  void rouse(const Model& model, State& state, Data& data);
  BadInput place(const Model& model, State& state, Data& data, ContactSource* contacts);
  bool rests(const Model& model, int tree, SleepState& sleep, const VectorX& v, const Data& data);
  void findRested(const Model& model, const Data& data, const SleepState& sleep);
  bool isStill(const Snapshot::ContactForce& contact) const;
  void fallAsleep(const Model& model, State& state, Data& data);
  void forgetElsewhere(const Model& model, const VectorX& q);

  TreeSelection still_;
  std::vector<int> known_, before_;  ///< SleepState::island, of `still_`; before the step
  bool woke_ = false;                ///< somebody has woken in this step
  int wokenTrees_ = 0;
  bool placed_ = false;                    ///< the Data have the sleepers' kinematics, of q_
  VectorX q_, seenAt_;                     ///< (nq); where each fell asleep in these Data
  const ContactSource* source_ = nullptr;  ///< that has their poses, by so many detections of all
  std::int64_t detections_ = 0;
  std::vector<std::uint8_t> marked_;  ///< (trees) 1: to wake, or to fall asleep
  bool anyMarked_ = false;
  std::vector<double> gyration_;  ///< (bodies) radius of gyration [m]
  std::vector<double> rotor_;     ///< (nv) speed of the tree that armature makes of v [m]
  std::vector<Motion> V_;         ///< (bodies) scratch
  std::vector<std::pair<int, int>> pairs_;
  TreeIslands islands_;
  std::vector<double> least_;  ///< (islands) rest time
  std::vector<int> first_;     ///< (islands) tree
  ContactSet all_;
  std::vector<Snapshot::ContactForce> contacts_, found_;
  std::vector<int> treeOf_;  ///< (geometries) −1: the world
  VectorX applied_, tau_;    ///< (nv)
};

}  // namespace softgauss
