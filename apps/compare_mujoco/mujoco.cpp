// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/mujoco.hpp"

#include <algorithm>
#include <cstdlib>

#include "apps/compare_mujoco/mujoco_load.hpp"

namespace softgauss::app {

struct Mujoco::Memory {
  mjModel* model = nullptr;
  mjData* data = nullptr;
  std::vector<mjtNum> transition{};  ///< of differentiateStep()
  ~Memory() {
    if (data) mj_deleteData(data);
    if (model) mj_deleteModel(model);
  }
};

namespace {

VectorX vectorOf(const mjtNum* values, int count) {
  return Eigen::Map<const VectorX>(values, count);
}

}  // namespace

Mujoco::Mujoco(const std::string& mjcf) : memory_(std::make_unique<Memory>()) {
  memory_->model = loadMujoco("comparison.xml", mjcf);
  memory_->data = mj_makeData(memory_->model);
}
Mujoco::~Mujoco() = default;

std::string Mujoco::version() { return mj_versionString(); }
std::string Mujoco::withRoom(std::string mjcf) {
#if mjVERSION_HEADER >= 300
  const std::size_t size = mjcf.find("<size ");
  mjcf.replace(size, mjcf.find("/>", size) - size, "<size memory=\"2G\"");
#endif
  return mjcf;
}
int Mujoco::nq() const { return memory_->model->nq; }
int Mujoco::nv() const { return memory_->model->nv; }
void Mujoco::setTolerance(double tolerance) { memory_->model->opt.tolerance = tolerance; }

void Mujoco::set(const State& state, const VectorX& tau) {
  mjData* const d = memory_->data;
  Eigen::Map<VectorX>(d->qpos, nq()) = state.q;
  Eigen::Map<VectorX>(d->qvel, nv()) = state.v;
  setForce(tau);
  d->time = state.time;
}
void Mujoco::setForce(const VectorX& tau) {
  Eigen::Map<VectorX>(memory_->data->qfrc_applied, nv()) = tau;
}
void Mujoco::setWarmStart(const VectorX& a) {
  Eigen::Map<VectorX>(memory_->data->qacc_warmstart, nv()) = a;
}
void Mujoco::setAcceleration(const VectorX& a) {
  Eigen::Map<VectorX>(memory_->data->qacc, nv()) = a;
}
void Mujoco::forward() { mj_forward(memory_->model, memory_->data); }
double Mujoco::imbalance() const {
  const mjData& d = *memory_->data;
  VectorX force(nv());
  mj_mulM(memory_->model, memory_->data, force.data(), d.qacc);
  const VectorX smooth = vectorOf(d.qfrc_smooth, nv());
  force -= smooth + vectorOf(d.qfrc_constraint, nv());
  return force.cwiseAbs().maxCoeff() / std::max(1.0, smooth.cwiseAbs().maxCoeff());
}
void Mujoco::inverse() { mj_inverse(memory_->model, memory_->data); }
void Mujoco::step() { mj_step(memory_->model, memory_->data); }
void Mujoco::differentiateStep() {
  constexpr double kDifference = 1e-6;
  const auto states = static_cast<std::size_t>(2 * nv() + memory_->model->na);
  memory_->transition.resize(states * states);
  mjd_transitionFD(memory_->model, memory_->data, kDifference, 0, memory_->transition.data(),
                   nullptr, nullptr, nullptr);
}

VectorX Mujoco::q() const { return vectorOf(memory_->data->qpos, nq()); }
VectorX Mujoco::v() const { return vectorOf(memory_->data->qvel, nv()); }
VectorX Mujoco::acceleration() const { return vectorOf(memory_->data->qacc, nv()); }
VectorX Mujoco::inverseForce() const { return vectorOf(memory_->data->qfrc_inverse, nv()); }

std::vector<Contact> Mujoco::contacts(const Model& model) const {
  std::vector<Contact> contacts;
  for (int i = 0; i < memory_->data->ncon; ++i) {
    const mjContact& c = memory_->data->contact[i];
    Contact contact;
    // Geometries are called after their indices.
    contact.geometryA = std::atoi(mj_id2name(memory_->model, mjOBJ_GEOM, c.geom1) + 1);
    contact.geometryB = std::atoi(mj_id2name(memory_->model, mjOBJ_GEOM, c.geom2) + 1);
    contact.bodyA = model.geometries[static_cast<std::size_t>(contact.geometryA)].body;
    contact.bodyB = model.geometries[static_cast<std::size_t>(contact.geometryB)].body;
    contact.p_WC = Eigen::Map<const Vector3>(c.pos);
    contact.n_W = Eigen::Map<const Vector3>(c.frame);
    contact.tangent_W = Eigen::Map<const Vector3>(c.frame + 3);
    contact.distance = c.dist;
    contacts.push_back(contact);
  }
  return contacts;
}

double Mujoco::deepestOverlap() const {
  double deepest = 0.0;
  for (int i = 0; i < memory_->data->ncon; ++i)
    deepest = std::max(deepest, -memory_->data->contact[i].dist);
  return deepest;
}

std::string Mujoco::firstWarning() const {
  for (int i = 0; i < mjNWARNING; ++i)
    if (memory_->data->warning[i].number > 0)
      return mju_warningText(i, static_cast<std::size_t>(memory_->data->warning[i].lastinfo));
  return {};
}

}  // namespace softgauss::app
