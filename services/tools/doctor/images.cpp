// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/images.hpp"

#include <fmt/format.h>

namespace handcast::doctor {
namespace {

constexpr int kSaturated = 250;
constexpr double kMostSaturated = 0.002;
/// The captures of the paper's rig: hands of 41 to 83 before a background of 9 to 17.
/// @{
constexpr int kBrightBackground = 40;
constexpr int kDarkHand = 35;
/// @}

}  // namespace

void Greys::add(std::span<const std::uint8_t> pixels) {
  for (const auto pixel : pixels) ++histogram_[pixel];
  count_ += pixels.size();
}

int Greys::percentile(double share) const {
  std::uint64_t below = 0;
  for (int grey = 0; grey < 255; ++grey) {
    below += histogram_[static_cast<std::size_t>(grey)];
    if (static_cast<double>(below) >= share * static_cast<double>(count_)) return grey;
  }
  return 255;
}

double Greys::share_from(int grey) const {
  std::uint64_t above = 0;
  for (std::size_t i = static_cast<std::size_t>(grey); i < histogram_.size(); ++i)
    above += histogram_[i];
  return count_ == 0 ? 0 : static_cast<double>(above) / static_cast<double>(count_);
}

std::vector<Finding> judge_images(const Greys& greys, bool has_hand) {
  std::vector<Finding> findings;
  const double saturated = greys.share_from(kSaturated);
  if (saturated > kMostSaturated)
    findings.push_back({"exposure", Grade::advice,
                        fmt::format("{:.1f} % of the pixels are saturated", 100 * saturated),
                        "lower camera.exposure_ms, or the infrared lamp"});
  else
    findings.push_back(
        {"exposure", Grade::good, fmt::format("{:.2f} % saturated", 100 * saturated), ""});

  const int background = greys.percentile(0.5);
  if (background > kBrightBackground)
    findings.push_back(
        {"background", Grade::advice, fmt::format("its grey value is {}", background),
         "keep daylight and the projector's light from the camera: a filter, dark cloth"});
  else
    findings.push_back({"background", Grade::good, fmt::format("grey value {}", background), ""});

  if (!has_hand) return findings;
  const int hand = greys.percentile(0.995);
  if (hand < kDarkHand || hand < 2 * background)
    findings.push_back(
        {"infrared light", Grade::advice,
         fmt::format("the brightest pixels have the grey value {}, the background {}", hand,
                     background),
         "more infrared light on the hand, or a longer camera.exposure_ms"});
  else
    findings.push_back({"infrared light", Grade::good,
                        fmt::format("hand {}, background {}", hand, background), ""});
  return findings;
}

}  // namespace handcast::doctor
