// SPDX-License-Identifier: Apache-2.0
#include "services/lab/report/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "ipc/base/output_file.hpp"
#include "renderer/media/picture.hpp"
#include "services/tools/page/html.hpp"

namespace handcast::report {
namespace fs = std::filesystem;
namespace {

constexpr double kLit = 80;  ///< change of the grey value that only projected light causes
constexpr int kPanelWidth = 480, kPanelHeight = 360, kCaptionHeight = 40;

/// Empty if the file cannot be read.
cv::Mat read(const fs::path& file) {
  auto picture = renderer::read_picture(file);
  if (!picture) return {};
  cv::Mat bgr;
  cv::cvtColor(cv::Mat(picture->height(), picture->width(), CV_8UC4, picture->row(0)), bgr,
               cv::COLOR_RGBA2BGR);
  return bgr;
}

std::vector<unsigned char> bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Bounds of the pixels in which light comes or goes during a run.
cv::Rect moving_part(const Run& run) {
  cv::Mat least, most;
  const std::size_t stride = std::max<std::size_t>(run.pictures.size() / 24, 1);
  for (std::size_t i = 0; i < run.pictures.size(); i += stride) {
    const cv::Mat picture = read(run.pictures[i]);
    if (picture.empty()) continue;
    if (least.empty()) {
      least = picture.clone();
      most = picture.clone();
    } else if (picture.size() == least.size()) {
      cv::min(least, picture, least);
      cv::max(most, picture, most);
    }
  }
  if (least.empty()) return {};
  cv::Mat grey, moved;
  cv::cvtColor(most - least, grey, cv::COLOR_BGR2GRAY);
  cv::threshold(grey, moved, kLit, 255, cv::THRESH_BINARY);
  return cv::boundingRect(moved);
}

/// `part` with a margin, in the aspect ratio of a panel and inside the picture; the whole picture
/// if `part` is empty or too large.
cv::Rect framed(const cv::Rect& part, const cv::Size& picture) {
  const cv::Rect whole({0, 0}, picture);
  if (part.empty()) return whole;
  const double aspect = double{kPanelWidth} / kPanelHeight;
  const double height = std::max(part.height * 1.15, part.width * 1.15 / aspect);
  if (height >= picture.height || height * aspect >= picture.width) return whole;
  cv::Rect frame(0, 0, static_cast<int>(height * aspect), static_cast<int>(height));
  frame.x = std::clamp(part.x + part.width / 2 - frame.width / 2, 0, picture.width - frame.width);
  frame.y =
      std::clamp(part.y + part.height / 2 - frame.height / 2, 0, picture.height - frame.height);
  return frame;
}

cv::Mat panel(const fs::path& file, const cv::Rect& frame) {
  const cv::Mat picture = read(file);
  if (picture.empty()) return {};
  cv::Mat shown;
  cv::resize(picture(frame & cv::Rect({0, 0}, picture.size())), shown, {kPanelWidth, kPanelHeight},
             0, 0, cv::INTER_AREA);
  return shown;
}

/// The panels of one moment. The captions are above them because players show their controls over
/// the lower edge. A picture that cannot be read stays dark.
cv::Mat side_by_side(const std::vector<const Run*>& runs, std::size_t moment,
                     const cv::Rect& frame) {
  cv::Mat image(kPanelHeight + kCaptionHeight, kPanelWidth * static_cast<int>(runs.size()), CV_8UC3,
                cv::Scalar::all(16));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const int x = static_cast<int>(i) * kPanelWidth;
    if (const cv::Mat shown = panel(runs[i]->pictures[moment], frame); !shown.empty())
      shown.copyTo(image({x, kCaptionHeight, kPanelWidth, kPanelHeight}));
    cv::putText(image, runs[i]->name, {x + 14, 26}, cv::FONT_HERSHEY_DUPLEX, 0.6,
                cv::Scalar::all(225), 1, cv::LINE_AA);
  }
  return image;
}

/// Opens a video file in H.264, or else in MPEG-4 part 2. Returns true for H.264, which browsers
/// play.
bool open_video(cv::VideoWriter& writer, const fs::path& file, double rate_hz,
                const cv::Size& size) {
  if (writer.open(file.string(), cv::VideoWriter::fourcc('a', 'v', 'c', '1'), rate_hz, size))
    return true;
  writer.open(file.string(), cv::VideoWriter::fourcc('m', 'p', '4', 'v'), rate_hz, size);
  return false;
}

/// The frame rate at which the film plays at the speed of the run, from 1 to 120 Hz.
double rate_of(const Run& run, std::size_t moments) {
  const double seconds = run.metrics.number("/seconds").value_or(0);
  return seconds > 0 ? std::clamp(static_cast<double>(moments) / seconds, 1.0, 120.0) : 30.0;
}

void add_stills(Film& film, const Run& run, std::size_t moments, const cv::Rect& frame) {
  film.rows.push_back(run.name);
  for (std::size_t i = 0; i < kStills; ++i) {
    const std::size_t moment = (2 * i + 1) * moments / (2 * kStills);
    const cv::Mat shown = panel(run.pictures[moment], frame);
    std::vector<unsigned char> jpeg;
    if (!shown.empty()) cv::imencode(".jpg", shown, jpeg, {cv::IMWRITE_JPEG_QUALITY, 85});
    film.stills.push_back(page::base64(jpeg));
  }
}

void shoot(Film& film, const std::vector<const Run*>& runs, const fs::path& video_file) {
  std::size_t moments = runs.front()->pictures.size();
  for (const Run* run : runs) moments = std::min(moments, run->pictures.size());
  cv::Rect moving;
  for (const Run* run : runs) moving |= moving_part(*run);
  const cv::Rect frame = framed(moving, read(runs.front()->pictures.front()).size());

  cv::VideoWriter writer;
  const cv::Size size(kPanelWidth * static_cast<int>(runs.size()), kPanelHeight + kCaptionHeight);
  const bool plays = open_video(writer, video_file, rate_of(*runs.front(), moments), size);
  for (std::size_t moment = 0; writer.isOpened() && moment < moments; ++moment)
    writer.write(side_by_side(runs, moment, frame));
  if (!writer.isOpened())
    film.problems.push_back("this build of OpenCV cannot write H.264 or MPEG-4 video");
  writer.release();
  cv::imwrite(fs::path(video_file).replace_extension(".png").string(),
              side_by_side(runs, moments / 2, frame));
  if (plays) film.video = page::base64(bytes_of(video_file));
  for (const Run* run : runs) add_stills(film, *run, moments, frame);
}

}  // namespace

