// SPDX-License-Identifier: Apache-2.0
#include "ipc/client/rig_presence.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/client/rig_ring.hpp"
#include "ipc/control/rig_address.hpp"

namespace handcast::client {
namespace {

constexpr auto kPatience = std::chrono::milliseconds(100);

/// Whether this error of rig_ring() means that another rig has taken the name: one without the
/// stream, or one of another version, whose answers and rings cannot be read.
bool is_of_another_rig(Errc code) { return code == Errc::bad_config || code == Errc::bad_data; }

}  // namespace

RigPresence::RigPresence(std::string rig, std::string stream, std::int64_t ring_created_ns,
                         PresenceTimes times)
    : rig_(std::move(rig)),
      stream_(std::move(stream)),
      ring_created_ns_(ring_created_ns),
      times_(times) {
  heard();
}

void RigPresence::heard() {
  next_check_ns_ = now_ns() + times_.silence_ns;
  absent_since_ns_ = 0;
}

Result<void> RigPresence::silent() {
  const auto now = now_ns();
  if (now < next_check_ns_) return {};
  next_check_ns_ = now + times_.silence_ns;
  if (!control::has_supervisor(rig_)) return absent(now);
  absent_since_ns_ = 0;
  return same_ring();
}

Result<void> RigPresence::absent(std::int64_t now) {
  if (absent_since_ns_ == 0) absent_since_ns_ = now;
  if (now - absent_since_ns_ < times_.absence_ns) return {};
  return fail(Errc::disconnected, fmt::format("rig '{}' is no longer up", rig_));
}

Result<void> RigPresence::same_ring() const {
  const auto ring = rig_ring(rig_, stream_, kPatience);
  const bool other =
      ring ? ring->segment.created_ns() != ring_created_ns_ : is_of_another_rig(ring.error().code);
  if (!other) return {};
  return fail(
      Errc::disconnected,
      fmt::format("rig '{}' was stopped and started anew meanwhile; call this command again",
                  rig_));
}

}  // namespace handcast::client
