// SPDX-License-Identifier: Apache-2.0
/// Saved states, sleepers and checkpoints with any bytes in them are restored or refused; what is
/// restored takes steps. The input is laid over bytes that were saved: a checksum would refuse all
/// others, so it is made anew.

#include "apps/simulate_gdd/checkpoint.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/core/sealed.hpp"
#include "softgauss/engine/model/model_hash.hpp"
#include "softgauss/engine/model/saved_state.hpp"
#include "softgauss/io/simulation/simulation.hpp"
#include "tests/fuzz/input_folder.hpp"
#include "tests/random_scenes/step_laws.hpp"

namespace softgauss::fuzz {
namespace {

constexpr int kBefore = 20;  // steps until it is saved
constexpr int kAfter = 2;

/// Edits of some bytes: where, and by what they are replaced, a few at a time. Then a cut.
std::string edited(std::string bytes, std::string_view edits) {
  const auto take = [&] {
    const auto byte = static_cast<unsigned char>(edits.front());
    edits.remove_prefix(1);
    return byte;
  };
  while (edits.size() >= 4 && !bytes.empty()) {
    const std::size_t at = (take() + 256u * take()) % bytes.size();
    for (std::size_t n = take() % 9u, i = at; n > 0 && i < bytes.size() && !edits.empty(); --n)
      bytes[i++] = static_cast<char>(take());
  }
  if (!edits.empty() && take() % 4 == 0) bytes.resize(bytes.size() / 2);
  return bytes;
}

/// An arm that follows a goal.
struct ControlledArm {
  Simulation simulation =
      Simulation::load(SOFTGAUSS_SOURCE_DIR "/data/robots/arm.urdf", {.base = BaseKind::fixed});
  std::string saved;

  ControlledArm() {
    simulation.goals.reach("hand", {0.4, 0.2, 0.6});
    for (int i = 0; i < kBefore; ++i) simulation.step();
    ByteWriter content;
    content(simulation.state());
    saved = content.bytes();
  }

  void restore(std::string_view edits) {
    simulation.reset();
    ByteWriter content;
    const std::string text = edited(saved, edits);
    content(hash(simulation.model()));
    const std::string bytes = sealed("SGSTATE\n", 1, content.bytes() + text);
    try {
      simulation.state() = softgauss::restore(simulation.model(), bytes);
    } catch (const ModelError& error) {
      expectMessage(error.what());
      return;
    }
    for (int i = 0; i < kAfter; ++i) {
      const SolveStatus status = simulation.step();
      if (!isRefused(status) && !simulation.state().q.allFinite())
        throw Finding("a restored state was stepped to one that is not finite");
    }
  }
};

/// Balls that fall on one another.
struct Balls {
  Model model = make();
  std::string saved;

  static Model make() {
    ModelBuilder builder("balls");
    LinkSpec world;
    world.name = "world";
    builder.link(world);
    const auto shape = [&](const std::string& link, const Shape& s) {
      GeometrySpec g;
      g.link = link;
      g.shape = s;
      builder.geometry(g);
    };
    shape("world", Shape::plane());
    for (int i = 0; i < 4; ++i) {
      LinkSpec ball;
      ball.name = "ball" + std::to_string(i);
      ball.mass = 1.0;
      ball.I_Lcm = 0.004 * Matrix3::Identity();
      builder.link(ball);
      JointSpec joint;
      joint.name = "of " + ball.name;
      joint.type = JointType::floating;
      joint.parent = "world";
      joint.child = ball.name;
      joint.X_PC.p = Vector3(0.15 * i, 0.0, 0.1 + 0.05 * i);
      builder.joint(joint);
      shape(ball.name, Shape::sphere(0.1));
    }
    builder.options.sleep.enabled = true;
    return builder.build();
  }

  Balls() {
    collision::SceneContacts contacts(model);
    State state(model);
    Data data(model);
    for (int i = 0; i < kBefore; ++i) step(model, {}, state, data, &contacts);
    ByteWriter writer;
    writer(state, *data.sleepers);
    saved = writer.bytes();
  }

  void restore(std::string_view edits) const {
    collision::SceneContacts contacts(model);
    State state(model);
    Data data(model);
    const std::string bytes = edited(saved, edits);
    try {
      ByteReader reader(bytes);
      reader(state, *data.sleepers);
      reader.expectEnd();
      expectStateOf(model, state);
    } catch (const BytesError& error) {
      expectMessage(error.what());
      return;
    }
    for (int i = 0; i < kAfter; ++i)
      if (!isRefused(step(model, {}, state, data, &contacts)) && !state.q.allFinite())
        throw Finding("a restored state was stepped to one that is not finite");
  }
};

void readCheckpoint(std::string_view edits) {
  const app::RunIdentity identity{7, {{"--duration", "3"}}, {"abc", "def"}, "softgauss"};
  ByteWriter content;
  content(identity, std::string("content"));
  const std::string bytes = edited(content.bytes(), edits);
  for (const std::string& whole : {sealed("SGCHECK\n", 2, bytes), std::string(edits)}) {
    try {
      expectMessage(differenceOf(app::readCheckpoint(whole).first, identity) + ".");
    } catch (const BytesError& error) {
      expectMessage(error.what());
    }
  }
}

}  // namespace
}  // namespace softgauss::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace softgauss::fuzz;
  static ControlledArm arm;
  static const Balls balls;
  if (size == 0) return 0;
  const std::string_view edits = textOf(data + 1, size - 1);
  switch (data[0] % 3) {
    case 0:
      arm.restore(edits);
      break;
    case 1:
      balls.restore(edits);
      break;
    default:
      readCheckpoint(edits);
  }
  return 0;
}
