// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "calib/calibration.hpp"
#include "calib/clock_map.hpp"
#include "config/sections/sensors.hpp"
#include "ipc/msg/frame_losses.hpp"
#include "services/camera/aravis/configure.hpp"
#include "services/camera/aravis/device.hpp"
#include "services/camera/aravis/glib.hpp"
#include "services/camera/keep/mailbox.hpp"

namespace handcast::camera::aravis {

/// An image of a stream, or none. Its buffer goes back to the stream when it is destroyed.
class Image {
 public:
  Image() = default;
  Image(Owned<ArvStream> stream, Owned<ArvBuffer> buffer)
      : stream_(std::move(stream)), buffer_(std::move(buffer)) {}
  Image(Image&&) noexcept = default;
  Image& operator=(Image&& other) noexcept;
  ~Image();

  ArvBuffer* buffer() const { return buffer_.get(); }

  std::uint64_t number = 0;           ///< see Mailbox
  std::int64_t exposed_ns = 0;        ///< the middle of the exposure, CLOCK_MONOTONIC
  std::int64_t exposed_error_ns = 0;  ///< uncertainty of exposed_ns
  std::int64_t exposure_ns = 0;       ///< duration of the exposure
  msg::FrameLosses lost;              ///< see Mailbox

 private:
  Owned<ArvStream> stream_;
  Owned<ArvBuffer> buffer_;
};

/// An image that waits in it keeps its camera open.
using Mailbox = camera::Mailbox<Image>;

/// Takes the buffers of one stream and puts the images into the mailbox, with their times and what
/// was lost before. Lives as long as the stream, on whose thread its callback runs.
class Receiver {
 public:
  /// `exposure_ms`: what the camera has accepted.
  Receiver(const config::Camera& settings, double exposure_ms, std::shared_ptr<Mailbox> mailbox);

  /// Opens the stream of a camera for `receiver`, which has no other one. Errors: unavailable.
  static Result<Owned<ArvStream>> open_stream(ArvCamera* camera,
                                              const std::shared_ptr<Receiver>& receiver);
  /// From now on no image is taken, and none is left in the mailbox. Call it while the stream is
  /// still owned: a stream that is about to end must get no new owner. Any thread.
  void close();

 private:
  static void on_stream(void* receiver, ArvStreamCallbackType what, ArvBuffer*);
  void begin_thread() const;
  void on_buffer_done(std::int64_t arrived_ns);
  Image image_of(Owned<ArvBuffer> buffer, std::int64_t arrived_ns);
  /// Number of exposures from the last image to the one with this number of the camera; 0 if that
  /// one is older.
  std::uint64_t steps_to(std::uint64_t camera_number);
  /// What was lost in this many exposures before the last one of them.
  msg::FrameLosses lost_in(std::uint64_t steps);

  std::mutex mutex_;  ///< held while a buffer is taken
  ArvStream* stream_ = nullptr;
  int priority_;
  std::int64_t exposure_ns_, delivery_ns_;
  std::shared_ptr<Mailbox> mailbox_;
  calib::ClockMap clock_;
  std::optional<std::uint64_t> camera_number_;  ///< of the last image
  int older_in_a_row_ = 0;                      ///< images with a number before that one
  std::uint64_t underruns_ = 0;                 ///< counted by the stream until the last image
};

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
