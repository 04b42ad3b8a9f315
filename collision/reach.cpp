// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/reach.hpp"

#include <cmath>

namespace softgauss::collision {
namespace {

/// The body nearest to both that carries, or is, both.
int carrier(const Model& model, int a, int b) {
  while (a != b) (a > b ? a : b) = model.bodies[static_cast<std::size_t>(a > b ? a : b)].parent;
  return a;
}

/// All places of `ball`, which is fixed to `body`, in the axes of `top`.
Ball swept(const Model& model, int body, int top, Ball ball) {
  for (; body != top; body = model.bodies[static_cast<std::size_t>(body)].parent) {
    const Body& b = model.bodies[static_cast<std::size_t>(body)];
    if (b.joint != JointKind::revolute) {
      ball.radius = kInfinity;
      return ball;
    }
    const Vector3 foot = b.axis * b.axis.dot(ball.centre);
    ball.radius += (ball.centre - foot).norm();
    ball.centre = b.X_PB * foot;
  }
  return ball;
}

}  // namespace

double leastDistance(const Model& model, const Geometry& a, const Ball& ballA, const Geometry& b,
                     const Ball& ballB) {
  const int top = carrier(model, a.body, b.body);
  const bool planeA = a.shape.kind == ShapeKind::plane, planeB = b.shape.kind == ShapeKind::plane;
  if (planeA || planeB) {
    const Geometry &plane = planeA ? a : b, &other = planeA ? b : a;
    if (plane.body != top || (planeA && planeB)) return -kInfinity;
    const Ball ball = swept(model, other.body, top, planeA ? ballB : ballA);
    return plane.X_BG.R.col(2).dot(ball.centre - plane.X_BG.p) - ball.radius;
  }
  const Ball first = swept(model, a.body, top, ballA), second = swept(model, b.body, top, ballB);
  return (first.centre - second.centre).norm() - first.radius - second.radius;
}

}  // namespace softgauss::collision
