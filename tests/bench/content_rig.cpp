// SPDX-License-Identifier: Apache-2.0
// What content costs a rig (config/rigs/twin.toml), and how fast it is there.
//   bench_content_rig [--goals FILE] [--turns N] [--priority N]
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/live/live_board.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/client/rig_ring.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/msg/content_picture.hpp"
#include "ipc/msg/content_state.hpp"
#include "ipc/msg/guest_picture.hpp"
#include "ipc/msg/projection.hpp"
#include "ipc/ring/writer.hpp"
#include "tests/bench/arguments.hpp"
#include "tests/bench/control_rig.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/rings_transports.hpp"
#include "tests/bench/watched_frames.hpp"

namespace handcast::bench {
namespace {

using namespace std::chrono_literals;

/// The supervisor waits longer after each death.
constexpr int kKills = 20;

constexpr double kRefresh_hz = 120, kContent_hz = 60;

/// Sensors and projector at rates that two cores keep beside a content, all with this real-time
/// priority.
std::vector<std::string> settings_with(const std::string& content, int priority) {
  std::vector<std::string> settings{"camera.rate_hz=120",      "projector.rate_hz=120",
                                    "observer.enabled=false",  "twin.motion=builtin:wave",
                                    "content.left=" + content, "content.right=" + content};
  for (const auto* service : {"camera", "pose", "landmarks", "projector"})
    settings.push_back(fmt::format("{}.process.priority={}", service, priority));
  return settings;
}

template <class T>
client::Stream<T> stream_of(std::string_view name) {
  auto stream = client::open_stream<T>("twin", name);
  if (!stream) give_up(stream.error().what);
  return std::move(*stream);
}

config::LiveBoard board_of_twin() {
  auto board = config::LiveBoard::open("twin");
  if (!board) give_up(board.error().what);
  return std::move(*board);
}

/// Sends a command and waits for the first picture of it, ms.
double change_ms(config::LiveBoard& board, const std::string& content) {
  auto states = stream_of<msg::ContentState>("content.state");
  auto pictures = stream_of<msg::ContentPicture>("content.left");
  const std::vector<std::string> changes{"content.left=" + content, "content.right=" + content};
  const auto begin_ns = now_ns();
  const auto change = board.set(changes, "bench", {"fade", 0.3});
  if (!change) give_up(change.error().what);
  for (const auto until = Deadline::in(10s); !until.passed();) {
    const auto state = states.latest(Deadline::in(1s));
    if (!state || (*state)->hands[0].command < *change) continue;
    if (!(*state)->hands[0].fault.view().empty())
      give_up(std::string((*state)->hands[0].fault.view()));
    const auto picture = pictures.latest(Deadline::in(1s));
    if (picture) return ns_to_ms((*picture)->header.published_ns - begin_ns);
  }
  give_up("no picture followed the command");
}

/// The red of the brightest lit pixel of a frame; empty without hands.
std::optional<int> brightest_red(const msg::Projection& frame) {
  if (frame.hand_count == 0) return std::nullopt;
  int best = 0;
  const std::size_t count = std::size_t{frame.region_width_px} * frame.region_height_px;
  for (std::size_t i = 0; i < count; i += 7)
    best = std::max(best, static_cast<int>(frame.pixels()[i] & 0xff));
  return best;
}

/// From the publication of a guest's picture to the publication of the frame that shows it, ms.
std::vector<double> times_to_light_ms(int runs) {
  auto ring = client::rig_ring("twin", "guest.left");
  if (!ring) give_up(ring.error().what);
  auto writer = ipc::Writer<msg::GuestPicture>::attach(std::move(ring->segment));
  if (!writer) give_up(writer.error().what);
  auto frames = stream_of<msg::Projection>("projection.frames");
  std::vector<double> times_ms;
  for (int run = 0; run < runs; ++run) {
    const bool is_bright = run % 2 == 0;
    auto slot = writer->loan();
    slot->width_px = slot->height_px = 64;
    std::fill_n(slot->pixels(), 64 * 64, is_bright ? 0xffffffffu : 0xff000028u);
    const auto begin_ns = now_ns();
    writer->publish(std::move(slot));
    for (const auto until = Deadline::in(2s); !until.passed();) {
      const auto frame = frames.latest(Deadline::in(100ms));
      if (!frame || (*frame)->header.published_ns < begin_ns) continue;
      const auto red = brightest_red(**frame);
      if (!red || (*red > 150) != is_bright) continue;
      times_ms.push_back(ns_to_ms((*frame)->header.published_ns - begin_ns));
      break;
    }
    ::usleep(static_cast<useconds_t>(50'000 + 1'700 * (run % 10)));
  }
  return times_ms;
}

/// The frames without light, and all, while the content service is killed.
struct Kills {
  int kills = 0, dark = 0, frames = 0;
};

Kills kill_content(const TwinRig& rig, int kills) {
  auto frames = stream_of<msg::Projection>("projection.frames");
  Kills result;
  while (result.kills < kills) {
    const auto pid = rig.pid_of("content");
    if (pid <= 0) continue;  // it is being started; 0 would be every process of this group
    ::kill(pid, SIGKILL);
    ++result.kills;
    for (const auto until = Deadline::in(150ms); !until.passed();) {
      const auto frame = frames.next(Deadline::in(20ms));
      if (!frame) continue;
      const auto red = brightest_red(**frame);
      result.frames += red.has_value();
      result.dark += red.has_value() && *red < 20;
    }
    rig.settle("");
  }
  return result;
}

/// The projector's frames with two contents in turns of one rig, so that whatever else the machine
/// does meets both alike.
struct Compared {
  std::vector<double> first_us, second_us;  ///< p50 of each turn of 1 s
  int first_missed = 0, second_missed = 0;  ///< refreshes without a new frame
  int frames = 0;                           ///< with each of them, about
};

Compared compare(const RigFolder& folder, int turns, int priority, const std::string& first,
                 const std::string& second) {
  const TwinRig rig(folder, settings_with(first, priority));
  auto board = board_of_twin();
  Compared compared;
  const auto watch = [&](const std::string& content) {
    change_ms(board, content);
    ::usleep(350'000);  // the transition
    return watch_frames(1, kRefresh_hz);
  };
  for (int turn = 0; turn < turns; ++turn) {
    const auto with_first = watch(first), with_second = watch(second);
    compared.first_us.push_back(median(with_first.frame_us));
    compared.second_us.push_back(median(with_second.frame_us));
    compared.first_missed += with_first.missed;
    compared.second_missed += with_second.missed;
    compared.frames += static_cast<int>(with_second.frame_us.size());
  }
  return compared;
}

void measure_frames(const RigFolder& folder, int turns, int priority, std::vector<Goal>& goals) {
  const auto moving = compare(folder, turns, priority, "builtin:atlas", "waves"),
             lit = compare(folder, turns, priority, "builtin:atlas",
                           "builtin:atlas | light kind=orbit");
  const auto ratios = [](const Compared& compared) {
    std::vector<double> all;
    for (std::size_t turn = 0; turn < compared.first_us.size(); ++turn)
      all.push_back(compared.second_us[turn] / compared.first_us[turn]);
    return all;
  };
  for (const auto& [name, compared] :
       {std::pair("a shader of 640x400 at 60 Hz", &moving), {"its light moving at 60 Hz", &lit}})
    fmt::print(
        "the projector's frame, p50 of {} turns of 1 s: {:.0f} us with a still picture, {:.0f} us "
        "with {}; half of the turns within {:+.1f} .. {:+.1f} %; refreshes missed: {} and {} of "
        "{}\n",
        turns, median(compared->first_us), median(compared->second_us), name,
        100 * (percentile(ratios(*compared), 0.25) - 1),
        100 * (percentile(ratios(*compared), 0.75) - 1), compared->first_missed,
        compared->second_missed, compared->frames);
  goals.push_back(
      {"frame with a moving content, longer by", 100 * (median(ratios(moving)) - 1), 5, "%"});
  goals.push_back({"missed refreshes more than with a still one, of all",
                   100. * (moving.second_missed - moving.first_missed) / std::max(moving.frames, 1),
                   0, "%"});
  goals.push_back({"frame with moving light, longer by",
                   1e-3 * (median(lit.second_us) - median(lit.first_us)), 0.15, "ms"});
}

int run(int turns, int priority, const Arguments& arguments) {
  const RigFolder folder;
  std::vector<Goal> goals;
  if (turns > 0) measure_frames(folder, turns, priority, goals);
  {
    const TwinRig rig(folder, settings_with("builtin:atlas", priority));
    std::vector<double> first_ms, again_ms;
    {
      auto board = board_of_twin();
      for (int round = 0; round < 3; ++round)
        for (const auto* look : {"lava", "tiger", "galaxy", "xray", "clock", "circuit"})
          first_ms.push_back(change_ms(board, look));
      for (int i = 0; i < 10; ++i)
        again_ms.push_back(change_ms(board, i % 2 ? "builtin:checker" : "builtin:skeleton"));
      change_ms(board, "program:left");
    }
    fmt::print(
        "change of a look, median of {}: {:.0f} ms, quartiles {:.0f} and {:.0f} ms; of a "
        "pattern: {:.0f} ms\n",
        first_ms.size(), median(first_ms), percentile(first_ms, 0.25), percentile(first_ms, 0.75),
        median(again_ms));
    goals.push_back({"first picture of a look after its command", median(first_ms), 100, "ms"});
    ::usleep(500'000);
    const auto light_ms = times_to_light_ms(60);
    goals.push_back({"content to light, median of " + std::to_string(light_ms.size()),
                     median(light_ms), 1000 / kContent_hz + 1000 / kRefresh_hz, "ms"});
  }
  {
    const TwinRig rig(folder, settings_with("waves", priority));
    const auto kills = kill_content(rig, kKills);
    fmt::print("content killed {} times: {} of {} frames dark\n", kills.kills, kills.dark,
               kills.frames);
    goals.push_back(
        {"dark frames while content was killed", static_cast<double>(kills.dark), 0, ""});
  }
  return arguments.report(goals);
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  handcast::bench::Arguments arguments("bench_content_rig", "Measures contents in a rig.");
  int turns = 15, priority = 0;
  arguments.add("--turns N", turns, "Turns of the frames; 0: none", {0, 1000});
  arguments.add("--priority N", priority,
                "Real-time priority of camera, tracker, detector and projector", {0, 99});
  if (const auto code = arguments.answered(argc, argv)) return *code;
  return handcast::bench::run(turns, priority, arguments);
}
