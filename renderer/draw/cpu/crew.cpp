// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/crew.hpp"

#include "ipc/base/clock.hpp"

namespace handcast::renderer::cpu {
namespace {

constexpr std::int64_t kAwake_ns = 1'000'000;  ///< how long a helper looks for a task

constexpr std::uint32_t number_of(std::uint64_t state) {
  return static_cast<std::uint32_t>(state >> 32);
}
constexpr std::uint64_t next_of(std::uint64_t state) { return state & 0xffff; }
constexpr std::uint64_t parts_of(std::uint64_t state) { return state >> 16 & 0xffff; }

inline void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

Crew::Crew(int helpers) {
  for (int i = 0; i < helpers; ++i) helpers_.emplace_back([this, i] { help(i + 1); });
}

Crew::~Crew() {
  ends_.store(true);
  roused_.fetch_add(1);
  roused_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void Crew::rouse() {
  if (helpers_.empty()) return;
  roused_.store(number_of(state_.load(std::memory_order_relaxed)) + 1);
  roused_.notify_all();
}

void Crew::run(int parts, Call call, void* task) {
  if (helpers_.empty()) {
    for (int part = 0; part < parts; ++part) call(task, part, 0);
    return;
  }
  // All parts of the task before are done: nobody reads these.
  call_ = call;
  task_ = task;
  done_.store(0, std::memory_order_relaxed);
  const std::uint32_t number = number_of(state_.load(std::memory_order_relaxed)) + 1;
  state_.store(std::uint64_t{number} << 32 | static_cast<std::uint64_t>(parts) << 16,
               std::memory_order_release);
  while (do_one(0)) {
  }
  while (done_.load(std::memory_order_acquire) < parts) pause();
}

/// Takes a part and does it. Returns false if none is left. A part that has been taken keeps run()
/// from returning, and so its task from changing.
bool Crew::do_one(int worker) {
  std::uint64_t state = state_.load(std::memory_order_acquire);
  do {
    if (next_of(state) >= parts_of(state)) return false;
  } while (!state_.compare_exchange_weak(state, state + 1, std::memory_order_acquire));
  call_(task_, static_cast<int>(next_of(state)), worker);
  done_.fetch_add(1, std::memory_order_release);
  return true;
}

/// True if all parts of a task have been taken, or a later one has begun.
bool Crew::is_over(std::uint32_t task) const {
  const std::uint64_t state = state_.load(std::memory_order_acquire);
  const auto later = static_cast<std::int32_t>(number_of(state) - task);
  return later > 0 || (later == 0 && next_of(state) >= parts_of(state));
}

void Crew::help(int worker) {
  std::uint32_t task = 0;
  while (true) {
    roused_.wait(task);
    task = roused_.load();
    if (ends_.load()) return;
    const std::int64_t until_ns = now_ns() + kAwake_ns;
    while (!is_over(task) && now_ns() < until_ns)
      if (!do_one(worker)) pause();
  }
}

}  // namespace handcast::renderer::cpu
