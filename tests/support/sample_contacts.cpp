// SPDX-License-Identifier: Apache-2.0
#include "tests/support/sample_contacts.hpp"

#include "softgauss/engine/constraints/contact.hpp"

namespace softgauss::test {
namespace {

class Detector {
 public:
  Detector(const Model& model, const Kinematics& k, bool tangentOfPlane, ContactSet& contacts)
      : model_(model), k_(k), tangentOfPlane_(tangentOfPlane), contacts_(contacts) {}

  Transform pose(int g) const { return k_.X_WB[geometry(g).body] * geometry(g).X_BG; }
  const Geometry& geometry(int g) const { return model_.geometries[g]; }

  /// The point of geometry b, a sphere of radius r about c, against plane a.
  void planePoint(int a, int b, const Vector3& c, double r) {
    const Transform X = pose(a);
    const Vector3 n = X.R.col(2);
    const double distance = n.dot(c - X.p) - r;
    if (!(distance < margin(a, b))) return;
    Contact contact = between(a, b);
    contact.distance = distance;
    contact.n_W = n;
    contact.p_WC = c - n * (r + 0.5 * distance);
    if (tangentOfPlane_) contact.tangent_W = X.R.col(0);
    contacts_.add(contact);
  }

  void plane(int a, int b) {
    const Transform X = pose(b);
    const Shape& shape = geometry(b).shape;
    const Vector3 half = shape.halfExtents;
    switch (shape.kind) {
      case ShapeKind::sphere:
        planePoint(a, b, X.p, shape.radius);
        return;
      case ShapeKind::capsule:
        for (const double end : {1.0, -1.0})
          planePoint(a, b, X * Vector3(0, 0, end * shape.halfLength), shape.radius);
        return;
      case ShapeKind::box:
        for (int i = 0; i < 8; ++i)
          planePoint(a, b,
                     X * Vector3(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(),
                                 i & 4 ? half.z() : -half.z()),
                     0.0);
        return;
      default:
        return;
    }
  }

  void spheres(int a, int b) {
    const Vector3 ca = pose(a).p, cb = pose(b).p;
    const double ra = geometry(a).shape.radius, gap = (cb - ca).norm();
    const double distance = gap - ra - geometry(b).shape.radius;
    if (!(distance < margin(a, b)) || gap == 0.0) return;
    Contact contact = between(a, b);
    contact.distance = distance;
    contact.n_W = (cb - ca) / gap;
    contact.p_WC = ca + contact.n_W * (ra + 0.5 * distance);
    contacts_.add(contact);
  }

 private:
  double margin(int a, int b) const { return pairMaterial(model_, a, b).margin; }
  Contact between(int a, int b) const {
    Contact contact;
    contact.geometryA = a;
    contact.geometryB = b;
    contact.bodyA = geometry(a).body;
    contact.bodyB = geometry(b).body;
    return contact;
  }

  const Model& model_;
  const Kinematics& k_;
  bool tangentOfPlane_;
  ContactSet& contacts_;
};

bool neighbours(const Model& model, int a, int b) {
  return a == b || model.bodies[a].parent == b || model.bodies[b].parent == a;
}

}  // namespace

void SampleContacts::detect(const Model& model, const Kinematics& k,
                            ContactSet& contacts) noexcept {
  contacts.clear();
  Detector detector(model, k, tangentOfPlane, contacts);
  const int count = static_cast<int>(model.geometries.size());
  for (int a = 0; a < count; ++a) {
    const Geometry& A = model.geometries[a];
    for (int b = 0; b < count; ++b) {
      const Geometry& B = model.geometries[b];
      if (A.shape.kind == ShapeKind::plane && A.body == 0 && B.body != 0) detector.plane(a, b);
      if (spheresTouch && a < b && A.shape.kind == ShapeKind::sphere &&
          B.shape.kind == ShapeKind::sphere && !neighbours(model, A.body, B.body))
        detector.spheres(a, b);
    }
  }
}

FixedContacts randomContacts(const Model& model, const Kinematics& k, Random& random, int count) {
  FixedContacts source;
  const int geometries = static_cast<int>(model.geometries.size());
  while (static_cast<int>(source.points.size()) < count) {
    Contact c;
    c.geometryA = random.chance(0.2) ? 0 : random.index(geometries);
    c.geometryB = random.index(geometries);
    c.bodyA = model.geometries[c.geometryA].body;
    c.bodyB = model.geometries[c.geometryB].body;
    if (c.bodyA == c.bodyB) continue;
    const int near = c.bodyB == 0 ? c.bodyA : c.bodyB;
    c.p_WC = k.X_WB[near].p + random.vector3(0.1);
    c.n_W = random.direction();
    if (random.chance(0.5)) c.tangent_W = random.direction();
    c.distance = random.chance(0.8) ? -random.uniform(0.0, 0.002) : random.uniform(0.0, 0.002);
    source.points.push_back(c);
  }
  return source;
}

}  // namespace softgauss::test
