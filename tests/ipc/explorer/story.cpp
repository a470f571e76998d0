// SPDX-License-Identifier: Apache-2.0
#include "tests/ipc/explorer/story.hpp"

#include <cstdlib>
#include <cstring>
#include <new>
#include <numeric>
#include <string_view>

namespace handcast::explorer {
namespace {

template <class Locals>
Locals& locals_of(State& state, int thread) {
  return *std::launder(reinterpret_cast<Locals*>(state.threads[thread].locals));
}

void put(State& state, const ModelAtomics::Word& word, std::uint64_t value) {
  state.memory.history[word.location][0].value = value;
}

/// Checks that a sequence is given to one message only, identified by its writer and slot.
void note_message(Machine& checked, State& state, int location, std::uint64_t word) {
  if (!ipc::holds_message(word)) return;
  const auto index = (ipc::sequence_of(word) - ring->shape().first_sequence) & (kMaxSequences - 1);
  const auto slot = location - ring->words().state(0).location;
  const auto author = static_cast<std::uint8_t>(1 + static_cast<std::uint64_t>(slot) +
                                                kModelSlots * (ipc::epoch_of(word) & 7));
  auto& known = state.published[index];
  checked.check(known == 0 || known == author, "a sequence is given twice");
  known = author;
}

}  // namespace

Story::Story(const RingShape& shape) : start_(std::make_unique<State>()) {
  std::memset(static_cast<void*>(start_.get()), 0, sizeof(State));
  machine = &machine_;
  memory_ = std::make_unique<RingMemory>(shape);
  ring = memory_.get();
  auto words = memory_->words();
  const auto before_first = ipc::state_word(shape.first_epoch - 1, shape.first_sequence - 1);
  put(*start_, words.epoch(), shape.first_epoch - 1);
  put(*start_, words.state(0), before_first);
  put(*start_, words.head(), ipc::head_word(0, shape.first_sequence - 1));
  for (int row = 0; row < kModelRows; ++row) {
    put(*start_, words.owner(row), ipc::free_word(shape.generation));
    put(*start_, words.wait(row), ipc::free_word(shape.generation));
    for (int index = 0; index < ipc::kLeasesPerRow; ++index)
      put(*start_, words.lease(row, index), ipc::free_word(shape.generation));
  }
  machine_.watch(Kind::state, note_message);
}

Story::~Story() {
  machine = nullptr;
  ring = nullptr;
}

template <class Locals>
int Story::add(std::string name, bool (*operation)(void*), Role role, const Locals& locals,
               Set reads, Set writes) {
  static_assert(std::is_trivially_copyable_v<Locals> && sizeof(Locals) <= kLocalsBytes);
  Program program;
  program.name = std::move(name);
  program.operation = operation;
  program.role = role;
  program.reads = reads;
  program.writes = writes;
  const int thread = machine_.add(std::move(program));
  start_->threads[thread].status = Status::running;
  new (start_->threads[thread].locals) Locals(locals);
  return thread;
}

int Story::writer(int publishes, int abandons) {
  WriterLocals locals(memory_->words());
  locals.left = static_cast<std::uint8_t>(publishes + memory_->shape().messages);
  abandons_ = abandons;
  return writer_ = add("writer", run_writer, Role::writer, locals, memory_->everything(),
                       memory_->words_of_writer());
}

int Story::successor(int publishes) {
  WriterLocals locals(memory_->words());
  locals.left = static_cast<std::uint8_t>(publishes);
  return add("successor", run_writer, Role::writer, locals, memory_->everything(),
             memory_->words_of_writer());
}

int Story::reader(int row, const Reading& reading) {
  const auto words = memory_->words();
  ReaderLocals locals(words, row, memory_->shape().generation);
  locals.reading = reading;
  locals.left = static_cast<std::uint8_t>(reading.takes);
  leases_of_row_[row] =
      std::max(leases_of_row_[row], reading.hold == Hold::copy ? 0 : reading.leases_at_once);
  Set writes = bit(words.owner(row).location);
  if (reading.hold != Hold::copy) writes |= memory_->lease_words(row);
  if (reading.waits) writes |= bit(words.wait(row).location);
  const int thread = add("reader " + std::to_string(row), run_reader, Role::reader, locals,
                         memory_->words_of_writer() | memory_->words_of_row(row), writes);
  const auto owner = owner_of(thread, memory_->shape().generation);
  locals_of<ReaderLocals>(*start_, thread).owner = owner;
  put(*start_, words.owner(row), owner);
  if (reading.hold == Hold::lease) memory_->count_reads_of(thread);
  return thread;
}

int Story::claiming_reader(int row, const Reading& reading) {
  const auto owner_before = start_->memory.history[memory_->words().owner(row).location][0].value;
  const int thread = reader(row, reading);
  put(*start_, memory_->words().owner(row), owner_before);
  auto& program = machine_.program(thread);
  program.name = "next reader " + std::to_string(row);
  program.writes |= memory_->words_of_row(row);
  auto& locals = locals_of<ReaderLocals>(*start_, thread);
  locals.owner = 0;
  locals.phase = ReaderLocals::claiming;
  return thread;
}

int Story::dead_reader(int row, std::initializer_list<int> leased_slots) {
  const int thread = reader(row, {.hold = Hold::lease, .leases_at_once = ipc::kLeasesPerRow});
  start_->threads[thread].status = Status::dead;
  const auto words = memory_->words();
  const auto generation = memory_->shape().generation;
  int index = 0;
  for (const int slot : leased_slots)
    put(*start_, words.lease(row, index++),
        ipc::lease_word(generation, slot, memory_->shape().first_sequence));
  put(*start_, words.wait(row), ipc::free_word(generation) | ipc::kWaiting);
  return thread;
}

int Story::recoverer(int row) {
  return add("recoverer", run_recoverer, Role::recoverer, RecovererLocals{row},
             memory_->words_of_row(row), memory_->words_of_row(row));
}

void Story::dies(int thread, std::initializer_list<int> then) {
  machine_.program(thread).mortal = true;
  for (const int next : then) {
    machine_.program(thread).starts_on_death |= bit(next);
    absent_ |= bit(next);
  }
}

void Story::ends(int thread, std::initializer_list<int> then) {
  for (const int next : then) {
    machine_.program(thread).starts_on_end |= bit(next);
    absent_ |= bit(next);
  }
}

int Story::leases_that_may_be_out() const {
  return std::accumulate(leases_of_row_, leases_of_row_ + kModelRows, 0);
}

/// Lets the writer attach and publish the first messages. Then all threads know all of memory, so
/// only the newest messages are kept.
void Story::start_in_same_knowledge() {
  auto& memory = start_->memory;
  std::fill_n(memory.length, machine_.locations(), std::uint8_t{1});
  const int attach_then_loans_and_publishes = 1 + 2 * memory_->shape().messages;
  machine_.run_alone(*start_, writer_, attach_then_loans_and_publishes);
  locals_of<WriterLocals>(*start_, writer_).abandons = static_cast<std::uint8_t>(abandons_);
  for (int i = 0; i < machine_.locations(); ++i) {
    memory.history[i][0] = {{}, memory.newest_value(i), 0};
    memory.length[i] = 1;
  }
  memory.fenced = {};
  for (int i = 0; i < machine_.threads(); ++i) {
    start_->threads[i].views = {};
    auto& status = start_->threads[i].status;
    if (absent_ & bit(i)) status = Status::absent;
  }
}

Found Story::explore() {
  const bool enough_slots = memory_->shape().slots >= leases_that_may_be_out() + 2;
  for (int i = 0; i < machine_.threads(); ++i)
    if (machine_.program(i).operation == run_writer)
      locals_of<WriterLocals>(*start_, i).never_drops = enough_slots;
  machine_.close();
  start_in_same_knowledge();
  return explorer::explore(machine_, *start_,
                           [this](const State& state) { return look_at_end(state); });
}

const char* Story::look_at_end(const State& state) const {
  const auto words = memory_->words();
  const auto newest = [&](const ModelAtomics::Word& word) {
    return state.memory.newest_value(word.location);
  };
  const auto head = ipc::sequence_of(newest(words.head()));
  bool writer_is_dead = false;
  for (int i = 0; i < machine_.threads(); ++i) {
    const auto& thread = state.threads[i];
    const bool is_writer = machine_.program(i).operation == run_writer;
    if (thread.status == Status::sleeping &&
        std::launder(reinterpret_cast<const ReaderLocals*>(thread.locals))->core.seen() < head)
      return "a wake-up is lost: a reader sleeps for ever, with a message unseen";
    if (is_writer)
      writer_is_dead =
          thread.status == Status::dead || (writer_is_dead && thread.status == Status::absent);
    if (!is_writer && thread.status == Status::dead && machine_.program(i).starts_on_death == 0)
      return nullptr;  // no thread cleans up, so leases may remain
  }
  for (int slot = 0; slot < words.slots() && !writer_is_dead; ++slot)
    if (const auto word = newest(words.state(slot));
        ipc::holds_message(word) && ipc::sequence_of(word) > head)
      return "a message was published that no reader will find";
  for (int row = 0; row < kModelRows; ++row)
    for (int index = 0; index < ipc::kLeasesPerRow; ++index)
      if (ipc::slot_of_lease(newest(words.lease(row, index))) >= 0)
        return "a lease is leaked: its owner is gone";
  return nullptr;
}

bool explores_deep() {
  const char* wanted = std::getenv("HANDCAST_EXPLORE");
  return wanted && std::string_view(wanted) == "deep";
}

}  // namespace handcast::explorer
