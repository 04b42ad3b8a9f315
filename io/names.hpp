// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Names that a user gives, looked up in a model and told.

#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/model/model.hpp"

namespace softgauss::io {

/// A name as it stands in a sentence: quoted where it reads as a number, as of a joint called 3.
std::string nameText(const std::string& name);

/// Why there can be no goal of that link, as a message goes on: "found 'hnd', expected a link of
/// model 'arm', did you mean 'hand'? there are: …"; nothing where the link exists and moves.
std::string linkProblem(const Model& model, const std::string& link);

/// The same of a joint of one degree of freedom.
std::string jointProblem(const Model& model, const std::string& joint);

/// What integrators are called, in full and in short: "runge-kutta-4", "rk4".
std::vector<std::string> integratorNames();
std::optional<Integrator> integratorCalled(const std::string& name);
/// What may sleep: none, objects (what no goal controls) or all.
std::optional<Sleep> sleepCalled(const std::string& name);

}  // namespace softgauss::io
