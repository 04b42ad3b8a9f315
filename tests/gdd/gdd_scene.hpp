// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Scenes with goals, once as gdd/ sees them and once in dense matrices.

#include <memory>

#include "softgauss/gdd/gdd.hpp"
#include "tests/gdd/dense_gdd.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {

class GddScene {
 public:
  Scene scene;
  gdd::GoalCost cost;
  gdd::ControlLimits limits;
  std::unique_ptr<gdd::AugmentedLagrangian> solver;
  gdd::GddReport report;
  DenseGdd dense;

  /// The scene's stages must be computed.
  explicit GddScene(Scene s);

  /// ½ weight |J a − target|² for the point p_WP of a body, in both forms.
  void addPoint(int body, const Vector3& p_WP, double weight, const Vector3& target);
  /// ½ weight (a − target)ᵀM(a − target), in both forms.
  void addMetric(double weight, const VectorX& target);
  /// ½ weight |Σ C F − target|² over the frictional contacts of pyramids named, in both forms.
  void addForce(double weight, const Vector3& target,
                const std::vector<std::pair<int, gdd::ContactForceCost::Map>>& contacts);
  /// Two goals of random wrenches of random contacts; none where nothing touches.
  void addRandomForces(Random& random);
  void removeForces();
  /// A few random points, and virtual damping as often as not.
  void addRandomGoals(Random& random);
  /// Gives actuated dofs a box about 0, with probability `share`.
  void addRandomBox(Random& random, double share, double largest = 10.0);
  /// Gives the driven dofs other actuators: gears, differentials of two dofs, and, where `tendons`,
  /// single actuators that pull two dofs; most with bounds of about `largest`.
  void addRandomActuators(Random& random, bool tendons, double largest = 10.0);
  /// Multipliers and penalties such as the solver has them.
  void randomMultipliers(Random& random, double scale);

  /// Solves from the scene's warm start, cold unless a test has set one; takes the multipliers
  /// and penalties at the end over into `dense`.
  const VectorX& solve();

  /// Place of a row in `dense`.
  int rowIndex(RowId id) const;

  Data& data() { return *scene.data; }
  const Model& model() const { return scene.model; }
  int dofs() const { return scene.model.nv; }
  /// Takes the box over into `dense`.
  void matchBox();
};

/// randomScene(seed, contacts) with random goals and boxes.
GddScene randomGddScene(std::uint64_t seed, int contacts, double boxShare = 0.5,
                        const RandomTreeOptions& options = {});

/// The same with the other soft effects for odd seeds, and goals of contact forces for every third.
GddScene lawGddScene(std::uint64_t seed, int contacts, double boxShare = 0.5);

}  // namespace softgauss::test
