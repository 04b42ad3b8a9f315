// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a large landscape costs who stands on it.

#include <map>
#include <string>

namespace softgauss::app {

/// A quadruped that stands on 200,000 triangles, and on a plane, pieces of both timed in turn:
///   landscape_quadruped.first.us    a step on the landscape, median of CPU time
///   landscape_quadruped.second.us   on the plane
///   landscape_quadruped.added.us    the difference
///   landscape_quadruped.load_s      CPU time until the landscape is ready to be stood on [s]
/// Nothing where the name does not match the regular expression.
std::map<std::string, double> landscapeFigures(const std::string& filter);

}  // namespace softgauss::app
