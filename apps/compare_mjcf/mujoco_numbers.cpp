// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mjcf/mujoco_numbers.hpp"

#include <mujoco/mujoco.h>

#include <cmath>
#include <memory>
#include <random>

#include "softgauss/engine/core/check.hpp"

namespace softgauss::app {
namespace {

/// A model and its data in MuJoCo.
class MujocoFile {
 public:
  explicit MujocoFile(const std::filesystem::path& file)
      : model_(load(file), mj_deleteModel), data_(mj_makeData(model_.get()), mj_deleteData) {
    model_->opt.tolerance = 0.0;
    model_->opt.ls_tolerance = 1e-10;
    model_->opt.iterations = 1000;
    model_->opt.ls_iterations = 1000;
    model_->opt.solver = mjSOL_NEWTON;
    model_->opt.disableflags |= mjDSBL_CONTACT | mjDSBL_ACTUATION;
    // Its weight of a joint whose body only slides leaves out the armature; here it has it.
    for (int j = 0; j < model_->njnt; ++j) {
      const int body = model_->jnt_bodyid[j], dof = model_->jnt_dofadr[j];
      if (model_->body_simple[body] == 2)
        model_->dof_invweight0[dof] = 1.0 / (model_->body_mass[body] + model_->dof_armature[dof]);
    }
  }
  mjModel& model() { return *model_; }
  mjData& data() { return *data_; }

  MjcfState random(std::mt19937& generator) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const mjModel& m = *model_;
    MjcfState state;
    state.q = Eigen::Map<const VectorX>(m.qpos0, m.nq);
    state.v.resize(m.nv);
    for (int j = 0; j < m.njnt; ++j) {
      const int at = m.jnt_qposadr[j];
      if (m.jnt_type[j] == mjJNT_FREE) {
        for (int i = 0; i < 7; ++i) state.q[at + i] = normal(generator);
        state.q.segment<4>(at + 3).normalize();
      } else {
        // A little beyond the range too, so that limits act.
        const double* r = m.jnt_range + 2 * j;
        state.q[at] = m.jnt_limited[j]
                          ? 0.5 * (r[0] + r[1]) + 0.55 * (r[1] - r[0]) * uniform(generator)
                          : m.qpos0[at] + uniform(generator);
      }
    }
    for (double& x : state.v) x = normal(generator);
    return state;
  }

  void evaluate(MjcfState& state) {
    mjModel* const m = model_.get();
    mjData* const d = data_.get();
    mj_resetData(m, d);
    Eigen::Map<VectorX>(d->qpos, m->nq) = state.q;
    Eigen::Map<VectorX>(d->qvel, m->nv) = state.v;
    mj_forward(m, d);
    state.M.resize(m->nv, m->nv);
    for (int i = 0; i < m->nv; ++i) {
      const VectorX unit = VectorX::Unit(m->nv, i);
      mj_mulM(m, d, state.M.col(i).data(), unit.data());
    }
    state.bias = Eigen::Map<const VectorX>(d->qfrc_bias, m->nv);
    state.passive = Eigen::Map<const VectorX>(d->qfrc_passive, m->nv);
    state.a = Eigen::Map<const VectorX>(d->qacc, m->nv);
  }

  /// Joint forces of an actuator alone whose control is far below or above, and not clipped where
  /// it is a set point; not finite where they grow with it.
  VectorX extreme(int actuator, double sign) {
    mjModel* const m = model_.get();
    const VectorX gains = parameters(m->actuator_gainprm, mjNGAIN),
                  biases = parameters(m->actuator_biasprm, mjNBIAS);
    const mjtByte kept = m->actuator_ctrllimited[actuator];
    for (int i = 0; i < m->nu; ++i) {
      if (i == actuator) continue;
      std::fill_n(m->actuator_gainprm + i * mjNGAIN, mjNGAIN, 0.0);
      std::fill_n(m->actuator_biasprm + i * mjNBIAS, mjNBIAS, 0.0);
    }
    if (m->actuator_biastype[actuator] == mjBIAS_AFFINE) m->actuator_ctrllimited[actuator] = 0;
    const double far = gains[actuator * mjNGAIN] < 0.0 ? -sign * 1e9 : sign * 1e9;
    const VectorX once = forcesAt(actuator, far), twice = forcesAt(actuator, 2.0 * far);
    m->actuator_ctrllimited[actuator] = kept;
    std::copy(gains.begin(), gains.end(), m->actuator_gainprm);
    std::copy(biases.begin(), biases.end(), m->actuator_biasprm);
    return once == twice ? once : VectorX::Constant(m->nv, kInfinity);
  }

 private:
  VectorX parameters(const mjtNum* first, int each) const {
    return Eigen::Map<const VectorX>(first, model_->nu * each);
  }

  /// With all actuators on, at the start.
  VectorX forcesAt(int actuator, double control) {
    mj_resetData(model_.get(), data_.get());
    data_->ctrl[actuator] = control;
    model_->opt.disableflags &= ~mjDSBL_ACTUATION;
    mj_forward(model_.get(), data_.get());
    model_->opt.disableflags |= mjDSBL_ACTUATION;
    return Eigen::Map<const VectorX>(data_->qfrc_actuator, model_->nv);
  }

  static mjModel* load(const std::filesystem::path& file) {
    mju_user_warning = [](const char*) {};
    char error[1000] = "";
    mjModel* const model = mj_loadXML(file.c_str(), nullptr, error, sizeof error);
    if (!model) throw ModelError({file.string(), 0}, "MuJoCo", std::string("refuses: ") + error);
    return model;
  }

  std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
  std::unique_ptr<mjData, void (*)(mjData*)> data_;
};

/// Of bodies that move, each with what is fixed to it, in the order of its last joint.
std::vector<double> movingMasses(const mjModel& m) {
  std::vector<double> masses(static_cast<std::size_t>(m.nbody), 0.0);
  for (int b = 1; b < m.nbody; ++b)
    masses[static_cast<std::size_t>(m.body_weldid[b])] += m.body_mass[b];
  std::vector<double> moving;
  for (int b = 1; b < m.nbody; ++b)
    if (m.body_weldid[b] == b && m.body_dofnum[b] > 0 && masses[static_cast<std::size_t>(b)] > 0.0)
      moving.push_back(masses[static_cast<std::size_t>(b)]);
  return moving;
}

}  // namespace

std::string mujocoVersion() { return mj_versionString(); }

int mujocoDofs(const std::filesystem::path& file) { return MujocoFile(file).model().nv; }

MjcfNumbers mujocoNumbers(const std::filesystem::path& file) {
  MujocoFile mujoco(file);
  const mjModel& m = mujoco.model();
  MjcfNumbers numbers;
  numbers.nq = m.nq;
  numbers.nv = m.nv;
  for (int b = 1; b < m.nbody; ++b) numbers.mass += m.body_mass[b];
  numbers.bodyMasses = movingMasses(m);
  std::mt19937 generator(1);
  for (int i = 0; i < kMjcfStates; ++i) {
    MjcfState state = mujoco.random(generator);
    mujoco.evaluate(state);
    numbers.states.push_back(std::move(state));
  }
  for (int i = 0; i < m.nu; ++i) {
    const VectorX low = mujoco.extreme(i, -1.0), high = mujoco.extreme(i, 1.0);
    numbers.least.push_back(low);
    numbers.most.push_back(high);
  }
  return numbers;
}

}  // namespace softgauss::app
