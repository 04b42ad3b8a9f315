// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "softgauss/engine/core/bytes.hpp"
#include "softgauss/engine/core/sealed.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/engine/model/followers.hpp"
#include "softgauss/engine/model/saved_state.hpp"
#include "softgauss/engine/step/reserve.hpp"
#include "softgauss/io/held_back.hpp"
#include "softgauss/io/names.hpp"
#include "softgauss/io/simulation/ground.hpp"
#include "softgauss/io/simulation/simulation_parts.hpp"

namespace softgauss {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view kSavedKind = "SGSIMUL\n";
constexpr std::uint32_t kSavedVersion = 2;

/// The body of a joint of one degree of freedom.
const Body& scalarJoint(const Model& model, const std::string& joint) {
  if (const std::string problem = io::jointProblem(model, joint); !problem.empty())
    throw NameError(fmt::format("joint '{}': {}", joint, problem));
  return model.bodies[model.findJoint(joint)];
}

/// The body of a link.
int bodyOf(const Model& model, const std::string& link, const char* what) {
  const int frame = model.findFrame(link);
  if (frame < 0) throw NameError(fmt::format("{}: {}", what, io::linkProblem(model, link)));
  return model.frames[static_cast<std::size_t>(frame)].body;
}

/// The dof of a joint with a servo, and where asked one that has a spring.
int servoedDof(const Model& model, const std::string& joint, bool withSpring) {
  const int v = scalarJoint(model, joint).v;
  const Servo& servo = model.dofs[static_cast<std::size_t>(v)].servo;
  if (withSpring ? servo.kp > 0.0 : servo.exists()) return v;
  throw NameError(fmt::format("joint '{}' has no {}; give it one in the scene's joint_parameters",
                              joint, withSpring ? "servo with a kp" : "servo"));
}

}  // namespace

SimulationParts::SimulationParts(std::unique_ptr<Scene> loaded, const SimulationOptions& loadedWith)
    : scene(std::move(loaded)), options(loadedWith), kinematics(scene->model), links(scene->model) {
  restart(true);
}

void SimulationParts::restart(bool otherModel) {
  state = scene->initial;
  input = {};
  grid = {};
  if (otherModel || !data) data = std::make_unique<Data>(scene->model);
  data->timed = recording != nullptr;
  controller = std::make_unique<gdd::GoalDirectedController>(scene->model);
  hasRegularisers = hasBalance = false;
  regularisers = 0;
  setUpControl(*scene, options, *controller);
}

Simulation Simulation::load(const std::filesystem::path& file, const SimulationOptions& options) {
  return Simulation(loadScene(file, options), options);
}

Simulation::Simulation(std::unique_ptr<Scene> scene, const SimulationOptions& options)
    : Simulation(std::make_unique<SimulationParts>(std::move(scene), options)) {}
