// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/ipc/explorer/machine.hpp"

namespace handcast::explorer {

/// Removes from a state the messages that all living threads know to be replaced, so that states
/// which differ only in those become equal. Otherwise no state would ever be reached twice.
class Oblivion {
 public:
  /// Call it after Machine::close().
  explicit Oblivion(const Machine& machine)
      : threads_(machine.threads()), locations_(machine.locations()) {
    for (int i = 0; i < threads_; ++i)
      for (int k = 0; k < kMaxLocations; ++k)
        blind_[i].place[k] = machine.reads_of(i) & bit(k) ? 0 : 0xff;
  }

  /// Removes these messages and adjusts all views.
  void forget(State& state) const {
    const auto old = oldest_in_sight(state);
    if (std::all_of(old.place, old.place + locations_,
                    [](std::uint8_t place) { return place == 0; }))
      return;
    auto& memory = state.memory;
    for (int i = 0; i < locations_; ++i) {
      std::copy(memory.history[i] + old.place[i], memory.history[i] + memory.length[i],
                memory.history[i]);
      memory.length[i] = static_cast<std::uint8_t>(memory.length[i] - old.place[i]);
      for (int place = 0; place < memory.length[i]; ++place)
        lower(memory.history[i][place].view, old);
    }
    lower(memory.fenced, old);
    for (int i = 0; i < threads_; ++i) {
      auto& views = state.threads[i].views;
      lower(views.current, old), lower(views.acquirable, old), lower(views.released, old);
    }
  }

 private:
  View oldest_in_sight(const State& state) const {
    View oldest{};
    for (int i = 0; i < locations_; ++i)
      oldest.place[i] = static_cast<std::uint8_t>(state.memory.newest(i));
    for (int i = 0; i < threads_; ++i) {
      if (!state.threads[i].lives()) continue;
      const auto& known = state.threads[i].views.current;
      for (int k = 0; k < kMaxLocations; ++k)
        oldest.place[k] =
            std::min<std::uint8_t>(oldest.place[k], known.place[k] | blind_[i].place[k]);
    }
    return oldest;
  }

  static void lower(View& view, const View& by) {
    for (int i = 0; i < kMaxLocations; ++i)
      view.place[i] =
          static_cast<std::uint8_t>(view.place[i] > by.place[i] ? view.place[i] - by.place[i] : 0);
  }

  int threads_, locations_;
  View blind_[kMaxThreads];
};

}  // namespace handcast::explorer
