// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "tests/ipc/explorer/reader_program.hpp"
#include "tests/ipc/explorer/ring_memory.hpp"
#include "tests/ipc/explorer/search.hpp"
#include "tests/ipc/explorer/writer_program.hpp"

namespace handcast::explorer {

/// A ring, who uses it and who is killed: what one exploration goes through to the end.
///
/// It begins with a writer that has attached and published a message or more, which everybody
/// knows, and with readers that own their rows.
class Story {
 public:
  explicit Story(const RingShape& shape);
  ~Story();
  Story(const Story&) = delete;
  Story& operator=(const Story&) = delete;

  /// Every function that adds a thread returns its number.
  int writer(int publishes, int abandons = 0);
  int reader(int row, const Reading& reading);

  /// One that died before the story, with leases and a raised flag.
  int dead_reader(int row, std::initializer_list<int> leased_slots);

  // Who is there from the beginning, or only after another's death.
  int claiming_reader(int row, const Reading& reading);
  int recoverer(int row);
  int successor(int publishes);

  /// `thread` may be killed before any of its steps; `then` start when it was.
  void dies(int thread, std::initializer_list<int> then);
  void ends(int thread, std::initializer_list<int> then);

  /// Everybody takes this thread for dead from the beginning, although it lives.
  void doubt(int thread) { machine_.program(thread).is_doubted = true; }

  void try_every_order() { machine_.try_every_order(true); }
  void plant(Faults faults) { machine_.plant(std::move(faults)); }
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

/// True with HANDCAST_EXPLORE=deep: more messages, more readers, minutes to hours.
bool explores_deep();

}  // namespace handcast::explorer
