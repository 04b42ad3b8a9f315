// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Counts heap allocations of this thread, in any build type.
///
///     const AllocationGuard guard;
///     step(…);
///     EXPECT_EQ(guard.count(), 0);
///
/// With glibc every malloc, calloc, realloc and aligned allocation of the process is seen, from
/// whichever library; elsewhere operator new alone. Sanitizers bring their own allocator: there
/// the hook is off, and kAllocationHook says so.

#include <cstdint>

#define SOFTGAUSS_ALLOCATION_HOOK 1
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#undef SOFTGAUSS_ALLOCATION_HOOK
#define SOFTGAUSS_ALLOCATION_HOOK 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
#undef SOFTGAUSS_ALLOCATION_HOOK
#define SOFTGAUSS_ALLOCATION_HOOK 0
#endif
#endif

namespace softgauss::test {

inline constexpr bool kAllocationHook = SOFTGAUSS_ALLOCATION_HOOK;

/// Allocations of this thread since it began.
std::int64_t allocationCount();

class AllocationGuard {
 public:
  AllocationGuard() : begin_(allocationCount()) {}
  /// Allocations since this guard was made.
  std::int64_t count() const { return allocationCount() - begin_; }

 private:
  std::int64_t begin_;
};

}  // namespace softgauss::test
