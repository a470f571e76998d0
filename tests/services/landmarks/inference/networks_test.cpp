// SPDX-License-Identifier: Apache-2.0
// The networks in ../shared/models (HANDCAST_MODELS names another folder): OpenCV calculates the
// same, and they run on one core.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <ctime>

#include "tests/services/landmarks/inference/little_model.hpp"
#include "tests/services/landmarks/inference/opencv_network.hpp"

namespace handcast::landmarks {
namespace {

std::filesystem::path models() {
  if (const char* place = std::getenv("HANDCAST_MODELS")) return place;
  const char* source = std::getenv("HANDCAST_SOURCE");
  return std::filesystem::path(source ? source : ".") / ".." / "shared" / "models";
}

#define NEEDS_MODEL(file)             \
  if (!std::filesystem::exists(file)) \
  GTEST_SKIP() << (file) << " is not here (HANDCAST_MODELS names another place)"

double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A bright blob before a gradient, in [0, 1]: closer to a picture than noise.
void paint(std::span<float> numbers, const Network::Port& port, unsigned seed) {
  const int rows = port.shape[1] > 64 ? port.shape[1] : port.shape[2];
  const std::size_t per_row = numbers.size() / static_cast<std::size_t>(rows);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const float y = static_cast<float>(i / per_row) / static_cast<float>(rows),
                x = static_cast<float>(i % per_row) / static_cast<float>(per_row);
    const float away =
        (x - 0.3f - 0.1f * static_cast<float>(seed)) * (x - 0.5f) + (y - 0.5f) * (y - 0.5f);
    numbers[i] = 0.2f * y + 0.8f * std::exp(-away * 20);
    numbers[i] = std::min(numbers[i], 1.f);
  }
}

struct Agreement {
  const char* file;
  double tolerance;  ///< of the first output, whose unit is the crop's pixel where there is one
  double of_others;
};

class Models : public testing::TestWithParam<Agreement> {};
INSTANTIATE_TEST_SUITE_P(, Models,
                         testing::Values(Agreement{"hand_landmark_lite.onnx", 224e-3, 1e-3},
                                         Agreement{"palm_detection_lite.onnx", 192e-3, 5e-3},
                                         Agreement{"first_trial.onnx", 1e-3, 1e-3}),
                         [](const auto& entry) {
                           return std::filesystem::path(entry.param.file).stem().string();
                         });

#ifdef HANDCAST_WITH_OPENCV_DNN
TEST_P(Models, CalculateWhatOpencvCalculates) {
  const std::filesystem::path file = models() / GetParam().file;
  NEEDS_MODEL(file);
  auto ours = open_network(file), reference = open_opencv_network(file);
  ASSERT_TRUE(ours) << ours.error().what;
  ASSERT_TRUE(reference) << reference.error().what;
  for (unsigned seed = 0; seed < 4; ++seed) {
    for (std::size_t i = 0; i < (*ours)->inputs().size(); ++i) {
      const auto input = (*ours)->input(i);
      seed < 2 ? fill(input, seed) : paint(input, (*ours)->inputs()[i], seed);
      std::copy(input.begin(), input.end(), (*reference)->input(i).begin());
    }
    ASSERT_TRUE((*ours)->run());
    ASSERT_TRUE((*reference)->run());
    for (std::size_t i = 0; i < (*ours)->outputs().size(); ++i) {
      const auto a = (*ours)->output(i), b = (*reference)->output(i);
      ASSERT_EQ((*ours)->outputs()[i].name, (*reference)->outputs()[i].name);
      double worst = 0;
      for (std::size_t k = 0; k < a.size(); ++k)
        worst = std::max(worst, std::abs(static_cast<double>(a[k]) - b[k]));
      EXPECT_LE(worst, i == 0 ? GetParam().tolerance : GetParam().of_others)
          << (*ours)->outputs()[i].name << ", input " << seed;
    }
  }
}
#endif

/// The time of all threads is the time of the calling one.
TEST_P(Models, RunOnTheCallersCoreAlone) {
  const std::filesystem::path file = models() / GetParam().file;
  NEEDS_MODEL(file);
  auto network = open_network(file);
  ASSERT_TRUE(network) << network.error().what;
  const double process_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID),
               thread_s = seconds_of(CLOCK_THREAD_CPUTIME_ID);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE((*network)->run());
  const double in_process_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - process_s,
               in_thread_s = seconds_of(CLOCK_THREAD_CPUTIME_ID) - thread_s;
  EXPECT_LE(in_process_s - in_thread_s, 0.1 * in_thread_s);
}

}  // namespace
}  // namespace handcast::landmarks
