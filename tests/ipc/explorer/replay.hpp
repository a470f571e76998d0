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

/// Threads that go one step at a time.
namespace handcast::explorer {

using Set = std::uint32_t;  ///< of locations or threads, a bit each
constexpr Set bit(int i) { return Set{1} << i; }

/// What a thread runs. It consists of operations, each a function of the thread's locals alone;
/// between two of them only the locals are kept, so short operations let more states fall together.
struct Program {
  std::string name;
  bool (*operation)(void* locals) = nullptr;  ///< false: that was the last one. Leaves by longjmp:
                                              ///< nothing in it needs a destructor
  Role role = Role::reader;
  Set reads = 0, writes = 0;                   ///< locations it may ever load or store
  bool mortal = false;                         ///< it may be killed before any of its steps
  bool is_doubted = false;                     ///< others take it for dead while it lives
  bool is_read_at_end = false;                 ///< its locals are kept when it has finished
  Set starts_on_death = 0, starts_on_end = 0;  ///< threads that are absent until then. They know
                                               ///< what this one knew: the kernel tells
};

/// What the order of an action among other threads' steps is worth. Most orders need not be tried:
enum class Manner {
  unnoticed,  ///< no other thread's step, no death can be told from it: it happens with the step
              ///< before
  early,  ///< nobody loses a choice when it comes at once. A store is such: others may still load
          ///< what was there before
  early_choice,  ///< the same, but it has several outcomes
  contested,     ///< its order among the others' steps matters
};

class Replay {
 public:
  virtual ~Replay() = default;

  int add(Program program) {
    programs_.push_back(std::move(program));
    return static_cast<int>(programs_.size()) - 1;
  }
  Program& program(int thread) { return programs_[static_cast<std::size_t>(thread)]; }
  const Program& program(int thread) const { return programs_[static_cast<std::size_t>(thread)]; }
  int threads() const { return static_cast<int>(programs_.size()); }

  /// One step of one thread: the operation is run again against the log, takes one action beyond
  /// it, and is left at the next. Returns how many outcomes that action has; `choice` picks one.
  int step(State& state, int thread, int choice) {
    begin(state, thread, choice);
    while (self().status == Status::running && run_operation()) {
    }
    return choices_;
  }

  /// Runs `count` whole operations with nobody about; for what lies before the story.
  void run_alone(State& state, int thread, int count) {
    begin(state, thread, 0);
    for (operations_left_ = count; operations_left_ > 0;) {
      acted_ = false;
      run_operation();
    }
    operations_left_ = -1;
  }

  void kill(State& state, int thread) {
    state_ = &state;
    thread_ = thread;
    if (tracing_) said_ += "KILLED";
    end(Status::dead, program(thread).starts_on_death);
  }

  bool mortal(const State& state, int thread) {
    return program(thread).mortal && state.threads[thread].lives();
  }

  void check(bool holds, const char* otherwise) {
    if (!holds && !broken_) broken_ = otherwise;
  }
  const char* broken() const { return broken_; }

  void trace(bool on) { tracing_ = on; }
  std::string said() { return std::exchange(said_, {}); }

  int thread() const { return thread_; }
  const State& state() const { return *state_; }
  Role role() const { return role_; }
  void act_as(Role role) { role_ = role; }

 protected:
  /// Called when an operation is over, before its locals are kept.
  virtual void operation_ends() {}
  virtual void operation_begins() {}

  Thread& self() { return state_->threads[thread_]; }
  State& changing() { return *state_; }
  bool replaying() { return cursor_ < self().log_length; }

  /// `action(self)` gives the value to log, once; from then on the log answers.
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

  /// One of `count` outcomes of the action that is being taken.
  int choose(int count) {
    choices_ = count;
    return choice_;
  }

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

  /// False where the operation was left half way, or was the last one.
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
    if (is_remembered) ended.views.current = known;  // for who asks whether it is gone
    ended.status = status;
  }

  std::vector<Program> programs_;
  State* state_ = nullptr;
  int thread_ = 0;
  Role role_ = Role::reader;
  int cursor_ = 0;
  int choice_ = 0, choices_ = 1;
  bool acted_ = false;
  int operations_left_ = -1;  ///< of run_alone()
  const char* broken_ = nullptr;
  bool tracing_ = false;
  std::string said_;
  std::jmp_buf left_;
  alignas(16) std::byte scratch_[kLocalsBytes];
};

}  // namespace handcast::explorer
