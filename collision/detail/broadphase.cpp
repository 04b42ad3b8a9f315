// SPDX-License-Identifier: Apache-2.0
#include "collision/detail/broadphase.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace softgauss::collision::detail {
namespace {

using NearPairs = std::vector<std::pair<int, int>>;

int indexOf(const fcl::CollisionObjectd* object) {
  return static_cast<int>(reinterpret_cast<std::intptr_t>(object->getUserData()));
}

bool collect(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
  const auto [low, high] = std::minmax({indexOf(a), indexOf(b)});
  static_cast<NearPairs*>(data)->emplace_back(low, high);
  return false;  // go on
}

}  // namespace

struct Broadphase::Tree {
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
  fcl::DynamicAABBTreeCollisionManagerd manager;
};

Broadphase::Broadphase(const std::vector<double>& radii) : tree_(std::make_unique<Tree>()) {
  for (std::size_t i = 0; i < radii.size(); ++i) {
    auto object = std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Sphered>(radii[i]));
    object->setUserData(reinterpret_cast<void*>(static_cast<std::intptr_t>(i)));
    tree_->manager.registerObject(object.get());
    tree_->objects.push_back(std::move(object));
  }
  tree_->manager.setup();
}

Broadphase::~Broadphase() = default;

void Broadphase::findNear(const std::vector<Vector3>& centres, NearPairs& near) {
  for (std::size_t i = 0; i < centres.size(); ++i) {
    tree_->objects[i]->setTranslation(centres[i]);
    tree_->objects[i]->computeAABB();
  }
  tree_->manager.update();
  tree_->manager.collide(&near, &collect);
}

}  // namespace softgauss::collision::detail
