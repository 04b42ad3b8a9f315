// SPDX-License-Identifier: Apache-2.0
/// MuJoCo in the study. Settings: integrator=Euler|RK4|implicit…, cone=elliptic, noslip=iterations,
/// impratio. All else is MuJoCo's default.

#include <mujoco/mujoco.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "apps/rivals/engine.hpp"
#include "apps/rivals/engines/mjcf.hpp"

namespace rivals {
namespace {

class Mujoco final : public Engine {
 public:
  Mujoco(const Scene& scene, double h, Settings& settings) : scene_(scene) {
    std::ostringstream options;
    options << " timestep=\"" << h << "\" integrator=\"" << settings.word("integrator", "Euler")
            << "\" cone=\"" << settings.word("cone", "pyramidal") << "\" noslip_iterations=\""
            << settings.number("noslip", 0) << "\" impratio=\"" << settings.number("impratio", 1)
            << "\"";
    std::string file = std::filesystem::temp_directory_path() / "rivals_XXXXXX.xml";
    const int descriptor = mkstemps(file.data(), 4);
    const std::string text =
        mjcf(scene, h, options.str(), mj_version() < 300 ? "nconmax=\"450\" njmax=\"1900\"" : "");
    if (descriptor < 0 || write(descriptor, text.data(), text.size()) < 0)
      throw std::runtime_error("no file for MJCF");
    close(descriptor);
    char error[500] = "";
    model_ = mj_loadXML(file.c_str(), nullptr, error, sizeof error);
    std::filesystem::remove(file);
    if (!model_) throw std::runtime_error(error);
    data_ = mj_makeData(model_);
    mju_user_warning = [](const char*) {};
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) place(static_cast<int>(i));
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      for (int k = 0; k < 3; ++k)
        data_->xfrc_applied[6 * bodies_[i] + k] = scene.bodies[i].force[k];
    mj_forward(model_, data_);
  }
  ~Mujoco() override {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }

  bool step(int count) override {
    for (int k = 0; k < count; ++k) {
      for (const auto& [v, joint] : forces_) data_->qfrc_applied[v] = joint->forceAt(data_->time);
      mj_step(model_, data_);
      for (const int warning : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC})
        if (data_->warning[warning].number > 0) return false;
    }
    return true;
  }

  std::vector<BodyState> state() override {
    mj_kinematics(model_, data_);
    mj_comPos(model_, data_);
    mj_comVel(model_, data_);
    std::vector<BodyState> out;
    for (const int b : bodies_) {
      mjtNum v[6];  // about the centre of mass: mjOBJ_BODY is the inertial frame
      mj_objectVelocity(model_, data_, mjOBJ_BODY, b, v, 0);
      const mjtNum *p = data_->xipos + 3 * b, *q = data_->xquat + 4 * b;
      out.push_back(
          {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}, {v[3], v[4], v[5]}, {v[0], v[1], v[2]}});
    }
    return out;
  }

  double mass() override { return mj_getTotalmass(model_); }
  std::optional<double> kineticEnergy() override {
    Eigen::VectorXd Mv(model_->nv);
    mj_mulM(model_, data_, Mv.data(), data_->qvel);
    return 0.5 * Mv.dot(Eigen::Map<const Eigen::VectorXd>(data_->qvel, model_->nv));
  }
  Eigen::MatrixXd massMatrix() override {
    const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(model_->nv, model_->nv);
    Eigen::MatrixXd M(model_->nv, model_->nv);
    for (int i = 0; i < model_->nv; ++i)
      mj_mulM(model_, data_, M.col(i).data(), unit.col(i).data());
    return M;
  }

 private:
  void place(int i) {
    const int body =
        mj_name2id(model_, mjOBJ_BODY, scene_.bodies[static_cast<std::size_t>(i)].name.c_str());
    bodies_.push_back(body);
    const BodyState& start = scene_.bodies[static_cast<std::size_t>(i)].start;
    const int joint = model_->body_jntadr[body], v = model_->jnt_dofadr[joint];
    const Vector3d spin = start.orientation.conjugate() * start.angularVelocity;
    const Joint* j = scene_.carrier(i);
    if (!j)
      for (int k = 0; k < 3; ++k)
        data_->qvel[v + k] = start.velocity[k], data_->qvel[v + 3 + k] = spin[k];
    else if (j->kind == JointKind::ball)
      for (int k = 0; k < 3; ++k) data_->qvel[v + k] = spin[k];
    else
      data_->qvel[v] = scene_.jointSpeed(*j);
    if (j && j->isDriven()) forces_.push_back({v, j});
  }

  const Scene scene_;
  mjModel* model_;
  mjData* data_;
  std::vector<int> bodies_;
  std::vector<std::pair<int, const Joint*>> forces_;  // of degrees of freedom
};

}  // namespace

std::string engineVersion() { return std::string("MuJoCo ") + mj_versionString(); }

std::unique_ptr<Engine> makeEngine(const Scene& scene, double h, Settings& settings) {
  return std::make_unique<Mujoco>(scene, h, settings);
}

}  // namespace rivals
