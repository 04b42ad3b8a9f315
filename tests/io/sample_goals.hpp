// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What tests of goal files read their goals for: the sample robot, away from its reference.

#include <memory>
#include <vector>

#include "sample_urdf.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/urdf.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {

using Goals = std::vector<std::unique_ptr<gdd::Goal>>;

inline const Model& sampleModel() {
  static const Model model = [] {
    const TempFolder folder;
    return loadUrdf(folder.write("sample.urdf", kSampleUrdf));
  }();
  return model;
}

/// Away from zero, so that references to it show.
inline State sampleState() {
  State state(sampleModel());
  state.q.head<3>() = Vector3(0.3, -0.2, 1.0);
  state.q.tail<1>()[0] = 0.4;
  return state;
}

}  // namespace softgauss::io
