// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Names that a user gives, looked up in a model.

#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/model/model.hpp"

namespace softgauss::io {

/// Why there can be no goal of that link, as a message goes on: "found 'hnd', expected a link of
/// model 'arm', did you mean 'hand'? there are: …"; nothing where the link exists and moves.
std::string linkProblem(const Model& model, const std::string& link);

/// The same of a joint of one degree of freedom.
std::string jointProblem(const Model& model, const std::string& joint);

/// What integrators are called, in full and in short: "runge-kutta-4", "rk4".
std::vector<std::string> integratorNames();
std::optional<Integrator> integratorCalled(const std::string& name);

}  // namespace softgauss::io
