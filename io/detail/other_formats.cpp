// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/other_formats.hpp"

#include <algorithm>
#include <string_view>

#include "softgauss/engine/core/check.hpp"

namespace softgauss::io::detail {
namespace {

struct Format {
  std::string_view root;  ///< element
  const char* problem;
};

constexpr Format kFormats[] = {
    {"mujoco", "is MJCF, the format of MuJoCo, which stands by itself; expected a URDF here"},
    {"sdf",
     "is SDF, the format of Gazebo, which is not read; expected a URDF, or a .yaml scene whose "
     "robots are URDF files. A converter can write one"},
    {"COLLADA",
     "is a COLLADA mesh, no robot; expected a URDF, which names it as "
     "<mesh filename=\"…\"/> of a <collision> or <visual>"},
};

int lineAt(std::string_view text, std::size_t at) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
}

/// Where the next element begins at or after `from`, comments, declarations and instructions left
/// out; npos where there is none.
std::size_t nextElement(std::string_view text, std::size_t from) {
  while ((from = text.find('<', from)) != std::string_view::npos) {
    const std::string_view rest = text.substr(from);
    const char* const end = rest.starts_with("<!--")        ? "-->"
                            : rest.starts_with("<![CDATA[") ? "]]>"
                            : rest.starts_with("<?")        ? "?>"
                            : rest.starts_with("<!")        ? ">"
                                                            : nullptr;
    if (!end) return from;
    from = text.find(end, from);
    if (from == std::string_view::npos) break;
  }
  return std::string_view::npos;
}

std::string_view nameAt(std::string_view text, std::size_t element) {
  const std::string_view rest = text.substr(element + 1);
  return rest.substr(0, rest.find_first_of(" \t\r\n/>"));
}

}  // namespace

void refuseOtherFormats(const std::string& file, const std::string& text) {
  const std::size_t root = nextElement(text, 0);
  if (root == std::string_view::npos) return;
  for (const Format& format : kFormats)
    if (nameAt(text, root) == format.root)
      throw ModelError({file, lineAt(text, root)}, "file", format.problem);
  for (std::size_t at = root; at != std::string_view::npos; at = nextElement(text, at + 1))
    if (nameAt(text, at).starts_with("xacro:"))
      throw ModelError({file, lineAt(text, at)}, "file",
                       "is xacro, from which a URDF is made; expected the URDF. Try: xacro " +
                           file + " > robot.urdf");
}

}  // namespace softgauss::io::detail
