// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/stiction.hpp"

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// Balls of 1 and 2 kg, one on the other, 0.1 mm deep in the ground and in each other.
Scene twoBalls(Cone cone) {
  constexpr double kDepth = 1e-4, kRadius = 0.1;
  ModelBuilder builder("heap");
  builder.options.cone = cone;
  builder.geometry(groundSpec(0.8));
  for (const double height : {kRadius - kDepth, 3.0 * kRadius - 2.0 * kDepth}) {
    const std::string name = height < 2.0 * kRadius ? "lower" : "upper";
    ModelBuilder one(name);
    one.base = BaseKind::floating;
    one.X_WRoot.p.z() = height;
    one.link(sphereLink(name, name == "lower" ? 1.0 : 2.0, kRadius));
    one.geometry(geometrySpec(name, Shape::sphere(kRadius), 0.8));
    builder.add(one, "");
  }
  return Scene(builder.build(), std::make_shared<SampleContacts>());
}

/// One row of the ground's contact.
struct Row {
  double D = 0.0, reference = 0.0, perInertia = 0.0;
};
Row firstRow(Scene& scene, bool soft) {
  scene.input.controlled =
      soft ? allTrees(scene.model, kControlledSoft) : std::vector<std::uint8_t>();
  EXPECT_EQ(scene.stages(), SolveStatus::converged);
  const Constraints& all = scene.data->constraints;
  if (scene.model.options.cone == Cone::elliptic)
    return {all.ellipticContact.cone(0).D, all.ellipticContact.reference[0],
            all.ellipticContact.perInertia(0)};
  return {all.contact.D[0], all.contact.reference[0], all.contact.perInertia[0]};
}

// (5.7): D grows as speeds fall, by the larger of slip and approach, and the part of the force
// that the depth makes stays as it was.
TEST(Stiction, HardensAsItSlowsDownUnderTheSameForce) {
  constexpr double kMu = 0.8;
  for (const Cone cone : {Cone::pyramidal, Cone::elliptic}) {
    Scene scene = twoBalls(cone);
    scene.model.options.mechanisms.remove(Mechanism::slipCorrection);  // it has its own tests
    const double b = 1.0 / scene.model.options.timestep;
    const Row soft = firstRow(scene, true);
    const double edges = cone == Cone::pyramidal ? 4.0 : 1.0;
    const double A = 1.0 / (soft.D * soft.perInertia);
    const double w = 9.81 / (soft.D * edges * A * b), u = soft.reference / b + w;
    EXPECT_GT(u, 1e-4);
    for (const double share : {0.0, 1e-9, 1e-3, 0.5, 1.0, 3.0})
      for (const bool slides : {true, false}) {
        scene.state.v.setZero();
        scene.state.v[0] = slides ? share * 200.0 * u / kMu : 0.0;  // x, by no rotation
        scene.state.v[2] = slides ? 0.0 : -share * 0.06 * w;
        const double slip = std::clamp(share, 1e-5, 1.0);
        const Row hard = firstRow(scene, false), same = firstRow(scene, true);
        EXPECT_SMALL(hard.D * slip / soft.D - 1.0, 1e-9) << share << slides;
        EXPECT_EQ(same.D, soft.D);
        // What speeds make is common to both references.
        const double depthHard = hard.reference - same.reference + soft.reference;
        EXPECT_SMALL(hard.D * depthHard / (soft.D * soft.reference) - 1.0, 1e-9) << share << slides;
      }
  }
}

// What stands alone on a softness that is given is as that says, bit for bit.
TEST(Stiction, LeavesWhatStandsAloneAsItIs) {
  for (const Cone cone : {Cone::pyramidal, Cone::elliptic}) {
    std::uint64_t hashes[2];
    for (const bool soft : {false, true}) {
      ModelBuilder builder = humanoid();
      builder.options.cone = cone;
      builder.geometry(groundSpec(0.8));
      Model model = builder.build();
      for (Geometry& g : model.geometries) g.material.impedance.timeConstant = 0.03;
      Scene scene(model, std::make_shared<SampleContacts>());
      if (soft) scene.input.controlled = allTrees(scene.model, kControlledSoft);
      int contacts = 0;
      for (int i = 0; i < 400; ++i) {
        scene.step();
        contacts += scene.data->stats.contacts;
      }
      EXPECT_GT(contacts, 100);
      hashes[soft] = hash(scene.state);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
  }
}

// What bounces is left alone: springs, and references that are less than critically damped.
TEST(Stiction, LeavesWhatBouncesAsItIs) {
  for (const Cone cone : {Cone::pyramidal, Cone::elliptic})
    for (const bool spring : {true, false}) {
      Scene scene = twoBalls(cone);
      for (Geometry& g : scene.model.geometries) {
        if (spring)
          g.material.spring = ContactSpring{.stiffness = 2500.0};
        else
          g.material.impedance.direct = {.stiffness = 2500.0, .damping = 0.0};
      }
      const Row soft = firstRow(scene, true), hard = firstRow(scene, false);
      EXPECT_GT(soft.D, 0.0);
      EXPECT_EQ(hard.D, soft.D);
      EXPECT_EQ(hard.reference, soft.reference);
    }
}

// The inverse gives back what went in, hard as contacts are: what is off is the rounding of J a,
// which D multiplies.
TEST(Stiction, InverseRecoversTheForce) {
  int sticking = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Scene scene = randomScene(seed, 12);
    scene.state.v *= 1e-6;
    ASSERT_EQ(scene.stages(), SolveStatus::converged);
    scene.forward();
    double stiffest = 0.0;
    for (const double D : scene.data->constraints.contact.D) stiffest = std::max(stiffest, D);
    for (const ContactRows& made : scene.data->constraints.contact.contactsWithRows())
      sticking += made.regularisationScale < 0.01;
    VectorX tau(scene.model.nv);
    inverseDynamics(scene.model, scene.data->forward.a, *scene.data, tau);
    const double most = scene.data->forward.a.cwiseAbs().maxCoeff();
    EXPECT_SMALL((tau - scene.data->forces.tau).cwiseAbs().maxCoeff(),
                 1e-8 + 100.0 * 2.2e-16 * stiffest * most)
        << seed;
  }
  EXPECT_GT(sticking, 50);
}

}  // namespace
}  // namespace softgauss::test
