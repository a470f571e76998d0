// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/receiver.hpp"

#include <algorithm>
#include <utility>

namespace handcast::camera::leap {
namespace {

/// Half a period: stamps of one image are the same, those of two differ by a period at least.
std::uint32_t split_ticks_of(const StreamFacts& facts) {
  return static_cast<std::uint32_t>(facts.clock_hz * facts.period_ns / 2'000'000'000);
}

/// An image takes about its period to be sent.
std::int64_t payload_ns_of(const StreamFacts& facts) {
  return facts.period_ns *
         static_cast<std::int64_t>(std::min(facts.payload_bytes, facts.frame_bytes)) /
         static_cast<std::int64_t>(facts.frame_bytes);
}

}  // namespace

Receiver::Receiver(const StreamFacts& facts, std::shared_ptr<Mailbox> mailbox)
    : facts_(facts),
      mailbox_(std::move(mailbox)),
      assembler_(facts.frame_bytes, split_ticks_of(facts)),
      times_(facts.clock_hz, facts.period_ns),
      before_arrival_ns_(payload_ns_of(facts) + facts.delivery_ns + facts.exposure_ns / 2) {}

void Receiver::on_payload(std::span<const std::uint8_t> bytes, std::int64_t arrived_ns) {
  const auto ended = assembler_.take(bytes, arrived_ns);
  if (ended.torn) finish(*ended.torn);
  if (ended.own) finish(*ended.own);
}

void Receiver::on_lost_payload() { assembler_.lose_payload(); }

void Receiver::finish(const EndedFrame& frame) {
  const auto place = times_.add(frame);
  msg::FrameLosses lost;
  lost.missing = static_cast<std::uint32_t>(place.steps - 1);
  if (!frame.is_whole) {
    lost.incomplete = 1;
    return mailbox_->count(lost, place.steps);
  }
  std::swap(image_.bytes, assembler_.bytes());
  image_.lost = lost;
  // The map of the clocks may move back a little; origins do not.
  image_.exposed_ns =
      std::max(place.arrival_ns - before_arrival_ns_, mailbox_->last_exposed_ns() + 1);
  image_.exposed_error_ns = place.error_ns;
  mailbox_->put(image_, place.steps);
}

}  // namespace handcast::camera::leap
