// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <random>
#include <string>

#include "renderer/base/image.hpp"
#include "renderer/media/picture.hpp"
#include "services/landmarks/geometry/points.hpp"
#include "services/landmarks/models/mediapipe_files.hpp"
#include "services/tools/detect/picture.hpp"

/// Pictures for the tests of the landmark detector: real captures from outside, and synthetic ones.
namespace handcast::test {

using Grey = renderer::Image<std::uint8_t>;

/// The folder of MediaPipe's files; empty where they are not here.
inline std::filesystem::path models() {
  const char* named = std::getenv("HANDCAST_MODELS");
  const std::filesystem::path folder = named && *named ? named : "../shared/models";
  const bool here = std::filesystem::exists(folder / landmarks::kMediapipeHandFile) &&
                    std::filesystem::exists(folder / landmarks::kMediapipePalmFile);
  return here ? folder : std::filesystem::path();
}

/// A real infrared picture of a left hand with the tracker's joints of that moment, in px.
struct Capture {
  Grey image;
  landmarks::Points tracker_px;
};
inline constexpr int kCaptures[] = {1, 3, 6, 8};

inline std::optional<Capture> capture(int number) {
  const char* data = std::getenv("HANDCAST_DATA");
  const auto name =
      (std::filesystem::path(data ? data : "../shared/data") / "real" / std::to_string(number))
          .string();
  auto image = detect::read_grey(name + "_camera.png");
  if (!image) return std::nullopt;
  const auto joints =
      detect::read_joints(name + "_joints_2d_left.npy", image->width(), image->height());
  if (!joints) return std::nullopt;
  return Capture{std::move(*image), *joints};
}

#define SKIP_WITHOUT_MODELS()           \
  if (handcast::test::models().empty()) \
  GTEST_SKIP() << "no networks in ../shared/models (HANDCAST_MODELS names another folder)"
#define SKIP_WITHOUT_CAPTURES()    \
  if (!handcast::test::capture(1)) \
  GTEST_SKIP() << "no real captures in ../shared/data/real (HANDCAST_DATA names another place)"

template <class Value>
Grey painted(int width, int height, Value value) {
  Grey image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y) = static_cast<std::uint8_t>(std::clamp<double>(value(x, y), 0, 255));
  return image;
}

inline Grey noise(int width, int height) {
  std::mt19937 random(7);
  return painted(width, height, [&](int, int) { return static_cast<double>(random() & 255u); });
}

/// An oval with eyes and a mouth.
inline Grey face(int width, int height) {
  return painted(width, height, [&](int x, int y) {
    const double u = (x - 0.5 * width) / (0.2 * height), v = (y - 0.5 * height) / (0.28 * height);
    const auto spot = [&](double cu, double cv, double su, double sv) {
      return std::hypot((u - cu) / su, (v - cv) / sv) < 1;
    };
    if (std::hypot(u, v) > 1) return 9.0;
    return spot(-0.4, -0.25, 0.15, 0.1) || spot(0.4, -0.25, 0.15, 0.1) || spot(0, 0.5, 0.4, 0.1)
               ? 40.0
               : 150.0 - 50 * std::hypot(u, v);
  });
}

inline Grey mirrored(const Grey& image) {
  return painted(image.width(), image.height(),
                 [&](int x, int y) { return image.at(image.width() - 1 - x, y); });
}

inline Grey brightened(const Grey& image, double gain) {
  return painted(image.width(), image.height(),
                 [&](int x, int y) { return image.at(x, y) * gain + 0.5; });
}

/// The mean over (2 reach_x + 1) x (2 reach_y + 1) pixels.
inline Grey blurred(const Grey& image, int reach_x, int reach_y) {
  const auto pass = [](const Grey& from, int dx, int dy, int reach) {
    return painted(from.width(), from.height(), [&](int x, int y) {
      int sum = reach;
      for (int k = -reach; k <= reach; ++k)
        sum += from.at(std::clamp(x + k * dx, 0, from.width() - 1),
                       std::clamp(y + k * dy, 0, from.height() - 1));
      return sum / (2 * reach + 1);
    });
  };
  return pass(pass(image, 1, 0, reach_x), 0, 1, reach_y);
}

/// The brighter of both, pixel by pixel, the second moved to the right.
inline Grey overlaid(const Grey& a, const Grey& b, int right_px) {
  return painted(a.width(), a.height(), [&](int x, int y) {
    const int from = x - right_px;
    return std::max<int>(a.at(x, y), from >= 0 && from < b.width() ? b.at(from, y) : 0);
  });
}

/// Black on one side of a line: left of `x`, right of it, above `y`.
enum class Hidden { left, right, above };
inline Grey covered(const Grey& image, Hidden side, int at) {
  return painted(image.width(), image.height(), [&](int x, int y) {
    const bool hidden = side == Hidden::left ? x < at : side == Hidden::right ? x >= at : y < at;
    return hidden ? 8 : static_cast<int>(image.at(x, y));
  });
}

}  // namespace handcast::test
