// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/picture_quality.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "renderer/base/srgb.hpp"
#include "renderer/media/picture.hpp"
#include "renderer/pipeline/pipeline.hpp"
#include "services/lab/twin/motion.hpp"
#include "tests/renderer/pipeline/stage_set.hpp"
#include "tests/scratch.hpp"

namespace handcast::bench {
namespace {

using namespace renderer;
namespace fs = std::filesystem;

constexpr int kShifts = 4;  ///< per axis

/// An image whose pixels are those of `calibration`'s projector, moved by a part of a pixel.
calib::Calibration shifted(calib::Calibration calibration, glm::dvec2 by_px) {
  const glm::dmat3 shift(1, 0, 0, 0, 1, 0, by_px.x, by_px.y, 1);
  calibration.projector.from_camera = shift * calibration.projector.from_camera;
  return calibration;
}

/// What the pipelines get of one moment.
struct Moment {
  std::vector<msg::HandPose> hands;
  Image<std::uint8_t> image;
};

/// The pipelines of the two ways and of the reference.
class Studio {
 public:
  static Result<Studio> open(const config::Cascade& cascade, config::Content content,
                             const calib::Calibration& calibration) {
    Studio studio;
    content.smooth = true;
    if (auto added = studio.add(cascade, content, calibration, studio.smooth_); !added)
      return tl::make_unexpected(added.error());
    content.smooth = false;
    if (auto added = studio.add(cascade, content, calibration, studio.hard_); !added)
      return tl::make_unexpected(added.error());
    for (int i = 0; i < kShifts * kShifts; ++i) {
      const glm::dvec2 by_px = (glm::dvec2(i % kShifts, i / kShifts) + 0.5) / double{kShifts} - 0.5;
      std::unique_ptr<Pipeline> one;
      if (auto added = studio.add(cascade, content, shifted(calibration, by_px), one); !added)
        return tl::make_unexpected(added.error());
      studio.samples_.push_back(std::move(one));
    }
    return studio;
  }

  /// Levels 0..255, grey, of the whole screen.
  struct Drawings {
    cv::Mat hard, smooth, reference;
    cv::Rect region;
  };

  /// Draws a moment at a time. Times must increase.
  Drawings draw(std::int64_t now_ns, const Moment& moment, const calib::Calibration& calibration) {
    Drawings out;
    Rect region;
    const auto render = [&](Pipeline& pipeline) {
      msg::HandPoses poses;
      poses.header.origin_ns = now_ns - kMs;
      for (const auto& hand : moment.hands) poses.hands[poses.count++] = hand;
      pipeline.push(now_ns, poses);
      msg::Landmarks landmarks;
      landmarks.header.origin_ns = now_ns - kMs;
      for (const auto& hand : moment.hands)
        landmarks.hands[landmarks.count++] =
            landmarks_of(calibration, now_ns - kMs, hand, {}).hands[0];
      pipeline.push(now_ns, landmarks);
      const Frame frame =
          pipeline.render(now_ns, now_ns, {moment.image.view(), now_ns - kMs, ++image_id_});
      region = region.joined(frame.region);
      return linear(frame);
    };
    out.hard = levels(render(*hard_));
    out.smooth = levels(render(*smooth_));
    cv::Mat sum;
    for (const auto& sample : samples_) {
      const cv::Mat one = render(*sample);
      sum = sum.empty() ? one : sum + one;
    }
    out.reference = levels(sum / static_cast<double>(samples_.size()));
    region = region.grown(6).within(sum.cols, sum.rows);
    out.region = {region.x0, region.y0, region.width(), region.height()};
    return out;
  }

 private:
  Result<void> add(const config::Cascade& cascade, const config::Content& content,
                   const calib::Calibration& calibration, std::unique_ptr<Pipeline>& to) {
    auto made = Pipeline::create(cascade, content, {}, calibration);
    if (!made) return tl::make_unexpected(made.error());
    to = std::move(*made);
    return {};
  }

  /// The light of a frame, three channels.
  static cv::Mat linear(const Frame& frame) {
    static const auto table = [] {
      std::array<float, 256> light{};
      for (int i = 0; i < 256; ++i) light[i] = static_cast<float>(srgb_light(i / 255.));
      return light;
    }();
    cv::Mat light(frame.colour.height, frame.colour.width, CV_32FC3, cv::Scalar::all(0));
    for (int y = frame.region.y0; y < frame.region.y1; ++y)
      for (int x = frame.region.x0; x < frame.region.x1; ++x) {
        const std::uint32_t rgba = frame.colour.at(x, y);
        if (rgba >> 24 == 0) continue;
        light.at<cv::Vec3f>(y, x) = {table[rgba & 0xff], table[rgba >> 8 & 0xff],
                                     table[rgba >> 16 & 0xff]};
      }
    return light;
  }
  static cv::Mat levels(const cv::Mat& light) {
    cv::Mat grey(light.rows, light.cols, CV_32F);
    for (int y = 0; y < light.rows; ++y)
      for (int x = 0; x < light.cols; ++x) {
        const auto& v = light.at<cv::Vec3f>(y, x);
        grey.at<float>(y, x) =
            static_cast<float>(255 * srgb_level(0.2126 * double{v[0]} + 0.7152 * double{v[1]} +
                                                0.0722 * double{v[2]}));
      }
    return grey;
  }

