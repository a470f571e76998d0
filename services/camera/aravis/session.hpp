// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "calib/calibration.hpp"
#include "config/sections/sensors.hpp"
#include "services/camera/aravis/configure.hpp"
#include "services/camera/aravis/device.hpp"
#include "services/camera/aravis/receiver.hpp"

namespace handcast::camera::aravis {

/// One life of a camera: opened, set up and streaming into a mailbox until it is destroyed. All
/// calls from one thread; the images come on another one, Aravis's. Destroying it while the camera
/// is absent takes up to 5 s.
class Session {
 public:
  /// Opens a camera and starts its images, of the size in the calibration. Errors: those of
  /// open_device() and configure(); bad_config (the calibration was made with another camera).
  static Result<std::unique_ptr<Session>> start(const Device& device,
                                                const config::Camera& settings,
                                                const calib::PlacedCamera& camera,
                                                std::shared_ptr<Mailbox> mailbox);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session();

  /// The camera, with the names that it says of itself.
  const Device& device() const { return device_; }
  /// What the camera has accepted.
  const Accepted& accepted() const { return accepted_; }
  /// Starts an exposure; only with the software trigger. Errors: unavailable.
  Result<void> trigger();

 private:
  Session(Owned<ArvCamera> camera, Device device, const config::Camera& settings,
          std::shared_ptr<Mailbox> mailbox);
  Result<void> start_stream();

  Owned<ArvCamera> camera_;
  Device device_;
  Owned<ArvStream> stream_;
  std::shared_ptr<Receiver> receiver_;
  config::Camera settings_;
  std::shared_ptr<Mailbox> mailbox_;
  Accepted accepted_;
};

}  // namespace handcast::camera::aravis
