// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "tests/ipc/explorer/faults.hpp"
#include "tests/ipc/explorer/state.hpp"

namespace handcast::explorer {

/// A set of locations or threads, with one bit for each.
using Set = std::uint32_t;
/// The set with one element.
constexpr Set bit(int i) { return Set{1} << i; }

/// The program of a thread: a sequence of operations, each a function of the thread's locals. Only
/// the locals are kept between two operations, so with short operations more states are equal.
struct Program {
  std::string name;  ///< used in traces
  /// Runs the next operation. Returns false if it was the last one. It may be left by longjmp, so
  /// nothing in it may need a destructor.
  bool (*operation)(void* locals) = nullptr;
  Role role = Role::reader;  ///< for faults
  /// The locations that it may ever load or store.
  /// @{
  Set reads = 0, writes = 0;
  /// @}
  bool mortal = false;          ///< it may be killed before any of its steps
  bool is_doubted = false;      ///< others mistake it for dead while it lives
  bool is_read_at_end = false;  ///< its locals are kept when it has finished
  /// Threads that are absent until it dies, or finishes. They know what it knew, since they learn
  /// its end from the kernel.
  /// @{
  Set starts_on_death = 0, starts_on_end = 0;
  /// @}
};

/// Whether the order of an action relative to steps of other threads matters. Most orders need not
/// be tried.
enum class Manner {
  /// No step of another thread and no death can be distinguished from it: it is part of the step
  /// before.
  unnoticed,
  /// No thread loses a choice if it happens at once, as with a store: others may still load the old
  /// value.
  early,
  /// Like `early`, but with several outcomes.
  early_choice,
  /// Its order matters.
  contested,
};

/// Runs threads step by step. A step runs the current operation again with the logged results of
/// its actions, until one action more is done.
class Replay {
 public:
  virtual ~Replay() = default;

  /// Adds a thread; returns its number.
  int add(Program program) {
    programs_.push_back(std::move(program));
    return static_cast<int>(programs_.size()) - 1;
  }
  /// The program of a thread.
  /// @{
  Program& program(int thread) { return programs_[static_cast<std::size_t>(thread)]; }
  const Program& program(int thread) const { return programs_[static_cast<std::size_t>(thread)]; }
  /// @}
  /// Number of threads.
  int threads() const { return static_cast<int>(programs_.size()); }

  /// Makes one step of a thread: runs its operation again with the log, does one action beyond the
  /// log, and leaves it at the next action. Returns the number of outcomes of that action; `choice`
  /// selects one.
  int step(State& state, int thread, int choice) {
    begin(state, thread, choice);
    while (self().status == Status::running && run_operation()) {
    }
    return choices_;
  }

  /// Runs `count` whole operations without other threads, for the time before a story begins.
  void run_alone(State& state, int thread, int count) {
    begin(state, thread, 0);
    for (operations_left_ = count; operations_left_ > 0;) {
      acted_ = false;
      run_operation();
    }
    operations_left_ = -1;
  }

  /// Kills a thread, and starts those of Program::starts_on_death.
  void kill(State& state, int thread) {
    state_ = &state;
    thread_ = thread;
    if (tracing_) said_ += "KILLED";
    end(Status::dead, program(thread).starts_on_death);
  }

  /// True if a thread lives and may be killed.
  bool mortal(const State& state, int thread) {
    return program(thread).mortal && state.threads[thread].lives();
  }

  /// Reports a broken property, described by `otherwise`, unless `holds`.
  void check(bool holds, const char* otherwise) {
    if (!holds && !broken_) broken_ = otherwise;
  }
  /// The first property that was broken in the last step; null if none was.
  const char* broken() const { return broken_; }

  /// Turns the description of steps on or off.
  void trace(bool on) { tracing_ = on; }
  /// Returns and clears the description of the last steps.
  std::string said() { return std::exchange(said_, {}); }

  /// The running thread, the state that it changes, and its role.
  /// @{
  int thread() const { return thread_; }
  const State& state() const { return *state_; }
  Role role() const { return role_; }
  /// @}
  /// Changes the role for the rest of the operation.
  void act_as(Role role) { role_ = role; }

