// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/inverse_weight.hpp"

#include <Eigen/LU>

#include "softgauss/engine/dynamics/inertia.hpp"
#include "softgauss/engine/dynamics/jacobian.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

TEST(InverseWeights, OfAFreeBodyAreItsOwn) {
  LinkSpec link = boxLink("body", 2.0, {0.1, 0.2, 0.3}, {0.4, -0.1, 0.2});
  const Model model = freeBody(link).build();
  const InverseWeights w(model);
  EXPECT_SMALL(w.translation[1] - 0.5, 1e-14);
  // Facts of a reference engine for this box: 18.8461538462 at its centre.
  EXPECT_SMALL(w.rotation[1] / 18.846153846153847 - 1.0, 1e-13);
  EXPECT_EQ(w.translation[0], 0.0);
  EXPECT_EQ(w.rotation[0], 0.0);
}

TEST(InverseWeights, AreMeansOfTheInverseInertiaAtTheCenterOfMass) {
  for (int seed = 0; seed < 10; ++seed) {
    const Model model = randomForest(seed).build();
    const InverseWeights w(model);
    Scene s(model);
    s.stages();
    const MatrixX Minv = s.data->inertia.M.dense().inverse();
    const Kinematics& k = s.data->kinematics;
    Eigen::Matrix<double, 3, Eigen::Dynamic> J(3, model.nv);
    for (int b = 1; b < model.bodyCount(); ++b) {
      pointJacobian(model, k, b, k.X_WB[b] * model.bodies[b].com, J);
      EXPECT_SMALL(w.translation[b] / ((J * Minv * J.transpose()).trace() / 3.0) - 1.0, 1e-10);
      rotationJacobian(model, k, b, J);
      const double rotation = (J * Minv * J.transpose()).trace() / 3.0;  // 0 where only slides
      EXPECT_SMALL((w.rotation[b] - rotation) / (1.0 + rotation), 1e-10);
      const int v = model.bodies[b].v;
      for (int i = 0; i < model.bodies[b].dofs; ++i) {
        const int first = v + (model.bodies[b].dofs == 6 ? i / 3 * 3 : 0);
        const double mean =
            model.bodies[b].dofs == 6 ? Minv.diagonal().segment(first, 3).mean() : Minv(v, v);
        EXPECT_SMALL(w.dof[v + i] / mean - 1.0, 1e-10);
      }
    }
  }
}

TEST(InverseWeights, AreThoseOfTheInitialConfiguration) {
  Scene s(chain(4).build());
  const std::vector<double> before = s.data->weights.dof;
  s.state.q.setConstant(1.0);
  s.steps(3);
  EXPECT_EQ(s.data->weights.dof, before);
}

}  // namespace
}  // namespace softgauss::test
