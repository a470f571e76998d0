// SPDX-License-Identifier: Apache-2.0
// handcast's network with changed weights, from its file to the hands in an image. The input is a
// sequence of changes: number of the constant, number of the element, new value.
// Limits: 10 s and 1 GB per input.
#include <cmath>
#include <iterator>

#include "renderer/base/image.hpp"
#include "services/landmarks/finder/hand_finder.hpp"
#include "services/landmarks/inference/onnx/model.hpp"
#include "services/landmarks/models/handcast_model.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/services/landmarks/inference/write_onnx.hpp"

namespace {

using namespace handcast;
using namespace handcast::landmarks;

constexpr int kWidth_px = 320, kHeight_px = 240;
constexpr int kMostChanges = 64;

const onnx::Model& shipped_model() {
  static const auto model = onnx::read_model(shipped_network_file());
  fuzz::require(model.has_value());
  return *model;
}

void change(onnx::Model& model, fuzz::Reader reader) {
  for (int i = 0; i < kMostChanges && !reader.at_end(); ++i) {
    const auto number = reader.number<std::uint16_t>() % model.constants.size();
    auto& weights = std::next(model.constants.begin(), static_cast<long>(number))->second.floats;
    const auto element = reader.number<std::uint32_t>();
    const auto value = reader.number<float>();
    if (!weights.empty()) weights[element % weights.size()] = value;
  }
}

/// A bright disc on a dark ground.
renderer::Image<std::uint8_t> picture() {
  renderer::Image<std::uint8_t> image(kWidth_px, kHeight_px);
  for (int y = 0; y < kHeight_px; ++y)
    for (int x = 0; x < kWidth_px; ++x)
      image.at(x, y) = std::hypot(x - 160, y - 120) < 70 ? 180 : static_cast<std::uint8_t>(x % 16);
  return image;
}

Hints tracker() {
  Points points;
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {110 + 5 * static_cast<float>(i), 160 - 4 * static_cast<float>(i)};
  return {points, std::nullopt};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  onnx::Model model = shipped_model();
  change(model, fuzz::Reader({data, size}));
  static fuzz::MemoryFile file;
  file.write(onnx::write_model(model));
  auto network = HandcastModel::open(file.path());
  if (!network) return 0;
  HandFinder finder({std::make_unique<HandcastModel>(std::move(*network)), std::nullopt}, 2);
  static const auto image = picture();
  for (int frame = 0; frame < 3; ++frame) {
    const auto found = finder.find(renderer::GreyView{image.view()}, tracker(), 10'000'000 * frame);
    if (!found) return 0;
    for (const auto& hand : *found)
      for (const auto& point : hand.points_px)
        fuzz::require(std::isfinite(point.x) && std::isfinite(point.y));
  }
  return 0;
}
