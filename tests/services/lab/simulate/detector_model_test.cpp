// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "services/lab/simulate/detector_tally.hpp"
#include "services/lab/simulate/score.hpp"
#include "tests/services/lab/simulate/run_rig.hpp"

/// The twin's model of a detector beside our own network on the twin's images.
namespace handcast::simulate {
namespace {

/// The model that config/rigs/twin.toml has in the place of our network (docs/method.md#twin).
std::vector<std::string> shipped_model() {
  const auto rig = config::load_rig(source_root() / "config/rigs/twin.toml");
  EXPECT_TRUE(rig) << rig.error().what;
  const auto& model = rig->twin.detector;
  return {"landmarks.backend=twin", fmt::format("twin.detector.noise_px={}", model.noise_px),
          fmt::format("twin.detector.bias_px={}", model.bias_px),
          fmt::format("twin.detector.bias_ms={}", model.bias_ms),
          fmt::format("twin.detector.bias_hidden={}", model.bias_hidden)};
}

/// p50 and p95 of the landmark error in px, and its autocorrelation at four delays.
using Figures = std::array<double, 6>;
constexpr std::array kFigures{"p50", "p95", "50 ms", "100 ms", "200 ms", "400 ms"};

Figures figures_of(const std::string& motion, std::vector<std::string> settings) {
  settings.push_back("twin.motion=" + (data_root() / "lmc" / motion).string());
  Options options = options_of("twin", 3);
  options.draw_every = 0;
  const auto json = score(rig_with(settings), calib::reference_rig(), options);
  EXPECT_TRUE(json) << json.error().what;
  const auto& error = (*json)["detector"]["error_px"];
  const auto& memory = error["autocorrelation"];
  return {error["p50"], error["p95"], memory["50"], memory["100"], memory["200"], memory["400"]};
}

Figures mean_over_recordings(const std::vector<std::string>& settings) {
  Figures mean{};
  for (const char* motion : {"translation", "rotation", "deformation", "all_5s"}) {
    const auto figures = figures_of(motion, settings);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += figures[i] / 4;
  }
  return mean;
}

TEST(DetectorModel, ErrsAsFarAndAsLongAsOurNetwork) {
  if (!std::filesystem::exists(data_root() / "lmc" / "all_5s"))
    GTEST_SKIP() << "no recordings in " << data_root() / "lmc"
                 << "; HANDCAST_DATA names another "
                 << "folder";
  const auto network = mean_over_recordings({"landmarks.backend=handcast"});
  Figures model{};
  for (const int seed : {1, 2, 3}) {
    auto settings = shipped_model();
    settings.push_back("twin.seed=" + std::to_string(seed));
    const auto figures = mean_over_recordings(settings);
    for (std::size_t i = 0; i < model.size(); ++i) model[i] += figures[i] / 3;
  }
  for (std::size_t i = 0; i < model.size(); ++i)
    EXPECT_NEAR(model[i], network[i], 0.2 * network[i]) << kFigures[i];
}

ErrorMemory::Errors errors_of(double x_px) {
  ErrorMemory::Errors errors;
  errors.fill(glm::vec2(x_px, -x_px));
  return errors;
}

TEST(ErrorMemory, OfAConstantErrorIsOneAndOfAnAlternatingOneMinusOne) {
  ErrorMemory constant, alternating;
  for (std::int64_t k = 0; k < 200; ++k) {
    constant.add(msg::Side::left, k * 10'000'000, errors_of(3));
    alternating.add(msg::Side::right, k * 10'000'000, errors_of((k / 10) % 2 ? 2 : -2));
  }
  EXPECT_NEAR(constant.to_json()["400"].get<double>(), 1, 1e-6);
  EXPECT_NEAR(alternating.to_json()["100"].get<double>(), -1, 0.03);
  EXPECT_NEAR(alternating.to_json()["200"].get<double>(), 1, 0.03);
}

TEST(ErrorMemory, OfWhiteNoiseIsNoneAndLandmarksThatWereNotSeenDoNotCount) {
  ErrorMemory noise;
  for (std::int64_t k = 0; k < 500; ++k) {
    auto errors = errors_of(std::sin(12.9898 * static_cast<double>(k * k)));
    errors[4] = glm::vec2(std::nanf(""));
    noise.add(msg::Side::left, k * 16'000'000, errors);
  }
  EXPECT_NEAR(noise.to_json()["50"].get<double>(), 0, 0.2);
  EXPECT_TRUE(ErrorMemory().to_json()["50"].is_null());
}

}  // namespace
}  // namespace handcast::simulate
