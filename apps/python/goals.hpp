// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Goals from Python: by calls, dicts or YAML, and their targets.

#include <string>
#include <vector>

#include "apps/python/held.hpp"

namespace softgauss::python {

/// The goals of a simulation.
struct GoalList {
  Held& held;
};

/// The text of a goal file (docs/reference/goals.md) from such a text, a dict `{kind: {key:
/// value}}`, a list of those, or a dict with `goals`. Throws TypeError where it is none.
std::string goalText(const py::object& goals);

/// The numbers that a goal seeks, in the goal itself: a place, accelerations, positions, a force;
/// none where it seeks no such thing.
std::vector<double*> targetOf(gdd::Goal& goal);

}  // namespace softgauss::python

SOFTGAUSS_MADE_ONLY(softgauss::python::GoalList)