Simulation::Simulation(std::unique_ptr<SimulationParts> parts)
    : goals(*parts), parts_(std::move(parts)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

const Input& SimulationParts::inputOfStep() {
  if (scene->schedule.empty()) return input;
  applied = input;
  computeKinematics(scene->model, state, kinematics);
  scene->schedule.at(state.time, scene->model.options.timestep, kinematics, applied.wrenches);
  applied.wrenches.insert(applied.wrenches.end(), input.wrenches.begin(), input.wrenches.end());
  return applied;
}

SolveStatus Simulation::step() noexcept {
  SimulationParts& p = *parts_;
  const Model& model = p.scene->model;
  const Input& input = p.inputOfStep();
  const double start = p.state.time;
  if (p.recording) p.recording->beforeStep();
  const Clock::time_point begun = p.recording ? Clock::now() : Clock::time_point();
  const SolveStatus status =
      p.controller->goals.empty()
          ? softgauss::step(model, input, p.state, *p.data, &p.scene->source())
          : p.controller->step(model, input, p.state, *p.data, &p.scene->source());
  if (isRefused(status)) return status;
  p.state.time = p.grid.after(start, model.options.timestep);
  if (p.recording)
    p.recording->afterStep(std::chrono::duration<double, std::micro>(Clock::now() - begun).count());
  return status;
}

void Simulation::run(double seconds) {
  const long steps = stepsIn(seconds, model().options.timestep);
  for (long i = 0; i < steps; ++i)
    if (isRefused(step())) throw StepError(failure());
}

namespace {

/// What the controller does in the state of `p`, into `answer`, which keeps its memory.
void solveInto(SimulationParts& p, ContactSource& contacts, ControlSolution& answer) noexcept {
  const Model& model = p.scene->model;
  const bool controlled = !p.controller->goals.empty();
  p.held = p.inputOfStep();
  if (controlled) p.controller->markControlled(model, p.held.controlled);
  answer.report = {};
  const auto compute = controlled ? computeStages : computeBodyStages;
  answer.status = compute(model, p.held, p.state, *p.data, &contacts);
  if (isRefused(answer.status)) return;
  const VectorX* guess = p.state.warmstart.valid ? &p.state.warmstart.a : nullptr;
  if (controlled) {
    p.controller->begin();
    guess = p.controller->apply(model, p.state, *p.data);
    answer.report = p.controller->report;
    if (!guess) {
      answer.status = p.data->stats.status;
      return;
    }
  }
  answer.status =
      forwardDynamics(model, guess, *p.data, controlled ? p.controller->known() : KnownTrees{});
  answer.tau = controlled ? p.controller->control : p.data->forces.tau;
  answer.a = p.data->forward.a;
  contactForces(*p.data, answer.contacts);
}

}  // namespace

void Simulation::reserve(int contacts) {
  constexpr int kOfShape = 4;
  SimulationParts& p = *parts_;
  const Model& model = p.scene->model;
  if (contacts == 0) contacts = kOfShape * static_cast<int>(model.geometries.size());
  std::vector<std::pair<int, int>> pairs;
  for (const collision::GeometryPair& pair : p.scene->contacts->filter().pairs)
    pairs.emplace_back(pair.a, pair.b);
  reserveRows(model, pairs, contacts, *p.data);
  const auto rows = static_cast<std::size_t>(p.data->constraints.rowCount());
  if (!p.controller->goals.empty()) p.controller->reserve(model, p.state, *p.data);
  p.data->contacts.contacts.reserve(static_cast<std::size_t>(contacts));
  p.solution.contacts.reserve(static_cast<std::size_t>(contacts));
  for (Input* input : {&p.applied, &p.held}) {
    input->wrenches.reserve(model.bodies.size());
    input->controlled.reserve(model.trees.size());
  }
  p.before = p.state;
  for (State* state : {&p.state, &p.before}) state->warmstart.breakpoints.reserve(rows);
  solveInto(p, p.scene->source(), p.solution);
}

ControlSolution Simulation::solve() {
  ControlSolution answer;
  solveInto(*parts_, parts_->scene->source(), answer);
  return answer;
}

const ControlSolution& Simulation::solve(const VectorX& q, const VectorX& v,
                                         ContactSource* contacts) noexcept {
  SimulationParts& p = *parts_;
  const Model& model = p.scene->model;
  const auto misfit = [](BadInputKind kind, const VectorX& found, int expected) {
    BadInput bad;
    if (found.size() == expected) return bad;
    bad.kind = kind;
    bad.found = static_cast<double>(found.size());
    bad.expected = expected;
    return bad;
  };
  p.data->stats = {};
  if (p.data->stats.refuse(model, misfit(BadInputKind::q, q, model.nq)) ||
      p.data->stats.refuse(model, misfit(BadInputKind::v, v, model.nv))) {
    p.solution.status = p.data->stats.status;
    return p.solution;
  }
  p.before = p.state;
  p.state.q = q;
  p.state.v = v;
  p.state.forgetLastStep();
  solveInto(p, contacts ? *contacts : p.scene->source(), p.solution);
  if (isRefused(p.solution.status)) {
    p.state = p.before;
    return p.solution;
  }
  p.state.warmstart.a = p.solution.a;
  p.state.warmstart.valid = true;
  if (!p.controller->goals.empty()) p.controller->keep(p.state.warmstart, p.data->active);
  return p.solution;
}

std::vector<io::GoalOutcome::Cause> Simulation::heldBack(const gdd::Goal& goal) {
  SimulationParts& p = *parts_;
  gdd::GoalBalance balance(p.scene->model, *p.controller);
  if (!goal.actsAt(p.state.time) || !balance.solve(p.inputOfStep(), p.state, &p.scene->source()))
    return {};
  const int i = balance.find(goal, goal.name());
  if (i < 0) return {};
  return io::heldBack(p.scene->model, p.controller->limits, balance, i).causes;
}

void Simulation::reset() { parts_->state = parts_->scene->initial; }

std::string Simulation::save() const {
  ByteWriter content;
  content(softgauss::save(model(), state()), parts_->grid);
  if (parts_->data->sleepers) content(*parts_->data->sleepers, *parts_->controller);
  return sealed(kSavedKind, kSavedVersion, content.bytes());
}

void Simulation::restore(std::string_view bytes) {
  std::string saved;
  TimeGrid grid;
  State restored;
  try {
    ByteReader content(unsealed(kSavedKind, kSavedVersion, bytes));
    content(saved, grid);
    restored = softgauss::restore(model(), saved);
    if (parts_->data->sleepers) content(*parts_->data->sleepers, *parts_->controller);
    content.expectEnd();
  } catch (const BytesError& error) {
    throw ModelError({scene().file.string(), 0}, "saved simulation", error.what());
  }
  state() = restored;  // copied: its vectors stay where they are
  parts_->grid = grid;
}

void Simulation::record() {
  parts_->recording = std::make_unique<RunRecording>(*parts_);
  parts_->data->timed = true;
}

void Simulation::saveReplay(const std::filesystem::path& file) const {
  if (!parts_->recording)
    throw std::logic_error("saveReplay: nothing was recorded, expected record() before the run");
  parts_->recording->write(file);
}

void Simulation::standOnGround() {
  if (!scene().ground) throw NameError("standOnGround: the scene has no ground plane");
  softgauss::standOnGround(model(), *scene().ground, nullptr, state());
  wakeAll(state().sleep);
}

double Simulation::time() const { return parts_->state.time; }

double Simulation::position(const std::string& joint) const {
  return parts_->state.q[scalarJoint(model(), joint).q];
}

double Simulation::velocity(const std::string& joint) const {
  return parts_->state.v[scalarJoint(model(), joint).v];
}

void Simulation::setPosition(const std::string& joint, double q) {
  const Body& body = scalarJoint(model(), joint);
  softgauss::wake(parts_->state.sleep, body.tree);
  parts_->state.q[body.q] = q;
  placeFollowers(model(), {model().findJoint(joint)}, parts_->state.q);
}

void Simulation::setVelocity(const std::string& joint, double v) {
  parts_->state.v[scalarJoint(model(), joint).v] = v;
}

bool Simulation::asleep(const std::string& link) const {
  const int tree = model().bodies[bodyOf(model(), link, "asleep")].tree;
  return tree >= 0 && parts_->state.sleep.isAsleep(tree);
}

void Simulation::wake(const std::string& link) {
  const int tree = model().bodies[bodyOf(model(), link, "wake")].tree;
  if (tree >= 0) softgauss::wake(parts_->state.sleep, tree);
}

Transform Simulation::pose(const std::string& link) const {
  const int frame = model().findFrame(link);
  if (frame < 0) throw NameError("pose: " + io::linkProblem(model(), link));
  computeKinematics(model(), parts_->state, parts_->kinematics);
  const Frame& f = model().frames[static_cast<std::size_t>(frame)];
  return parts_->kinematics.X_WB[f.body] * f.X_BF;
}

double Simulation::torque(const std::string& joint) const {
  VectorX tau;
  appliedForces(*parts_->data, tau);
  return tau[scalarJoint(model(), joint).v];
}

void Simulation::setSetPoint(const std::string& joint, double setPoint, double rate) {
  const int dof = servoedDof(model(), joint, false);
  Input& input = parts_->input;
  if (input.setPoint.size() != model().nv || input.setPointRate.size() != model().nv) {
    input.setPoint.resize(model().nv);
    input.setPointRate.resize(model().nv);
    for (int i = 0; i < model().nv; ++i) {
      input.setPoint[i] = model().dofs[static_cast<std::size_t>(i)].servo.setPoint;
      input.setPointRate[i] = model().dofs[static_cast<std::size_t>(i)].servo.setPointRate;
    }
  }
  input.setPoint[dof] = setPoint;
  input.setPointRate[dof] = rate;
}

double Simulation::setPoint(const std::string& joint) const {
  const Dof& dof = model().dofs[static_cast<std::size_t>(servoedDof(model(), joint, true))];
  return setPointOf(dof.servo, position(joint), velocity(joint), torque(joint));
}

Vector3 Simulation::contactForceOn(const std::string& link) const {
  const auto& names = parts_->links.names();
  const auto place = std::find(names.begin(), names.end(), link);
  if (place == names.end()) {
    if (const std::string problem = io::linkProblem(model(), link); !problem.empty())
      throw NameError("contactForceOn: " + problem);
    throw NameError(fmt::format("contactForceOn: link '{}' has no shapes that could touch", link));
  }
  std::vector<Snapshot::ContactForce> touching;
  contactForces(*parts_->data, touching);
  VectorX forces;
  parts_->links.forces(touching, forces);
  return forces.segment<3>(3 * (place - names.begin()));
}

std::string Simulation::failure() const {
  return failureText(model(), parts_->state, *parts_->data);
}

const Model& Simulation::model() const { return parts_->scene->model; }
const Scene& Simulation::scene() const { return *parts_->scene; }
State& Simulation::state() { return parts_->state; }
const State& Simulation::state() const { return parts_->state; }
const Data& Simulation::data() const { return *parts_->data; }
Data& Simulation::data() { return *parts_->data; }
ContactSource& Simulation::contacts() { return parts_->scene->source(); }
gdd::GoalDirectedController& Simulation::controller() { return *parts_->controller; }
SimulationParts& Simulation::parts() { return *parts_; }
Input& Simulation::input() { return parts_->input; }

}  // namespace softgauss
