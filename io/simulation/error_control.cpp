// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/error_control.hpp"

#include <fmt/format.h>

namespace softgauss {

std::vector<std::string> setErrorControl(const SimulationOptions& options,
                                         const io::IntegrationKeys& scene, Options& o) {
  std::vector<std::string> warnings;
  const bool named = options.integrator || scene.integrator;
  const bool doubled = o.stepDoubling || options.stepDoubling;
  if (options.integrator)
    o.integrator = *options.integrator;
  else if (!named && !doubled && (options.integrationTolerance || scene.tolerance))
    o.integrator = Integrator::dormandPrince;
  else if (!named)
    o.integrator = o.constraintModel == ConstraintModel::softgauss ? Integrator::leapfrog
                                                                   : Integrator::semiImplicitEuler;

  const std::string_view name = integratorName(o.integrator);
  const auto ignored = [&](const char* key, const char* reason) {
    warnings.push_back(fmt::format("{} of the scene changes nothing: {} {}", key, name, reason));
  };
  if (options.stepDoubling && !o.isSingleSolve())
    throw OptionError(
        fmt::format("step-doubling changes nothing beside {}; it is for leapfrog, "
                    "semi-implicit-euler and implicit",
                    name));
  o.stepDoubling = doubled && o.isSingleSolve();
  if (doubled && !o.stepDoubling) ignored("step_doubling", "is not doubled");

  if (io::controlsError(o)) {
    if (options.integrationTolerance) o.integrationTolerance = *options.integrationTolerance;
    return warnings;
  }
  if (options.integrationTolerance)
    throw OptionError(
        fmt::format("integration-tolerance changes nothing beside {}, which has no error "
                    "control; it is for dormand-prince and for step doubling",
                    name));
  if (scene.tolerance) ignored("integration_tolerance", "has no error control");
  return warnings;
}

}  // namespace softgauss
