// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

namespace handcast::msg {

/// What kept the thread of a projector frame from its work: StageMark::detail of Stage::frame.
struct FrameDelay {
  /// Time in which the thread was not on a processor, us. Interrupts count as well if the kernel
  /// accounts for their time (IRQ_TIME_ACCOUNTING), and a hypervisor if it tells.
  std::uint32_t off_cpu_us = 0;
  std::uint32_t preemptions = 0;  ///< times that another thread took the processor
  std::uint32_t faults = 0;       ///< page faults

  bool operator==(const FrameDelay&) const = default;
};

/// The delay as a number: off_cpu_us, at most 65,535, in the lowest 16 bits, then preemptions and
/// faults, at most 255 each.
inline constexpr std::uint32_t detail_of(const FrameDelay& delay) {
  return std::min<std::uint32_t>(delay.off_cpu_us, 0xffff) |
         std::min<std::uint32_t>(delay.preemptions, 0xff) << 16 |
         std::min<std::uint32_t>(delay.faults, 0xff) << 24;
}
/// The delay in a number.
inline constexpr FrameDelay frame_delay_in(std::uint32_t detail) {
  return {detail & 0xffff, detail >> 16 & 0xff, detail >> 24};
}

}  // namespace handcast::msg
