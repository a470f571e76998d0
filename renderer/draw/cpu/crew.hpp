// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace handcast::renderer::cpu {

/// Threads that share the parts of a task with the thread that has it. Between two tasks they
/// sleep. A helper that is not there in time is not waited for: the others do its parts. No locks,
/// no allocations. run() and rouse() on one thread.
class Crew {
 public:
  /// Starts `helpers` threads, which inherit the priority and the cores of the calling thread.
  explicit Crew(int helpers);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// The threads that work on a task, the caller's included.
  int size() const { return static_cast<int>(helpers_.size()) + 1; }
  /// Wakes the helpers for one task that comes within 1 ms: waking one takes up to 60 us.
  void rouse();
  /// Calls do_part(part, worker) once for each part in [0, parts), in any order and on any of the
  /// threads; `worker` is in [0, size()), and no two calls at a time have the same. Returns when
  /// all have returned. `parts` < 2^16; do_part must not throw.
  template <class Part>
  void run(int parts, Part& do_part) {
    run(
        parts, [](void* task, int part, int worker) { (*static_cast<Part*>(task))(part, worker); },
        &do_part);
  }

 private:
  using Call = void (*)(void* task, int part, int worker);
  void run(int parts, Call call, void* task);
  void help(int worker);
  bool do_one(int worker);
  bool is_over(std::uint32_t task) const;

  Call call_ = nullptr;
  void* task_ = nullptr;
  /// Number of the task << 32 | its parts << 16 | the next part: who raises it by one has that
  /// part.
  std::atomic<std::uint64_t> state_{0};
  std::atomic<int> done_{0};              ///< parts of the task
  std::atomic<std::uint32_t> roused_{0};  ///< number of the task for which the helpers shall wake
  std::atomic<bool> ends_{false};
  std::vector<std::thread> helpers_;
};

}  // namespace handcast::renderer::cpu
