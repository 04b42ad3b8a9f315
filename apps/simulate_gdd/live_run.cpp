// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/live_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "apps/live/messages.hpp"
#include "apps/shared/interrupt.hpp"
#include "apps/simulate_gdd/plan_run.hpp"
#include "apps/simulate_gdd/replay.hpp"
#include "softgauss/io/replay/page.hpp"

namespace softgauss::app {
namespace {

using Clock = live::Pace::Clock;
using std::chrono::milliseconds;

constexpr std::chrono::nanoseconds kFrameTime{1000000000 / 60};
constexpr milliseconds kStatusTime{200};
constexpr milliseconds kNap{10};       // between two looks at what pages ask
constexpr std::size_t kToldLines = 8;  // messages that a page shows
constexpr int kTimedSteps = 2000;      // whose times the figures are of

/// The initial state as a recording of one instant, which a page begins with.
void takeInitial(const gdd::GoalContext& start, io::Recording& recording) {
  io::StepRecord record;
  record.isEnd = true;
  record.time = start.state.time;
  record.q = start.state.q;
  record.v = start.state.v;
  record.a = record.u = VectorX::Zero(start.model.nv);
  recording.finish(record, start.data);
}

/// Of all that moves, where there is gravity as on earth [N].
double weightOf(const Model& model) {
  constexpr double kEarth = 9.81;  // [m/s²]
  const double mass = model.totalMass();
  return kEarth * (mass > 0.0 ? mass : 1.0);
}

bool isCertified(gdd::GddStatus status) {
  return status == gdd::GddStatus::converged || status == gdd::GddStatus::nonsmoothMinimum;
}

}  // namespace

LiveRun::LiveRun(const SimulateOptions& options, const Scene& scene, live::Hands& hands,
                 const gdd::GoalDirectedController& controller, const gdd::GoalContext& start)
    : options_(options),
      model_(scene.model),
      state_(start.state),
      hands_(hands),
      controller_(controller),
      scene_(model_, controller.goals, start),
      frame_(model_.bodyCount(), static_cast<int>(scene_.places().size())),
      shown_(model_, Data::Evaluation{}),
      marks_(scene_.places().size()),
      times_(kTimedSteps) {
  if (!options.record.empty())
    record_.emplace(options.record, model_.name, model_.options.timestep);
  scene_.command = options.commandLine;
  scene_.hulls = collidingHulls(scene);
  scene_.images = visualImages(model_, options.largestMesh, status_.told);
  takeInitial(start, scene_);
  LivePlace& place = *options.live;
  if (place.token.empty() && !live::isLoopback(options.liveAddress))
    place.token = live::makeToken();
  ++place.loads;
  live::ServerOptions server;
  server.address = options.liveAddress;
  server.port = place.port;
  server.access = {place.token.empty(), place.token, live::hostOf(options.liveAddress)};
  server.page = io::livePage(
      scene_, std::string("softgauss ") + SOFTGAUSS_VERSION,
      live::liveHeader(hands.names(),
                       {place.token, place.loads, controller.goals.empty(), weightOf(model_)}),
      runBeside(options));
  try {
    server_ = std::make_unique<live::Server>(std::move(server), hands.names());
  } catch (const std::runtime_error& error) {
    throw UsageError(fmt::format("--live: {}; --live 0 takes any port that is free", error.what()));
  }
  place.port = server_->port();
  status_.loads = place.loads;
  frame_.origin = scene_.frames().origin;
  showState();
}

LiveRun::~LiveRun() = default;

std::string LiveRun::announcement() const {
  const std::string& token = options_.live->token;
  const bool loopback = token.empty();
  const std::string host = live::hostOf(options_.liveAddress);
  const std::string address = fmt::format("live: http://{}:{}/{}\n", host, server_->port(),
                                          loopback ? "" : "?token=" + token);
  return address + (loopback
                        ? fmt::format("  Open it in a browser here; from elsewhere: ssh -L "
                                      "{0}:{1}:{0} THIS_MACHINE. ctrl-c ends the run.\n",
                                      server_->port(), host == "127.0.0.1" ? "localhost" : host)
                        : "  Whoever knows this address may move the robot; it goes over the "
                          "network unencrypted. ctrl-c ends the run.\n");
}

bool LiveRun::before(long taken) {
  // The state is that before the step: whoever looks on may go back, or let go what asks for it.
  if (taken == begun_) pause();
  taken_ = taken;
  for (;;) {
    const bool changed = takeEvents();
    if (interrupted() || reloads()) return false;
    const Clock::time_point now = Clock::now();
    if (changed) nextStatus_ = now;
    if (hands_.paused()) {
      if (changed) showState();
      pace_.restart(state_.time);
    }
    if (now >= nextStatus_) {
      nextStatus_ = now + kStatusTime;
      showStatus();
    }
    const Clock::time_point due =
        hands_.paused() ? now + kNap : pace_.due(state_.time, hands_.factor());
    if (!hands_.paused() && due <= now) {
      begun_ = taken;
      return true;
    }
    std::this_thread::sleep_until(std::min(due, now + kNap));
  }
}

/// As if a page had asked for it.
void LiveRun::pause() {
  live::Event event;
  event.kind = live::EventKind::pause;
  event.step = taken_;
  event.fields.emplace_back("on", true);
  hands_.apply(event);
  if (record_) record_->write(event);
  nextStatus_ = {};
}

/// Does what pages have asked since the last look; whether something was asked.
bool LiveRun::takeEvents() {
  server_->inbox().take(asked_);
  for (auto& [sender, event] : asked_) {
    const bool holds =
        event.kind == live::EventKind::release ? !hands_.holding().empty() : hands_.pushes();
    if (sender.client == 0 && !holds) continue;
    event.step = taken_;
    const bool isReload = event.kind == live::EventKind::reload;
    const std::string refused = isReload ? reload() : hands_.apply(event);
    if (refused.empty() && record_ && !isReload) record_->write(event);
    if (sender.client != 0) server_->answer(sender, live::answer(sender.id, refused));
  }
  return !asked_.empty();
}

/// Why the files cannot be read anew, and the run goes on; empty: it ends, and they are.
std::string LiveRun::reload() {
  if (options_.model == "-") return "what came from standard input cannot be read anew";
  try {
    SimulateOptions trial = options_;
    trial.changeGoals = {};
    const std::unique_ptr<Scene> scene = loadScene(trial);
    if (options_.planControl) readPlan(trial, *scene);
    gdd::GoalDirectedController controller(scene->model);
    setUp(trial, *scene, controller);
  } catch (const std::exception& error) {
    tell(error.what());
    return error.what();
  }
  options_.live->reload = true;
  return "";
}

void LiveRun::after(const SeenStep& step, const Verdict& verdict) {
  const bool gdd = !controller_.goals.empty();
  times_.add(step.record.stepUs);
  contacts_ = step.contacts;
  if (gdd) status_.certified &= isCertified(controller_.report.status);
  const Clock::time_point now = Clock::now();
  if (now < nextFrame_) return;
  nextFrame_ = std::max(nextFrame_ + kFrameTime, now);
  status_.record = step.record;
  status_.fallen = verdict.lying(step.data.kinematics, step.record.time);
  status_.saturated = verdict.saturatedNow();
  status_.atLimits = verdict.atLimitsNow();
  showErrors(verdict.goals());
  showFrame(step.data, step.contacts, step.record.time);
}

void LiveRun::showErrors(const GoalRecord& goals) {
  status_.errors.clear();
  for (std::size_t i = 0; i < goals.tracks().size(); ++i) {
    const GoalRecord::Track& track = goals.tracks()[i];
    const double error = goals.errors()[static_cast<Eigen::Index>(i)];
    if (track.acts && std::isfinite(error))
      status_.errors.push_back({track.outcome.name, track.outcome.unit, error});
  }
}

/// Where the robot is now that no step brought it there.
void LiveRun::showState() {
  computeKinematics(model_, state_, shown_.kinematics);
  showFrame(shown_, contacts_, state_.time);
}

void LiveRun::showFrame(const Data& data, const std::vector<Snapshot::ContactForce>& contacts,
                        double time) {
  takeSnapshot(model_, data.kinematics, contacts, time, snapshot_);
  for (std::size_t i = 0; i < marks_.size(); ++i)
    marks_[i] = scene_.markOf(i, {model_, state_, data});
  frame_.forget();
  frame_.add(snapshot_, marks_);
  server_->publishFrame(
      std::make_shared<const std::string>(live::frameMessage(frame_, taken_, hands_.paused())));
}

void LiveRun::showStatus() {
  if (server_->pages() == 0) return;
  status_.time = state_.time;
  status_.steps = taken_;
  status_.paused = hands_.paused();
  status_.factor = hands_.factor();
  status_.stepUs = times_.spread();
  status_.realTimeFactor = std::max(0.0, pace_.reached(state_.time));
  status_.gravity = model_.options.gravity;
  status_.effectsOff.clear();
  for (const std::string& effect : hands_.names().effects)
    if (!model_.options.effects.has(*effectFromName(effect))) status_.effectsOff.push_back(effect);
  const VectorX* sought = hands_.keyframes().sought();
  status_.joints.clear();
  status_.targets.clear();
  for (const live::JointName& joint : hands_.names().joints) {
    const int at = model_.bodies[joint.body].q;
    status_.joints.push_back(state_.q[at]);
    if (sought) status_.targets.push_back((*sought)[at]);
  }
  status_.pages = server_->pages();
  server_->publishStatus(std::make_shared<const std::string>(live::statusMessage(status_, hands_)));
  status_.certified = true;
}

void LiveRun::tell(const std::string& message) {
  status_.told.push_back(fmt::format("{:.2f} s: {}", state_.time, message));
  if (status_.told.size() > kToldLines) status_.told.erase(status_.told.begin());
}

void LiveRun::finish(long taken) {
  server_.reset();
  if (record_) record_->finish(taken);
}

}  // namespace softgauss::app
