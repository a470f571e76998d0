// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "tests/services/camera/leap/leap_model.hpp"

namespace handcast::test {

/// A Leap Motion Controller at /dev/bus/usb/001/002, in USB port 1-2, for this process and its
/// children: the kernel's part (usbfs) by umockdev, the device's by a LeapModel. One at a time.
class EmulatedLeap {
 public:
  /// `change`: changes the model before it is plugged in.
  explicit EmulatedLeap(const std::function<void(LeapModel&)>& change = {});
  /// Unplugs it.
  ~EmulatedLeap();
  EmulatedLeap(const EmulatedLeap&) = delete;

  /// Unplugs it: its transfers end, and later calls find no device. And plugs it in again.
  /// @{
  void unplug();
  void plug_in();
  /// @}
  /// Another program holds its interfaces.
  void hold(bool is_held);
  /// Does something with the model, alone.
  template <class Use>
  auto with_model(const Use& use) {
    const std::scoped_lock lock(mutex_);
    return use(model_);
  }

  /// What the driver asked the kernel for.
  struct Counts {
    int detached = 0;  ///< interfaces taken from the kernel's driver
    int halts_cleared = 0, resets = 0, most_waiting = 0;
    int unknown = 0;  ///< calls that the emulation does not know
  };
  Counts counts() const;

 private:
  struct Usbfs;
  mutable std::mutex mutex_;
  LeapModel model_;
  std::unique_ptr<Usbfs> usbfs_;
};

}  // namespace handcast::test