  std::unique_ptr<Pipeline> hard_, smooth_;
  std::vector<std::unique_ptr<Pipeline>> samples_;
  std::uint64_t image_id_ = 0;
};

/// The mean of the structural similarity where there is light.
double similarity_of(const cv::Mat& a, const cv::Mat& b) {
  const auto blurred = [](const cv::Mat& m) {
    cv::Mat out;
    cv::GaussianBlur(m, out, {11, 11}, 1.5);
    return out;
  };
  constexpr double kC1 = 6.5025, kC2 = 58.5225;  // (0.01 * 255)^2, (0.03 * 255)^2
  const cv::Mat mean_a = blurred(a), mean_b = blurred(b);
  const cv::Mat aa = mean_a.mul(mean_a), bb = mean_b.mul(mean_b), ab = mean_a.mul(mean_b);
  const cv::Mat var_a = blurred(a.mul(a)) - aa, var_b = blurred(b.mul(b)) - bb,
                cov = blurred(a.mul(b)) - ab;
  cv::Mat map;
  cv::divide((2 * ab + kC1).mul(2 * cov + kC2), (aa + bb + kC1).mul(var_a + var_b + kC2), map);
  return cv::mean(map, blurred(b) > 1)[0];
}

/// The camera's image of the hands, with the point spread of a lens.
Image<std::uint8_t> seen(const calib::Calibration& calibration,
                         const std::vector<msg::HandPose>& hands) {
  Image<std::uint8_t> image(calibration.camera.width_px, calibration.camera.height_px, 8);
  for (const auto& hand : hands) {
    const Image<std::uint8_t> one = image_of(calibration, {hand});
    for (std::size_t i = 0; i < one.pixels().size(); ++i)
      image.pixels()[i] = std::max(image.pixels()[i], one.pixels()[i]);
  }
  cv::Mat pixels(image.height(), image.width(), CV_8U, image.row(0));
  cv::GaussianBlur(pixels, pixels, {5, 5}, 0.8);
  return image;
}

/// Lines of one texel, every eighth texel in both directions.
Texture fine_lines() {
  Texture texture(1024, 640, 0xff202020u);
  for (int y = 0; y < texture.height(); ++y)
    for (int x = 0; x < texture.width(); ++x)
      if (x % 8 == 0 || y % 8 == 0) texture.at(x, y) = 0xffffffffu;
  return texture;
}

Result<void> measure_similarity(PictureQuality& out) {
  const calib::Calibration calibration = calib::reference_rig();
  auto studio = Studio::open({}, {}, calibration);
  if (!studio) return tl::make_unexpected(studio.error());
  std::int64_t now_ns = 300 * kMs;
  for (const char* name : {"wave", "open_close", "rotate", "pinch", "two_hands"}) {
    const auto motion = twin::make_builtin_motion(name, {}, calibration);
    if (!motion) continue;
    for (const double seconds : {0.4, 1.3}) {
      Moment moment;
      for (const Side side : {Side::left, Side::right})
        if (const auto frames = motion->at(side, seconds))
          moment.hands.push_back(pose_of(side, *frames));
      moment.image = seen(calibration, moment.hands);
      Studio::Drawings drawings;
      for (int i = 0; i < 60; ++i, now_ns += 2 * kMs)
        if (i % 20 == 0 || i == 59) drawings = studio->draw(now_ns, moment, calibration);
      now_ns += 1000 * kMs;  // the next pose is another hand's
      out.similarity.push_back(
          {fmt::format("{} at {} s", name, seconds),
           similarity_of(drawings.hard(drawings.region), drawings.reference(drawings.region)),
           similarity_of(drawings.smooth(drawings.region), drawings.reference(drawings.region))});
    }
  }
  return {};
}

Result<void> measure_flicker(int frames, PictureQuality& out) {
  const test::Scratch folder;
  const fs::path picture = folder.path() / "lines.png";
  if (auto written = write_png(picture, fine_lines().view()); !written) return written;
  config::Cascade cascade;
  cascade.predict.method = config::PredictMethod::hold;
  cascade.predict.still_mm_s = 0;
  cascade.filter.method = config::FilterMethod::none;
  cascade.fill.method = config::FillMethod::none;
  cascade.skin.widths = false;
  config::Content content;
  content.left = picture.string();
  calib::Calibration calibration = rig_above_hand();
  calibration.camera_from_tracker[3].z = 0.73;
  auto studio = Studio::open(cascade, content, calibration);
  if (!studio) return tl::make_unexpected(studio.error());
  cv::Mat hard, smooth;
  double hard_sum = 0, smooth_sum = 0, count = 0;
  for (int i = 0; i < frames; ++i) {
    const float moved_m = static_cast<float>(i) * 5e-5f;  // some 0.07 px
    const Moment moment{
        {pose_of(Side::left, {moved_m, 0, 0.6f * moved_m})},
        Image<std::uint8_t>(calibration.camera.width_px, calibration.camera.height_px)};
    const auto drawn = studio->draw(300 * kMs + i * 2 * kMs, moment, calibration);
    const cv::Mat hard_error = drawn.hard - drawn.reference,
                  smooth_error = drawn.smooth - drawn.reference;
    if (i > 0) {
      const auto square = [](const cv::Mat& change) { return cv::norm(change, cv::NORM_L2SQR); };
      hard_sum += square(hard_error - hard);
      smooth_sum += square(smooth_error - smooth);
      count += cv::countNonZero(drawn.reference > 0);
    }
    hard = hard_error;
    smooth = smooth_error;
  }
  out.hard_flicker = std::sqrt(hard_sum / count);
  out.smooth_flicker = std::sqrt(smooth_sum / count);
  return {};
}

}  // namespace

PictureQuality measure_picture_quality(int flicker_frames) {
  PictureQuality quality;
  auto measured = measure_similarity(quality);
  if (measured) measured = measure_flicker(flicker_frames, quality);
  if (!measured) quality.error = measured.error().what;
  return quality;
}

}  // namespace handcast::bench
