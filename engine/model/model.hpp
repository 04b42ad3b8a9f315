// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The immutable description of a scene: kinematic trees, joints, shapes, options.
///
/// Made by ModelBuilder::build(), shared by any number of threads. Body 0 is the world; bodies are
/// sorted depth first, so parent < child and a subtree is a contiguous range. Each body but the
/// world hangs from its parent by one joint, and dofs follow the order of the bodies.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/core/spatial.hpp"
#include "softgauss/engine/model/effects.hpp"
#include "softgauss/engine/model/equality.hpp"
#include "softgauss/engine/model/material.hpp"
#include "softgauss/engine/model/mechanisms.hpp"
#include "softgauss/engine/model/servo.hpp"
#include "softgauss/engine/model/shape.hpp"

namespace softgauss {

enum class JointKind : std::uint8_t {
  world,      ///< body 0 only: no joint, no dof
  revolute,   ///< one angle [rad] about an axis through the body's origin
  prismatic,  ///< one displacement [m] along an axis
  floating    ///< pose in the world: q = (x y z, qw qx qy qz), v = (world ṗ, ω in body axes)
};

/// A rigid body and the joint that carries it.
struct Body {
  JointKind joint = JointKind::world;
  bool massless = true;  ///< no inertia at all (an intermediate link of a joint of several dofs)
  int parent = 0;        ///< index of the parent body
  int q = 0;             ///< first entry in State::q
  int v = 0;             ///< first entry in State::v (its first dof)
  int dofs = 0;          ///< 0, 1 or 6
  int tree = -1;         ///< kinematic tree it belongs to; −1 for the world
  int robot = -1;        ///< root link it descends from, or free body it is; −1 for the world
  int subtreeEnd = 0;    ///< bodies [this, subtreeEnd) are its subtree
  Transform X_PB;        ///< pose in the parent body at q = 0 (floating: unused)
  Vector3 axis = Vector3::UnitZ();  ///< joint axis in B, unit (revolute, prismatic)

