// SPDX-License-Identifier: Apache-2.0
#include "apps/python/pushes.hpp"

#include <algorithm>

#include "softgauss/io/names.hpp"

namespace softgauss::python {

void Pushes::set(const Simulation& sim, const std::string& link, const Vector3& force_W,
                 const Vector3& moment_W, const Vector3& p_LP) {
  const Model& model = sim.model();
  if (const std::string problem = io::linkProblem(model, link); !problem.empty())
    throw NameError("push: " + problem);
  std::erase_if(pushes_, [&](const io::TimedWrench& push) { return push.link == link; });
  if (!force_W.isZero(0.0) || !moment_W.isZero(0.0)) {
    io::TimedWrench push;
    push.link = link;
    push.p_LP = p_LP;
    push.force_W = force_W;
    push.moment_W = moment_W;
    push.start = -kInfinity;
    pushes_.push_back(push);
  }
  schedule_ = io::WrenchSchedule(model, pushes_);
  if (kinematics_.X_WB.empty()) kinematics_ = Kinematics(model);
}

void Pushes::act(Simulation& sim) {
  if (pushes_.empty()) return sim.input().wrenches.clear();
  computeKinematics(sim.model(), sim.state(), kinematics_);
  schedule_.at(sim.time(), sim.model().options.timestep, kinematics_, sim.input().wrenches);
}

}  // namespace softgauss::python
