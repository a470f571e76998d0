// SPDX-License-Identifier: Apache-2.0
// libhandcast-film.so.
#include <algorithm>
#include <exception>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "renderer/media/film_reader.hpp"

namespace {

/// Frames up to so far ahead are passed over; others are searched for.
constexpr std::int64_t kNear = 50;

class OpencvFilm final : public handcast::renderer::FilmReader {
 public:
  bool open(const char* file) {
    for (const int backend : {cv::CAP_FFMPEG, cv::CAP_OPENCV_MJPEG})
      if (capture_.open(file, backend)) return true;
    return false;
  }
  int width_px() const override { return static_cast<int>(get(cv::CAP_PROP_FRAME_WIDTH)); }
  int height_px() const override { return static_cast<int>(get(cv::CAP_PROP_FRAME_HEIGHT)); }
  std::int64_t frames() const override {
    return static_cast<std::int64_t>(std::clamp(get(cv::CAP_PROP_FRAME_COUNT), 0.0, 1e9));
  }
  double rate_hz() const override { return get(cv::CAP_PROP_FPS); }

  bool read(std::int64_t index, std::uint8_t* grey) override try {
    if (!go_to(index) || !capture_.read(colour_)) return false;
    ++next_;
    if (colour_.cols != width_px() || colour_.rows != height_px()) return false;
    cv::Mat out(colour_.rows, colour_.cols, CV_8UC1, grey);
    if (colour_.type() == CV_8UC1)
      colour_.copyTo(out);
    else
      cv::cvtColor(colour_, out, cv::COLOR_BGR2GRAY);
    return true;
  } catch (const std::exception&) {
    return false;
  }

 private:
  double get(int property) const { return capture_.get(property); }
  bool go_to(std::int64_t index) {
    if (index < next_ || index > next_ + kNear) {
      if (!capture_.set(cv::CAP_PROP_POS_FRAMES, static_cast<double>(index))) return false;
      next_ = index;
    }
    for (; next_ < index; ++next_)
      if (!capture_.grab()) return false;
    return true;
  }

  cv::VideoCapture capture_;
  std::int64_t next_ = 0;  ///< the frame that comes next
  cv::Mat colour_;
};

}  // namespace

handcast::renderer::FilmReader* handcast_open_film(const char* file) try {
  auto film = std::make_unique<OpencvFilm>();
  return film->open(file) ? film.release() : nullptr;
} catch (const std::exception&) {
  return nullptr;
}