  double mass = 0.0;              ///< [kg]
  Vector3 com = Vector3::Zero();  ///< p_BoBcm_B [m]
  Symmetric3 I_Bcm;               ///< central rotational inertia in B axes [kg m²]
  double reference = 0.0;         ///< q of a scalar joint at which weights of rows are [rad or m]
  double borneMass = 0.0;         ///< of which the weight is borne (gravity_compensation.hpp) [kg]
  Vector3 borneCom = Vector3::Zero();  ///< its centre, in B [m]
};

/// A kinematic tree: everything that hangs from one child of the world.
struct Tree {
  int rootBody = 0;
  int bodyEnd = 0;  ///< bodies [rootBody, bodyEnd)
  int firstDof = 0;
  int dofEnd = 0;         ///< dofs [firstDof, dofEnd)
  double mass = 0.0;      ///< of all its bodies [kg]
  bool actuated = false;  ///< has a dof with a control u
};

/// One entry of the velocity vector v.
struct Dof {
  int body = 0;
  int parent = -1;                  ///< the next dof towards the root, −1 at the root
  double damping = 0.0;             ///< [N m s/rad or N s/m], force −damping·v
  double armature = 0.0;            ///< rotor inertia added to the diagonal of M [kg m² or kg]
  double dryFriction = 0.0;         ///< largest dry friction force [N m or N]
  Impedance frictionImpedance;      ///< of the dry friction
  double stiffness = 0.0;           ///< of a spring, scalar joints only [N m/rad or N/m]
  double springReference = 0.0;     ///< q at which the spring is at rest [rad or m]
  bool actuated = false;            ///< has a control u
  double effortLower = -kInfinity;  ///< control limits [N m or N]
  double effortUpper = kInfinity;
  double velocityLimit = kInfinity;  ///< [rad/s or m/s], for controllers
  Servo servo;                       ///< scalar joints only
};

/// A range q_min ≤ q ≤ q_max of a scalar joint.
struct JointRange {
  int body = 0;
  double lower = -kInfinity;  ///< [rad or m]
  double upper = kInfinity;
  double margin = 0.0;  ///< a limit makes a row where its distance < margin
  Impedance impedance;
};

/// A named frame fixed to a body: every link of the URDF, merged or not.
struct Frame {
  std::string name;
  int body = 0;
  Transform X_BF;
};

/// What bounds the friction of a contact.
enum class Cone : std::uint8_t {
  pyramidal,  ///< edges ± μ_k t_k: piecewise quadratic (constraints/pyramidal_contact.hpp)
  elliptic    ///< √Σ(f_k/μ_k)² ≤ f_n (constraints/elliptic_contact.hpp)
};

/// How a step moves the state on; one file each in step/integrators.
enum class Integrator : std::uint8_t {
  leapfrog,           ///< order 2, one solve, moves as was solved (leapfrog.hpp)
  semiImplicitEuler,  ///< order 1, one solve, implicit damping (semi_implicit_euler.hpp)
  implicit,           ///< order 1, one solve, Coriolis derivative too (implicit_velocity.hpp)
  implicitMidpoint,   ///< order 2, keeps the energy balance (implicit_midpoint.hpp)
  rungeKutta4,        ///< order 4, four solves (runge_kutta.hpp)
  dormandPrince       ///< order 5 with error control, six solves or more (runge_kutta.hpp)
};

struct IntegratorName {
  Integrator integrator;
  std::string_view name;         ///< as on the command line, in files and in the summary
  std::string_view description;  ///< what it does and costs, one line
};

inline constexpr IntegratorName kIntegratorNames[] = {
    {Integrator::leapfrog, "leapfrog",
     "order 2, one solve a step, implicit joint damping; the motion realises the solved "
     "acceleration"},
    {Integrator::semiImplicitEuler, "semi-implicit-euler",
     "order 1, one solve a step, implicit joint damping"},
    {Integrator::implicit, "implicit",
     "order 1, one solve a step, implicit in velocity, Coriolis forces included"},
    {Integrator::implicitMidpoint, "implicit-midpoint",
     "order 2, some five solves a step, keeps the energy balance to rounding"},
    {Integrator::rungeKutta4, "runge-kutta-4",
     "order 4 in smooth motion, four solves a step, explicit damping"},
    {Integrator::dormandPrince, "dormand-prince",
     "order 5, six solves or more, steps divided until an error estimate is met"},
};

inline std::optional<Integrator> integratorFromName(std::string_view name) {
  for (const IntegratorName& i : kIntegratorNames)
    if (i.name == name) return i.integrator;
  return std::nullopt;
}

inline std::string_view integratorName(Integrator integrator) {
  return kIntegratorNames[static_cast<int>(integrator)].name;
}

/// Whose laws of softness, friction and load the rows of constraints have.
enum class ConstraintModel : std::uint8_t {
  mujoco,    ///< as MuJoCo has them, for comparisons
  softgauss  ///< they know the load that they support and the step that resolves them
};

/// What is at rest is left out of steps (step/sleep.hpp).
struct Sleep {
  bool enabled = false;
  double speed = 5e-3;  ///< [m/s] of every link: its centre of mass, and its radius of gyration
  double time = 0.5;    ///< [s] for which they have been slower, and steady
  /// What a control acts on may sleep too: it keeps its pose, and its control the last value.
  bool controlled = false;
};

/// Choices that hold for the whole simulation.
struct Options {
  double timestep = 0.002;                     ///< h [s]
  Vector3 gravity = Vector3(0.0, 0.0, -9.81);  ///< [m/s²], world
  EffectSet effects = EffectSet::all();        ///< which effects may be simulated
  Integrator integrator = Integrator::leapfrog;
  /// Largest error of a step that error control leaves [m or rad].
  double integrationTolerance = 1e-6;
  /// Error control for integrators of one solve (integrators/step_doubling.hpp).
  bool stepDoubling = false;
  /// Joint damping and stiff springs are in the solve, as inertia (6.1), or follow it as MuJoCo's.
  bool implicitInSolve = true;
  Cone cone = Cone::pyramidal;  ///< of contacts with friction
  double impedanceRatio = 1.0;  ///< impratio: friction against normal impedance
  /// Of the leapfrog: what turns further in a step is stepped in parts (6.3) [rad].
  double substepAngle = 0.1;
  /// h of the step that this one is a part of, whose rows and stiff springs it keeps; 0: of none.
  double outerTimestep = 0.0;
  /// h of the step after this one, where it is another: of the last part of a step; 0: the same.
  double nextTimestep = 0.0;
  /// softgauss's is beyond MuJoCo's by (3.15), (3.11), (4.9), (5.1), (5.6), (5.7), (5.8),
  /// and the curvature of couplings (4.6).
  ConstraintModel constraintModel = ConstraintModel::softgauss;
  /// Of softgauss's `constraintModel` and the leapfrog, which mechanisms may be used.
  MechanismSet mechanisms = MechanismSet::all();
  Sleep sleep;                 ///< of semi-implicit Euler and the leapfrog
  bool exactDiagonal = false;  ///< see constraints/exact_diagonal.hpp
  int maxIterations = 400;     ///< Newton
  double tolerance = 1e-12;    ///< Newton: scaled gradient, see solver/newton.hpp

