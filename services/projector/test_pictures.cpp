// SPDX-License-Identifier: Apache-2.0
#include "services/projector/test_pictures.hpp"

#include <algorithm>
#include <cstddef>

#include "ipc/base/clock.hpp"

namespace handcast::projector {

const renderer::Frame* TestPictures::at(std::int64_t time_ns, std::int64_t target_ns,
                                        config::Flip flip) {
  if (!take_newest() && time_ns >= until_ns_) return nullptr;
  if (flip != flip_) mirror(flip);
  frame_.target_ns = target_ns;
  mark_ = {msg::Stage::frame, 0, time_ns, now_ns()};
  frame_.stages = {&mark_, 1};
  return &frame_;
}

/// Turns the image into one that is mirrored otherwise.
void TestPictures::mirror(config::Flip flip) {
  const auto is_in = [](config::Flip one, config::Flip axis) {
    return one == axis || one == config::Flip::both;
  };
  using config::Flip;
  const int height = image_.height();
  if (is_in(flip, Flip::horizontal) != is_in(flip_, Flip::horizontal))
    for (int y = 0; y < height; ++y) std::reverse(image_.row(y), image_.row(y) + image_.width());
  if (is_in(flip, Flip::vertical) != is_in(flip_, Flip::vertical))
    for (int y = 0; y < height / 2; ++y)
      std::swap_ranges(image_.row(y), image_.row(y) + image_.width(), image_.row(height - 1 - y));
  flip_ = flip;
}

/// True if there is a picture that was not seen before. One that is only repeated is not copied.
bool TestPictures::take_newest() {
  if (!pictures_.await(Deadline::now())) return false;
  const auto newest = pictures_.latest(Deadline::now());
  if (!newest) return false;
  const msg::TestPicture& picture = **newest;
  const bool fits = static_cast<int>(picture.width_px) == image_.width() &&
                    static_cast<int>(picture.height_px) == image_.height();
  if (picture.header.frame_id == 0 || (!fits && !is_black_)) return false;
  until_ns_ = picture.header.published_ns + msg::TestPicture::kLasting_ns;
  if (frame_.test_picture == picture.header.frame_id) return true;
  auto& pixels = image_.pixels();
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = 0xff000000u | (is_black_ ? 0 : picture.levels()[i] * 0x010101u);
  flip_ = config::Flip::none;
  frame_.colour = image_.view();
  frame_.region = {0, 0, image_.width(), image_.height()};
  frame_.test_picture = picture.header.frame_id;
  return true;
}

}  // namespace handcast::projector
