// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "calib/calibration.hpp"
#include "config/sections/sensors.hpp"
#include "services/camera/leap/receiver.hpp"
#include "services/camera/leap/usb_stream.hpp"

namespace handcast::camera::leap {

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
