// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What tests of goal files read their goals for: the sample robot, away from its reference.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "sample_urdf.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/goals.hpp"
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

namespace items {

/// The goals of the items, each on a line of its own from line 2 on.
inline Goals readItems(const std::string& list) {
  const TempFolder folder;
  return readGoals(folder.write("goals.yaml", "goals:\n" + list), sampleModel(), sampleState());
}

template <class Kind>
std::unique_ptr<Kind> readOne(const std::string& item) {
  Goals goals = readItems("  - " + item + "\n");
  EXPECT_EQ(goals.size(), 1u);
  Kind* kind = dynamic_cast<Kind*>(goals.at(0).release());
  EXPECT_NE(kind, nullptr) << item;
  return std::unique_ptr<Kind>(kind);
}

/// What reading the item ends in, after `goals.yaml:2: goal 1 `.
inline std::string errorOfItem(const std::string& item) {
  const std::string start = "goals.yaml:2: goal 1 ";
  try {
    readItems("  - " + item + "\n");
  } catch (const ModelError& error) {
    const std::string message = error.what();
    const std::size_t at = message.find(start);
    if (at == std::string::npos) return message;
    return message.substr(at + start.size());
  }
  return "no error";
}

}  // namespace items

}  // namespace softgauss::io
