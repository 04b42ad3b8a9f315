// SPDX-License-Identifier: Apache-2.0
/// Steps of small scenes that bytes decide, held against laws.

#include "tests/fuzz/input_folder.hpp"
#include "tests/random_scenes/hold_scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace softgauss;
  try {
    if (const auto scene = fuzz::decodeScene(data, size)) fuzz::holdScene(*scene);
  } catch (const ModelError& error) {
    fuzz::expectMessage(error.what());
  }
  return 0;
}
