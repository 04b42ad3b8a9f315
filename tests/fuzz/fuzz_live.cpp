// SPDX-License-Identifier: Apache-2.0
/// What a page sends is taken or refused with a reason; so is a file of events.

#include <cmath>

#include "apps/live/event_file.hpp"
#include "apps/live/messages.hpp"
#include "softgauss/io/goals.hpp"
#include "softgauss/io/urdf.hpp"
#include "tests/fuzz/input_folder.hpp"

namespace softgauss::fuzz {
namespace {

struct Robot {
  Model model = io::loadUrdf(SOFTGAUSS_SOURCE_DIR "/data/robots/humanoid.urdf");
  std::vector<std::unique_ptr<gdd::Goal>> goals =
      io::readGoals(SOFTGAUSS_SOURCE_DIR "/data/goals/stand_and_reach.yaml", model, State(model));
  live::Names names{model, goals};
};

/// What is taken can be asked of the run.
void expectPossible(const live::Event& event, const live::Names& names) {
  if (const std::string problem = problemOf(event, names); !problem.empty())
    throw Finding("taken, and yet " + problem);
  for (const auto& [name, value] : event.fields) {
    const double* const number = std::get_if<double>(&value);
    const Vector3* const vector = std::get_if<Vector3>(&value);
    if ((number && !std::isfinite(*number)) || (vector && !vector->allFinite()))
      throw Finding("taken with a number that is not finite: " + name);
  }
}

void takeMessage(const std::string& text, const live::Names& names) {
  const auto read = live::readMessage(text, names);
  if (const auto* const refused = std::get_if<live::Refused>(&read)) {
    expectMessage(refused->reason);
    expectMessage(live::answer(refused->id, refused->reason));
  } else if (const auto& asked = std::get<live::Asked>(read); !asked.toWrite && !asked.seen) {
    expectPossible(asked.event, names);
    expectMessage(live::eventText(asked.event));
  }
}

void readFile(const std::filesystem::path& file, const live::Names& names) {
  try {
    const live::EventFile read = live::readEvents(file, names, 0.002);
    for (const live::Event& event : read.events) expectPossible(event, names);
  } catch (const ModelError& error) {
    expectMessage(error.what());
  }
}

}  // namespace
}  // namespace softgauss::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace softgauss::fuzz;
  static const InputFolder folder;
  static const Robot robot;
  const std::string text(textOf(data, size));
  if (text.starts_with("{") || text.starts_with("["))
    takeMessage(text, robot.names);
  else
    readFile(folder.write("events.yaml", text), robot.names);
  return 0;
}
