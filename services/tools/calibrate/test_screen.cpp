// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/test_screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "ipc/base/statistics.hpp"
#include "ipc/msg/largest_images.hpp"
#include "renderer/content/lettering.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kRepeatEvery_ns = 250'000'000;
constexpr std::size_t kPeriods = 31;  ///< whose median is the rhythm of the frames

using Levels = renderer::Image<std::uint8_t>;

constexpr double kUsed = 0.9;                 ///< of the picture's width and height
constexpr int kLargest = 12, kSmallest = 40;  ///< height of the picture in first lines

/// Breaks a line between words. A single word may be too wide.
std::vector<Levels> broken(const std::string& line, int height, double width_px) {
  std::vector<Levels> parts;
  std::istringstream words(line);
  std::string part;
  for (std::string word; words >> word;) {
    const auto longer = part.empty() ? word : part + " " + word;
    if (!part.empty() && renderer::whole_lettering(longer, height).width() > width_px) {
      parts.push_back(renderer::whole_lettering(part, height));
      part = word;
    } else {
      part = longer;
    }
  }
  if (!part.empty()) parts.push_back(renderer::whole_lettering(part, height));
  return parts;
}

std::vector<Levels> page_of(const std::vector<std::string>& lines, int height, double width_px) {
  std::vector<Levels> page;
  for (const auto& line : lines) {
    const int line_height = &line == &lines.front() ? height : height * 2 / 3;
    for (auto& part : broken(line, line_height, width_px)) page.push_back(std::move(part));
  }
  return page;
}

int gap_of(const Levels& line) { return line.height() / 4; }

int height_of(const std::vector<Levels>& page) {
  int height = 0;
  for (const auto& line : page) height += line.height() + gap_of(line);
  return height;
}

bool fits(const std::vector<Levels>& page, double width_px, double height_px) {
  return height_of(page) <= height_px &&
         std::ranges::all_of(page, [&](const auto& line) { return line.width() <= width_px; });
}

/// Copies a line into a picture, its middle at `x`, its top at `y`; what does not fit is cut off.
void put(const Levels& line, int x, int y, Levels& picture) {
  const int left = x - line.width() / 2;
  for (int row = 0; row < line.height(); ++row)
    for (int column = 0; column < line.width(); ++column)
      if (const int px = left + column, py = y + row;
          px >= 0 && px < picture.width() && py >= 0 && py < picture.height())
        picture.at(px, py) = line.at(column, row);
}

}  // namespace

void draw_text(const std::vector<std::string>& lines, Levels& picture) {
  const double width_px = kUsed * picture.width(), height_px = kUsed * picture.height();
  std::vector<Levels> page;
  for (int part = kLargest; part <= kSmallest; part += 2) {
    page = page_of(lines, picture.height() / part, width_px);
    if (fits(page, width_px, height_px)) break;
  }
  std::ranges::fill(picture.pixels(), std::uint8_t{0});
  int y = (picture.height() - height_of(page)) / 2;
  for (const auto& line : page) {
    put(line, picture.width() / 2, y, picture);
    y += line.height() + gap_of(line);
  }
}

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