  /// Softness as MuJoCo has it and, where nothing else is named, Euler's step, `--compatibility
  /// mujoco`; or softness as softgauss has it.
  void useMujocoModel(bool mujoco = true) {
    implicitInSolve = !mujoco;
    constraintModel = mujoco ? ConstraintModel::mujoco : ConstraintModel::softgauss;
    if (mujoco && integrator == Integrator::leapfrog) integrator = Integrator::semiImplicitEuler;
  }
  /// The integrator moves on with one solve, unless it is doubled.
  bool isSingleSolve() const {
    return integrator == Integrator::semiImplicitEuler || integrator == Integrator::leapfrog ||
           integrator == Integrator::implicit;
  }
  /// Contacts, limits and joint friction are springs and dampers at the step's end, near-rigid
  /// where no stiffness is given, and begin before they touch (3.15).
  bool hasRowLaw() const {
    return uses(Mechanism::nearRigid) && integrator == Integrator::leapfrog && !stepDoubling;
  }
  /// Contacts slide by Coulomb's law (5.8). It needs the last acceleration, which the leapfrog has.
  bool correctsSlip() const {
    return uses(Mechanism::slipCorrection) && integrator == Integrator::leapfrog && !stepDoubling;
  }
  bool uses(Mechanism m) const {
    return constraintModel == ConstraintModel::softgauss && mechanisms.has(m);
  }
  /// h by which rows bound their softness: what a whole step follows, a part of it does too [s].
  double rowTimestep() const { return outerTimestep > 0.0 ? outerTimestep : timestep; }
  /// From where the leapfrog makes rows, at mid-step, to where it makes them next [s].
  double timeToNextRows() const {
    return nextTimestep > 0.0 ? 0.5 * (timestep + nextTimestep) : timestep;
  }
  /// The step evaluates the dynamics again within it.
  bool isMultiStage() const { return !isSingleSolve() || stepDoubling; }
};

struct Model {
  std::string name;
  Options options;

  std::vector<Body> bodies;  ///< [0] is the world
  std::vector<std::string> bodyNames;
  std::vector<std::string> jointNames;  ///< of the joint that carries body i; "" for the world
  std::vector<Tree> trees;
  std::vector<Dof> dofs;
  std::vector<JointRange> ranges;  ///< ordered by body
  std::vector<Connection> connections;
  std::vector<Weld> welds;
  std::vector<JointCoupling> couplings;  ///< mimic joints first
  std::vector<Frame> frames;
  std::vector<Geometry> geometries;
  std::vector<ContactPair> contactPairs;  ///< ordered by (geometryA, geometryB)
  /// Links, by name, whose shapes are never tested against each other.
  std::vector<std::pair<std::string, std::string>> apart;
  std::vector<Visual> visuals;
  std::vector<std::string> warnings;  ///< what a user should know about how it was read

  int nq = 0;  ///< size of State::q
  int nv = 0;  ///< size of State::v
  VectorX q0;  ///< initial configuration (floating bases at their initial pose)

  int bodyCount() const { return static_cast<int>(bodies.size()); }
  /// The last dof that moves a body, −1 for the world.
  int lastDof(int body) const { return bodies[idx(body)].v + bodies[idx(body)].dofs - 1; }
  /// A body that floats and carries no other.
  bool isFree(int body) const {
    return bodies[idx(body)].joint == JointKind::floating &&
           bodies[idx(body)].subtreeEnd == body + 1;
  }
  /// Whether a tree, −1 for the world, stands on no base: its first joint lets it go everywhere.
  bool floats(int tree) const {
    return tree >= 0 && bodies[idx(trees[idx(tree)].rootBody)].joint == JointKind::floating;
  }
  double totalMass() const;                      ///< of all moving bodies [kg]
  int findFrame(const std::string& name) const;  ///< index or −1
  int findJoint(const std::string& name) const;  ///< body that the joint carries, or −1
};

}  // namespace softgauss
