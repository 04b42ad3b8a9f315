// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/keyframe.hpp"

namespace softgauss::io::mjcf {

Keyframe readKeyframe(const Element& e, std::size_t index) {
  if (e.tag != "key") e.fail("is not read in <keyframe>; expected key");
  e.expectAttributes({"name", "time", "qpos", "qvel", "act", "ctrl", "mpos", "mquat"});
  return {e.has("name") ? e.requiredText("name") : std::to_string(index), e.where,
          e.numbers("qpos"), e.numbers("qvel"), e.numbers("ctrl")};
}

}  // namespace softgauss::io::mjcf
