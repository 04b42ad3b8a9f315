// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/part_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>

#include "softgauss/io/output.hpp"

namespace softgauss::io {
namespace {

/// A name in memory that a signal handler may read at any time.
struct Slot {
  std::atomic<bool> taken{false}, ready{false};
  std::array<char, 4096> name{};
};

/// More are not written at a time; a file too many is merely not remembered.
std::array<Slot, 16> slots;

}  // namespace

void removePartFiles() noexcept {
  for (Slot& slot : slots)
    if (slot.ready.load()) unlink(slot.name.data());
}

namespace detail {

std::filesystem::path rememberPart(const std::filesystem::path& target) {
  static std::atomic<int> count{0};
  const std::filesystem::path part =
      target.parent_path() / fmt::format("softgauss-{}-{}.part", getpid(), ++count);
  const std::string name = part.string();
  for (Slot& slot : slots) {
    if (name.size() >= slot.name.size() || slot.taken.exchange(true)) continue;
    std::memcpy(slot.name.data(), name.c_str(), name.size() + 1);
    slot.ready.store(true);
    break;
  }
  return part;
}

void forgetPart(const std::filesystem::path& part) noexcept {
  for (Slot& slot : slots) {
    if (!slot.ready.load() || part.native() != slot.name.data()) continue;
    slot.ready.store(false);
    slot.taken.store(false);
  }
}

}  // namespace detail
}  // namespace softgauss::io
