// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "config/sections/stereo.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/pose/stereo/view.hpp"

namespace handcast::pose::stereo {

/// The landmarks of the views that make one sample; empty: this view has none.
using Pair = std::array<std::optional<msg::Landmarks>, kViews>;

/// Decides which landmarks of two views belong to one sample. The cameras need not be triggered
/// together: each message has the origin of its own image. One thread.
class Pairing {
 public:
  /// Reads pair_ms and wait_ms.
  explicit Pairing(const config::PoseStereo& settings);

  /// Takes landmarks that arrived at `now_ns`. Those that are not newer than what this view has
  /// already given are ignored. What this view has waiting is replaced: the newest image counts.
  void push(int view, const msg::Landmarks& landmarks, std::int64_t now_ns);
  /// The landmarks of the next sample: of both views as soon as their images are at most pair_ms
  /// apart; of one view if those of the other did not come within wait_ms. Each is given once, and
  /// the newest origins of samples increase. Empty if there is none at `now_ns`.
  std::optional<Pair> take(std::int64_t now_ns);
  /// The view whose landmarks the next sample waits for: the one that has none waiting.
  int awaited_view() const { return waiting_[0] ? 1 : 0; }
  /// The time from which on take() may have a sample without another push(); empty if none waits.
  std::optional<std::int64_t> due_ns() const;

 private:
  struct Waiting {
    msg::Landmarks landmarks;
    std::int64_t arrived_ns;
  };
  std::optional<Pair> given(const Pair& pair);
  bool can_be_alone(int view) const;

  std::int64_t apart_ns_, wait_ns_;
  std::array<std::optional<Waiting>, kViews> waiting_;
  std::array<std::int64_t, kViews> newest_ns_;  ///< origin of the last message of each view
  std::int64_t sampled_ns_;                     ///< newest origin of the last sample
};

}  // namespace handcast::pose::stereo
