// SPDX-License-Identifier: Apache-2.0
// The tracker `openxr` with the real loader and the runtime of the tests: how long after a runtime
// has joints the sample is there, and whether a runtime should be asked for the pose at the light.
// A bare thread that sleeps and wakes beside it shows the share of the machine.
//   bench_trackers_openxr [--seconds S] [--priority N] [--goals FILE]
#include <fmt/format.h>
#include <sched.h>

#include <cmath>
#include <cstdlib>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "renderer/predict/pose_history.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/pose/pose_source.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/services/pose/openxr/runtime/motion.hpp"
#include "tests/services/pose/openxr/scripted_runtime.hpp"

namespace handcast::bench {
namespace {

using namespace std::chrono_literals;

constexpr double kRate_hz = 110.6, kAge_ms = 9.1;     // of the runtime's tracker: a Leap Motion's
constexpr double kOld_ms = kAge_ms + 1e3 / kRate_hz;  ///< what the runtime surely has measured
constexpr double kNoise_mm = 0.3;
constexpr double kLight_ms = 8;  ///< from a sample's arrival to the light that is drawn by it
constexpr double kMotion_hz = 1000;
constexpr std::int64_t kFrame_ns = 2'000'000;

msg::HandPoses poses_of(const twin::Twin& twin, std::int64_t time_ns) {
  msg::HandPoses poses;
  const auto joints = twin.joints(msg::Side::left, time_ns);
  if (!joints) return poses;
  poses.count = 1;
  for (std::size_t j = 0; j < msg::kJoints; ++j) {
    const auto& frame = (*joints)[j];
    const auto turn = glm::quat_cast(glm::mat3(frame));
    poses.hands[0].joints[j] = {.position_m = {frame[3].x, frame[3].y, frame[3].z},
                                .orientation_xyzw = {turn.x, turn.y, turn.z, turn.w},
                                .radius_m = 0.008f};
  }
  return poses;
}

test_runtime::Motion motion_of(const std::string& name, double seconds) {
  config::Rig rig;
  rig.twin.motion = "builtin:" + name;
  const auto twin = twin::Twin::create(rig, calib::reference_rig()).value();
  test_runtime::Motion motion{kMotion_hz, {}};
  for (int k = 0; k < kMotion_hz * seconds; ++k)
    motion.frames.push_back(poses_of(*twin, static_cast<std::int64_t>(k * 1e9 / kMotion_hz)));
  return motion;
}

/// What came from the back end, and when.
struct Arrived {
  std::int64_t at_ns;
  msg::HandPoses poses;
};

struct Played {
  std::int64_t epoch_ns = 0;
  std::vector<Arrived> samples;
};

Played play(const test::ScriptedRuntime& runtime, const std::string& times,
            const config::OpenXr& settings, double seconds) {
  Played played;
  played.epoch_ns = now_ns() - 500'000'000;  // the tracker has samples from the beginning
  runtime.play(fmt::format("motion {}\nepoch_ns {}\nrate_hz {}\nage_ms {}\nnoise_mm {}\ntimes {}",
                           runtime.in_scratch("motion"), played.epoch_ns, kRate_hz, kAge_ms,
                           kNoise_mm, times));
  auto rig = runtime.rig();
  const auto manifest = rig.pose.openxr.runtime;
  rig.pose.openxr = settings;
  rig.pose.openxr.runtime = manifest;
  const auto source = pose::open_pose_source(rig, calib::reference_rig(), now_ns());
  if (!source) {
    fmt::print(stderr, "{}\n", source.error().what);
    std::exit(1);
  }
  for (const auto end = Deadline::in(std::chrono::nanoseconds(seconds_to_ns(seconds)));
       !end.passed();) {
    Arrived sample{};
    if ((*source)->sample(sample.poses, end) && sample.poses.count == 1) {
      sample.at_ns = now_ns();
      played.samples.push_back(sample);
    }
  }
  return played;
}

/// From the moment at which the runtime has joints to that at which the sample is there.
std::vector<double> added_us(const Played& played, const std::string& times, double age_ms) {
  std::vector<double> added;
  for (const auto& sample : played.samples) {
    const auto since_ns = static_cast<double>(sample.at_ns - played.epoch_ns) - kAge_ms * 1e6;
    const double period_ns = 1e9 / kRate_hz;
    const bool holds = times == "holds";
    added.push_back(
        1e-3 *
        (holds ? std::fmod(since_ns, period_ns)
               : static_cast<double>(sample.at_ns - sample.poses.header.origin_ns) - age_ms * 1e6));
  }
  return added;
}

/// The errors of the pose at the light, and of that of an image 8 ms ago, mm.
struct Errors {
  std::vector<double> at_light, at_image;
};

double error_mm(const msg::HandPose& pose, const test_runtime::Motion& motion,
                std::int64_t time_ns) {
  const auto place =
      static_cast<std::size_t>(1e-9 * static_cast<double>(time_ns) * kMotion_hz + 0.5);
  const auto& truth = motion.frames[place % motion.frames.size()].hands[0];
  double sum = 0;
  for (std::size_t j = 0; j < msg::kJoints; ++j) {
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double off = pose.joints[j].position_m[i] - truth.joints[j].position_m[i];
      square += off * off;
    }
    sum += std::sqrt(square);
  }
  return 1e3 * sum / msg::kJoints;
}

/// Plays what arrived to the history of the projector, and asks it as the projector does.
Errors errors_of(const Played& played, const test_runtime::Motion& motion) {
  renderer::PoseHistory history{config::Predict{}};
  Errors errors;
  std::size_t next = 0;
  const auto begin_ns = played.samples.front().at_ns + 200'000'000;
  for (auto now = played.samples.front().at_ns; now < played.samples.back().at_ns;
       now += kFrame_ns) {
    for (; next < played.samples.size() && played.samples[next].at_ns <= now; ++next)
      history.push(played.samples[next].poses.header.origin_ns,
                   played.samples[next].poses.hands[0]);
    const auto light = history.at(now + ms_to_ns(kLight_ms));
    const auto image = history.at(now - ms_to_ns(kLight_ms));
    if (now < begin_ns || !light || !image) continue;
    errors.at_light.push_back(
        error_mm(*light, motion, now + ms_to_ns(kLight_ms) - played.epoch_ns));
    errors.at_image.push_back(
        error_mm(*image, motion, now - ms_to_ns(kLight_ms) - played.epoch_ns));
  }
  return errors;
}

void compare(const test::ScriptedRuntime& runtime, const test_runtime::Motion& motion,
             const std::string& name, const std::string& times, double age_ms, double predict_ms,
             double seconds) {
  const config::OpenXr settings{.rate_hz = 120, .age_ms = age_ms, .predict_ms = predict_ms};
  const auto played = play(runtime, times, settings, seconds);
  if (played.samples.size() < 10) return;
  const auto errors = errors_of(played, motion);
  fmt::print("{:10} {:12} {:8.1f} {:8.0f} {:8.2f} {:8.2f} {:10.2f}\n", name, times,
             predict_ms > 0 ? predict_ms : -age_ms,
             static_cast<double>(played.samples.size()) / seconds, mean(errors.at_light),
             percentile(errors.at_light, 0.95), mean(errors.at_image));
}

/// A thread that wakes as often as a tracker has samples and notes how late it is, us.
class BareThread {
 public:
  std::vector<double> end() {
    thread_.request_stop();
    thread_.join();
    return late_us_;
  }

