// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/sound/recorder.hpp"

#include <utility>

#include "ipc/base/clock.hpp"

namespace handcast::calibrate {
namespace {

/// The time of a sample by the card's clock.
std::int64_t device_ns(std::size_t sample, double rate_hz) {
  return seconds_to_ns(static_cast<double>(sample) / rate_hz);
}

}  // namespace

Recorder::Recorder(std::unique_ptr<SoundCard> card)
    : card_(std::move(card)), thread_([this](const std::stop_token& asked) { record(asked); }) {}

Recorder::~Recorder() = default;

void Recorder::record(const std::stop_token& asked) {
  constexpr double kLead_s = 2;  // what a card may have in its buffer
  const auto began_ns = now_ns();
  while (!asked.stop_requested()) {
    if (const auto read = card_->read(samples_); !read) {
      error_ = read.error();
      return;
    }
    // A block arrives when its last sample has been taken.
    clock_.add(device_ns(samples_.size(), card_->rate_hz()), now_ns());
    // A device that is not a card (ALSA's `null`) sends as fast as it is read.
    const double heard_s = static_cast<double>(samples_.size()) / card_->rate_hz();
    if (heard_s > 2 * ns_to_seconds(now_ns() - began_ns) + kLead_s) {
      error_ = Error{Errc::bad_config, "the sound device does not keep its rate; is it a card?"};
      return;
    }
  }
}

Result<calib::SoundClip> Recorder::finish() {
  thread_.request_stop();
  thread_.join();
  if (error_) return tl::make_unexpected(*error_);
  if (static_cast<double>(samples_.size()) < 0.5 * card_->rate_hz())
    return fail(Errc::bad_data, "the sound card has sent less than half a second");
  // The map is a line over the last 8 s; older samples lie on its continuation.
  const auto begin = clock_.earliest_arrival(0),
             end = clock_.earliest_arrival(device_ns(samples_.size(), card_->rate_hz()));
  const auto count = static_cast<double>(samples_.size());
  return calib::SoundClip{std::move(samples_), static_cast<double>(begin.ns),
                          static_cast<double>(end.ns - begin.ns) / count, end.error_ns};
}

}  // namespace handcast::calibrate
