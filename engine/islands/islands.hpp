// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A scene that is stepped island by island, and whose islands may sleep.
///
/// An island is a set of units (units.hpp) that touch one another. P = M + JᵀHJ has no entry
/// between two islands, so the objective of (1.1) is the sum of theirs, and each is solved alone,
/// as a model of its own (sub_model.hpp): it stops when it has converged, and its result is the
/// same, bit for bit, whoever else is in the scene. The joint solve of step() finds the same
/// accelerations up to rounding: a row is as soft as the two trees that it holds have it
/// (Input::controlled). What differs is which trees a control acts on, where it has no goal for a
/// robot: alone in its island this is passive, in the joint solve it gets what costs nothing.
///
///   1. islands that touch become one; an island may fall apart into those that touch
///   2. each island that is awake takes its step, and the poses are found where it ends
///   3. an island that has been at rest for long falls asleep
///
/// Units join at once. An island is looked at only every kSplitAge of its steps to see whether it
/// has come apart: solving two islands as one is right too. Step 1 makes models of its own where it
/// joins or splits, and allocates then and where it looks; otherwise a step allocates where a list,
/// of contacts, of rows or of near pairs, is longer than it ever was.
///
/// Sleep. An island is at rest where, over Sleep::time, no link has been faster than Sleep::speed,
/// none has changed its velocity by more than a tenth of that, the fastest is not faster than
/// before, and nothing is applied. Then its velocity becomes zero and it costs nothing until
/// something touches it, a force or wrench is applied to it, what controls it begins, ends or
/// changes, wake() or setState() is called. What a control acts on stays awake unless
/// Sleep::controlled. What sleep leaves out: docs/decisions/0026.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "softgauss/engine/core/union_find.hpp"
#include "softgauss/engine/islands/island_contacts.hpp"
#include "softgauss/engine/islands/island_control.hpp"
#include "softgauss/engine/islands/units.hpp"
#include "softgauss/engine/step/step.hpp"

namespace softgauss {

class ByteReader;
class ByteWriter;

struct Sleep {
  bool enabled = false;
  double speed = 5e-3;  ///< [m/s] of every link: its centre of mass, and its radius of gyration
  double time = 0.5;    ///< [s] for which they have been slower, and steady
  /// What a control acts on may sleep too: it then keeps its pose, and its control the last value.
  bool controlled = false;
};

struct IslandStats {
  int islands = 0;     ///< all, asleep or not
  int awake = 0;       ///< of them
  int regroups = 0;    ///< islands made in this step because units met or came apart
  int wakeups = 0;     ///< islands that were woken by this step
  int controlled = 0;  ///< islands on which a control has acted in this step
};

class Islands {
 public:
  /// Steps of an island between two looks at whether it has come apart.
  static constexpr int kSplitAge = 32;

  /// `contacts` may be null: nothing collides. `controls` may be null: every step is the ordinary
  /// one. Model, contacts and controls must outlive this object.
  /// Throws ModelError when the model's integrator is neither semi-implicit Euler nor the leapfrog:
  /// the others evaluate the dynamics within the step, where islands may meet that were apart at
  /// its start.
  explicit Islands(const Model& model, IslandContacts* contacts, Sleep sleep = {},
                   IslandControls* controls = nullptr);
  ~Islands();
  Islands(const Islands&) = delete;
  Islands& operator=(const Islands&) = delete;

  const State& state() const { return state_; }
  /// Wakes everything.
  void setState(const State& state);
  /// The state with all that makes it go on to the same bits: groups, their ages, who sleeps and
  /// since when who rests (core/bytes.hpp). What controls islands is not among it.
  template <class Archive>
  void archive(Archive& a) {
    if constexpr (Archive::kReads)
      restore(a);
    else
      save(a);
  }
  /// Wakes the island of a body.
  void wake(int body);
  bool asleep(int body) const;

  /// One step of all islands that are awake. Where isRefused() the whole state is left as it was;
  /// stats() tells the dof, or what does not fit the model.
  SolveStatus step(const Input& input) noexcept;

  /// Sums over the awake islands; status and residual are the worst.
  const StepStats& stats() const { return stats_; }
  const IslandStats& islandStats() const { return islandStats_; }
  /// Of the last step; sleepers have none (nv).
  const VectorX& acceleration() const { return acceleration_; }

  /// An island, as the last step has left it. The state is that of the step's end, the data that of
  /// its solve.
  struct Island {
    Island(const Model& whole, std::vector<int> ofUnits, const std::vector<int>& trees,
           IslandContacts* contacts, IslandControls* controls);

    std::vector<int> units;  ///< ascending
    SubModel part;
    std::unique_ptr<ContactSource> contacts;  ///< null: nothing collides
    std::unique_ptr<IslandControl> control;   ///< null: nothing controls any
    State state;
    Data data;
    Kinematics end;  ///< of `state`, where it may rest
    Input input;
    std::vector<double> gyration;  ///< (bodies) radius of gyration [m]
    std::vector<double> rotor;     ///< (dofs) speed of the tree that armature makes of v [m]
    std::vector<Motion> rest;      ///< (bodies) velocity when it began to rest
    double restSpeed = 0.0;        ///< of the fastest link then [m/s]
    int age = 0;                   ///< steps since it was made
    double resting = 0.0;          ///< [s]
    bool active = false;           ///< part of the scene now
    bool awake = false;
    bool controlled = false;  ///< in its last step
    std::int64_t lastUse = 0;
  };
  /// Those that are awake, by their first unit.
  const std::vector<Island*>& awake() const { return awake_; }
  /// The island of a unit now.
  const Island& islandOf(int unit) const { return *islandOf_[static_cast<std::size_t>(unit)]; }
  const Units& units() const { return units_; }

 private:
  void save(ByteWriter& a);
  void restore(ByteReader& a);
  Island& find(const std::vector<int>& units);
  void activate(Island& island);
  void deactivate(Island& island);
  void wake(Island& island);
  void fallAsleep(Island& island);
  void place(const Island& island);
  void refreshLists();
  /// Wakes the island of a tree, which then rests anew.
  void push(int tree);
  void wakeWhatIsPushed(const Input& input);
  void wakeWhatIsControlled();
  void wakeWhatIsServoed(const Input& input);
  SolveStatus take(Island& island, const Input& input);
  void part();
  void join();
  void makeIslands(const std::vector<Island*>& old, UnionFind& sets);
  void forget();
  void settle();
  bool rests(Island& island) const;
  SolveStatus fail(const Island& island);
  void collectStats();

  const Model& model_;
  IslandContacts* contacts_;
  IslandControls* controls_;
  const Sleep sleep_;
  const Units units_;
  State state_;
  VectorX acceleration_;
  StepStats stats_;
  IslandStats islandStats_;

  std::map<std::vector<int>, std::unique_ptr<Island>> islands_;  ///< by units; all that are kept
  std::vector<Island*> islandOf_;                                ///< (units)
  std::vector<int> groupOf_;                   ///< (units) first unit of its island
  std::vector<Island*> awake_;                 ///< by first unit
  std::vector<int> awakeUnits_;                ///< ascending
  int active_ = 0;                             ///< islands, asleep or not
  std::int64_t clock_ = 0;                     ///< steps taken
  std::array<VectorX, 2> setPoints_;           ///< (nv) of servos and their rates, last asked for
  std::vector<std::pair<int, int>> touching_;  ///< scratch
  std::vector<Island*> affected_;              ///< scratch
  std::vector<int> changed_;                   ///< scratch
};

}  // namespace softgauss
