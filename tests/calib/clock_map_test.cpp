// SPDX-License-Identifier: Apache-2.0
#include "calib/clock_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "ipc/base/clock.hpp"

namespace handcast::calib {
namespace {

constexpr std::int64_t kLeastDelay_ns = 400'000;

/// A camera of 525 Hz with a clock of its own, whose images arrive after 0.4 ms, a jitter of 60 us
/// with a standard deviation of 30 us, and an exponential one of 0.1 ms; one of 200 comes several
/// ms late. There is no sharp lower limit, so the envelope does not lie on a line by itself.
class Device {
 public:
  /// `device_of`: the device's clock, in ns, at a time of the host's clock, in s.
  explicit Device(std::function<double(double)> device_of) : device_of_(std::move(device_of)) {}

  struct Item {
    std::int64_t true_ns, device_ns, arrival_ns;
  };
  Item next() {
    const double time_s = 1000 + count_++ / 525.;
    double delay_s = std::max(0., 60e-6 + 30e-6 * normal_(random_)) + 1e-4 * exponential_(random_);
    if (random_() % 200 == 0) delay_s += 5e-3 * exponential_(random_);
    const auto true_ns = seconds_to_ns(time_s);
    return {true_ns, static_cast<std::int64_t>(device_of_(time_s)),
            true_ns + kLeastDelay_ns + seconds_to_ns(delay_s)};
  }

 private:
  std::function<double(double)> device_of_;
  std::mt19937 random_{7};
  std::exponential_distribution<double> exponential_{1};
  std::normal_distribution<double> normal_;
  int count_ = 0;
};

struct Errors {
  double p50_us = 0, p99_us = 0, within_stated = 0;
};

/// The errors of the map over `seconds` of a device, after the first `warm_up_s`.
Errors errors_of(Device device, double seconds, double warm_up_s) {
  ClockMap map;
  std::vector<double> errors_us;
  int within = 0;
  for (int i = 0; i < static_cast<int>(525 * seconds); ++i) {
    const auto item = device.next();
    map.add(item.device_ns, item.arrival_ns);
    if (i < static_cast<int>(525 * warm_up_s)) continue;
    const auto mapped = map.earliest_arrival(item.device_ns);
    const auto error_ns = std::abs(mapped.ns - item.true_ns - kLeastDelay_ns);
    errors_us.push_back(ns_to_us(error_ns));
    within += error_ns <= mapped.error_ns;
  }
  std::ranges::sort(errors_us);
  const auto at = [&](double share) {
    return errors_us[static_cast<std::size_t>(share * static_cast<double>(errors_us.size() - 1))];
  };
  const Errors errors{at(0.5), at(0.99), within / static_cast<double>(errors_us.size())};
  std::printf("  error p50 %.1f us, p99 %.1f us, %.1f %% within the stated error\n", errors.p50_us,
              errors.p99_us, 100 * errors.within_stated);
  return errors;
}

TEST(ClockMap, FollowsADriftOf50PartsPerMillion) {
  for (const double drift : {50e-6, -50e-6, 0.}) {
    const auto errors =
        errors_of(Device([=](double s) { return 5e9 + s * 1e9 * (1 + drift); }), 60, 2);
    EXPECT_LE(errors.p99_us, 50);
    EXPECT_GE(errors.within_stated, 0.9);
  }
}

TEST(ClockMap, StatesAnErrorThatHoldsFromTheFirstImageOn) {
  const auto errors = errors_of(Device([](double s) { return 3e9 + s * 1e9 * (1 + 50e-6); }), 3, 0);
  EXPECT_LE(errors.p99_us, 150);
  EXPECT_GE(errors.within_stated, 0.9);
}

TEST(ClockMap, FollowsAClockThatWarmsUp) {
  // The drift changes by 20 ppm within 30 s.
  const auto errors = errors_of(Device([](double s) {
                                  const double since_s = s - 1000;
                                  return s * 1e9 + 1e9 * since_s * since_s * 20e-6 / 60;
                                }),
                                30, 2);
  EXPECT_LE(errors.p99_us, 60);
}

TEST(ClockMap, BeginsAnewWhenTheDevicesClockIsSet) {
  for (const double step_s : {-10., +2.}) {  // within the window of 8 s, old points would stay
    Device before([](double s) { return s * 1e9; });
    ClockMap map;
    Device::Item item{};
    for (int i = 0; i < 2000; ++i) {
      item = before.next();
      map.add(item.device_ns, item.arrival_ns);
    }
    const auto step_ns = seconds_to_ns(step_s);
    map.add(item.device_ns + 2'000'000 + step_ns, item.arrival_ns + 2'000'000);
    const auto mapped = map.earliest_arrival(item.device_ns + 2'000'000 + step_ns);
    EXPECT_NEAR(static_cast<double>(mapped.ns - item.arrival_ns - 2'000'000), 0, 1e5) << step_s;
    EXPECT_LT(mapped.error_ns, 1'000'000) << step_s;
  }
}

TEST(ClockMap, IgnoresImagesThatWaitedWhileTheProcessWasStopped) {
  Device device([](double s) { return s * 1e9; });
  ClockMap map;
  Device::Item item{};
  for (int i = 0; i < 5000; ++i) {
    item = device.next();
    map.add(item.device_ns, item.arrival_ns + (i > 4000 && i < 4500 ? 3'000'000'000 : 0));
  }
  const auto mapped = map.earliest_arrival(item.device_ns);
  EXPECT_NEAR(static_cast<double>(mapped.ns - item.true_ns - kLeastDelay_ns), 0, 5e4);
}

TEST(ClockMap, TakesNoBusySecondsForADrift) {
  // 115 Hz. The machine is busy in half of the seconds: then every image waits, by an amount that
  // changes slowly.
  std::vector<double> errors_ms;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform;
    ClockMap map;
    double from_ms = 0, to_ms = 0;
    for (int i = 0; i < 3 * 115; ++i) {
      if (i % 115 == 0) {
        from_ms = to_ms;
        to_ms = uniform(random) < 0.5 ? 8 * uniform(random) : 0;
      }
      const double waited_ms = std::lerp(from_ms, to_ms, i % 115 / 115.) + 0.3 * uniform(random);
      const auto device_ns = seconds_to_ns(i / 115.);
      map.add(device_ns, device_ns + static_cast<std::int64_t>(1e6 * waited_ms));
      errors_ms.push_back(std::abs(ns_to_ms(map.earliest_arrival(device_ns).ns - device_ns)));
    }
  }
  std::ranges::sort(errors_ms);
  const auto at = [&](std::size_t percent) { return errors_ms[errors_ms.size() * percent / 100]; };
  std::printf("  error p95 %.2f ms, p99 %.2f ms\n", at(95), at(99));
  EXPECT_LT(at(99), 0.5);
}

TEST(ClockMap, TellsTheDriftAfterASecond) {
  Device device([](double s) { return s * 1e9 * (1 - 100e-6); });
  ClockMap map;
  for (int i = 0; i < 500; ++i) {
    const auto item = device.next();
    map.add(item.device_ns, item.arrival_ns);
  }
  EXPECT_EQ(map.drift_ppm(), 0);
  for (int i = 0; i < 5000; ++i) {
    const auto item = device.next();
    map.add(item.device_ns, item.arrival_ns);
  }
  EXPECT_NEAR(map.drift_ppm(), 100, 5);
}

}  // namespace
}  // namespace handcast::calib
