// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "tests/ipc/explorer/replay.hpp"

/// The operations threads see: atomic words, fences, a futex, and plain memory whose races are
/// found.
namespace handcast::explorer {

class Machine : public Replay {
 public:
  int add_location(std::string name, Kind kind);
  /// A location that only counts plain reads: whoever writes must know of all of them.
  int add_read_count(std::string name) { return add_location(std::move(name), Kind::other); }
  const std::string& name(int location) const { return names_[static_cast<std::size_t>(location)]; }
  int locations() const { return static_cast<int>(names_.size()); }

  /// Once all locations and programs are there.
  void close();
  /// Locations this thread, or one that it starts, may still load.
  Set reads_of(int thread) const { return reads_[thread]; }

  /// Without the reductions that Manner stands for: slower, and the same result. For tests of the
  /// reductions.
  void try_every_order(bool on) { every_order_ = on; }

  void plant(Faults faults) { faults_ = std::move(faults); }
  /// Called with every value stored in a word of this kind.
  void watch(Kind kind, void (*watcher)(Machine&, State&, int location, std::uint64_t value)) {
    watched_ = kind, watcher_ = watcher;
  }

  std::uint64_t load(int location, std::memory_order order);
  void store(int location, std::uint64_t value, std::memory_order order);
  bool exchange(int location, std::uint64_t expected, std::uint64_t desired,
                std::memory_order order);
  void fence(std::memory_order order);
  /// FUTEX_WAIT without a time limit, which would heal a lost wake-up. The kernel's fences are
  /// there: it looks under its lock.
  void futex_wait(int location, std::uint64_t seen);
  void futex_wake(int location);

  /// A plain read in a lease. It races if the newest write did not happen before it.
  std::uint64_t plain_read(int location, int read_count);
  /// A payload write: plain memory to readers with a lease (their read counts are given), relaxed
  /// to those that copy.
  void write_payload(int location, std::uint64_t value, const std::vector<int>& read_counts);

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
    const Fault* why;  ///< null: nothing is held back
    int location;
    std::uint64_t value;
    std::memory_order order;
  } held_back_{};
};

}  // namespace handcast::explorer
