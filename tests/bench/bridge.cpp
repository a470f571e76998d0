// SPDX-License-Identifier: Apache-2.0
// Two rigs with a network cable between them, and clocks that differ by 1000 s
// (tests/two_computers.hpp): how much later a sample of the tracker is in the ring of the far
// projector, how well its time is mapped, and how far the two lights are apart.
//   bench_bridge [--goals FILE] [--seconds N] [--both path=value]... [--near path=value]...
// The far computer has no images; give the near one --near cascade.register.method=none to compare
// like with like.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/program.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/projection.hpp"
#include "tests/bench/arguments.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/rig_process.hpp"
#include "tests/bench/rings_transports.hpp"
#include "tests/two_computers.hpp"

namespace handcast::bench {
namespace {

using namespace std::chrono_literals;
using Words = std::vector<std::string>;
using test::TwoComputers;

/// The drawn vertices of one hand in one frame of a projector.
struct Drawn {
  std::int64_t target_ns = 0;
  std::vector<msg::Landing> landings;
};

std::optional<Drawn> drawn_in(const msg::Projection& frame) {
  if (frame.hand_count == 0) return std::nullopt;
  const auto& hand = frame.hands[0];
  return Drawn{frame.target_ns, {hand.landings.begin(), hand.landings.begin() + hand.vertex_count}};
}

/// Mean distance of the vertices of `at` from those between two other frames, px.
double distance_px(const Drawn& at, const Drawn& before, const Drawn& after) {
  const double part = static_cast<double>(at.target_ns - before.target_ns) /
                      static_cast<double>(after.target_ns - before.target_ns);
  double sum_px = 0;
  for (std::size_t i = 0; i < at.landings.size(); ++i) {
    const auto &a = before.landings[i], &b = after.landings[i];
    sum_px += std::hypot(a.x_px + part * (b.x_px - a.x_px) - at.landings[i].x_px,
                         a.y_px + part * (b.y_px - a.y_px) - at.landings[i].y_px);
  }
  return sum_px / static_cast<double>(at.landings.size());
}

/// The distance of each frame from what was drawn elsewhere at its time.
std::vector<double> distances_px(const std::vector<Drawn>& frames,
                                 const std::vector<Drawn>& others) {
  constexpr std::int64_t kFarthest_ns = 50'000'000;
  std::vector<double> all;
  std::size_t next = 0;
  for (const auto& frame : frames) {
    while (next < others.size() && others[next].target_ns < frame.target_ns) ++next;
    if (next == 0 || next == others.size()) continue;
    const auto &before = others[next - 1], &after = others[next];
    if (after.target_ns - before.target_ns > kFarthest_ns) continue;
    if (before.landings.size() == frame.landings.size() &&
        after.landings.size() == frame.landings.size())
      all.push_back(distance_px(frame, before, after));
  }
  return all;
}

/// Each second frame against those around it: what the interpolation between frames costs, four
/// times as much as between neighbours.
double interpolation_px(const std::vector<Drawn>& frames) {
  std::vector<Drawn> odd, even;
  for (std::size_t i = 0; i < frames.size(); ++i) (i % 2 ? odd : even).push_back(frames[i]);
  return median(distances_px(odd, even)) / 4;
}

/// What a rig has published.
struct Streams {
  explicit Streams(const std::string& rig)
      : poses(must(client::open_stream<msg::HandPoses>(rig, "pose.hands"))),
        frames(must(client::open_stream<msg::Projection>(rig, "projection.frames"))) {}
  client::Stream<msg::HandPoses> poses;
  client::Stream<msg::Projection> frames;
};

/// A sample of the tracker, which a joint identifies on both computers.
struct Sample {
  std::int64_t origin_ns = 0, published_ns = 0;
};
using Samples = std::map<float, Sample>;

void collect(Streams& from, std::int64_t ahead_ns, Samples& samples, std::vector<Drawn>& frames) {
  while (const auto poses = from.poses.next(Deadline::now()))
    if ((*poses)->count > 0) {
      const auto& header = (*poses)->header;
      samples[(*poses)->hands[0].joints[5].position_m[0]] = {header.origin_ns - ahead_ns,
                                                             header.published_ns - ahead_ns};
    }
  while (const auto frame = from.frames.next(Deadline::now()))
    if (auto drawn = drawn_in(**frame)) {
      drawn->target_ns -= ahead_ns;
      frames.push_back(std::move(*drawn));
    }
}

std::filesystem::path programs() { return program_folder(); }

Words up(const std::string& name, const Words& more) {
  const auto root = programs().parent_path().parent_path();
  Words words{programs() / "handcast", "up", root / "config/rigs/twin.toml"};
  Words settings{"name=" + name,      "observer.enabled=false",     "projector.rate_hz=400",
                 "camera.rate_hz=60", "landmarks.backend=twin",     "twin.motion=builtin:wave",
                 "desk.page.listen=", "bridge.process.priority=40", "pose.process.priority=40"};
  settings.insert(settings.end(), more.begin(), more.end());
  for (const auto& setting : settings) words.insert(words.end(), {"--set", setting});
  return words;
}

Words network(const TwoComputers& computers, const char* device, const char* peer) {
  if (!computers.is_connected()) return {};
  return {std::string("bridge.interface=") + device, fmt::format("bridge.peers=['{}']", peer)};
}

int run(double seconds, const Words& both_settings, const Words& near_settings,
        const Arguments& arguments) {
  const RigScope scope;
  TwoComputers computers;
  if (!computers.is_connected()) fmt::print("both are this computer: {}\n", computers.kWhyNot);
  auto near_words = network(computers, "near0", TwoComputers::kFar);
  near_words.push_back("bridge.send=['pose.hands', 'landmarks.hands']");
  near_words.insert(near_words.end(), near_settings.begin(), near_settings.end());
  near_words.insert(near_words.end(), both_settings.begin(), both_settings.end());
  auto far_words = network(computers, "far0", TwoComputers::kNear);
  far_words.insert(far_words.end(),
                   {"bridge.receive=['pose.hands', 'landmarks.hands']", "camera.backend=external",
                    "pose.backend=external", "landmarks.backend=external",
                    "cascade.fill.method=none", "cascade.register.method=none"});
  far_words.insert(far_words.end(), both_settings.begin(), both_settings.end());
  const auto near_rig = computers.in_near([&] {
    return std::make_unique<RigProcess>("near", up("near", near_words), scope.path() / "near.log");
  });
  const bool has_clocks = computers.is_connected() && computers.set_far_clock();
  const auto far_rig = computers.in_far([&] {
    return std::make_unique<RigProcess>("far", up("far", far_words), scope.path() / "far.log");
  });
  const auto is_ready = [](const nlohmann::json& services) {
    return services.contains("bridge") && services["bridge"]["state"] == "ready" &&
           services["projector"]["state"] == "ready";
  };
  computers.in_near([&] { near_rig->wait_until(is_ready); });
  computers.in_far([&] { far_rig->wait_until(is_ready); });
  sleep_until_ns(now_ns() + to_ns(5s));

  auto near_streams = computers.in_near([] { return Streams("near"); });
  auto far_streams = computers.in_far([] { return Streams("far"); });
  Samples near_samples, far_samples;
  std::vector<Drawn> near_frames, far_frames;
  const auto ahead_ns = has_clocks ? TwoComputers::kAhead_s * to_ns(1s) : 0;
  for (const auto until = Deadline::in(std::chrono::nanoseconds(seconds_to_ns(seconds)));
       !until.passed(); sleep_until_ns(now_ns() + to_ns(5ms))) {
    collect(near_streams, 0, near_samples, near_frames);
    collect(far_streams, ahead_ns, far_samples, far_frames);
  }

  std::vector<double> added_ms, mapped_us;
  for (const auto& [joint, sample] : far_samples)
    if (const auto sent = near_samples.find(joint); sent != near_samples.end()) {
      added_ms.push_back(ns_to_ms(sample.published_ns - sent->second.published_ns));
      mapped_us.push_back(std::abs(ns_to_us(sample.origin_ns - sent->second.origin_ns)));
    }
  const auto apart_px = distances_px(far_frames, near_frames);
  fmt::print("{} of {} samples came; {} and {} frames\n", added_ms.size(), near_samples.size(),
             near_frames.size(), far_frames.size());
  fmt::print(
      "added age p50 {:.3f} ms, p99 {:.3f} ms; times mapped within p50 {:.0f} us, p99 {:.0f} "
      "us\n",
      median(added_ms), percentile(added_ms, 0.99), median(mapped_us), percentile(mapped_us, 0.99));
  fmt::print(
      "lights apart: median {:.2f} px, p95 {:.2f} px, mean {:.2f} px; by interpolation alone "
      "{:.2f} px\n",
      median(apart_px), percentile(apart_px, 0.95), mean(apart_px), interpolation_px(near_frames));
  const std::vector<Goal> goals{
      {"added age of a pose on another computer, p99", percentile(added_ms, 0.99), 1, "ms"},
      {"the same, p50", median(added_ms), 0.5, "ms"},
      {"lights of two computers apart, mean", mean(apart_px), 1, "px"}};
  return arguments.report(goals);
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  handcast::bench::Arguments arguments("bench_bridge", "Measures two rigs on two computers.");
  double seconds = 20;
  std::vector<std::string> both_settings, near_settings;
  arguments.add("--seconds N", seconds, "How long", {1, 3600});
  arguments.add("--both path=value", both_settings, "A setting of both rigs");
  arguments.add("--near path=value", near_settings, "A setting of the near rig");
  if (const auto code = arguments.answered(argc, argv)) return *code;
  return handcast::bench::run(seconds, both_settings, near_settings, arguments);
}