 protected:
  /// Called before an operation, and after it before its locals are kept.
  /// @{
  virtual void operation_ends() {}
  virtual void operation_begins() {}
  /// @}

  /// The running thread.
  Thread& self() { return state_->threads[thread_]; }
  /// The state that the running thread changes.
  State& changing() { return *state_; }
  /// True if the next action is in the log already.
  bool replaying() { return cursor_ < self().log_length; }

  /// Does an action: action(self) returns the value to log. If the action is in the log already,
  /// returns that value instead.
  template <class Action>
  std::uint64_t perform(Manner manner, const Action& action) {
    auto& self = this->self();
    if (cursor_ < self.log_length) return self.log[cursor_++];
    const bool at_once =
        manner == Manner::unnoticed || (manner == Manner::early && !program(thread_).mortal);
    if (!at_once && acted_) {
      self.urgent = manner != Manner::contested;
      std::longjmp(left_, 1);
    }
    if (!at_once && operations_left_ < 0) acted_ = true;
    const auto value = action(self);
    if (self.log_length == kMaxLog)
      std::fputs("explorer: kMaxLog is too small\n", stderr), std::abort();
    self.log[self.log_length++] = value;
    ++cursor_;
    if (self.status == Status::sleeping) std::longjmp(left_, 1);
    return value;
  }

  /// The number of the outcome to use, out of `count`, in the present action.
  int choose(int count) {
    choices_ = count;
    return choice_;
  }

  /// Adds to the description of the step, with the format of printf().
  template <class... Args>
  void say(const char* format, Args... args) {
    if (!tracing_) return;
    char text[160];
    std::snprintf(text, sizeof text, format, args...);
    said_ += (said_.empty() ? "" : "; ") + std::string(text);
  }

 private:
  void begin(State& state, int thread, int choice) {
    state_ = &state;
    thread_ = thread;
    choice_ = choice;
    choices_ = 1;
    acted_ = false;
    broken_ = nullptr;
    self().urgent = false;
  }

  /// Runs the current operation. Returns false if it was left half way or was the last one.
  [[gnu::noinline]] bool run_operation() {
    cursor_ = 0;
    role_ = program(thread_).role;
    std::memcpy(scratch_, self().locals, kLocalsBytes);
    operation_begins();
    if (setjmp(left_) != 0) return false;
    const bool more = program(thread_).operation(scratch_);
    operation_ends();
    keep_locals();
    if (!more) end(Status::finished, program(thread_).starts_on_end);
    return more;
  }

  void keep_locals() {
    std::memcpy(self().locals, scratch_, kLocalsBytes);
    self().log_length = 0;
    if (operations_left_ > 0) --operations_left_;
  }

  void end(Status status, Set starts) {
    auto& ended = self();
    for (int i = 0; i < threads(); ++i)
      if (auto& next = state_->threads[i]; starts & bit(i) && next.status == Status::absent) {
        next.status = Status::running;
        next.views.current = next.views.acquirable = ended.views.current;
      }
    const auto known = ended.views.current;
    const bool is_remembered = status == Status::dead && program(thread_).role != Role::writer;
    std::memset(static_cast<void*>(&ended), 0, offsetof(Thread, locals));
    if (!program(thread_).is_read_at_end) std::memset(ended.locals, 0, kLocalsBytes);
    if (is_remembered) ended.views.current = known;  // for Machine::is_gone()
    ended.status = status;
  }

  std::vector<Program> programs_;
  State* state_ = nullptr;
  int thread_ = 0;
  Role role_ = Role::reader;
  int cursor_ = 0;
  int choice_ = 0, choices_ = 1;
  bool acted_ = false;
  int operations_left_ = -1;  ///< in run_alone(); -1 otherwise
  const char* broken_ = nullptr;
  bool tracing_ = false;
  std::string said_;
  std::jmp_buf left_;
  alignas(16) std::byte scratch_[kLocalsBytes];
};

}  // namespace handcast::explorer