Film make_film(const Inputs& inputs, const fs::path& video_file) {
  Film film;
  std::vector<const Run*> runs;
  for (const auto& run : inputs.runs) {
    if (!run.pictures.empty() && !read(run.pictures.front()).empty())
      runs.push_back(&run);
    else
      film.problems.push_back(fmt::format("there are no pictures of {} in frames/", run.name));
  }
  if (runs.empty()) return film;
  for (const auto& file : {video_file, fs::path(video_file).replace_extension(".png")})
    if (const auto possible = check_output(file); !possible) {
      film.problems.push_back(possible.error().what);
      return film;
    }
  try {
    shoot(film, runs, video_file);
  } catch (const cv::Exception& error) {
    film.problems.push_back(fmt::format("the film could not be made: {}", error.what()));
  }
  return film;
}

std::string film_section(const Film& film) {
  std::string html;
  if (!film.video.empty())
    html += fmt::format(
        "<video controls loop muted playsinline src=\"data:video/mp4;base64,{}\"></video>\n",
        film.video);
  for (std::size_t row = 0; row < film.rows.size(); ++row) {
    html += fmt::format("<h3 class=\"{0}\">{0}</h3>\n<div class=\"strip\">",
                        page::escape(film.rows[row]));
    for (std::size_t i = 0; i < kStills; ++i)
      html += fmt::format("<img alt=\"{}, moment {}\" src=\"data:image/jpeg;base64,{}\">",
                          page::escape(film.rows[row]), i + 1, film.stills[row * kStills + i]);
    html += "</div>\n";
  }
  for (const auto& problem : film.problems) html += page::missing("Not shown: " + problem + ".");
  return html;
}

}  // namespace handcast::report
