// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/default_weight.hpp"

#include "softgauss/gdd/goals/hold.hpp"
#include "softgauss/gdd/goals/joints.hpp"
#include "softgauss/gdd/goals/posture.hpp"
#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::gdd {
namespace {

bool actTogether(const Goal& a, const Goal& b) {
  return a.startTime < b.endTime && b.startTime < a.endTime;
}

/// Whether one of the joints is between the base and the link; of a goal of no link any is.
bool holds(const Model& model, const JointPosture& posture, int frame) {
  if (frame < 0) return true;
  std::vector<char> between(model.bodies.size(), 0);
  for (int b = model.frames[frame].body; b > 0; b = model.bodies[b].parent) between[b] = 1;
  return std::any_of(posture.targets.begin(), posture.targets.end(),
                     [&](const JointTarget& target) { return between[target.body] != 0; });
}

/// The weight of what a posture holds against the goal.
double heldWeight(const Model& model, const Goal& goal, const Goal& other) {
  if (!actTogether(goal, other)) return 0.0;
  if (const auto* posture = dynamic_cast<const Posture*>(&other)) return posture->weight;
  const auto* joints = dynamic_cast<const JointPosture*>(&other);
  return joints && holds(model, *joints, goal.linkFrame()) ? joints->weight : 0.0;
}

/// Of a posture that nobody asked for, beside a goal whose weight somebody has given as if there
/// were none: less than a millimetre of a reach. And with elliptic cones, whose solver seldom ends
/// with a certificate: what it is short of grows with the weights.
constexpr double kWeakPosture = 0.01;

bool hasOwnWeight(const Goal& goal) {
  if (const auto* reach = dynamic_cast<const Reach*>(&goal))
    return !reach->defaultWeight.isAt(reach->weight);
  const auto* hold = dynamic_cast<const Hold*>(&goal);
  return hold && !hold->defaultWeight.isAt(hold->weight);
}

/// Regularisers give way to weights that were given; those that somebody has changed stay.
void weighRegularisers(const Model& model, const std::vector<std::unique_ptr<Goal>>& goals) {
  const bool weak =
      model.options.cone == Cone::elliptic ||
      std::any_of(goals.begin(), goals.end(), [](const auto& goal) { return hasOwnWeight(*goal); });
  for (const auto& goal : goals) {
    auto* posture = dynamic_cast<Posture*>(goal.get());
    if (!posture || !posture->isRegulariser) continue;
    if (posture->weight == Posture::kDefaultWeight || posture->weight == kWeakPosture)
      posture->weight = weak ? kWeakPosture : Posture::kDefaultWeight;
  }
}

}  // namespace

void weighDefaults(const Model& model, const std::vector<std::unique_ptr<Goal>>& goals) {
  weighRegularisers(model, goals);
  for (const auto& goal : goals) {
    double strongest = 0.0;
    for (const auto& other : goals)
      strongest = std::max(strongest, heldWeight(model, *goal, *other));
    goal->weighBeside(strongest);
  }
  for (const auto& goal : goals) {
    auto* posture = dynamic_cast<Posture*>(goal.get());
    if (!posture) continue;
    posture->yieldsTo.clear();
    for (const auto& other : goals)
      if (const auto place = other->ledPlace(); place && actTogether(*posture, *other))
        posture->yieldsTo.push_back(*place);
  }
}

}  // namespace softgauss::gdd
