// SPDX-License-Identifier: Apache-2.0
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

/// Grows one tree link by link.
class TreeGrower {
 public:
  TreeGrower(ModelBuilder& builder, Random& random, const RandomTreeOptions& options,
             std::string prefix)
      : builder_(builder), random_(random), options_(options), prefix_(std::move(prefix)) {}

  /// The root hangs from the world by a joint of this type.
  void root(JointType type) { massiveLink("world", type); }

  void grow() {
    // Chains are long, yet branch.
    const std::size_t n = links_.size();
    const std::size_t parent =
        random_.chance(0.5) ? n - 1 : static_cast<std::size_t>(random_.index(static_cast<int>(n)));
    const std::string from = links_[parent];
    switch (random_.index(7)) {
      case 0:
      case 1:
        massiveLink(from, JointType::revolute);
        return;
      case 2:
        massiveLink(from, JointType::continuous);
        return;
      case 3:
        massiveLink(from, JointType::prismatic);
        return;
      case 4:
        massiveLink(from, JointType::planar);
        return;
      case 5:
        massiveLink(from, JointType::fixed);
        return;
      default:
        universal(from);
        return;
    }
  }

 private:
  void massiveLink(const std::string& parent, JointType type) {
    // One draw after another: the order in which arguments are evaluated is the compiler's.
    const Vector3 axis = random_.direction();
    const Transform X_PC{random_.rotation(), random_.vector3(0.3)};
    massiveLink(parent, type, X_PC, axis);
  }

  void massiveLink(const std::string& parent, JointType type, const Transform& X_PC,
                   const Vector3& axis) {
    const std::string name = prefix_ + std::to_string(count_++);
    builder_.link(randomLink(name, random_));
    builder_.joint(specOf(name, type, parent, X_PC, axis));
    links_.push_back(name);
    if (!options_.geometries) return;
    GeometrySpec g = geometrySpec(name, Shape::sphere(0.05), random_.uniform(0.2, 1.5));
    if (random_.chance(0.2)) g.material.condim = 1;
    if (random_.chance(0.3)) g.material.margin = 0.001;
    builder_.geometry(g);
  }

  /// Two hinges at right angles with a link without mass between them.
  void universal(const std::string& parent) {
    const std::string cross = prefix_ + std::to_string(count_++);
    builder_.link(emptyLink(cross));
    builder_.joint(specOf(cross, JointType::revolute, parent,
                          {random_.rotation(), random_.vector3(0.3)}, Vector3::UnitX()));
    massiveLink(cross, JointType::revolute, {}, Vector3::UnitY());
  }

  JointSpec specOf(const std::string& child, JointType type, const std::string& parent,
                   const Transform& X_PC, const Vector3& axis) {
    JointSpec joint = jointSpec("to " + child, type, parent, child, X_PC, axis);
    if (options_.damping && random_.chance(0.5)) joint.damping = random_.uniform(0.0, 0.5);
    if (options_.armature && random_.chance(0.5)) joint.armature = random_.uniform(0.0, 0.1);
    const bool ranged = type == JointType::revolute || type == JointType::prismatic;
    if (options_.ranges && ranged && random_.chance(0.7)) {
      joint.lower = -random_.uniform(0.2, 1.0);
      joint.upper = random_.uniform(0.2, 1.0);
    }
    return joint;
  }

  ModelBuilder& builder_;
  Random& random_;
  const RandomTreeOptions& options_;
  std::string prefix_;
  std::vector<std::string> links_;
  int count_ = 0;
};

}  // namespace

ModelBuilder randomForest(std::uint64_t seed, const RandomTreeOptions& options) {
  Random random(seed);
  ModelBuilder builder("forest " + std::to_string(seed));
  builder.link(emptyLink("world"));
  if (options.geometries) builder.geometry(groundSpec(0.1));
  builder.options.gravity = Vector3(0.5, -0.3, -9.81);  // every axis matters
  constexpr JointType kFixedBase[] = {JointType::revolute, JointType::prismatic, JointType::planar};
  for (int t = 0; t < options.trees; ++t) {
    TreeGrower tree(builder, random, options, std::string(1, static_cast<char>('a' + t)));
    tree.root(t % 2 == 0 ? JointType::floating : kFixedBase[random.index(3)]);
    for (int i = 1; i < options.links; ++i) tree.grow();
  }
  return builder;
}

ModelBuilder randomFloatingTree(std::uint64_t seed, bool armature) {
  RandomTreeOptions options;
  options.trees = 1;
  options.links = 9;
  options.armature = armature;
  options.damping = false;
  return randomForest(seed, options);
}

}  // namespace softgauss::test
