// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How long a part of a step may be so that no two shapes pass through each other unseen.
///
/// No estimate of an error tells of a contact that begins and ends between two evaluations of the
/// dynamics. So a part is as short as the velocities at its start ask for, ContactSource::
/// tunnellingTimeBound() of (7.7); the evaluations of all methods here are at most half a part
/// apart. Where nothing can touch nothing is asked.

#include <algorithm>

#include "softgauss/engine/step/contact_source.hpp"
#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// Whether the dynamics ask for contacts.
inline bool looksForContacts(const Data& data, const ContactSource* contacts) {
  const RowKinds& planned = data.plan.rows;
  return kBuiltRows.has(RowKind::pyramid) && contacts && contacts->mayTouch() &&
         (planned.has(RowKind::pyramid) || planned.has(RowKind::ellipticCone));
}

/// The part of `length` [s] that is in sight from `kinematics`.
inline double tunnellingLengthBound(
    const Model& model, const Data& data, const Kinematics& kinematics, ContactSource* contacts,
    double length, ContactSource::TimeDirection direction = ContactSource::TimeDirection::forward) {
  if (!looksForContacts(data, contacts)) return length;
  return std::min(length, contacts->tunnellingTimeBound(model, kinematics, length, direction));
}

}  // namespace softgauss
