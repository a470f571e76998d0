// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/test_screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "ipc/base/statistics.hpp"
#include "ipc/msg/largest_images.hpp"
#include "services/tools/calibrate/text_page.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kRepeatEvery_ns = 250'000'000;
constexpr std::size_t kPeriods = 31;  ///< whose median is the rhythm of the frames

}  // namespace

Result<TestScreen> TestScreen::open(const std::string& rig, int width_px, int height_px) {
  auto ring = client::rig_ring(rig, msg::kTestPictures);
  if (!ring) return tl::make_unexpected(ring.error());
  if (msg::TestPicture::bytes(static_cast<std::size_t>(width_px),
                              static_cast<std::size_t>(height_px)) > ring->segment.payload_bytes())
    return fail(Errc::bad_config,
                fmt::format("a projector of {}x{} px is too large for test pictures; {}x{} is "
                            "possible",
                            width_px, height_px, msg::kLargestTestPictureWidth_px,
                            msg::kLargestTestPictureHeight_px));
  auto writer = ipc::Writer<msg::TestPicture>::attach(std::move(ring->segment));
  if (!writer) return fail_in("test pictures", writer.error());
  auto projections = client::open_stream<msg::Projection>(rig, "projection.frames");
  if (!projections) return tl::make_unexpected(projections.error());
  TestScreen screen(std::move(*writer), std::move(*projections), width_px, height_px);
  // Numbers must not repeat those of an earlier program that wrote to this ring.
  screen.number_ = static_cast<std::uint64_t>(now_ns());
  return screen;
}

void TestScreen::show(const std::function<void(std::uint8_t* levels)>& draw) {
  draw(picture_.pixels().data());
  text_.clear();
  ++number_;
  publish();
}

void TestScreen::show_level(std::uint8_t level) {
  show([&](std::uint8_t* levels) { std::fill_n(levels, picture_.pixels().size(), level); });
}

void TestScreen::show_text(const std::vector<std::string>& lines) {
  if (lines == text_) return keep();
  draw_text(lines, picture_);
  text_ = lines;
  ++number_;
  publish();
}

void TestScreen::keep() {
  if (now_ns() - published_ns_ > kRepeatEvery_ns) publish();
}

void TestScreen::publish() {
  published_ns_ = now_ns();
  auto slot = writer_.loan();
  if (!slot) return;
  slot->header.frame_id = number_;
  slot->width_px = static_cast<std::uint32_t>(picture_.width());
  slot->height_px = static_cast<std::uint32_t>(picture_.height());
  std::memcpy(slot->levels(), picture_.pixels().data(), picture_.pixels().size());
  writer_.publish(std::move(slot));
}

/// Notes the rhythm of the frames. True if the frame before this one was read, too.
bool TestScreen::follow(const msg::Projection& shown) {
  const bool is_next = last_frame_ != 0 && shown.header.frame_id == last_frame_ + 1;
  if (is_next) periods_ns_.push_back(shown.lit_ns - last_lit_ns_);
  if (periods_ns_.size() > kPeriods) periods_ns_.pop_front();
  last_frame_ = shown.header.frame_id;
  last_lit_ns_ = shown.lit_ns;
  return is_next;
}

Result<FirstLight> TestScreen::first_light(Deadline deadline) {
  constexpr std::chrono::seconds kStart{20};  // of a projector on a busy computer
  for (;;) {
    const auto shown = projections_.next(last_frame_ == 0 ? Deadline::in(kStart) : deadline);
    if (!shown) return tl::make_unexpected(shown.error());
    if (last_frame_ == 0)
      deadline = Deadline::in(kStart);  // the picture may have expired meanwhile
    const bool is_sure = follow(**shown);
    if ((*shown)->test_picture == number_)
      return FirstLight{(*shown)->lit_ns, median(periods_ns_), is_sure};
    keep();
  }
}

}  // namespace handcast::calibrate
