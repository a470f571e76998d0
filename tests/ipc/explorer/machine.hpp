// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "tests/ipc/explorer/replay.hpp"

namespace handcast::explorer {

/// The operations of the threads: atomic words, fences, a futex, and plain memory with detection of
/// races.
class Machine : public Replay {
 public:
  /// Adds a word of shared memory with the value 0; returns its location.
  int add_location(std::string name, Kind kind);
  /// Adds a location that counts plain reads: a writer must know all reads.
  int add_read_count(std::string name) { return add_location(std::move(name), Kind::other); }
  /// The name of a location in traces.
  const std::string& name(int location) const { return names_[static_cast<std::size_t>(location)]; }
  /// Number of locations.
  int locations() const { return static_cast<int>(names_.size()); }

  /// Ends the setup. Call it after all locations and programs were added.
  void close();
  /// The locations that this thread, or one that it starts, may still load.
  Set reads_of(int thread) const { return reads_[thread]; }

  /// Disables the reductions of the search (see Manner), to test them: slower, with the same
  /// result.
  void try_every_order(bool on) { every_order_ = on; }

  /// Plants faults under the operations.
  void plant(Faults faults) { faults_ = std::move(faults); }
  /// Calls `watcher` with each value that is stored in a word of this kind.
  void watch(Kind kind, void (*watcher)(Machine&, State&, int location, std::uint64_t value)) {
    watched_ = kind, watcher_ = watcher;
  }

  /// The operations of RealAtomics. futex_wait() has no timeout, which could hide a lost wake-up;
  /// it includes the fence of the kernel, which compares the word under a lock.
  /// @{
  std::uint64_t load(int location, std::memory_order order);
  void store(int location, std::uint64_t value, std::memory_order order);
  bool exchange(int location, std::uint64_t expected, std::uint64_t desired,
                std::memory_order order);
  void fence(std::memory_order order);
  void futex_wait(int location, std::uint64_t seen);
  void futex_wake(int location);
  /// @}

  /// A plain read of a leased payload. It is a race if the newest write did not happen before it.
  std::uint64_t plain_read(int location, int read_count);
  /// A write of a payload: plain memory for readers with a lease, whose read counts are given, and
  /// relaxed for readers that copy.
  void write_payload(int location, std::uint64_t value, const std::vector<int>& read_counts);

  /// True if a thread is dead, or doubted (Program::is_doubted). The caller then knows what the
  /// thread knew, as after a look into /proc.
  bool is_gone(int thread);

 private:
  static constexpr Place kNothing{Operation::load, Kind::other};

  Kind kind(int location) const { return kinds_[static_cast<std::size_t>(location)]; }
  bool knows_newest(int location) {
    return self().views.current.place[location] == state().memory.newest(location);
  }
  bool only_i_write(int location);
  Manner manner_of_load(int location);
  Manner manner_of_store(int location);

  const Fault* meet(Operation operation, Kind kind, std::uint64_t value = 0);
  void touch(Operation operation, Kind kind) { touched_ = {operation, kind}; }
  void release_held_back(Operation operation, Kind kind);
  void store_now(int location, std::uint64_t value, std::memory_order order);
  bool exchange_now(int location, std::uint64_t expected, std::uint64_t desired,
                    std::memory_order order);
  void append(Thread& self, int location, std::uint64_t value, bool release,
              const Message* replaced);
  void operation_begins() override;
  void operation_ends() override;

  std::vector<std::string> names_;
  std::vector<Kind> kinds_;
  Set reads_[kMaxThreads]{}, writes_[kMaxThreads]{};
  bool every_order_ = false;
  Faults faults_;
  Place touched_ = kNothing;
  Kind watched_ = Kind::other;
  void (*watcher_)(Machine&, State&, int, std::uint64_t) = nullptr;

  struct HeldBack {
    const Fault* why;  ///< null: no store is held back
    int location;
    std::uint64_t value;
    std::memory_order order;
  } held_back_{};
};

}  // namespace handcast::explorer
