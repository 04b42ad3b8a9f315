// SPDX-License-Identifier: Apache-2.0
#include "tests/random_scenes/small_scene.hpp"

#include <cmath>

#include "softgauss/engine/dynamics/coupled_mass.hpp"
#include "softgauss/engine/dynamics/regular_mass.hpp"

namespace softgauss::fuzz {

Draws::Draws(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {
  std::seed_seq seed(data, data + size);
  after_.seed(seed);
  oddness_ = chance(0.2) ? 0.02 : 0.0;  // most scenes hold none
}

std::uint16_t Draws::word() {
  if (left_ < 2) return static_cast<std::uint16_t>(after_());
  const auto word = static_cast<std::uint16_t>(data_[0] | data_[1] << 8);
  data_ += 2;
  left_ -= 2;
  return word;
}

double Draws::power(double low, double high) { return std::pow(10.0, uniform(low, high)); }

double Draws::odd(double usual) {
  if (!chance(oddness_)) return usual;
  constexpr double kOdd[] = {0.0, -0.0, 5e-324, 1e-300, 1e-160, 1e-12,     -1.0,
                             1e6, 1e12, 1e155,  -1e155, 1e300,  kInfinity, kNaN};
  return kOdd[index(static_cast<int>(std::size(kOdd)))];
}

Vector3 Draws::vector(double scale) {
  Vector3 x;
  for (double& entry : x) entry = odd(uniform(-scale, scale));
  return x;
}

Matrix3 Draws::rotation() {
  // One draw after another: the order in which arguments are evaluated is the compiler's.
  Eigen::Vector4d x;
  for (double& entry : x) entry = uniform(-1.0, 1.0);
  const Quaternion q(x);
  return q.norm() > 0.01 ? q.normalized().toRotationMatrix() : Matrix3::Identity();
}

namespace {

std::shared_ptr<const Mesh> tetrahedron(double size) {
  auto mesh = std::make_shared<Mesh>();
  mesh->vertices = {Vector3(size, size, size), Vector3(size, -size, -size),
                    Vector3(-size, size, -size), Vector3(-size, -size, size)};
  mesh->triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  return mesh;
}

/// Draws the parts of a scene one after another.
class Decoder {
 public:
  explicit Decoder(Draws& draws) : draws_(draws), builder_("small") {}

  ModelBuilder& build() {
    setOptions();
    LinkSpec world;
    world.name = "world";
    builder_.link(world);
    links_ = {"world"};
    if (draws_.chance(0.6)) geometry("world", Shape::plane(), Transform{});
    for (int trees = 1 + draws_.index(3); trees > 0; --trees) tree();
    ties_ = draws_.chance(0.2);
    if (ties_) tie();
    return builder_;
  }
  bool isTied() const { return ties_; }

 private:
  void setOptions() {
    Options& o = builder_.options;
    // Those that look within a step take longest, and are drawn more seldom.
    constexpr Integrator kOthers[] = {Integrator::semiImplicitEuler, Integrator::implicit,
                                      Integrator::semiImplicitEuler, Integrator::implicit,
                                      Integrator::implicitMidpoint,  Integrator::rungeKutta4,
                                      Integrator::dormandPrince};
    if (draws_.chance(0.4)) o.integrator = kOthers[draws_.index(7)];
    o.timestep = draws_.odd(draws_.chance(0.5) ? 0.002 : draws_.power(-4.0, -1.5));
    o.gravity = draws_.chance(0.8) ? Vector3(0.0, 0.0, -9.81) : draws_.vector(20.0);
    if (draws_.chance(0.3)) o.cone = Cone::elliptic;
    if (draws_.chance(0.15)) o.useMujocoModel();
    o.stepDoubling = o.isSingleSolve() && draws_.chance(0.05);
    if (draws_.chance(0.15)) o.mechanisms.remove(Mechanism::slipCorrection);
    o.exactDiagonal = draws_.chance(0.15);
    if (draws_.chance(0.1)) o.impedanceRatio = draws_.power(-1.0, 1.0);
    if (draws_.chance(0.1)) o.maxIterations = 1 + draws_.index(10);
    if (draws_.chance(0.1)) o.mechanisms.remove(static_cast<Mechanism>(draws_.index(8)));
  }

  LinkSpec massiveLink(const std::string& name) {
    LinkSpec link;
    link.name = name;
    link.mass = draws_.odd(draws_.power(-3.0, 2.0));
    link.com = draws_.vector(0.1);
    Vector3 spread;
    for (double& s : spread) s = link.mass * draws_.power(-5.0, -1.5);
    const Matrix3 R = draws_.rotation();
    const Vector3 moments(spread.y() + spread.z(), spread.x() + spread.z(),
                          spread.x() + spread.y());
    const Matrix3 I = R * moments.asDiagonal() * R.transpose();
    link.I_Lcm = 0.5 * (I + I.transpose());
    return link;
  }

  void tree() {
    std::vector<std::string> own;
    for (int i = 1 + draws_.index(5); i > 0; --i) {
      const std::string name = "l" + std::to_string(links_.size());
      builder_.link(massiveLink(name));
      const bool first = own.empty();
      const std::string parent =
          first ? "world"
                : own[static_cast<std::size_t>(draws_.index(static_cast<int>(own.size())))];
      joint(parent, name, first && draws_.chance(0.6));
      if (draws_.chance(0.6)) {
        const Shape drawn = shape();
        geometry(name, drawn, {draws_.rotation(), draws_.vector(0.1)});
      }
      own.push_back(name);
      links_.push_back(name);
    }
  }

  void joint(const std::string& parent, const std::string& child, bool floats) {
    constexpr JointType kTypes[] = {JointType::revolute,   JointType::revolute,
                                    JointType::continuous, JointType::prismatic,
                                    JointType::planar,     JointType::fixed};
    JointSpec j;
    j.name = "to " + child;
    j.type = floats ? JointType::floating : kTypes[draws_.index(6)];
    j.parent = parent;
    j.child = child;
    j.X_PC = {draws_.rotation(), draws_.vector(floats ? 1.0 : 0.3)};
    j.axis = draws_.rotation().col(0);
    if (j.type == JointType::fixed) {
      builder_.joint(j);
      return;
    }
    if (draws_.chance(0.5)) j.damping = draws_.odd(draws_.power(-4.0, 2.0));
    if (draws_.chance(0.3)) j.armature = draws_.odd(draws_.power(-4.0, 0.0));
    if (draws_.chance(0.2)) j.dryFriction = draws_.odd(draws_.power(-3.0, 1.0));
    const bool scalar = j.type == JointType::revolute || j.type == JointType::prismatic;
    if (scalar && draws_.chance(0.3)) {
      j.stiffness = draws_.odd(draws_.power(-2.0, 4.0));
      j.springReference = draws_.uniform(-0.5, 0.5);
    }
    if (scalar && draws_.chance(0.4)) {
      j.lower = draws_.odd(-draws_.uniform(0.05, 2.0));
      j.upper = draws_.odd(draws_.uniform(0.05, 2.0));
    }
    if (draws_.chance(0.5)) j.effort = draws_.odd(draws_.power(-1.0, 3.0));
    if (floats) j.damping = j.dryFriction = j.armature = 0.0;
    if (scalar || j.type == JointType::continuous) scalars_.push_back(j.name);
    builder_.joint(j);
  }

  Shape shape() {
    Vector3 sizes;
    for (double& size : sizes) size = draws_.odd(draws_.power(-2.5, -0.5));
    switch (draws_.index(6)) {
      case 0:
        return Shape::sphere(sizes.x());
      case 1:
        return Shape::capsule(sizes.x(), sizes.y());
      case 2:
        return Shape::cylinder(sizes.x(), sizes.y());
      case 3:
        return Shape::hull(tetrahedron(sizes.x()));
      case 4:
        return Shape::surface(tetrahedron(sizes.x()));
      default:
        return Shape::box(sizes);
    }
  }

  void geometry(const std::string& link, const Shape& shape, const Transform& X_LG) {
    GeometrySpec g;
    g.link = link;
    g.shape = shape;
    g.X_LG = X_LG;
    Material& m = g.material;
    m.slidingFriction = draws_.odd(draws_.power(-2.0, 0.5));
    constexpr int kDimensions[] = {1, 3, 3, 4, 6};
    m.condim = kDimensions[draws_.index(5)];
    if (draws_.chance(0.2)) m.margin = draws_.odd(draws_.power(-4.0, -2.0));
    if (draws_.chance(0.3)) m.impedance = impedance();
    if (draws_.chance(0.1))
      m.spring = ContactSpring{draws_.power(2.0, 6.0), 0.0, 0.0, draws_.uniform(0.0, 2.0)};
    builder_.geometry(g);
  }

  Impedance impedance() {
    Impedance p;
    p.timeConstant = draws_.odd(draws_.power(-4.0, 0.0));
    p.dampingRatio = draws_.odd(draws_.power(-1.0, 0.5));
    p.dMin = draws_.uniform(0.05, 0.98);
    p.dMax = draws_.uniform(0.05, 0.98);
    p.width = draws_.odd(draws_.power(-4.0, -1.0));
    p.midpoint = draws_.uniform(0.1, 0.9);
    p.power = draws_.uniform(1.0, 4.0);
    if (draws_.chance(0.2))
      p.direct = ReferenceSpring{draws_.odd(draws_.power(0.0, 6.0)), draws_.power(-1.0, 4.0)};
    return p;
  }

  std::string anyLink() {
    return links_[static_cast<std::size_t>(draws_.index(static_cast<int>(links_.size())))];
  }

  void tie() {
    if (draws_.chance(0.5)) {
      ConnectSpec c;
      c.linkA = anyLink(), c.linkB = anyLink();
      c.p_LAP = draws_.vector(0.3), c.p_LBP = draws_.vector(0.3);
      if (c.linkA != c.linkB) builder_.connect(c);
    }
    if (draws_.chance(0.3)) {
      WeldSpec w;
      w.linkA = anyLink(), w.linkB = anyLink();
      w.X_LAF = {draws_.rotation(), draws_.vector(0.3)};
      if (w.linkA != w.linkB) builder_.weld(w);
    }
    if (scalars_.size() >= 2 && draws_.chance(0.5)) {
      CouplingSpec c;
      c.follower = scalars_.back(), c.leader = scalars_.front();
      for (double& factor : c.polynomial) factor = draws_.odd(draws_.uniform(-1.0, 1.0));
      builder_.couple(c);
    }
  }

  Draws& draws_;
  ModelBuilder builder_;
  std::vector<std::string> links_, scalars_;
  bool ties_ = false;
};

void drawState(Draws& draws, const Model& model, State& state) {
  const double speed = draws.chance(0.1) ? 1e3 : draws.chance(0.5) ? 1.0 : 10.0;
  for (const JointRange& range : model.ranges)
    state.q[model.bodies[range.body].q] = draws.odd(
        draws.chance(0.1) ? range.upper : draws.uniform(0.5 * range.lower, 0.5 * range.upper));
  for (double& v : state.v) v = draws.odd(draws.uniform(-speed, speed));
}

void drawInput(Draws& draws, const Model& model, Input& input) {
  if (draws.chance(0.7)) {
    // By what is moved: a step follows light links that are driven hard in 400 parts of up to 4,000
    // sub-steps, which sanitizers make a matter of minutes.
    input.tau = VectorX::Zero(model.nv);
    const double most = draws.power(-1.0, 2.0);
    for (int i = 0; i < model.nv; ++i) {
      const Body& body = model.bodies[static_cast<std::size_t>(model.dofs[i].body)];
      input.tau[i] = draws.odd(draws.uniform(-most, most)) * 0.1 * body.mass;
    }
  }
  if (!draws.chance(0.3)) return;
  const int body = draws.index(model.bodyCount());
  const double mass = model.bodies[static_cast<std::size_t>(body)].mass;
  const Vector3 moment = draws.vector(1.0) * mass, force = draws.vector(10.0) * mass;
  input.wrenches.push_back({body, {moment, force}});
}

}  // namespace

std::optional<SmallScene> decodeScene(const std::uint8_t* data, std::size_t size) {
  Draws draws(data, size);
  Decoder decoder(draws);
  SmallScene scene;
  scene.model = decoder.build().build();
  if (scene.model.nv == 0) return {};
  scene.state = State(scene.model);
  drawState(draws, scene.model, scene.state);
  if (!scene.state.q.allFinite()) return scene;  // to be refused by the step
  regulariseCoupledJoints(scene.model, scene.state.q);
  if (findSingularMass(scene.model, scene.state.q) || findSingularMass(scene.model, scene.model.q0))
    return {};
  const bool driven = draws.chance(0.6);
  if (driven) drawInput(draws, scene.model, scene.input);
  scene.passive = !driven && !decoder.isTied();
  return scene;
}

}  // namespace softgauss::fuzz
