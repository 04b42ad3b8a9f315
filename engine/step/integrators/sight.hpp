// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How long a part of a step may be so that no two shapes pass through each other unseen.
///
/// No estimate of an error tells of a contact that begins and ends between two evaluations of the
/// dynamics. So a part is as short as the velocities at its start ask for, ContactSource::
/// timeInSight() of (T.125); the evaluations of all methods here are at most half a part apart.
/// Where nothing can touch nothing is asked.

#include <algorithm>

#include "engine/step/contact_source.hpp"
#include "engine/step/data.hpp"

namespace softgauss {

/// Whether the dynamics ask for contacts.
inline bool looksForContacts(const Data& data, const ContactSource* contacts) {
  const RowKinds& planned = data.plan.rows;
  return kBuiltRows.has(RowKind::pyramid) && contacts && contacts->mayTouch() &&
         (planned.has(RowKind::pyramid) || planned.has(RowKind::ellipticCone));
}

/// The part of `length` [s] that is in sight from `kinematics`.
inline double lengthInSight(const Model& model, const Data& data, const Kinematics& kinematics,
                            ContactSource* contacts, double length,
                            ContactSource::Way way = ContactSource::Way::onwards) {
  if (!looksForContacts(data, contacts)) return length;
  return std::min(length, contacts->timeInSight(model, kinematics, length, way));
}

}  // namespace softgauss
