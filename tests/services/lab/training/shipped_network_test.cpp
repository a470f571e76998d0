// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "services/lab/training/generator.hpp"
#include "services/landmarks/inference/network.hpp"

/// What is asked of the network that is shipped, on images of people and poses that it was not
/// trained on.
namespace handcast::landmarks::training {
namespace {

constexpr std::uint64_t kUnseen = 987654;
constexpr int kImages = 300;

std::filesystem::path shipped() { return std::filesystem::path(HANDCAST_SHIPPED_NETWORK); }

class Shipped : public testing::Test {
 protected:
  void SetUp() override {
    auto opened = open_network(shipped());
    ASSERT_TRUE(opened) << opened.error().what;
    network_ = std::move(*opened);
  }

  handcast_network::Answer estimate(const Sample& sample,
                                    const std::optional<handcast_network::Places>& tracker) {
    const auto image = network_->input(0);
    for (std::size_t i = 0; i < sample.image.size(); ++i)
      image[i] = sample.image[i] / Sample::kUnit - handcast_network::kShownShift;
    handcast_network::write_tracker(tracker, network_->input(1));
    EXPECT_TRUE(network_->run());
    return handcast_network::read_answer(network_->output(0));
  }

  float presence_in(std::uint8_t (*pixel)(Dice&)) {
    Dice dice(1, 1);
    std::vector<std::uint8_t> pixels(handcast_network::kSide_px * handcast_network::kSide_px);
    for (auto& p : pixels) p = pixel(dice);
    handcast_network::write_image(pixels, msg::Side::right, network_->input(0));
    handcast_network::write_tracker(std::nullopt, network_->input(1));
    EXPECT_TRUE(network_->run());
    return handcast_network::read_answer(network_->output(0)).presence;
  }

  std::unique_ptr<Network> network_;
};

/// Errors in px of the crop.
struct Errors {
  std::vector<float> tracker, with, without;
};

float mean(const std::vector<float>& values) {
  float sum = 0;
  for (const float value : values) sum += value;
  return sum / static_cast<float>(values.size());
}

float median(std::vector<float> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

Generator& generator() {
  static auto made = Generator::create(4, kUnseen);
  EXPECT_TRUE(made);
  return *made;
}

TEST_F(Shipped, FindsLandmarksAndTheTrackerHelpsIt) {
  Errors errors;
  for (int n = 0; n < kImages; ++n) {
    const Sample sample = generator().make(static_cast<std::uint64_t>(n));
    if (!sample.has_hand || !sample.has_tracker) continue;
    const auto off = [&](const handcast_network::Places& places) {
      return distance_px(places, sample.truth) * handcast_network::kSide_px;
    };
    errors.tracker.push_back(off(sample.tracker));
    errors.with.push_back(off(estimate(sample, sample.tracker).places));
    errors.without.push_back(off(estimate(sample, std::nullopt).places));
  }
  EXPECT_LT(median(errors.with), 3.0f);
  EXPECT_LT(mean(errors.with), 0.5f * mean(errors.tracker));
  EXPECT_LT(mean(errors.with), mean(errors.without));
}

TEST_F(Shipped, ItsSigmasSayHowFarOffItIs) {
  int inside_half = 0, inside_most = 0, all = 0;
  for (int n = 0; n < kImages; ++n) {
    const Sample sample = generator().make(static_cast<std::uint64_t>(n));
    if (!sample.has_hand) continue;
    const handcast_network::Answer answer =
        estimate(sample, sample.has_tracker ? std::optional(sample.tracker) : std::nullopt);
    for (int i = 0; i < msg::kLandmarks; ++i)
      for (int axis = 0; axis < 2; ++axis, ++all) {
        const float off =
            std::abs(answer.places[i][axis] - sample.truth[i][axis]) / answer.sigma[i];
        inside_half += off < -std::log(1 - 0.5f);
        inside_most += off < -std::log(1 - 0.9f);
      }
  }
  EXPECT_NEAR(static_cast<double>(inside_half) / all, 0.5, 0.1);
  EXPECT_NEAR(static_cast<double>(inside_most) / all, 0.9, 0.05);
}

TEST_F(Shipped, TellsAHandFromNone) {
  int hands = 0, seen = 0, others = 0, imagined = 0;
  for (int n = 0; n < 2 * kImages; ++n) {
    const Sample sample = generator().make(static_cast<std::uint64_t>(n));
    const bool says_hand =
        estimate(sample, sample.has_tracker ? std::optional(sample.tracker) : std::nullopt)
            .presence > 0.5f;
    ++(sample.has_hand ? hands : others);
    if (says_hand) ++(sample.has_hand ? seen : imagined);
  }
  EXPECT_GT(seen, 0.95 * hands);
  EXPECT_LT(imagined, 0.2 * others);
}

TEST_F(Shipped, SeesNoHandInBlackWhiteOrNoise) {
  EXPECT_LT(presence_in([](Dice&) { return std::uint8_t{0}; }), 0.5f);
  EXPECT_LT(presence_in([](Dice&) { return std::uint8_t{255}; }), 0.5f);
  EXPECT_LT(presence_in([](Dice& dice) { return static_cast<std::uint8_t>(dice.pick(256)); }),
            0.5f);
}

}  // namespace
}  // namespace handcast::landmarks::training
