// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/box_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/collision/manifold.hpp"
#include "softgauss/engine/core/check.hpp"

namespace softgauss::collision {
namespace {

/// A face is kept as the axis unless edges separate better by this part of the box, so that
/// rounding does not choose.
constexpr double kEdgeAdvantage = 1e-3;

/// Nearest points of the edges through pA along u and through pB along w, midway.
Vector3 betweenEdges(const Vector3& pA, const Vector3& u, const Vector3& pB, const Vector3& w) {
  const Vector3 r = pA - pB;
  const double cosine = u.dot(w);
  const Vector3 across = u - w * cosine;
  const double s = -across.dot(r) / std::max(across.squaredNorm(), 1e-12);
  const double t = w.dot(r) + s * cosine;
  return 0.5 * (pA + u * s + pB + w * t);
}

}  // namespace

void sphereBox(const Shape& sphere, const Transform& X_WA, const Shape& box, const Transform& X_WB,
               double margin, PairContacts& out) {
  const Vector3& h = box.halfExtents;
  const Vector3 c = X_WB.R.transpose() * (X_WA.p - X_WB.p);
  const Vector3 excess = c - c.cwiseMax(-h).cwiseMin(h);
  double height = excess.norm();
  Vector3 outward = Vector3::Zero();
  if (height > 1e-12 * h.maxCoeff()) {
    outward = excess / height;
  } else {
    int axis = 0;
    height = (c.cwiseAbs() - h).maxCoeff(&axis);
    outward[axis] = std::copysign(1.0, c[axis]);
  }
  const double distance = height - sphere.radius;
  if (distance >= margin) return;
  const Vector3 n = -(X_WB.R * outward);
  out.add(X_WA.p + n * (sphere.radius + 0.5 * distance), n, distance);
}

BoxSeparation separateBoxes(const Vector3& halfA, const Transform& X_WA, const Vector3& halfB,
                            const Transform& X_WB, double margin) {
  const Matrix3 C = X_WA.R.transpose() * X_WB.R;  // axes of B in A
  const Matrix3 absC = C.cwiseAbs();
  const Vector3 c = X_WA.R.transpose() * (X_WB.p - X_WA.p);  // centre of B in A
  const Vector3 cB = C.transpose() * c;                      // the same offset in B's axes

  BoxSeparation best;
  best.distance = -kInfinity;
  const Vector3 alongA = c.cwiseAbs() - halfA - absC * halfB;
  const Vector3 alongB = cB.cwiseAbs() - halfB - absC.transpose() * halfA;
  int a = 0, b = 0;
  const double faceA = alongA.maxCoeff(&a), faceB = alongB.maxCoeff(&b);
  // B's face must win clearly, by the same argument.
  const double slack = kEdgeAdvantage * std::min(halfA.maxCoeff(), halfB.maxCoeff());
  if (faceB > faceA + 0.1 * slack) {
    best.distance = faceB;
    best.n_W = X_WB.R.col(b) * std::copysign(1.0, cB[b]);
  } else {
    best.distance = faceA;
    best.n_W = X_WA.R.col(a) * std::copysign(1.0, c[a]);
  }
  if (std::max(faceA, faceB) >= margin) {
    best.distance = std::max(faceA, faceB);
    return best;
  }

  double bestEdge = -kInfinity;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double sine2 = 1.0 - C(i, j) * C(i, j);
      if (sine2 < 1e-6) continue;  // parallel edges: a face does as well
      // e_i × b_j in A's axes has components −C(i2, j) along i1 and C(i1, j) along i2.
      const double centre = c[i2] * C(i1, j) - c[i1] * C(i2, j);
      const double reach = halfA[i1] * absC(i2, j) + halfA[i2] * absC(i1, j) +
                           halfB[j1] * absC(i, j2) + halfB[j2] * absC(i, j1);
      const double sine = std::sqrt(sine2);
      const double separation = (std::abs(centre) - reach) / sine;
      if (separation <= bestEdge) continue;
      bestEdge = separation;
      if (separation <= best.distance + slack && separation < margin) continue;
      best.edgeA = i;
      best.edgeB = j;
      best.n_W = X_WA.R.col(i).cross(X_WB.R.col(j)) * (std::copysign(1.0, centre) / sine);
      if (separation >= margin) {
        best.distance = separation;
        return best;
      }
    }
  }
  if (best.edgeA >= 0) best.distance = bestEdge;
  return best;
}

void boxBox(const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
            double margin, PairContacts& out) {
  const BoxSeparation s = separateBoxes(a.halfExtents, X_WA, b.halfExtents, X_WB, margin);
  if (s.distance >= margin) return;
  const Convex boxA{&a, nullptr}, boxB{&b, nullptr};
  const Vector3 pA = supportPoint(boxA, X_WA, s.n_W), pB = supportPoint(boxB, X_WB, -s.n_W);
  if (s.edgeA >= 0) {
    const Vector3 p = betweenEdges(pA, X_WA.R.col(s.edgeA), pB, X_WB.R.col(s.edgeB));
    out.add(p, s.n_W, s.distance);
    return;
  }
  addFaceContacts(supportFace(boxA, X_WA, s.n_W), supportFace(boxB, X_WB, -s.n_W),
                  {0.5 * (pA + pB), s.n_W, s.distance}, margin, out);
}

}  // namespace softgauss::collision
