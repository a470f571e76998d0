// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
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
  /// Shows lines of text in the middle, the first one larger, on black.
  void show_text(const std::vector<std::string>& lines);
  /// Keeps the picture: call it at least twice a second.
  void keep();
  /// Waits until the light of the last picture has come: the middle of its first frame,
  /// CLOCK_MONOTONIC, as the projector reports it. Errors: timeout, and those of client::Stream.
  Result<std::int64_t> lit_ns(Deadline deadline);

 private:
  TestScreen(ipc::Writer<msg::TestPicture> writer, client::Stream<msg::Projection> projections,
             int width_px, int height_px)
      : writer_(std::move(writer)),
        projections_(std::move(projections)),
        picture_(width_px, height_px) {}
  void publish();

  ipc::Writer<msg::TestPicture> writer_;
  client::Stream<msg::Projection> projections_;
  renderer::Image<std::uint8_t> picture_;
  std::vector<std::string> text_;  ///< that is shown; empty: another picture
  std::uint64_t number_ = 0;
  std::int64_t published_ns_ = 0;
};

}  // namespace handcast::calibrate
