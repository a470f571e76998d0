// SPDX-License-Identifier: Apache-2.0
#include "services/camera/film_reader.hpp"

#include <algorithm>
#include <exception>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

struct handcast_film {
  cv::VideoCapture capture;
  handcast_film_about about{};
  long next = 0;  ///< the frame that comes next
  cv::Mat colour;
};

namespace {

/// Frames up to so far ahead are passed over; others are searched for.
constexpr long kNear = 50;

bool go_to(handcast_film& film, long index) {
  if (index < film.next || index > film.next + kNear) {
    if (!film.capture.set(cv::CAP_PROP_POS_FRAMES, static_cast<double>(index))) return false;
    film.next = index;
  }
  for (; film.next < index; ++film.next)
    if (!film.capture.grab()) return false;
  return true;
}

bool read(handcast_film& film, long index, unsigned char* grey) {
  if (!go_to(film, index) || !film.capture.read(film.colour)) return false;
  ++film.next;
  const auto& about = film.about;
  if (film.colour.cols != about.width_px || film.colour.rows != about.height_px) return false;
  cv::Mat out(about.height_px, about.width_px, CV_8UC1, grey);
  if (film.colour.type() == CV_8UC1)
    film.colour.copyTo(out);
  else
    cv::cvtColor(film.colour, out, cv::COLOR_BGR2GRAY);
  return true;
}

}  // namespace

handcast_film* handcast_film_open(const char* file, handcast_film_about* about) {
  try {
    auto film = std::make_unique<handcast_film>();
    for (const int backend : {cv::CAP_FFMPEG, cv::CAP_OPENCV_MJPEG})
      if (film->capture.open(file, backend)) break;
    if (!film->capture.isOpened()) return nullptr;
    const auto get = [&](int property) { return film->capture.get(property); };
    film->about = {static_cast<int>(get(cv::CAP_PROP_FRAME_WIDTH)),
                   static_cast<int>(get(cv::CAP_PROP_FRAME_HEIGHT)),
                   static_cast<long>(std::clamp(get(cv::CAP_PROP_FRAME_COUNT), 0.0, 1e9)),
                   get(cv::CAP_PROP_FPS)};
    *about = film->about;
    return film.release();
  } catch (const std::exception&) {
    return nullptr;
  }
}

int handcast_film_read(handcast_film* film, long index, unsigned char* grey) {
  try {
    return read(*film, index, grey) ? 1 : 0;
  } catch (const std::exception&) {
    return 0;
  }
}

void handcast_film_close(handcast_film* film) { delete film; }
