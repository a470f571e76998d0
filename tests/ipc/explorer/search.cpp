// SPDX-License-Identifier: Apache-2.0
#include "tests/ipc/explorer/search.hpp"

#include <chrono>
#include <memory>

#include "tests/ipc/explorer/oblivion.hpp"
#include "tests/ipc/explorer/visited.hpp"

namespace handcast::explorer {
namespace {

struct Move {
  int thread = 0;
  int choice = 0;     ///< outcome of the step; -1: no step, only death
  bool dies = false;  ///< the thread is killed after the step
};

/// A state on the path, and the moves from it that were tried.
struct Frame {
  State state;
  Move move;             ///< the last one that was tried
  int choices = 0;       ///< outcomes of the step; known after the first try
  bool may_die = false;  ///< the thread may be killed after the step
  bool is_started = false;
  int only = -1;  ///< the only thread whose step needs to be tried; -1: all
};

class Search {
 public:
  Search(Machine& machine, const State& start, std::uint64_t max_states)
      : machine_(machine),
        oblivion_(machine),
        extent_{machine.threads(), machine.locations()},
        max_states_(max_states) {
    open(0);
    copy_state(path_[0]->state, start, extent_);
    oblivion_.forget(path_[0]->state);
    enter(0);
  }

  Found run(const std::function<const char*(const State&)>& at_end) {
    const auto began = std::chrono::steady_clock::now();
    while (depth_ >= 0 && found_.broken.empty() && found_.is_complete) advance(at_end);
    found_.states = visited_.count();
    found_.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return found_;
  }

 private:
  void advance(const std::function<const char*(const State&)>& at_end) {
    auto& frame = *path_[depth_];
    if (!next_move(frame)) {
      --depth_;
      return;
    }
    open(depth_ + 1);
    auto& child = path_[depth_ + 1]->state;
    copy_state(child, frame.state, extent_);
    apply(frame, child);
    ++found_.steps;
    if (machine_.broken()) return fail(machine_.broken());
    oblivion_.forget(child);
    if (!visited_.insert(hash_state(child, extent_))) return;
    found_.is_complete = visited_.count() < max_states_;
    enter(depth_ + 1);
    if (!is_over(child)) return;
    ++found_.ends;
    if (const char* broken = at_end(child)) fail(broken, 1);
    --depth_;
  }

  /// Selects the next move. A death commutes with all steps of other threads, so it is enough to
  /// kill a thread directly after each of its own steps.
  bool next_move(Frame& frame) {
    auto& move = frame.move;
    if (!frame.is_started) {
      frame.is_started = true;
      move = {-1, 0, false};
      frame.choices = 0, frame.may_die = false;
    }
    if (frame.may_die && !move.dies) {
      move.dies = true;
      return true;
    }
    move.dies = false;
    if (++move.choice < frame.choices) return true;
    return next_thread(frame);
  }

  bool next_thread(Frame& frame) {
    auto& move = frame.move;
    for (++move.thread; move.thread < extent_.threads; ++move.thread) {
      if (frame.only >= 0 && move.thread != frame.only) continue;
      if (frame.state.threads[move.thread].status != Status::running) continue;
      move.choice = 0;
      frame.choices = 1;
      if (depth_ == 0 && machine_.mortal(frame.state, move.thread))
        move.choice = -1, move.dies = true, frame.may_die = true;
      return true;
    }
    return false;
  }

  void apply(Frame& frame, State& state) {
    const auto& move = frame.move;
    if (move.choice >= 0) {
      frame.choices = machine_.step(state, move.thread, move.choice);
      if (!move.dies) frame.may_die = machine_.mortal(state, move.thread);
    }
    if (move.dies && !machine_.broken()) machine_.kill(state, move.thread);
    if (move.choice < 0) frame.may_die = false;
  }

  void enter(int depth) {
    depth_ = depth;
    found_.depth = std::max(found_.depth, depth);
    auto& frame = *path_[depth];
    frame.is_started = false;
    frame.only = -1;
    for (int i = 0; i < extent_.threads && frame.only < 0; ++i)
      if (frame.state.threads[i].status == Status::running && frame.state.threads[i].urgent)
        frame.only = i;
  }

  bool is_over(const State& state) const {
    for (int i = 0; i < extent_.threads; ++i)
      if (state.threads[i].status == Status::running) return false;
    return true;
  }

  void open(int depth) {
    if (static_cast<int>(path_.size()) <= depth) path_.push_back(std::make_unique<Frame>());
  }

  /// Runs the path again to describe its steps. `above`: the number of frames at the end of the
  /// path without a move.
  void fail(const char* broken, int above = 0) {
    found_.broken = broken;
    auto state = std::make_unique<State>();
    copy_state(*state, path_[0]->state, extent_);
    machine_.trace(true);
    for (int i = 0; i <= depth_ - above; ++i) {
      auto move = *path_[i];
      apply(move, *state);
      oblivion_.forget(*state);
      found_.trace +=
          "   " + machine_.program(path_[i]->move.thread).name + ": " + machine_.said() + "\n";
    }
    machine_.trace(false);
  }

  Machine& machine_;
  Oblivion oblivion_;
  Extent extent_;
  std::uint64_t max_states_;
  Visited visited_;
  std::vector<std::unique_ptr<Frame>> path_;
  int depth_ = 0;
  Found found_;
};

}  // namespace

Found explore(Machine& machine, const State& start,
              const std::function<const char*(const State&)>& at_end, std::uint64_t max_states) {
  return Search(machine, start, max_states).run(at_end);
}

}  // namespace handcast::explorer
