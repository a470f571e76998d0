// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "tests/emulation/under_umockdev.hpp"

namespace handcast::test {

/// What a report is to the kernel: the number 0, then 64 bytes.
using NumberedReport = std::array<std::uint8_t, 65>;

/// A USB HID device at /dev/hidraw0, for this process and its children. One at a time.
class EmulatedHid {
 public:
  /// `product_id` of vendor 0451. `on_report` is called on a thread of the device for each report
  /// that comes.
  EmulatedHid(std::uint16_t product_id, const std::string& serial,
              std::function<void(const NumberedReport&)> on_report);
  /// Removes it.
  ~EmulatedHid();
  EmulatedHid(const EmulatedHid&) = delete;

  /// Sends a report, which may be too short, to those who have opened the device.
  void send(const void* bytes, std::size_t count) const;
  /// Stops taking reports; they pile up in the kernel.
  void stall(bool stalled) { stalled_ = stalled; }

 private:
  struct Testbed;
  void serve();

  std::unique_ptr<Testbed> testbed_;
  std::function<void(const NumberedReport&)> on_report_;
  int fd_ = -1;
  std::atomic<bool> stalled_ = false, ends_ = false;
  std::thread device_;
};

}  // namespace handcast::test
