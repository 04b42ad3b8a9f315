// SPDX-License-Identifier: Apache-2.0
/// A URDF is loaded or refused (model_file.hpp).

#include "tests/fuzz/model_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace softgauss::fuzz;
  static const InputFolder folder;
  loadModelFile(folder.write("robot.urdf", textOf(data, size)));
  return 0;
}
