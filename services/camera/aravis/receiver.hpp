// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "calib/clock_map.hpp"
#include "config/sections/sensors.hpp"
#include "services/camera/aravis/image.hpp"

namespace handcast::camera::aravis {

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

}  // namespace handcast::camera::aravis
