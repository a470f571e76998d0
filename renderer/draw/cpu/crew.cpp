// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/crew.hpp"

#include "ipc/base/clock.hpp"

namespace handcast::renderer::cpu {
namespace {

constexpr std::int64_t kAwake_ns = 1'000'000;  ///< how long a helper looks for a task

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
  rouse();
  for (std::thread& helper : helpers_) helper.join();
}

void Crew::rouse() {
  if (helpers_.empty()) return;
  roused_.fetch_add(1);
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
  const std::uint64_t number = (state_.load(std::memory_order_relaxed) >> 32) + 1;
  state_.store(number << 32 | static_cast<std::uint64_t>(parts) << 16, std::memory_order_release);
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

void Crew::help(int worker) {
  std::uint32_t seen = 0;
  while (true) {
    roused_.wait(seen);
    seen = roused_.load();
    if (ends_.load()) return;
    bool is_done = false;
    for (const std::int64_t until_ns = now_ns() + kAwake_ns; !is_done && now_ns() < until_ns;
         pause())
      while (do_one(worker)) is_done = true;
  }
}

}  // namespace handcast::renderer::cpu
