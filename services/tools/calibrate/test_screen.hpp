// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/msg/projection.hpp"
#include "ipc/msg/test_picture.hpp"
#include "ipc/ring/writer.hpp"
#include "renderer/base/image.hpp"

namespace handcast::calibrate {

/// The first frame that showed a picture, as the projector reports it. Times are CLOCK_MONOTONIC.
struct FirstLight {
  std::int64_t middle_ns = 0;  ///< of the time it was lit
  std::int64_t period_ns =
      0;                 ///< from one frame to the next, median of the last ones; 0: not known
  bool is_sure = false;  ///< the frame before it was seen, and showed another picture
};

/// Fills a picture with text, white on black, in the middle: the first line larger, long ones
/// broken between words. Text that is still too much is drawn smaller.
void draw_text(const std::vector<std::string>& lines, renderer::Image<std::uint8_t>& picture);

/// The rig's projector as a screen for test pictures. One thread.
class TestScreen {
 public:
  /// Opens the streams of a rig that is up. The sizes are those of its projector. Errors: those of
  /// client::open_stream() and ipc::Writer::attach(); bad_config (the projector is too large).
  static Result<TestScreen> open(const std::string& rig, int width_px, int height_px);

  int width_px() const { return picture_.width(); }    ///< of the pictures
  int height_px() const { return picture_.height(); }  ///< of the pictures

  /// Shows a picture: `draw` writes the levels, row by row without padding.
  void show(const std::function<void(std::uint8_t* levels)>& draw);
  /// Shows one level everywhere.
  void show_level(std::uint8_t level);
  /// Shows lines of text as draw_text() draws them.
  void show_text(const std::vector<std::string>& lines);
  /// Keeps the picture: call it at least twice a second.
  void keep();
  /// Waits until the projector has shown the last picture. Errors: timeout, and those of
  /// client::Stream.
  Result<FirstLight> first_light(Deadline deadline);

 private:
  TestScreen(ipc::Writer<msg::TestPicture> writer, client::Stream<msg::Projection> projections,
             int width_px, int height_px)
      : writer_(std::move(writer)),
        projections_(std::move(projections)),
        picture_(width_px, height_px) {}
  void publish();
  bool follow(const msg::Projection& shown);

  ipc::Writer<msg::TestPicture> writer_;
  client::Stream<msg::Projection> projections_;
  renderer::Image<std::uint8_t> picture_;
  std::vector<std::string> text_;  ///< that is shown; empty: another picture
  std::uint64_t number_ = 0;
  std::int64_t published_ns_ = 0;
  std::uint64_t last_frame_ = 0;         ///< of the projector that was read; 0: none
  std::int64_t last_lit_ns_ = 0;         ///< its time
  std::deque<std::int64_t> periods_ns_;  ///< of the last pairs of frames
};

}  // namespace handcast::calibrate
