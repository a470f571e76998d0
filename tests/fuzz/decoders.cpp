// SPDX-License-Identifier: Apache-2.0
// The decoders of the networks' outputs, with any finite numbers. The input's numbers are repeated
// until an output is full.
// Limits: 10 s and 1 GB per input.
#include <cmath>
#include <vector>

#include "services/landmarks/models/handcast_network.hpp"
#include "services/landmarks/models/mediapipe_palms.hpp"
#include "tests/fuzz/input.hpp"

namespace {

using namespace handcast;
using namespace handcast::landmarks;

std::vector<float> numbers_of(fuzz::Reader reader) {
  std::vector<float> numbers;
  while (!reader.at_end()) {
    const auto number = reader.number<float>();
    numbers.push_back(std::isfinite(number) ? number : 0);  // Network::run() refuses others
  }
  return numbers;
}

std::vector<float> repeated(const std::vector<float>& numbers, std::size_t count) {
  std::vector<float> all(count);
  for (std::size_t i = 0; i < count; ++i) all[i] = numbers[i % numbers.size()];
  return all;
}

void decode_palms_of(const std::vector<float>& numbers) {
  const auto boxes = repeated(numbers, std::size_t{kPalmAnchors} * kPalmValues);
  const auto palms = decode_palms(boxes, repeated(numbers, kPalmAnchors));
  fuzz::require(palms.size() <= kPalmAnchors);
  for (const auto& palm : palms) region_of_palm(palm, region_of_image(720, 540));
}

void decode_landmarks_of(const std::vector<float>& numbers) {
  using namespace handcast_network;
  const auto answer =
      read_answer(repeated(numbers, (2 * msg::kLandmarks + 1) * kHeatCells * kHeatCells));
  const auto points = to_image(region_of_image(720, 540), msg::Side::left, answer.places);
  for (const auto& point : points)
    fuzz::require(point.x > -1000 && point.x < 2000 && point.y > -1000 && point.y < 2000);
  region_around(points);
  mediapipe_region_of_landmarks(points);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto numbers = numbers_of(fuzz::Reader({data, size}));
  if (numbers.empty()) return 0;
  decode_palms_of(numbers);
  decode_landmarks_of(numbers);
  return 0;
}
