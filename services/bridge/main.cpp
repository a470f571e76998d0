// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <string>
#include <thread>

#include "config/guests.hpp"
#include "config/live/live_board.hpp"
#include "ipc/base/log.hpp"
#include "ipc/msg/bridge_note.hpp"
#include "ipc/msg/guest_streams.hpp"
#include "ipc/msg/live_settings.hpp"
#include "services/bridge/bridge.hpp"
#include "services/runtime/context.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using service::must;

/// "RIG@COMPUTER".
static std::string name_of(const config::Rig& rig) {
  std::array<char, 64> host{};
  ::gethostname(host.data(), host.size() - 1);
  return fmt::format("{}@{}", rig.name, host.data());
}

/// Sends the newest messages of a ring until it is told to stop.
template <class Message>
static std::jthread sender(ipc::Reader<Message> from, bridge::Link& link) {
  return std::jthread([reader = std::move(from), &link](const std::stop_token& stop) mutable {
    while (!stop.stop_requested()) {
      const auto newest = reader.latest(Deadline::in(50ms));
      if (newest) link.send(**newest);
      if (!newest && newest.error().code != Errc::timeout) std::this_thread::sleep_for(50ms);
    }
  });
}

template <class Message>
static std::optional<ipc::Writer<Message>> writer_if(bool is_wanted, service::Context& context,
                                                     std::string_view stream) {
  if (!is_wanted) return std::nullopt;
  return must(context.writer<Message>(stream));
}

/// Whether the settings fit together.
static Result<void> check_bridge(const config::Rig& rig, const calib::Calibration&) {
  const auto streams = bridge::streams_of(rig.bridge);
  if (!streams) return tl::make_unexpected(streams.error());
  if (auto settings = bridge::dds_settings(rig.bridge); !settings)
    return tl::make_unexpected(settings.error());
  for (const auto& guest : config::kGuests) {
    const bool comes = (guest.feeds == "pose" && streams->takes_poses) ||
                       (guest.feeds == "landmarks" && streams->takes_landmarks);
    if (!comes) continue;
    if (!guest.is_heard(rig))
      return fail(
          Errc::bad_config,
          fmt::format("bridge.receive: {0}.hands is used only by {0}.backend = \"external\"",
                      guest.feeds));
    if (guest.is_wanted(rig))
      return fail(Errc::bad_config,
                  fmt::format("bridge.receive: {}.hands comes from {}.command already", guest.feeds,
                              guest.section()));
  }
  return {};
}

static void run_bridge(service::Context& context) {
  if (const auto fits = check_bridge(context.rig(), context.calibration()); !fits)
    service::give_up(fits.error());
  const auto& settings = context.rig().bridge;
  const auto streams = must(bridge::streams_of(settings));
  context.stand_by();
  auto poses = writer_if<msg::HandPoses>(streams.takes_poses, context, msg::kGuestPoses);
  auto landmarks =
      writer_if<msg::Landmarks>(streams.takes_landmarks, context, msg::kGuestLandmarks);
  const auto link = must(bridge::Link::open(settings, streams, name_of(context.rig())));
  bridge::Arrivals arrivals(settings, context.calibration().camera,
                            [](const std::string& sentence) { log::info("{}", sentence); });
  std::vector<std::jthread> senders;
  if (streams.sends_poses || streams.sends_ros)
    senders.push_back(sender(must(context.reader<msg::HandPoses>("pose.hands")), *link));
  if (streams.sends_landmarks)
    senders.push_back(sender(must(context.reader<msg::Landmarks>("landmarks.hands")), *link));
  if (streams.sends_settings)
    senders.push_back(
        sender(must(ipc::Reader<msg::LiveSettings>::attach(must(context.ring(msg::kLiveSettings)))),
               *link));
  std::optional<config::LiveBoard> board;
  if (streams.takes_settings) board = must(config::LiveBoard::open(context.rig().name));

  context.ready();
  std::int64_t asked_ns = 0;
  while (context.running()) {
    if (now_ns() >= arrivals.next_question_ns(asked_ns)) link->ask(), asked_ns = now_ns();
    link->take(arrivals, Deadline::in(20ms));
    const auto brought = arrivals.collect();
    if (!brought.settings.empty())
      if (const auto set = board->set(brought.settings, "bridge " + brought.settings_of); !set)
        log::warning("live.settings of {}: {}", brought.settings_of, set.error().what);
    if (brought.poses) poses->publish(*brought.poses);
    if (brought.landmarks) landmarks->publish(*brought.landmarks);
    if (!brought.poses && !brought.landmarks) continue;
    const msg::BridgeNote note{ns_to_us(brought.clock_error_ns), arrivals.refused()};
    const auto end_ns = now_ns();
    context.mark(brought.poses ? brought.poses->header : brought.landmarks->header,
                 std::array{msg::StageMark{msg::Stage::bridge, msg::detail_of(note),
                                           std::min(brought.published_ns, end_ns), end_ns}});
  }
}

int main(int argc, char** argv) {
  return service::run(
      {.name = "bridge",
       .summary = "Sends streams to other computers, and receives theirs.",
       .paced_by = "pose.hands, the network",
       .publishes = {std::string(msg::kGuestPoses), std::string(msg::kGuestLandmarks)},
       .subscribes = {"pose.hands", "landmarks.hands"},
       .settings = {"bridge"}},
      argc, argv, run_bridge, check_bridge);
}
