// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/effect_use.hpp"

#include <algorithm>
#include <tuple>

#include "softgauss/engine/step/substep_workspace.hpp"

namespace softgauss {
namespace {

Effect contactEffectOf(const Model& model, const Contact& c) {
  if (c.bodyA == 0 || c.bodyB == 0) return Effect::groundContact;
  return model.bodies[c.bodyA].robot == model.bodies[c.bodyB].robot ? Effect::selfCollision
                                                                    : Effect::objectContact;
}

}  // namespace

std::array<EffectUse, kEffects> effectUse(const Model& model, const Data& data,
                                          const ContactSource* contacts) {
  std::array<EffectUse, kEffects> use{};
  const auto at = [&](Effect effect) -> EffectUse& {
    return use[static_cast<std::size_t>(effect)];
  };

  const Plan& plan = data.plan;
  const SmoothForces::Calls& forces = data.forces.calls;
  const RneaWorkspace& work = data.forces.work;
  at(Effect::gravity).calls = forces.gravity;
  at(Effect::coriolis).calls = forces.coriolis;
  // The pass over the tree serves both: its memory counts where either runs.
  at(Effect::gravity).bytes = plan.gravity ? bytesOf(work.F) : 0;
  at(Effect::coriolis).bytes = plan.coriolis ? bytesOfAll(work.F, work.V, work.A) : 0;
  if (plan.coriolis && data.parts)
    at(Effect::coriolis).bytes +=
        data.parts->substepSelection.bytes() + data.parts->treeSubstepping.bytes();
  at(Effect::damping) = {forces.damping, 0, bytesOf(plan.damping)};
  at(Effect::spring) = {forces.spring, 0, bytesOf(plan.springs)};
  at(Effect::externalWrench).calls = forces.externalWrench;

  const Constraints& rows = data.constraints;
  const auto of = [&](const auto& kind, RowKind number) {
    return EffectUse{rows.calls()[static_cast<std::size_t>(number)], kind.rowCount(), kind.bytes()};
  };
  at(Effect::jointLimit) = of(rows.jointLimit, RowKind::jointLimit);
  at(Effect::actuation) = of(rows.servo, RowKind::servo);
  at(Effect::dryFriction) = of(rows.dryFriction, RowKind::dryFriction);
  for (const EffectUse& kind : {of(rows.connection, RowKind::connection),
                                of(rows.weld, RowKind::weld), of(rows.coupling, RowKind::coupling),
                                of(rows.geometricStiffness, RowKind::geometricStiffness)}) {
    EffectUse& equality = at(Effect::equality);
    equality.calls += kind.calls;
    equality.rows += kind.rows;
    equality.bytes += kind.bytes;
  }

  const EffectUse pyramids = of(rows.contact, RowKind::pyramid);
  const EffectUse cones = of(rows.ellipticContact, RowKind::ellipticCone);
  // Where none of the three runs, all tell what there is: it has to be nothing.
  const auto kinds = {Effect::groundContact, Effect::selfCollision, Effect::objectContact};
  const bool any = std::any_of(kinds.begin(), kinds.end(),
                               [&](Effect effect) { return plan.effects.has(effect); });
  for (const Effect effect : kinds)
    if (plan.effects.has(effect) || !any) {
      at(effect).calls = data.contacts.detections + pyramids.calls + cones.calls;
      at(effect).bytes = bytesOf(data.contacts.contacts) + pyramids.bytes + cones.bytes +
                         (contacts ? contacts->bytes() : 0);
    }
  const auto count = [&](const std::vector<ContactRows>& made, int rowsOfDirection) {
    for (const ContactRows& contact : made) {
      const int dim = contact.frictionDim;
      const bool pyramid = rowsOfDirection == 2;
      at(contactEffectOf(model, data.contacts.contacts[contact.contact])).rows +=
          pyramid ? std::max(1, 2 * dim) : dim + 1;
      for (const auto& [effect, first, last] : {std::tuple(Effect::torsionalFriction, 3, 3),
                                                std::tuple(Effect::rollingFriction, 4, 5)}) {
        if (dim < first) continue;
        at(effect).rows += rowsOfDirection * (last - first + 1);
      }
    }
  };
  count(rows.contact.contactsWithRows(), 2);
  count(rows.ellipticContact.contactsWithRows(), 1);
  return use;
}

}  // namespace softgauss
