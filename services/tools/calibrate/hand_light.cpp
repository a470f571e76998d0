// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/hand_light.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "ipc/base/statistics.hpp"

namespace handcast::calibrate {
namespace {

constexpr int kSaturated = 250;
/// Of the captures of the paper's rig: finger tips of 41 to 83 before a background of 9 to 17.
constexpr int kDarkTips = 41, kGoodTips = 60;
constexpr double kMostSaturated = 0.01, kLeastRatio = 2, kMostFlicker = 0.02;
constexpr double kMostLeak = 0.1;  ///< of the hand's brightness

constexpr int kWrist = 0, kMiddleKnuckle = 9;
constexpr bool is_tip(int landmark) { return landmark > 0 && landmark % 4 == 0; }
/// The landmark before this one on its finger; the wrist for the knuckles.
constexpr int before(int landmark) { return landmark % 4 == 1 ? kWrist : landmark - 1; }

using Points = std::array<std::optional<glm::dvec2>, msg::kLandmarks>;

/// Where the landmarks are in the image as the lens forms it.
Points image_points(const calib::CameraModel& camera, const msg::HandLandmarks& hand) {
  Points points;
  for (int i = 0; i < msg::kLandmarks; ++i)
    if (const auto& point = hand.points[static_cast<std::size_t>(i)];
        point.confidence > 0 && std::isfinite(point.x_px) && std::isfinite(point.y_px))
      points[static_cast<std::size_t>(i)] = camera.distort({point.x_px, point.y_px});
  return points;
}

/// Counts 3 x 3 pixels; returns their mean, or nothing outside the image.
std::optional<double> count_at(const calib::GreyView& image, const glm::dvec2& px,
                               GreyCount& count) {
  const glm::dvec2 last(image.width_px - 2, image.height_px - 2);
  if (!(px.x >= 1 && px.y >= 1 && px.x <= last.x && px.y <= last.y)) return {};
  const auto x = std::lround(px.x), y = std::lround(px.y);
  double sum = 0;
  for (auto row = y - 1; row <= y + 1; ++row)
    for (auto column = x - 1; column <= x + 1; ++column) {
      const auto grey = image.pixels[row * image.stride + column];
      count.add(grey);
      sum += grey;
    }
  return sum / 9;
}

/// Counts every 8th pixel that is neither near the hand nor beyond its wrist.
void count_background(const calib::GreyView& image, const Points& points, GreyCount& count) {
  constexpr int kEvery = 8;
  if (!points[kWrist] || !points[kMiddleKnuckle]) return;
  const glm::dvec2 wrist = *points[kWrist], to_arm = wrist - *points[kMiddleKnuckle];
  glm::dvec2 low = wrist, high = wrist;
  for (const auto& point : points)
    if (point) {
      low = glm::min(low, *point);
      high = glm::max(high, *point);
    }
  const glm::dvec2 margin(glm::length(to_arm) / 2);
  for (int y = 0; y < image.height_px; y += kEvery)
    for (int x = 0; x < image.width_px; x += kEvery) {
      const glm::dvec2 px(x, y);
      const bool is_near = glm::all(glm::greaterThan(px, low - margin)) &&
                           glm::all(glm::lessThan(px, high + margin));
      if (!is_near && glm::dot(px - wrist, to_arm) < 0)
        count.add(image.pixels[y * image.stride + x]);
    }
}

std::vector<double> counts_of(const GreyCount& count) {
  std::vector<double> counts;
  for (int grey = 0; grey < 256; ++grey) counts.push_back(static_cast<double>(count.of(grey)));
  return counts;
}

/// The exposure that makes the tips bright enough, without saturating the brightest part.
double better_exposure_ms(const HandLight& light, double exposure_ms) {
  const double tips = std::max(light.tips().percentile(0.5), 1),
               brightest = std::max(light.hand().percentile(0.99), 1);
  return exposure_ms * std::min(kGoodTips / tips, 240 / brightest);
}

std::optional<std::string> exposure_advice(const HandLight& light, const CameraSettings& settings) {
  const double saturated = light.hand().share_from(kSaturated);
  if (saturated > kMostSaturated)
    return fmt::format(
        "{:.0f} % of the hand is saturated: set camera.exposure_ms to {:.2g} or less, or dim the "
        "infrared lamp",
        100 * saturated, settings.exposure_ms / 2);
  const int tips = light.tips().percentile(0.5);
  if (tips >= kDarkTips) return {};
  const double better_ms = better_exposure_ms(light, settings.exposure_ms);
  const auto seen = fmt::format("the finger tips have the grey value {} and should have {} or more",
                                tips, kDarkTips);
  if (better_ms > 1.05 * settings.exposure_ms && better_ms <= settings.longest_exposure_ms)
    return fmt::format("{}: set camera.exposure_ms to {:.2g}", seen, better_ms);
  return fmt::format(
      "{}: the exposure cannot do it ({:.2g} ms is the longest at this rate, and the "
      "palm must not saturate); bring the infrared lamp nearer to the axis of the "
      "camera, or add another one",
      seen, settings.longest_exposure_ms);
}

std::optional<std::string> threshold_advice(const HandLight& light, double threshold) {
  const int tips = light.tips().percentile(0.1), behind = light.background().percentile(0.75);
  if (tips < kLeastRatio * behind)
    return fmt::format(
        "the finger tips ({}) hardly stand out from what is behind them ({}): keep "
        "daylight out, and lay dark cloth on what the lamp lights",
        tips, behind);
  if (threshold == 0 || (threshold > behind && threshold < tips)) return {};
  return fmt::format(
      "cascade.mask.threshold = {:g} is {}: set it to {}, or to 0, which chooses it "
      "for each image",
      threshold, threshold >= tips ? "brighter than the finger tips" : "darker than the background",
      threshold_between(light));
}

}  // namespace

int GreyCount::percentile(double share) const {
  std::uint64_t below = 0;
  for (int grey = 0; grey < 256; ++grey) {
    below += of(grey);
    if (total_ > 0 && static_cast<double>(below) >= share * static_cast<double>(total_))
      return grey;
  }
  return 0;
}

double GreyCount::share_from(int grey) const {
  std::uint64_t above = 0;
  for (int i = grey; i < 256; ++i) above += of(i);
  return total_ == 0 ? 0 : static_cast<double>(above) / static_cast<double>(total_);
}

void HandLight::add(const calib::GreyView& image, const msg::HandLandmarks& hand,
                    Lighting lighting) {
  constexpr double kPad = 0.3;  // from the tip to the joint before it: the pad of the finger
  const auto points = image_points(camera_, hand);
  double sum = 0;
  int count = 0;
  for (int i = 1; i < msg::kLandmarks; ++i) {
    const auto& point = points[static_cast<std::size_t>(i)];
    const auto& previous = points[static_cast<std::size_t>(before(i))];
    if (!point || !previous) continue;
    const auto px = glm::mix(*point, *previous, is_tip(i) ? kPad : 0.5);
    const auto mean = count_at(image, px, hand_);
    if (!mean) continue;
    if (is_tip(i)) count_at(image, px, tips_);
    sum += *mean;
    ++count;
  }
  if (count == 0) return;
  means_.push_back({sum / count, lighting});
  count_background(image, points, background_);
}

double HandLight::flicker() const {
  constexpr std::size_t kEnough = 10;
  std::vector<double> changes;
  for (std::size_t i = 1; i < means_.size(); ++i)
    if (means_[i].lighting == means_[i - 1].lighting && means_[i].grey > 0)
      changes.push_back(std::abs(means_[i].grey - means_[i - 1].grey) / means_[i].grey);
  if (changes.size() < kEnough) return 0;
  return kSigmaPerMad * median(std::move(changes)) / std::sqrt(2.0);
}

double HandLight::leak() const {
  std::array<double, 3> sums{}, counts{};
  for (const auto& mean : means_) {
    sums[static_cast<std::size_t>(mean.lighting)] += mean.grey;
    counts[static_cast<std::size_t>(mean.lighting)] += 1;
  }
  constexpr auto kDark = static_cast<std::size_t>(Lighting::dark),
                 kFull = static_cast<std::size_t>(Lighting::full);
  if (counts[kDark] == 0 || counts[kFull] == 0) return 0;
  return sums[kFull] / counts[kFull] - sums[kDark] / counts[kDark];
}

std::vector<std::string> advice_on(const HandLight& light, const CameraSettings& settings) {
  std::vector<std::string> advice;
  if (auto exposure = exposure_advice(light, settings)) advice.push_back(std::move(*exposure));
  if (auto threshold = threshold_advice(light, settings.threshold))
    advice.push_back(std::move(*threshold));
  if (const double flicker = light.flicker(); flicker > kMostFlicker)
    advice.push_back(fmt::format(
        "the hand's brightness changes by {:.1f} % from image to image: a lamp on mains "
        "flickers with 100 or 120 Hz; feed the infrared lamp with direct current, or "
        "keep daylight lamps out of the camera's filter",
        100 * flicker));
  const double hand = std::max(light.hand().percentile(0.5), 1);
  if (const double leak = light.leak(); leak > kMostLeak * hand)
    advice.push_back(
        fmt::format("the projector's full light makes the hand {:.0f} grey values brighter ({:.0f} "
                    "% of it), which disturbs the mask and the landmarks: put an infrared-pass "
                    "filter before the camera, or a stronger infrared lamp",
                    leak, 100 * leak / hand));
  return advice;
}

int threshold_between(const HandLight& light) {
  const int behind = light.background().percentile(0.75), tips = light.tips().percentile(0.1);
  return (behind + std::max(behind, tips) + 1) / 2;
}

Picture histograms_picture(const HandLight& light) {
  return {
      "histograms",
      "Grey values 0 to 255 of the background, the hand and its finger tips, each scaled to its "
      "most frequent value. Dashes: a threshold between background and hand.",
      {{"background", counts_of(light.background())},
       {"hand", counts_of(light.hand())},
       {"tips", counts_of(light.tips())},
       {"threshold", {static_cast<double>(threshold_between(light))}}}};
}

}  // namespace handcast::calibrate
