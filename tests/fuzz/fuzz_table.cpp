// SPDX-License-Identifier: Apache-2.0
/// Tables: recorded controls, and heights as numbers or as an image.

#include <cmath>

#include "softgauss/io/height_field.hpp"
#include "softgauss/io/torque_table.hpp"
#include "softgauss/io/urdf.hpp"
#include "tests/fuzz/input_folder.hpp"

namespace softgauss::fuzz {
namespace {

template <class Read>
void attempt(const Read& read) {
  try {
    read();
  } catch (const ModelError& error) {
    expectMessage(error.what());
  }
}

void readControls(const std::filesystem::path& file, const Model& model) {
  const io::TorqueTable table = io::TorqueTable::read(file, model);
  VectorX u = VectorX::Zero(model.nv);
  double time = table.startTime();
  for (int row = 0; row < 4 && std::isfinite(time); ++row) {
    table.controlAt(time, u);
    if (!u.allFinite()) throw Finding("a control that is not finite");
    const double next = table.nextRow(time);
    if (!(next > time)) throw Finding("times of a table that do not rise");
    time = next;
  }
}

void readSurface(const std::filesystem::path& file) {
  const io::Heights heights = io::readHeights(file);
  if (heights.values.size() !=
      static_cast<std::size_t>(heights.rows) * static_cast<std::size_t>(heights.columns))
    throw Finding("heights that are no grid");
  if (heights.values.size() > 10000) return;
  const Mesh mesh = io::heightFieldMesh(heights, 1.0, 1.0, 1.0, 0.1);
  for (const Vector3& vertex : mesh.vertices)
    if (!vertex.allFinite()) throw Finding("a height that is not finite");
}

}  // namespace
}  // namespace softgauss::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace softgauss::fuzz;
  static const InputFolder folder;
  static const softgauss::Model arm =
      softgauss::io::loadUrdf(SOFTGAUSS_SOURCE_DIR "/data/robots/arm.urdf");
  const std::string_view text = textOf(data, size);
  if (text.starts_with("\x89PNG")) {
    attempt([&] { readSurface(folder.write("heights.png", text)); });
    return 0;
  }
  const auto file = folder.write("table.csv", text);
  attempt([&] { readControls(file, arm); });
  attempt([&] { readSurface(file); });
  return 0;
}
