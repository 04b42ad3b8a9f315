// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/state.hpp"

#include <algorithm>
#include <cstring>

#include "softgauss/engine/core/rotation.hpp"

namespace softgauss {
namespace {

Quaternion readQuaternion(const VectorX& q, int i) {
  return {q[i], q[i + 1], q[i + 2], q[i + 3]};  // w first
}

/// FNV-1a over eight bytes.
void mixBits(std::uint64_t& h, std::uint64_t bits) {
  for (int byte = 0; byte < 8; ++byte) {
    h ^= (bits >> (8 * byte)) & 0xffu;
    h *= 0x100000001b3ull;
  }
}

/// The same over an array.
void mix(std::uint64_t& h, const double* data, Eigen::Index count) {
  for (Eigen::Index i = 0; i < count; ++i) {
    std::uint64_t bits;
    std::memcpy(&bits, data + i, sizeof bits);
    mixBits(h, bits);
  }
}

}  // namespace

State::State(const Model& model)
    : q(model.q0),
      v(VectorX::Zero(model.nv)),
      a(VectorX::Zero(model.nv)),
      connectionForces(VectorX::Zero(9 * static_cast<Eigen::Index>(model.connections.size()))) {
  warmstart.a = VectorX::Zero(model.nv);
  warmstart.gddA = VectorX::Zero(model.nv);
  warmstart.multipliers = VectorX::Zero(model.nv);
  warmstart.control = VectorX::Zero(model.nv);
  warmstart.gddSearchAge.assign(model.trees.size(), 0);
  warmstart.gddSearchWait.assign(model.trees.size(), 1);
  if (!model.options.sleep.enabled) return;
  sleep.island.assign(model.trees.size(), -1);
  sleep.restTime.assign(model.trees.size(), 0.0);
  sleep.restSpeed.assign(model.trees.size(), 0.0);
  sleep.restVelocity = VectorX::Zero(model.nv);
  if (std::ranges::none_of(model.dofs, [](const Dof& dof) { return dof.servo.exists(); })) return;
  sleep.setPoint = sleep.setPointRate = VectorX::Zero(model.nv);
}

void wake(SleepState& sleep, int tree) {
  if (!sleep.isAsleep(tree)) return;
  const int island = sleep.island[idx(tree)];
  for (std::size_t t = 0; t < sleep.island.size(); ++t)
    if (sleep.island[t] == island) sleep.island[t] = -1, sleep.restTime[t] = 0.0;
}

void wakeAll(SleepState& sleep) {
  std::ranges::fill(sleep.island, -1);
  std::ranges::fill(sleep.restTime, 0.0);
}

std::uint64_t hash(const State& state) {
  std::uint64_t h = 0xcbf29ce484222325ull;
  for (const VectorX* x : {&state.q, &state.v, &state.warmstart.a, &state.warmstart.gddA,
                           &state.warmstart.multipliers, &state.warmstart.control})
    mix(h, x->data(), x->size());
  const double rest[] = {state.time, state.warmstart.valid ? 1.0 : 0.0,
                         state.warmstart.gddValid ? 1.0 : 0.0};
  mix(h, rest, 3);
  for (const std::vector<int>* solves :
       {&state.warmstart.gddSearchAge, &state.warmstart.gddSearchWait})
    for (const int count : *solves) mixBits(h, static_cast<std::uint64_t>(count));
  for (const BreakpointKey& k : state.warmstart.breakpoints)
    for (const int part :
         {k.kind, k.row.first, k.row.second, k.row.contact, k.row.direction, k.index})
      mixBits(h, static_cast<std::uint64_t>(part));
  if (state.hasAcceleration) mix(h, state.a.data(), state.a.size());
  mix(h, state.connectionForces.data(), state.connectionForces.size());
  for (const int island : state.sleep.island) mixBits(h, static_cast<std::uint64_t>(island));
  if (!state.sleep.island.empty()) mix(h, &state.sleep.lastTime, 1);
  for (const std::vector<double>* x : {&state.sleep.restTime, &state.sleep.restSpeed})
    mix(h, x->data(), static_cast<Eigen::Index>(x->size()));
  for (const VectorX* x :
       {&state.sleep.restVelocity, &state.sleep.setPoint, &state.sleep.setPointRate})
    mix(h, x->data(), x->size());
  return h;
}

void integratePosition(const Model& model, const VectorX& v, double h, VectorX& q) {
  const Segment all{1, model.bodyCount()};
  integratePosition(model, v, h, {&all, 1}, q);
}

void integratePosition(const Model& model, const VectorX& v, double h, Segments bodies,
                       VectorX& q) {
  for (const Segment s : bodies)
    for (int b = s.begin; b < s.end; ++b) {
      const Body& body = model.bodies[idx(b)];
      if (body.joint == JointKind::floating) {
        q.segment<3>(body.q) += h * v.segment<3>(body.v);
        const Quaternion r =
            readQuaternion(q, body.q + 3) * quaternionExp(h * Vector3(v.segment<3>(body.v + 3)));
        q.segment<4>(body.q + 3) = Eigen::Vector4d(r.w(), r.x(), r.y(), r.z()) / r.norm();
      } else if (body.joint != JointKind::world) {
        q[body.q] += h * v[body.v];
      }
    }
}

VectorX positionDifference(const Model& model, const VectorX& q0, const VectorX& q1) {
  VectorX v(model.nv);
  positionDifference(model, q0, q1, v);
  return v;
}

void positionDifference(const Model& model, const VectorX& q0, const VectorX& q1, VectorX& v) {
  v.setZero();
  for (const Body& body : model.bodies) {
    if (body.joint == JointKind::floating) {
      v.segment<3>(body.v) = q1.segment<3>(body.q) - q0.segment<3>(body.q);
      const Quaternion d =
          readQuaternion(q0, body.q + 3).conjugate() * readQuaternion(q1, body.q + 3);
      v.segment<3>(body.v + 3) = quaternionLog(d);
    } else if (body.joint != JointKind::world) {
      v[body.v] = q1[body.q] - q0[body.q];
    }
  }
}

}  // namespace softgauss
