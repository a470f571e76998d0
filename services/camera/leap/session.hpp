// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "calib/calibration.hpp"
#include "config/sections/sensors.hpp"
#include "services/camera/leap/payload.hpp"
#include "services/camera/leap/receiver.hpp"
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

/// One life of a controller: opened, set up and streaming into a mailbox until it is destroyed. All
/// calls from one thread; the images come on another one.
class Session {
 public:
  /// Opens a controller and starts its images, in the mode for the size in the calibration.
  /// `wanted`: see open_controller(). `resets`: resets the device first, which helps some that have
  /// stopped. Takes about 0.1 s. Errors: those of open_controller(), mode_of(), transfers_of() and
  /// load_bring_up(); bad_config (the calibration was made with another camera); timeout and
  /// bad_data (the controller does not do what it is asked), disconnected.
  static Result<std::unique_ptr<Session>> start(const std::string& wanted,
                                                const config::Camera& settings,
                                                const calib::PlacedCamera& camera,
                                                std::shared_ptr<Mailbox> mailbox, bool resets);

  /// The serial number of the controller, or its USB port if it does not say.
  const std::string& name() const { return name_; }
  /// What it sends.
  const StreamMode& mode() const { return mode_; }
  /// Why its stream has ended; empty while it runs.
  std::optional<Error> trouble() const { return stream_->trouble(); }

 private:
  Session(std::string name, const StreamMode& mode, const StreamFacts& facts,
          std::shared_ptr<Mailbox> mailbox)
      : name_(std::move(name)), mode_(mode), receiver_(facts, std::move(mailbox)) {}

  std::string name_;
  StreamMode mode_;
  Receiver receiver_;
  std::unique_ptr<UsbStream> stream_;  ///< the first to end: it calls the receiver
};

}  // namespace handcast::camera::leap
