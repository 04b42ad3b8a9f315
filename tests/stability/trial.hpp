// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A hard case: a scene that is stepped, watched at every step, and measured at the end.
///
/// At every step the state must be finite and the solve converged to 10³ of its tolerance, nothing
/// may have been done in place of what was asked (StepStats::abandonedTrees and the like), and a
/// passive scene must gain no energy, neither against its start nor against any step on the way
/// (energy_watch.hpp):
///   E(t) − E(0) − W(t) ≤ mayGain + what the integrator is off by, at 0 and t
///   E(t) − W(t) ≤ E(s) − W(s) + what rows store at s + what the integrator is off by + mayRise
/// with E of computeEnergy(), to which what contacts store does not belong, and W what `input.tau`
/// has done, h τᵀ ½ (v + v⁺) in each step.
/// A case then states its figures one by one, each beside a bound that was chosen before it was
/// measured: expect("sinks", 0.4e-3, 2e-3, "m"). Every figure is printed, so that a run of the
/// tests shows how much room there is.
///
/// With SOFTGAUSS_TWINS set, a copy takes every step a second time on another thread, and has to
/// come to the same bits. With SOFTGAUSS_WITHOUT set to the name of a mechanism, every case runs
/// without it: what fails then is what the mechanism is for.
///
///   Trial trial("1000 kg on 1 kg", boxes({1.0, 1000.0}));
///   trial.mayGain = 1e-6;
///   trial.run(5.0);
///   trial.expect("penetration", trial.deepest, 2e-3, "m");

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {

class EnergyWatch;

class Trial {
 public:
  /// The model's own shapes collide; its options give step, cone and all else.
  Trial(std::string name, const ModelBuilder& builder) : Trial(std::move(name), builder.build()) {}
  Trial(std::string name, Model m);
  ~Trial();
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;

  Model model;
  State state;  ///< may be changed before the first run()
  Input input;
  std::unique_ptr<collision::SceneContacts> contacts;
  /// The same without pruning: at every step the two must find the same, bit for bit.
  std::unique_ptr<collision::SceneContacts> unpruned;
  std::unique_ptr<Data> data;

  /// [J] above the energy of the first step's start; rounding and the landing of what begins a
  /// nanometre away, where a case says nothing.
  double mayGain = 1e-6;
  /// [J] above the energy of any earlier step, beyond what the law of energy_watch.hpp allows, and
  /// [J] more for each step since.
  double mayRise = 1e-12, perStep = 0.0;
  /// Steps whose solve may end short of its tolerance; their residual is in `worstResidual`.
  int mayStall = 0;

  // Measured over all steps so far.
  double gained = -kInfinity;  ///< most energy above that of the start and of the work [J]
  double rises = -kInfinity;   ///< most that the passivity bound is broken by, without mayRise [J]
  double work = 0.0;           ///< of `input.tau` [J]
  double deepest = 0.0;        ///< deepest overlap of any two shapes [m]
  double fastest = 0.0;        ///< largest |v_i| [m/s or rad/s]
  double worstResidual = 0.0;  ///< of the solve, scaled
  int mostIterations = 0;
  int stalls = 0;  ///< solves that ended short of the tolerance
  int steps = 0;

  /// Advances by `seconds`, `each` being called after every step (it may set `input` for the next).
  /// False, and a failed test, at the first step that breaks a law; the trial then stays there.
  bool run(double seconds, const std::function<void()>& each = {});

  /// |value| ≤ bound, printed; bounds follow TOL_SCALE.
  void expect(const std::string& quantity, double value, double bound, const std::string& unit);

  Energy energy();                               ///< of the present state
  Vector3 origin(const std::string& link);       ///< of a link [m], world
  Matrix3 rotation(const std::string& link);     ///< of a link, world
  double start() const { return startEnergy_; }  ///< energy of the first step's start [J]

 private:
  class Twin;
  bool watch(SolveStatus status);

  std::string name_;
  double startEnergy_ = 0.0, startOffset_ = 0.0;
  bool begun_ = false, broken_ = false;
  VectorX before_;  ///< v at the start of the step
  ContactSet all_;  ///< of `unpruned`
  std::unique_ptr<EnergyWatch> energies_;
};

/// Writes a case's last state down, to be compared with that of another run of the suite: a line in
/// the file that SOFTGAUSS_BITS names, if any.
void writeBits(const std::string& name, const State& state);

/// Runs `trial`, which returns a hash, twice in turn and twice at once on two threads, and expects
/// the same bits each time.
void expectSameBits(const std::function<std::uint64_t()>& trial);

}  // namespace softgauss::test
