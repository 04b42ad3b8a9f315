// SPDX-License-Identifier: Apache-2.0
#pragma once

/// <option> and its <flag>: of the step, as far as they are simulated.

#include "softgauss/engine/model/model.hpp"
#include "softgauss/io/mjcf/xml.hpp"

namespace softgauss::io::mjcf {

/// What a file says, besides what is set in Options.
struct FileOptions {
  std::string integrator = "Euler";   ///< in the file's word
  SourceLocation timestepWhere;       ///< line 0 where it does not say it
  std::vector<std::string> readPast;  ///< attributes that change nothing here, where they are given
};

/// Sets timestep, gravity, cone, impratio and effects. The integrator stays as it is. Throws where
/// what is asked for is not simulated.
void readOption(const Element& element, Options& options, FileOptions& file);

/// Which of ours stands for the file's integrator.
Integrator integratorOf(const std::string& word);

}  // namespace softgauss::io::mjcf
