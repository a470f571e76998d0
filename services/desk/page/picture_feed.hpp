// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "calib/calibration.hpp"
#include "services/desk/base/surface.hpp"

namespace handcast::desk {

/// The pictures of the camera and of the projectors for open pages, 16 times a second. A thread of
/// its own, which neither reads nor compresses anything while nobody looks.
///
/// A packet: the length of a JSON text (uint32, little-endian) and the text, and the same for three
/// JPEG files, those of the camera and of both projectors, which are empty if there is none. The
/// text:
///
///     {"camera": {"width", "height", "id", "age_ms"},           size of the camera's image in px
///      "joints": {"left": [x, y, …]},                           of the tracker, in that image, px
///      "landmarks": {"left": [x, y, …]},                        of the detector, likewise
///      "light": {"width", "height", "x", "y", "w", "h"}}        size of the projector's picture
///      and
///                                                               the part of it that is sent, px
///      "light2": likewise, of a second projector
class PictureFeed {
 public:
  using Packet = std::shared_ptr<const std::string>;

  PictureFeed(std::string rig, calib::CameraModel camera);
  /// Waits for the thread.
  ~PictureFeed();
  PictureFeed(const PictureFeed&) = delete;
  PictureFeed& operator=(const PictureFeed&) = delete;

  /// Where the joints are; never blocks.
  void take(const Scene& scene);
  /// Waits for a packet that is none of the first `seen`, which is increased; null if none comes.
  /// False: the feed is closed.
  bool wait(std::uint64_t& seen, Packet& packet, std::chrono::milliseconds patience);
  /// Ends all waits.
  void close();

 private:
  struct Inputs;
  struct Joints {
    std::array<bool, msg::kMaxHands> there{};
    std::array<std::array<glm::vec3, msg::kJoints>, msg::kMaxHands> at_m{};
  };

  void work();
  bool wait_for_viewer();
  std::string picture(Inputs& inputs);

  std::string rig_;
  calib::CameraModel camera_;
  std::mutex mutex_;
  std::condition_variable news_, viewers_;
  Joints joints_;
  Packet newest_;
  std::uint64_t count_ = 0;
  std::int64_t wanted_until_ns_ = 0;  ///< somebody has waited lately
  bool is_closed_ = false;
  std::thread thread_;
};

}  // namespace handcast::desk
