// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/mujoco_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "engine/core/check.hpp"

namespace softgauss::app {
namespace {

/// It reads files only, so the text becomes one in memory.
void addFile(mjVFS& files, const std::string& name, const std::string& bytes) {
#if mjVERSION_HEADER >= 314
  if (mj_addBufferVFS(&files, name.c_str(), bytes.data(), static_cast<int>(bytes.size())) != 0)
    throw ModelError({}, "MuJoCo", "has no room for file " + name);
#else
  mj_makeEmptyFileVFS(&files, name.c_str(), static_cast<int>(bytes.size()));
  const int place = mj_findFileVFS(&files, name.c_str());
  if (place < 0) throw ModelError({}, "MuJoCo", "has no room for file " + name);
  std::copy(bytes.begin(), bytes.end(), static_cast<char*>(files.filedata[place]));
#endif
}

}  // namespace

mjModel* loadMujoco(const std::string& name, const std::string& text,
                    const std::vector<std::pair<std::string, std::string>>& files) {
  // It would print them, and write a log where the program was started; firstWarning() tells.
  mju_user_warning = [](const char*) {};
  const auto erase = [](mjVFS* memory) {
    mj_deleteVFS(memory);
    delete memory;
  };
  const std::unique_ptr<mjVFS, decltype(erase)> memory(new mjVFS, erase);
  mj_defaultVFS(memory.get());
  addFile(*memory, name, text);
  for (const auto& [file, bytes] : files) addFile(*memory, file, bytes);
  char error[1000] = "";
  mjModel* const model = mj_loadXML(name.c_str(), memory.get(), error, sizeof error);
  if (!model) throw ModelError({}, "MuJoCo", fmt::format("refuses the model: {}", error));
  return model;
}

}  // namespace softgauss::app
