// SPDX-License-Identifier: Apache-2.0
/// A state goes to bytes and back, to the same bits, and to no other model.
#include "softgauss/engine/model/saved_state.hpp"

#include <gtest/gtest.h>

#include "softgauss/engine/core/bytes.hpp"
#include "softgauss/engine/core/sealed.hpp"
#include "softgauss/engine/model/model_hash.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// Random scenes, with every integrator among them.
Scene someScene(int seed) {
  Scene s = lawScene(static_cast<std::uint64_t>(seed));
  s.model.options.integrator =
      kIntegratorNames[static_cast<std::size_t>(seed) % std::size(kIntegratorNames)].integrator;
  s.data = std::make_unique<Data>(s.model);
  return s;
}

std::string problemOf(const Model& model, const std::string& bytes) {
  try {
    restore(model, bytes);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

TEST(SavedState, GoesOnToTheSameBits) {
  for (int seed = 0; seed < 24; ++seed) {
    Scene s = someScene(seed);
    s.steps(7);
    const std::string bytes = save(s.model, s.state);
    Scene other = someScene(seed);
    other.state = restore(other.model, bytes);
    EXPECT_TRUE(save(other.model, other.state) == bytes) << seed;
    s.steps(7);
    other.steps(7);
    EXPECT_TRUE(save(other.model, other.state) == save(s.model, s.state)) << seed;
  }
}

TEST(SavedState, IsOfOneModelWithItsOptions) {
  const Model model = humanoid().build();
  const std::string bytes = save(model, State(model));
  const auto refuses = [&](auto&& change) {
    Model other = model;
    change(other);
    return hash(other) != hash(model) &&
           problemOf(other, bytes).find("another model") != std::string::npos;
  };
  EXPECT_FALSE(refuses([](Model&) {}));
  EXPECT_FALSE(refuses([](Model& m) { m.warnings.emplace_back("a warning"); }));
  EXPECT_TRUE(refuses([](Model& m) { m.options.timestep *= 0.5; }));
  EXPECT_TRUE(refuses([](Model& m) { m.options.effects.remove(Effect::gravity); }));
  EXPECT_TRUE(refuses([](Model& m) { m.options.tolerance *= 0.5; }));
  EXPECT_TRUE(refuses([](Model& m) { m.bodies[1].mass = std::nextafter(m.bodies[1].mass, 9e9); }));
  EXPECT_TRUE(refuses([](Model& m) { m.bodies.back().I_Bcm.yz += 1e-9; }));
  EXPECT_TRUE(refuses([](Model& m) { m.dofs.back().damping += 1e-9; }));
  EXPECT_TRUE(refuses([](Model& m) { m.geometries.front().shape.radius += 1e-9; }));
  EXPECT_TRUE(refuses([](Model& m) { m.geometries.front().material.impedance.direct.emplace(); }));
  EXPECT_TRUE(refuses([](Model& m) { std::swap(m.jointNames[7], m.jointNames[8]); }));
  EXPECT_TRUE(refuses([](Model& m) { m.ranges.pop_back(); }));
  EXPECT_TRUE(refuses([](Model& m) { m.q0[2] += 1e-9; }));
}

// Shapes that share a mesh are told by the mesh, wherever in memory it is.
TEST(SavedState, SeesVerticesOfMeshes) {
  const auto modelWith = [](double x) {
    Model model = humanoid().build();
    Mesh mesh;
    mesh.vertices = {Vector3(x, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1), Vector3(0, 0, 0)};
    const auto shared = std::make_shared<const Mesh>(mesh);
    for (int g : {0, 1}) model.geometries[static_cast<std::size_t>(g)].shape = Shape::hull(shared);
    return model;
  };
  EXPECT_EQ(hash(modelWith(1.0)), hash(modelWith(1.0)));
  EXPECT_NE(hash(modelWith(1.0)), hash(modelWith(1.5)));
}

TEST(SavedState, ThatWasChangedIsRefused) {
  Scene s = someScene(3);
  s.steps(3);
  const std::string bytes = save(s.model, s.state);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ 0x10);
    EXPECT_NE(problemOf(s.model, changed), "") << i;
    EXPECT_NE(problemOf(s.model, bytes.substr(0, i)), "") << i;
  }
  EXPECT_NE(problemOf(s.model, "nothing").find("SGSTATE"), std::string::npos);
}

// Who writes a checksum of his own still has to bring a state of the model.
TEST(SavedState, ThatDoesNotFitIsRefused) {
  const Scene s = someScene(4);
  const auto problem = [&](auto&& change) {
    State state = s.state;
    change(state);
    return problemOf(s.model, save(s.model, state));
  };
  EXPECT_EQ(problem([](State&) {}), "");
  EXPECT_NE(problem([](State& x) { x.q.conservativeResize(x.q.size() - 1); }), "");
  EXPECT_NE(problem([](State& x) { x.v[0] = kNaN; }), "");
  EXPECT_NE(problem([](State& x) { x.time = kInfinity; }), "");
  EXPECT_NE(problem([](State& x) { x.a.conservativeResize(x.a.size() - 1); }), "");
  EXPECT_NE(problem([](State& x) { x.a[0] = kNaN; }), "");
  EXPECT_NE(problem([](State& x) { x.warmstart.control.resize(0); }), "");
  EXPECT_NE(problem([](State& x) { x.warmstart.gddSearchWait[0] = 0; }), "");
  EXPECT_NE(problem([](State& x) { x.warmstart.gddSearchAge[0] = 1 << 30; }), "");
}

}  // namespace
}  // namespace softgauss::test
