// SPDX-License-Identifier: Apache-2.0
/// How the shapes of a scene move: how far each goes in a step, and how long they may be left
/// alone.

#include <algorithm>

#include "softgauss/collision/detail/scene.hpp"
#include "softgauss/collision/reach.hpp"

namespace softgauss::collision {

/// Of all at rest where they are now.
void SceneContacts::Scene::makeMovingShapes() {
  for (std::size_t i = 0; i < X_WG.size(); ++i) {
    const Shape& shape = model.geometries[i].shape;
    const ConvexHull* hull = set.hull[i].get();
    const TriangleMesh* surface = set.surface[i].get();
    moving.push_back({&shape, hull, extentOf(shape, hull, surface), &X_WG[i], centre[i],
                      Vector3::Zero(), Vector3::Zero(), surface});
  }
  fast.assign(moving.size(), 0);
}

bool SceneContacts::Scene::setMotion(const Kinematics& kinematics, double longest, double sign) {
  visitPosed(nullptr, [&](std::size_t g) { poseOne(kinematics, g); });
  bool any = false;
  for (const int g : posed) {
    const auto i = static_cast<std::size_t>(g);
    const int body = model.geometries[i].body;
    MovingShape& shape = moving[i];
    shape.centre = centre[i];
    shape.v = sign * pointVelocity(model, kinematics, body, centre[i]);
    shape.omega = sign * kinematics.V[static_cast<std::size_t>(body)].angular;
    fast[i] = shape.mayTunnel(longest);
    any = any || fast[i];
  }
  return any;
}

void SceneContacts::Scene::setWay(const Kinematics& kinematics, double time, std::size_t i) {
  const int body = model.geometries[i].body;
  const Vector3& omega = kinematics.V[static_cast<std::size_t>(body)].angular;
  way[i] = time * (pointVelocity(model, kinematics, body, centre[i]).norm() +
                   omega.norm() * moving[i].extent.lever);
}

double SceneContacts::Scene::tunnellingTimeBound(const Kinematics& kinematics, double longest,
                                                 double sign) {
  // Where no shape moves by its share of its own thickness no two move by that of both.
  if (!setMotion(kinematics, longest, sign)) return longest;
  double time = longest;
  for (const Row& row : rows) {
    const auto a = static_cast<std::size_t>(row.a), b = static_cast<std::size_t>(row.b);
    if ((fast[a] || fast[b]) && surfaceWithin(row, time * moving[a].speed()))
      time = collision::tunnellingTimeBound(moving[a], moving[b], row.margin, time);
  }
  return time;
}

}  // namespace softgauss::collision
