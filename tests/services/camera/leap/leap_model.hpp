// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace handcast::test {

/// What can happen to the next payload of an emulated controller.
enum class LeapFault {
  none,
  stall,           ///< the endpoint halts; the payload is lost
  transfer_error,  ///< the transfer fails; the payload is lost
  short_payload,   ///< half of its bytes are missing
  garbage_header,  ///< its header is none
  error_bit,       ///< the controller says that the image is damaged
  lost_payload,    ///< it never comes
  lost_frame,      ///< this and all others of its image never come
  lost_end,        ///< nothing comes until the end of the image
  hang,            ///< nothing comes any more, until the stream is started again
};

/// A size and rate of the images, by its number in the descriptors.
struct LeapMode {
  int width_px = 0, height_px = 0;
  std::uint32_t ticks = 0;  ///< of 100 ns from image to image
};

/// What a Leap Motion Controller does, without USB: controls, memory, negotiation, and payloads at
/// their times. Its images are numbered from 0, or as numbers_per_start says; the first four pixels
/// of both eyes hold the number, the others left_of() and right_of().
class LeapModel {
 public:
  /// The sizes of the real one.
  std::vector<LeapMode> modes{{640, 480, 173913}, {640, 240, 86956},  {640, 120, 46728},
                              {752, 480, 200000}, {752, 240, 100000}, {752, 120, 52631}};
  std::string serial = "LP53304172541";
  std::vector<std::uint8_t> calibration;  ///< the block in its memory
  bool is_locked = false;                 ///< sends no images until control 0x0a of unit 5 was set
  bool has_stamps = true;                 ///< its payloads carry stamps
  double drift = 0;                       ///< by how much its clock is fast
  std::uint32_t numbers_per_start = 0;    ///< so much further begin the numbers of each next start
  /// Draws the image of both eyes with a number, instead of the numbers and greys.
  std::function<void(std::uint32_t number, std::span<std::uint8_t> both)> draw_picture;

  /// The configuration with its descriptors, as the device sends it.
  std::vector<std::uint8_t> configuration() const;

  /// A control transfer; the answer of one that reads. Empty: the controller refuses it.
  std::optional<std::vector<std::uint8_t>> control(std::span<const std::uint8_t, 8> setup,
                                                   std::span<const std::uint8_t> data);
  /// The controls that were set, by unit and selector.
  std::map<std::pair<int, int>, int> controls;
  std::optional<std::pair<int, int>> refused;  ///< a control that cannot be set

  /// What becomes of a transfer.
  struct Delivery {
    std::vector<std::uint8_t> bytes;
    LeapFault fault = LeapFault::none;
  };
  /// The payload that is due at a time of CLOCK_MONOTONIC; empty if none is.
  std::optional<Delivery> next(std::int64_t now_ns);
  /// Nobody reads: drops what the controller cannot hold.
  void overflow(std::int64_t now_ns);
  /// The next payloads meet these faults, one each.
  void inject(LeapFault fault) { faults_.push_back(fault); }
  /// Faults that have not happened yet.
  std::size_t faults_left() const { return faults_.size(); }
  /// Stops sending, as without power.
  void stop() { is_streaming_ = false; }

  /// The number of the first image since the stream was started.
  std::uint32_t first() const { return first_; }
  std::uint32_t frames_begun() const { return number_ - first_ + (payload_ > 0); }
  /// When an image began to be sent, the end of its exposure.
  std::int64_t begun_ns(std::uint32_t number) const {
    return start_ns_ + static_cast<std::int64_t>(number - first_) * period_ns();
  }
  static std::uint8_t left_of(std::uint32_t number) {
    return static_cast<std::uint8_t>(number % 251);
  }
  static std::uint8_t right_of(std::uint32_t number) {
    return static_cast<std::uint8_t>((7 * number + 13) % 251);
  }

 private:
  std::int64_t period_ns() const;
  std::size_t payloads() const;
  std::int64_t due_ns() const;
  void start(int mode);
  void advance();
  std::vector<std::uint8_t> payload() const;
  void draw();

  std::vector<std::uint8_t> probed_;
  LeapMode mode_;
  bool is_streaming_ = false, frame_id_ = false;
  std::int64_t start_ns_ = 0;
  std::uint32_t number_ = 0, first_ = 0, starts_ = 0;
  std::size_t payload_ = 0;
  bool is_losing_ = false;  ///< the rest of the image
  std::vector<std::uint8_t> image_;
  std::deque<LeapFault> faults_;
};

}  // namespace handcast::test
