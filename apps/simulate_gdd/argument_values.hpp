// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Values of the command line, from their text. `context`: how messages begin. All throw
/// UsageError.

#include <cstdint>
#include <string>

#include "apps/simulate_gdd/options.hpp"

namespace softgauss::app {

/// Without blanks at its ends.
std::string trimmed(const std::string& text);
double parseNumber(const std::string& given, const std::string& context);
/// A weight as a file of goals has them.
double parseWeight(const std::string& text, const std::string& context);
std::uintmax_t bytesOf(double megabytes, const std::string& context);
/// What follows --reach.
ReachArgument parseReach(const std::string& text);
/// What follows --effects.
EffectSet parseEffects(const std::string& text);
/// What follows --without: the mechanisms that are left.
MechanismSet parseWithout(const std::string& text);

}  // namespace softgauss::app
