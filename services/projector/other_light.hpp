// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

#include "ipc/base/clock.hpp"
#include "ipc/msg/projection.hpp"
#include "ipc/ring/reader.hpp"

namespace handcast::projector {

/// Whether the other projector of a rig is on. If its process dies, this one lights the hands alone
/// after 0.1 s or three of its frames, gently, until the other one is back. One thread.
class OtherLight {
 public:
  /// Takes the reader of the other projector's frames, which come at `rate_hz`.
  OtherLight(ipc::Reader<msg::Projection> frames, double rate_hz)
      : frames_(std::move(frames)),
        silence_ns_(std::max(kSilence_ns, seconds_to_ns(3 / rate_hz))) {}

  /// What is on of its light at `time_ns`, CLOCK_MONOTONIC, 0..1: renderer::Pipeline::set_beside().
  /// Never waits.
  float share(std::int64_t time_ns) {
    if (frames_.await(Deadline::now()) && frames_.latest(Deadline::now())) seen_ns_ = time_ns;
    const bool is_on = seen_ns_ != 0 && time_ns - seen_ns_ < silence_ns_;
    const auto step = static_cast<float>(time_ns - last_ns_) / static_cast<float>(kFade_ns);
    if (last_ns_ != 0) share_ = std::clamp(share_ + (is_on ? step : -step), 0.0f, 1.0f);
    last_ns_ = time_ns;
    return share_;
  }

 private:
  static constexpr std::int64_t kSilence_ns = 100'000'000, kFade_ns = 200'000'000;

  ipc::Reader<msg::Projection> frames_;
  std::int64_t silence_ns_;
  std::int64_t seen_ns_ = 0, last_ns_ = 0;  ///< 0: never
  float share_ = 0;
};

}  // namespace handcast::projector
