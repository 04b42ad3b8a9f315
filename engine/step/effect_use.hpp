// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What each effect costs a simulation in calls, rows and memory.
///
/// The counters are kept in every build: one addition for each effect that runs, a few nanoseconds
/// a step. Memory is added up when it is asked for.

#include <array>

#include "softgauss/engine/step/contact_source.hpp"
#include "softgauss/engine/step/data.hpp"

namespace softgauss {

struct EffectUse {
  std::int64_t calls = 0;  ///< of its code since the data were made
  int rows = 0;            ///< in the last step
  std::size_t bytes = 0;   ///< that it holds, and that nothing would hold without it
};

inline constexpr std::size_t kEffects = std::size(kEffectNames);

/// By Effect. Contacts of the three kinds share calls and memory: each that runs shows all of it;
/// rows are those of its own contacts, and count for torsional and rolling friction as well as far
/// as they add directions; their code is that of the contacts. Armature and actuation have no code
/// of their own in the step. `contacts`: where they come from, to count its memory; null: it is not
/// counted.
std::array<EffectUse, kEffects> effectUse(const Model& model, const Data& data,
                                          const ContactSource* contacts = nullptr);

}  // namespace softgauss
