// SPDX-License-Identifier: Apache-2.0
/// What --explain says of softness is what the simulation does.

#include <gtest/gtest.h>

#include <sstream>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/io/explain.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

constexpr double kRadius = 0.1;

/// Balls of 0.02 and 5 kg on guides, so that they cannot roll, above the ground.
struct Balls {
  Model model;
  io::ExplainContext context;

  Balls(const Material& ground, const Material& ball, Cone cone) {
    ModelBuilder builder("balls");
    builder.link(emptyLink("world"));
    GeometrySpec plane = groundSpec(1.0);
    plane.material = ground;
    builder.geometry(plane);
    for (const auto& [name, mass, at] : {std::tuple("light", 0.02, 0.0), {"heavy", 5.0, 1.0}}) {
      const std::string rail = std::string(name) + "_rail";
      builder.link(emptyLink(rail)).link(sphereLink(name, mass, kRadius));
      builder.joint(jointSpec(rail, JointType::prismatic, "world", rail,
                              {Matrix3::Identity(), Vector3(0, at, kRadius)}, Vector3::UnitX()));
      builder.joint(jointSpec(name, JointType::prismatic, rail, name));
      GeometrySpec shape = geometrySpec(name, Shape::sphere(kRadius));
      shape.material = ball;
      builder.geometry(shape);
    }
    builder.options.cone = cone;
    model = builder.build();
    context.materials = {{"floor", ground}, {"rubber", ball}};
    const collision::SceneContacts contacts(model);
    for (const collision::GeometryPair& pair : contacts.filter().pairs)
      context.pairs.emplace_back(pair.a, pair.b);
  }
};

/// The numbers of the row of a body, after its name and mass.
std::vector<double> rowOf(const std::string& text, const std::string& body) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find("'" + body + "', ");
    if (at == std::string::npos) continue;
    std::istringstream words(line.substr(line.find(" kg", at) + 3));
    std::vector<double> numbers;
    for (double x = 0.0; words >> x;) numbers.push_back(x);
    return numbers;
  }
  return {};
}

Material surface(double friction) {
  Material m;
  m.slidingFriction = friction;
  return m;
}

// Depth, stiffness, damping and creep, to 1 % and better: four digits are printed. What sticks
// stops about a thousandth off its depth (5.7).
TEST(ExplainSoftness, SaysWhatTheSimulationDoes) {
  constexpr double kDepth = 2e-3;
  std::vector<std::pair<Material, Material>> surfaces;
  surfaces.emplace_back(surface(0.6), surface(0.3));
  surfaces.emplace_back(surface(0.2), surface(1.5));
  surfaces.back().second.impedance.direct = {3000.0, 90.0};
  surfaces.emplace_back(surface(0.8), surface(0.1));
  surfaces.back().second.spring = {4e4, 0.0, 700.0, 0.0};
  surfaces.emplace_back(surface(0.4), surface(0.1));
  surfaces.back().first.spring = {0.0, 1e-3, 0.0, 1.0};
  surfaces.back().second.spring = {0.0, 2e-3, 0.0, 0.7};
  for (const Cone cone : {Cone::pyramidal, Cone::elliptic})
    for (const auto& [ground, ball] : surfaces) {
      Balls balls(ground, ball, cone);
      const std::string text = io::softnessText(balls.model, balls.context);
      EXPECT_NE(text.find("floor and rubber: friction"), std::string::npos) << text;
      for (const char* body : {"light", "heavy"}) {
        const std::vector<double> row = rowOf(text, body);
        ASSERT_GE(row.size(), 6u) << text;
        Scene s(balls.model, std::make_shared<collision::SceneContacts>(balls.model));
        const Body& along = s.model.bodies[s.model.findJoint(std::string(body) + "_rail")];
        const Body& up = s.model.bodies[s.model.findJoint(body)];
        s.input.controlled =
            allTrees(s.model, cone == Cone::elliptic ? kControlledSoft : kControlled);
        s.input.tau[along.v] = 0.2 * row[4];
        s.steps(8000);
        SCOPED_TRACE(text);
        EXPECT_SMALL(-1e3 * s.state.q[up.q] / row[0] - 1.0, kDepth);
        EXPECT_SMALL(9.81 * up.mass / -s.state.q[up.q] / row[1] - 1.0, kDepth);
        EXPECT_SMALL(1e3 * s.state.v[along.v] / s.input.tau[along.v] / row[3] - 1.0, 1e-3);
      }
    }
}

TEST(ExplainSoftness, NamesPairsWithASurfaceOfTheirOwn) {
  Balls balls(surface(0.6), surface(0.3), Cone::pyramidal);
  balls.model.contactPairs.push_back({0, 1, surface(0.0)});
  const std::string text = io::softnessText(balls.model, balls.context);
  EXPECT_NE(text.find("'world/shape' and 'light/shape', a surface of their own: friction 0"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("slides"), std::string::npos);
  EXPECT_NE(text.find("rubber on itself"), std::string::npos) << "the balls may touch";
}

TEST(ExplainSoftness, IsSilentWithoutContactsOrWeight) {
  Balls balls(surface(0.6), surface(0.3), Cone::pyramidal);
  EXPECT_EQ(io::softnessText(balls.model, {}), "");
  balls.model.options.gravity.setZero();
  EXPECT_EQ(io::softnessText(balls.model, balls.context), "");
}

}  // namespace
}  // namespace softgauss::test
