// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/model_hash.hpp"

#include <map>

#include "softgauss/engine/core/bytes.hpp"

namespace softgauss {
namespace {

// Structured bindings name every field: one that is added does not compile before it is here.

class Hasher {
 public:
  std::uint64_t value() const {
    Fnv1a hash;
    hash.add(bytes_.bytes());
    return hash.value();
  }
  template <class... T>
  void operator()(const T&... x) {
    (add(x), ...);
  }

 private:
  template <class T>
  void add(const T& x) {
    bytes_(x);
  }
  template <class T>
  void add(const std::vector<T>& list) {
    bytes_(list.size());
    for (const T& x : list) add(x);
  }
  template <class T>
  void add(const std::optional<T>& x) {
    bytes_(x.has_value());
    if (x) add(*x);
  }
  void add(const Transform& X) { bytes_(X.R, X.p); }
  void add(const Symmetric3& I) { bytes_(I.xx, I.yy, I.zz, I.xy, I.xz, I.yz); }
  void add(const EffectSet& effects) {
    for (const EffectName& e : kEffectNames) bytes_(effects.has(e.effect));
  }
  void add(const MechanismSet& mechanisms) {
    for (const MechanismName& m : kMechanismNames) bytes_(mechanisms.has(m.mechanism));
  }
  void add(const Options& o) {
    const auto& [timestep, gravity, effects, integrator, integrationTolerance, stepDoubling,
                 implicitInSolve, cone, impedanceRatio, substepAngle, outerTimestep, nextTimestep,
                 constraintModel, mechanisms, sleep, exactDiagonal, maxIterations, tolerance] = o;
    const auto& [enabled, speed, time, controlled] = sleep;
    (*this)(timestep, gravity, effects, integrator, integrationTolerance, stepDoubling,
            implicitInSolve, cone, impedanceRatio, substepAngle, outerTimestep, nextTimestep,
            constraintModel, mechanisms, enabled, speed, time, controlled, exactDiagonal,
            maxIterations, tolerance);
  }
  void add(const Body& b) {
    const auto& [joint, massless, parent, q, v, dofs, tree, robot, subtreeEnd, X_PB, axis, mass,
                 com, I_Bcm, reference, borneMass, borneCom] = b;
    (*this)(joint, massless, parent, q, v, dofs, tree, robot, subtreeEnd, X_PB, axis, mass, com,
            I_Bcm, reference, borneMass, borneCom);
  }
  void add(const Tree& t) {
    const auto& [rootBody, bodyEnd, firstDof, dofEnd, mass, actuated] = t;
    (*this)(rootBody, bodyEnd, firstDof, dofEnd, mass, actuated);
  }
  void add(const ReferenceSpring& s) {
    const auto& [stiffness, damping] = s;
    (*this)(stiffness, damping);
  }
  void add(const Impedance& i) {
    const auto& [timeConstant, dampingRatio, dMin, dMax, width, midpoint, power, direct] = i;
    (*this)(timeConstant, dampingRatio, dMin, dMax, width, midpoint, power, direct);
  }
  void add(const ContactSpring& s) {
    const auto& [stiffness, restDepth, damping, dampingRatio] = s;
    (*this)(stiffness, restDepth, damping, dampingRatio);
  }
  void add(const Material& m) {
    const auto& [sliding, torsional, rolling, condim, margin, priority, mixWeight, impedance,
                 spring] = m;
    (*this)(sliding, torsional, rolling, condim, margin, priority, mixWeight, impedance, spring);
  }
  void add(const Dof& d) {
    const auto& [body, parent, damping, armature, dryFriction, frictionImpedance, stiffness,
                 springReference, actuated, effortLower, effortUpper, velocityLimit, servo] = d;
    const auto& [kp, kd, effort, setPoint, setPointRate] = servo;
    (*this)(body, parent, damping, armature, dryFriction, frictionImpedance, stiffness,
            springReference, actuated, effortLower, effortUpper, velocityLimit, kp, kd, effort,
            setPoint, setPointRate);
  }
  void add(const JointRange& r) {
    const auto& [body, lower, upper, margin, impedance] = r;
    (*this)(body, lower, upper, margin, impedance);
  }
  void add(const Connection& c) {
    const auto& [bodyA, bodyB, p_AP, p_BP, impedance, centers] = c;
    (*this)(bodyA, bodyB, p_AP, p_BP, impedance, centers.inA, centers.inB);
  }
  void add(const Weld& w) {
    const auto& [bodyA, bodyB, X_AF, X_BF, torqueScale, impedance, centers] = w;
    (*this)(bodyA, bodyB, X_AF, X_BF, torqueScale, impedance, centers.inA, centers.inB);
  }
  void add(const JointCoupling& c) {
    const auto& [follower, leader, polynomial, impedance] = c;
    (*this)(follower, leader, polynomial, impedance);
  }
  void add(const Frame& f) {
    const auto& [name, body, X_BF] = f;
    (*this)(name, body, X_BF);
  }
  /// A mesh that several shapes have is looked at once.
  void add(const Shape& s) {
    const auto& [kind, radius, halfLength, halfExtents, mesh] = s;
    (*this)(kind, radius, halfLength, halfExtents);
    const auto [place, isNew] = meshes_.try_emplace(mesh.get(), meshes_.size());
    bytes_(place->second);
    if (!isNew || !mesh) return;
    const auto& [vertices, triangles, parts, file] = *mesh;
    (void)parts, (void)file;
    (*this)(vertices, triangles);
  }
  void add(const Geometry& g) {
    const auto& [name, link, body, X_BG, shape, material, base, automaticMesh, bits] = g;
    (*this)(name, link, body, X_BG, shape, material, base, automaticMesh, bits.category, bits.mask);
  }
  void add(const ContactPair& p) {
    const auto& [geometryA, geometryB, material, always] = p;
    (*this)(geometryA, geometryB, material, always);
  }

  ByteWriter bytes_;
  std::map<const Mesh*, std::size_t> meshes_;  ///< by place of their first shape
};

}  // namespace

std::uint64_t hash(const Model& model) {
  const auto& [name, options, bodies, bodyNames, jointNames, trees, dofs, ranges, connections,
               welds, couplings, frames, geometries, contactPairs, apart, visuals, warnings, nq, nv,
               q0] = model;
  (void)visuals, (void)warnings;
  Hasher hasher;
  hasher(name, options, bodies, bodyNames, jointNames, trees, dofs, ranges, connections, welds,
         couplings, frames, geometries, contactPairs, nq, nv, q0);
  for (const auto& [linkA, linkB] : apart) hasher(linkA, linkB);
  return hasher.value();
}

}  // namespace softgauss
