// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/mujoco_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string_view>

#include "softgauss/engine/core/check.hpp"

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

/// Its reader refuses elements that are nested a hundred deep. Bodies that are deep in others go
/// into files of their own, which it includes.
class Unfolded {
 public:
  explicit Unfolded(const std::string& text) {
    static constexpr int kDeep = 64;
    parts_.push_back({});
    int depth = 0;
    std::size_t at = 0;
    for (std::size_t next; (next = text.find_first_of('<', at + 1)) != text.npos; at = next) {
      const std::string_view element(text.data() + at, next - at);
      if (element.starts_with("<body ") && ++depth % kDeep == 0)
        parts_.push_back("<mujocoinclude>");
      parts_.back() += element;
      if (element.starts_with("</body>") && depth-- % kDeep == 0) fold();
    }
    parts_.back() += text.substr(at);
  }

  const std::string& text() const { return parts_.front(); }
  const std::vector<std::pair<std::string, std::string>>& files() const { return files_; }

 private:
  void fold() {
    const std::string name = fmt::format("deep{}.xml", files_.size());
    files_.emplace_back(name, parts_.back() + "</mujocoinclude>");
    parts_.pop_back();
    parts_.back() += fmt::format("<include file=\"{}\"/>", name);
  }

  std::vector<std::string> parts_;  ///< begun, each within the one before
  std::vector<std::pair<std::string, std::string>> files_;
};

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
  const Unfolded unfolded(text);
  addFile(*memory, name, unfolded.text());
  for (const auto& [file, bytes] : unfolded.files()) addFile(*memory, file, bytes);
  for (const auto& [file, bytes] : files) addFile(*memory, file, bytes);
  char error[1000] = "";
  mjModel* const model = mj_loadXML(name.c_str(), memory.get(), error, sizeof error);
  if (!model) throw ModelError({}, "MuJoCo", fmt::format("refuses the model: {}", error));
  return model;
}

}  // namespace softgauss::app
