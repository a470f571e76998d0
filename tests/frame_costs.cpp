// SPDX-License-Identifier: Apache-2.0
#include "tests/frame_costs.hpp"

#include <dlfcn.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstddef>
#include <ctime>

namespace handcast::test {

thread_local void (*at_each_look_at_the_clock)() = nullptr;

#ifdef HANDCAST_WITH_SANITIZER

bool are_costs_counted() { return false; }
FrameCosts frame_costs() { return {}; }

#else

namespace {

thread_local std::uint64_t allocations = 0, locks = 0;

}  // namespace

bool are_costs_counted() { return true; }

FrameCosts frame_costs() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return {allocations, locks, static_cast<std::uint64_t>(usage.ru_minflt + usage.ru_majflt)};
}

#endif

}  // namespace handcast::test

#ifndef HANDCAST_WITH_SANITIZER

extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t bytes) noexcept {
  ++handcast::test::allocations;
  return __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) noexcept {
  ++handcast::test::allocations;
  return __libc_calloc(count, bytes);
}
void* realloc(void* old, std::size_t bytes) noexcept {
  ++handcast::test::allocations;
  return __libc_realloc(old, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept {
  ++handcast::test::allocations;
  return __libc_memalign(alignment, bytes);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static const auto real = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  ++handcast::test::locks;
  return real(mutex);
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  if (handcast::test::at_each_look_at_the_clock) handcast::test::at_each_look_at_the_clock();
  return static_cast<int>(syscall(SYS_clock_gettime, clock, time));
}

}  // extern "C"

#endif