 private:
  void run(const std::stop_token& stop) {
    for (std::int64_t wake_ns = now_ns(); !stop.stop_requested();) {
      wake_ns += seconds_to_ns(1 / kRate_hz);
      sleep_until_ns(wake_ns);
      late_us_.push_back(ns_to_us(now_ns() - wake_ns));
    }
  }
  std::vector<double> late_us_;
  std::jthread thread_{[this](const std::stop_token& stop) { run(stop); }};
};

std::vector<Goal> measure_delay(const test::ScriptedRuntime& runtime, double seconds) {
  std::vector<Goal> goals;
  for (const std::string times : {"predicts", "holds"}) {
    const config::OpenXr settings{.rate_hz = 120, .age_ms = kAge_ms};
    BareThread bare;
    const auto added = added_us(play(runtime, times, settings, seconds), times, kAge_ms);
    const auto late = bare.end();
    fmt::print(
        "{:12} {} samples: added median {:.0f} us, p99 {:.0f} us; a bare thread wakes late by "
        "median {:.0f} us, p99 {:.0f} us\n",
        times, added.size(), median(added), percentile(added, 0.99), median(late),
        percentile(late, 0.99));
    goals.push_back(
        {"openxr, runtime that " + times + ": median added", median(added) / 1000, 0.3, "ms"});
  }
  return goals;
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast;
  double seconds = 4;
  std::string goals_file;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    if (option == "--seconds") seconds = std::atof(argv[i + 1]);
    if (option == "--goals") goals_file = argv[i + 1];
    if (option != "--priority") continue;
    const sched_param parameters{.sched_priority = std::atoi(argv[i + 1])};
    if (sched_setscheduler(0, SCHED_FIFO, &parameters) != 0)
      fmt::print("real-time priority is denied\n");
  }
  const test::ScriptedRuntime runtime;
  std::vector<bench::Goal> goals;
  for (const std::string name : {"wave", "shake", "open_close"}) {
    const auto motion = bench::motion_of(name, seconds + 2);
    test_runtime::write_motion(runtime.in_scratch("motion"), motion);
    if (goals.empty()) {
      goals = bench::measure_delay(runtime, seconds);
      fmt::print(
          "\nerror of the pose at the light (8 ms after now), and at an image 8 ms ago, mm\n"
          "{:10} {:12} {:8} {:>8} {:>8} {:>8} {:>10}\n",
          "motion", "runtime", "asked", "samples", "mean", "p95", "at image");
    }
    for (const std::string times : {"holds", "interpolates", "predicts", "overshoots", "knows"})
      for (const auto& [age_ms, predict_ms] : {std::pair{bench::kAge_ms, 0.},
                                               {bench::kOld_ms, 0.},
                                               {bench::kAge_ms, bench::kLight_ms}})
        bench::compare(runtime, motion, name, times, age_ms, predict_ms, seconds);
  }
  bench::print_goals(goals);
  return goals_file.empty() || bench::write_goals(goals_file, goals) ? 0 : 1;
}
