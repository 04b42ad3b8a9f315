// SPDX-License-Identifier: Apache-2.0
#include "apps/step_benchmark/landscape.hpp"

#include <cmath>
#include <memory>
#include <regex>

#include "apps/shared/cpu_time.hpp"
#include "apps/step_benchmark/in_turn.hpp"
#include "apps/step_benchmark/scenes.hpp"

namespace softgauss::app {
namespace {

constexpr double kLeg = 0.25, kFoot = 0.03;  ///< of a thigh and of a shank; radius [m]

double heightAt(double x, double y) { return 0.05 * std::sin(0.8 * x) * std::cos(0.7 * y); }

/// 317 × 317 cells of 5 cm about the origin.
std::shared_ptr<const Mesh> hills() {
  constexpr int kCells = 317;
  constexpr double kCell = 0.05;
  auto mesh = std::make_shared<Mesh>();
  mesh->file = "hills";
  for (int i = 0; i <= kCells; ++i)
    for (int j = 0; j <= kCells; ++j) {
      const double x = (i - 0.5 * kCells) * kCell, y = (j - 0.5 * kCells) * kCell;
      mesh->vertices.emplace_back(x, y, heightAt(x, y));
    }
  const auto vertex = [](int i, int j) { return i * (kCells + 1) + j; };
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      mesh->triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh->triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  return mesh;
}

LinkSpec massOf(const std::string& name, double mass, const Vector3& com) {
  LinkSpec link;
  link.name = name;
  link.mass = mass;
  link.com = com;
  link.I_Lcm = 0.01 * mass * Matrix3::Identity();
  return link;
}

/// A trunk of 30 kg on four straight legs, whose joints are held by springs.
ModelBuilder quadruped(const Shape& ground) {
  ModelBuilder builder("quadruped");
  builder.base = BaseKind::floating;
  builder.X_WRoot.p = Vector3(0.0, 0.0, 2.0 * kLeg + kFoot + 0.02);
  builder.link(massOf("trunk", 30.0, Vector3::Zero()));
  for (const double x : {0.3, -0.3})
    for (const double y : {0.2, -0.2}) {
      const std::string leg =
          std::string(x > 0.0 ? "front" : "hind") + (y > 0.0 ? "_left" : "_right");
      std::string parent = "trunk";
      Vector3 place(x, y, 0.0);
      for (const char* part : {"_hip", "_thigh", "_shank"}) {
        const bool isHip = part == std::string("_hip");
        const double length = isHip ? 0.0 : kLeg;
        builder.link(massOf(leg + part, isHip ? 0.5 : 1.0, Vector3(0.0, 0.0, -0.5 * length)));
        JointSpec joint;
        joint.name = leg + part + "_joint";
        joint.type = JointType::continuous;
        joint.parent = parent;
        joint.child = leg + part;
        joint.X_PC.p = place;
        joint.axis = isHip ? Vector3::UnitX() : Vector3::UnitY();
        joint.stiffness = 500.0;
        joint.damping = 10.0;
        joint.effort = 0.0;
        builder.joint(joint);
        parent = leg + part;
        place = Vector3(0.0, 0.0, -length);
      }
      GeometrySpec foot;
      foot.name = leg + "_foot";
      foot.link = parent;
      foot.X_LG.p = Vector3(0.0, 0.0, -kLeg);
      foot.shape = Shape::sphere(kFoot);
      builder.geometry(foot);
    }
  GeometrySpec fixed;
  fixed.name = "ground";
  fixed.link = "world";
  fixed.shape = ground;
  return builder.geometry(fixed);
}

std::unique_ptr<Scene> standing(const Shape& ground) {
  auto scene = makeScene(quadruped(ground).build());
  for (int i = 0; i < 3000; ++i) scene->step();
  if (scene->data->stats.contacts != 4) throw std::runtime_error("the quadruped does not stand");
  return scene;
}

}  // namespace

std::map<std::string, double> landscapeFigures(const std::string& filter) {
  const std::string name = "landscape_quadruped";
  if (!std::regex_search(name, std::regex(filter))) return {};
  const Shape surface = Shape::surface(hills());
  const double start = cpuSeconds();
  makeScene(quadruped(surface).build());
  const double load = cpuSeconds() - start;
  const auto onHills = standing(surface), onPlane = standing(Shape::plane());
  const std::vector<double> times = timeInTurn(
      {{nullptr, [&] { onHills->step(); }, 200}, {nullptr, [&] { onPlane->step(); }, 200}});
  return {{name + ".first.us", times[0]},
          {name + ".second.us", times[1]},
          {name + ".added.us", times[0] - times[1]},
          {name + ".load_s", load}};
}

}  // namespace softgauss::app
