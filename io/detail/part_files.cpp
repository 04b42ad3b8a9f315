// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/part_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>

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

namespace {

constexpr std::string_view kBegin = "softgauss-", kEnd = ".part";

bool isPartName(std::string_view name) {
  if (name.size() <= kBegin.size() + kEnd.size() || !name.starts_with(kBegin) ||
      !name.ends_with(kEnd))
    return false;
  name.remove_prefix(kBegin.size());
  name.remove_suffix(kEnd.size());
  return name.find_first_not_of("0123456789-") == std::string_view::npos;
}

/// Takes the lock of a new file; false where somebody who looks for what was left has it, and the
/// file may be gone.
bool lockNew(int descriptor) {
  // Where the file system knows no locks, nobody will find it unlocked.
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) return errno != EWOULDBLOCK;
  struct stat info = {};
  return fstat(descriptor, &info) == 0 && info.st_nlink > 0;
}

}  // namespace

int makePart(const std::filesystem::path& target, std::filesystem::path& part) {
  constexpr int kMostNames = 100;  // that a process killed by force may have left
  for (int i = 0; i < kMostNames; ++i) {
    part = rememberPart(target);
    const int made = open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (made >= 0 && lockNew(made)) return made;
    const int error = made >= 0 ? EEXIST : errno;
    if (made >= 0) close(made);
    forgetPart(std::exchange(part, {}));
    errno = error;
    if (error != EEXIST) break;
  }
  return -1;
}

void removeLeftParts(const std::filesystem::path& target) {
  static std::mutex mutex;
  static std::optional<std::filesystem::path> last;
  const std::filesystem::path folder =
      target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
  const std::lock_guard guard(mutex);
  if (std::exchange(last, folder) == folder) return;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error)) {
    if (!isPartName(at->path().filename().native())) continue;
    const int left = open(at->path().c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (left < 0) continue;
    struct stat info = {};
    if (fstat(left, &info) == 0 && S_ISREG(info.st_mode) && flock(left, LOCK_EX | LOCK_NB) == 0)
      unlink(at->path().c_str());
    close(left);
  }
}

}  // namespace detail
}  // namespace softgauss::io
