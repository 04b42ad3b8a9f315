// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What each mechanism of the step is for: which bounds of the hard cases are missed without it.

#include <filesystem>
#include <functional>
#include <string>

#include "apps/stability_report/cases.hpp"

namespace softgauss::app {

/// Leaves out each mechanism alone, then sets of them, in the cases that `takes` wants, and returns
/// the rows of a table of the bounds that are missed then and held with all mechanisms. Sets are
/// pairs of those that no bound needs alone, which may stand in for each other, these together, and
/// all. `told` is called with each row.
std::string ablate(const std::filesystem::path& scenes,
                   const std::function<bool(const HardCase&)>& takes,
                   const std::function<void(const std::string&)>& told);

}  // namespace softgauss::app
