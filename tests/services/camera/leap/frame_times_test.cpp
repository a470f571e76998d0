// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/frame_times.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace handcast::camera::leap {
namespace {

constexpr std::int64_t kPeriod_ns = 8'695'600;
constexpr std::int64_t kStart_ns = 1'000'000'000'000;

/// A camera whose clock counts milliseconds, and arrivals of which each is later than the least by
/// up to 3 ms.
class Stream {
 public:
  explicit Stream(double period_ns = kPeriod_ns) : period_ns_(period_ns) {}

  std::int64_t least_arrival_ns(std::uint64_t number) const {
    return kStart_ns + std::llround(period_ns_ * static_cast<double>(number));
  }
  EndedFrame frame(std::uint64_t number, bool has_stamp = true) {
    noise_ = noise_ * 1664525u + 1013904223u;
    EndedFrame frame{.is_whole = true, .frame_id = number % 2 == 1};
    // The number of the stamps wraps after the third of a second.
    if (has_stamp)
      frame.stamp = static_cast<std::uint32_t>(
          static_cast<std::uint64_t>(period_ns_ * static_cast<double>(number) * 1e-6) - 300);
    frame.first_ns = least_arrival_ns(number) + noise_ % 3'000'000;
    return frame;
  }

 private:
  double period_ns_;
  std::uint32_t noise_ = 1;
};

TEST(FrameTimes, StampsOfAMillisecondGiveTimesOfATenth) {
  for (const double drift : {-200e-6, 0., 200e-6}) {
    Stream stream(kPeriod_ns * (1 + drift));
    FrameTimes times(1000, kPeriod_ns);
    double square = 0;
    int count = 0;
    for (std::uint64_t i = 0; i < 3000; ++i) {
      const auto place = times.add(stream.frame(i));
      EXPECT_EQ(place.steps, 1u);
      EXPECT_LE(place.arrival_ns, stream.least_arrival_ns(i) + 3'000'000);
      if (i < 1000) continue;
      const double off_ms =
          static_cast<double>(place.arrival_ns - stream.least_arrival_ns(i)) * 1e-6;
      square += off_ms * off_ms;
      ++count;
    }
    EXPECT_LT(std::sqrt(square / count), 0.1) << "ms, drift " << drift;
  }
}

TEST(FrameTimes, StampsShowHowManyImagesAreMissing) {
  Stream stream;
  FrameTimes times(1000, kPeriod_ns);
  std::uint64_t last = 0;
  times.add(stream.frame(0));
  for (const std::uint64_t number : {1u, 2u, 5u, 6u, 10u, 31u, 32u, 132u, 133u, 700u, 702u}) {
    EXPECT_EQ(times.add(stream.frame(number)).steps, number - last);
    last = number;
  }
}

// The transfers that waited hold the images from before the stall; those after it follow at once.
TEST(FrameTimes, AfterAStallOfThisComputerAllMissingImagesAreCounted) {
  Stream stream;
  FrameTimes times(1000, kPeriod_ns);
  for (std::uint64_t i = 0; i < 300; ++i) times.add(stream.frame(i));
  auto late = stream.frame(300);
  late.first_ns += 900'000'000;
  EXPECT_EQ(times.add(late).steps, 1u);
  auto next = stream.frame(403);
  next.first_ns = late.first_ns + 1'000'000;
  EXPECT_EQ(times.add(next).steps, 103u);
  EXPECT_EQ(times.add(stream.frame(404)).steps, 1u);
}

TEST(FrameTimes, WithoutStampsAnOddNumberOfMissingImagesIsOne) {
  Stream stream;
  FrameTimes times(1000, kPeriod_ns);
  times.add(stream.frame(0, false));
  EXPECT_EQ(times.add(stream.frame(1, false)).steps, 1u);
  EXPECT_EQ(times.add(stream.frame(3, false)).steps, 2u);
  const auto place = times.add(stream.frame(40, false));
  EXPECT_EQ(place.steps, 37u) << "a long gap is counted by the arrivals";
  EXPECT_EQ(place.error_ns, kPeriod_ns);
}

TEST(FrameTimes, StampsThatAreNoTimesCountNothing) {
  Stream stream;
  FrameTimes times(1000, kPeriod_ns);
  for (std::uint32_t i = 0; i < 200; ++i) {
    auto frame = stream.frame(i);
    frame.stamp = i * 1'000'003u;
    EXPECT_EQ(times.add(frame).steps, 1u);
  }
}

}  // namespace
}  // namespace handcast::camera::leap
