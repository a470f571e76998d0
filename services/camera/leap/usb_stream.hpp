// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <thread>

#include "services/camera/leap/payload.hpp"
#include "services/camera/leap/usb_device.hpp"

namespace handcast::camera::leap {

/// The images' endpoint of a controller, read by many transfers that wait at the same time, because
/// the controller can hold only a small part of an image. A thread of its own gives the payloads to
/// a sink; it has a real-time priority if the system permits one. A halt of the endpoint is ended
/// and the stream goes on.
class UsbStream {
 public:
  /// Starts reading. `priority`: SCHED_FIFO's; 0: the lowest one, and no complaint if it is not
  /// permitted. `sink` lives as long as the stream. Errors: disconnected, unavailable.
  static Result<std::unique_ptr<UsbStream>> start(const UsbDevice& device, PayloadSink& sink,
                                                  std::size_t payload_bytes, int priority);
  /// Ends all transfers. If the kernel does not return them within a second, they and the device
  /// stay open for good.
  ~UsbStream();
  UsbStream(const UsbStream&) = delete;

  /// Why the stream has ended; empty while it runs. Any thread.
  std::optional<Error> trouble() const;

 private:
  struct State;
  explicit UsbStream(std::shared_ptr<State> state);

  std::shared_ptr<State> state_;
  std::thread thread_;
};

}  // namespace handcast::camera::leap
