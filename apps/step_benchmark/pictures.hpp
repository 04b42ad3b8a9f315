// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The figures as drawings: what each effect adds to a step, and how a step grows.

#include <filesystem>
#include <map>
#include <string>

namespace softgauss::app {

/// ladder.svg and scaling.svg into `folder`, from figures named as they are printed; a drawing
/// whose figures are missing is left out. Throws std::runtime_error when gnuplot fails or a file
/// cannot be written.
void drawPictures(const std::map<std::string, double>& figures,
                  const std::filesystem::path& folder);

}  // namespace softgauss::app
