// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "tests/ipc/explorer/reader_program.hpp"
#include "tests/ipc/explorer/ring_memory.hpp"
#include "tests/ipc/explorer/search.hpp"
#include "tests/ipc/explorer/writer_program.hpp"

namespace handcast::explorer {

/// One exploration: a ring, the threads that use it, and those that are killed.
///
/// It begins with a writer that has attached and published at least one message, which all threads
/// know, and with readers that own their rows.
class Story {
 public:
  /// A story of this ring, without threads yet. Only one story at a time.
  explicit Story(const RingShape& shape);
  ~Story();
  Story(const Story&) = delete;
  Story& operator=(const Story&) = delete;

  /// Adds the writer or a reader; returns the number of the thread. The first `abandons` of the
  /// writer's `publishes` loans are abandoned.
  /// @{
  int writer(int publishes, int abandons = 0);
  int reader(int row, const Reading& reading);
  /// @}

  /// Adds a reader that died before the story, with leases and a set wait flag; returns its number.
  int dead_reader(int row, std::initializer_list<int> leased_slots);

  /// Adds a thread that takes over from another one: a reader that claims a row, a recoverer, or a
  /// second writer. It runs from the beginning unless dies() or ends() names it. Returns its
  /// number.
  /// @{
  int claiming_reader(int row, const Reading& reading);
  int recoverer(int row);
  int successor(int publishes);
  /// @}

  /// `thread` may be killed before any of its steps; the threads `then` start when it is dead.
  void dies(int thread, std::initializer_list<int> then);
  /// The threads `then` start when `thread` has finished.
  void ends(int thread, std::initializer_list<int> then);

  /// All threads mistake this one for dead from the beginning, although it lives.
  void doubt(int thread) { machine_.program(thread).is_doubted = true; }

  /// See Machine::try_every_order().
  void try_every_order() { machine_.try_every_order(true); }
  /// See Machine::plant().
  void plant(Faults faults) { machine_.plant(std::move(faults)); }
  /// Explores all executions. Call it once, last.
  Found explore();

 private:
  template <class Locals>
  int add(std::string name, bool (*operation)(void*), Role role, const Locals& locals, Set reads,
          Set writes);
  void start_in_same_knowledge();
  int leases_that_may_be_out() const;
  const char* look_at_end(const State& state) const;

  Machine machine_;
  std::unique_ptr<RingMemory> memory_;
  std::unique_ptr<State> start_;
  int writer_ = -1;
  int abandons_ = 0;
  Set absent_ = 0;
  int leases_of_row_[kModelRows]{};
};

/// True with HANDCAST_EXPLORE=deep: stories have one message or one take more, which takes minutes
/// to hours.
bool explores_deep();

}  // namespace handcast::explorer
