// SPDX-License-Identifier: Apache-2.0
#include "tests/support/allocation_guard.hpp"

#include <cerrno>
#include <cstdlib>
#include <new>

namespace softgauss::test {
namespace {

// Plain integer, so that the hook may run before any constructor and needs no memory itself.
thread_local std::int64_t allocations __attribute__((tls_model("initial-exec"))) = 0;

}  // namespace

std::int64_t allocationCount() { return allocations; }

}  // namespace softgauss::test

#if SOFTGAUSS_ALLOCATION_HOOK
#ifdef __GLIBC__

// The linker prefers these to the C library's, also for calls from shared libraries.
extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  ++softgauss::test::allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++softgauss::test::allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  ++softgauss::test::allocations;
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++softgauss::test::allocations;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++softgauss::test::allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  ++softgauss::test::allocations;
  void* result = __libc_memalign(alignment, size);
  if (!result) return ENOMEM;
  *memory = result;
  return 0;
}

}  // extern "C"

#else

void* operator new(std::size_t size) {
  ++softgauss::test::allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

#endif
#endif
