// SPDX-License-Identifier: Apache-2.0
#pragma once

/// softgauss in one object: model, state, contacts, goals and controller, put together as
/// simulate_gdd does it.
///
///   softgauss::Simulation sim = softgauss::Simulation::load("humanoid.urdf");
///   sim.goals.reach("right_hand", {0.4, -0.2, 1.1});
///   while (sim.time() < 2.0) sim.step();
///   sim.contactForceOn("left_foot");   // [N], world
///   sim.torque("right_knee");          // [N m]
///
/// The same file, options and goals give the same bits as simulate_gdd. One a thread. What takes a
/// name throws NameError where the model has none like it.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "softgauss/io/simulation/scene.hpp"
#include "softgauss/io/simulation/simulation_goals.hpp"
#include "softgauss/io/summary.hpp"

namespace softgauss {

/// A step that was refused. what() tells the time, the joint and the deepest contact.
class StepError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the controller answers to a state.
struct ControlSolution {
  SolveStatus status = SolveStatus::converged;
  VectorX tau;                                   ///< control (nv) [N m or N]
  VectorX a;                                     ///< acceleration that it causes (nv)
  std::vector<Snapshot::ContactForce> contacts;  ///< with their forces [N]
  gdd::GddReport report;                         ///< the certificate among it
};

class Simulation {
 public:
  /// A URDF, or a scene with its own goals. Throws ModelError and OptionError.
  static Simulation load(const std::filesystem::path& file, const SimulationOptions& options = {});
  explicit Simulation(std::unique_ptr<Scene> scene, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  SimulationGoals goals;

  /// Makes room for states with at most `contacts` contacts, 0: four for each shape: step() and
  /// solve(q, v) allocate no memory then, but for goals of functions and where a search meets more
  /// breakpoints than such a state has rows. Takes about as long as a step for each pair of shapes
  /// that may touch. After all goals are set.
  void reserve(int contacts = 0);
  /// One step of model().options.timestep. Where isRefused(), the state is as it was.
  SolveStatus step() noexcept;
  /// Steps until `seconds` later. Throws StepError.
  void run(double seconds);
  /// What the controller does in the present state, which is left as it is: control, acceleration
  /// and contact forces. Without goals the control is input().tau. After an iteration limit the
  /// best control that was found, with its report.
  ControlSolution solve();
  /// The same for a state that was measured: q (nq) and v (nv) become those of state(); its time is
  /// the caller's to set. `contacts`, where given, in place of
  /// those that are found from q. Each call starts from the answer of the last, allocates no memory
  /// once it runs, and stays within controller().iterationBudget. Where isRefused(), state() is as
  /// it was; what was answered holds until the next call.
  const ControlSolution& solve(const VectorX& q, const VectorX& v,
                               ContactSource* contacts = nullptr) noexcept;
  /// What holds one of `goals` back in the present state, in names of the scene, the largest share
  /// first; shares add up to 1. Empty where it does not act, or pulls no more. Solves once, and
  /// allocates.
  std::vector<io::GoalOutcome::Cause> heldBack(const gdd::Goal& goal);
  /// Back to the state at which it started; goals stay.
  void reset();
  /// State and time as bytes: restore() goes on from them to the same bits, in another process too,
  /// with the same file, options, goals and input(), which are not among them.
  std::string save() const;
  /// Throws ModelError where the bytes are no save() of the same scene with the same options, or
  /// were changed; the state is then as it was.
  void restore(std::string_view bytes);
  /// From the present state on the run is recorded, for saveReplay(); again: anew. Steps then
  /// allocate memory, and goals that are set later are not shown.
  void record();
  /// Writes what was recorded until now as a replay page, which any browser shows. Throws
  /// std::logic_error where nothing is recorded, ModelError where the file cannot be made and
  /// std::runtime_error where it cannot be written.
  void saveReplay(const std::filesystem::path& file) const;
  /// Every floating base is raised or lowered until its lowest point touches the ground plane.
  /// Throws NameError where there is none.
  void standOnGround();

  double time() const;                                   ///< [s]
  double position(const std::string& joint) const;       ///< of one degree of freedom [rad or m]
  double velocity(const std::string& joint) const;       ///< [rad/s or m/s]
  void setPosition(const std::string& joint, double q);  ///< joints that follow it go with it
  void setVelocity(const std::string& joint, double v);
  /// Tells the servo of a joint where to go: its set point [rad or m] and that one's rate [rad/s or
  /// m/s], at the end of every step from now on. Without goals; they choose forces themselves.
  void setSetPoint(const std::string& joint, double setPoint, double rate = 0.0);
  /// What the servo of a joint is to be told to make the force of the last step: of a robot under
  /// goals, what its drive would be sent. Needs a servo of kp > 0.
  double setPoint(const std::string& joint) const;
  /// Whether a link sleeps, with the option `sleep`.
  bool asleep(const std::string& link) const;
  /// Wakes a link and all that sleeps with it: after its place in state() was changed.
  void wake(const std::string& link);
  Transform pose(const std::string& link) const;  ///< of the link's frame in the world, now
  /// Of the last step: what acts on the joint from its actuator or servo and from input().tau [N m
  /// or N].
  double torque(const std::string& joint) const;
  /// Of the last step: the sum of the contact forces on a link [N], world axes.
  Vector3 contactForceOn(const std::string& link) const;
  /// Why the last step was refused.
  std::string failure() const;

  // The parts.
  const Model& model() const;
  const Scene& scene() const;
  State& state();  ///< the memory of q and v stays where it is as long as the simulation
  const State& state() const;
  const Data& data() const;  ///< stages of the last step, at its start
  Data& data();
  ContactSource& contacts();
  gdd::GoalDirectedController& controller();
  SimulationParts& parts();
  Input& input();  ///< acts in every step besides the controller and the scene's own wrenches

 private:
  explicit Simulation(std::unique_ptr<SimulationParts> parts);

  std::unique_ptr<SimulationParts> parts_;
};

}  // namespace softgauss
