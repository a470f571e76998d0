// SPDX-License-Identifier: Apache-2.0
#include "services/bridge/bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "ipc/msg/check_guest.hpp"

namespace handcast::bridge {
namespace {

constexpr std::size_t kMostClocks = 16;
/// A clock is asked so often while it is new, and then so often that its drift shows.
/// @{
constexpr int kYoung = 8;
constexpr std::int64_t kSoon_ns = 20'000'000, kLater_ns = 200'000'000;
/// @}
/// How often what goes wrong, and what is known of a clock, is said again; and how long a clock
/// that was asked for may stay unknown without a word.
/// @{
constexpr std::int64_t kQuiet_ns = 10'000'000'000, kClockNews_ns = 60'000'000'000;
constexpr std::int64_t kUnknown_ns = 1'000'000'000;
/// @}

Gate gate_of(const char* stream, const config::Bridge& settings) {
  return {stream, settings.from, ms_to_ns(settings.oldest_ms)};
}

}  // namespace

Result<Link::Streams> streams_of(const config::Bridge& settings) {
  Link::Streams streams{.sends_ros = settings.ros};
  using Flags = std::map<std::string_view, bool*>;
  const auto mark = [](const std::vector<std::string>& names, const char* setting,
                       const Flags& flags) -> Result<void> {
    for (const auto& name : names) {
      const auto flag = flags.find(name);
      if (flag == flags.end())
        return fail(Errc::bad_config,
                    fmt::format("bridge.{}: there is no stream '{}'; there are pose.hands, "
                                "landmarks.hands and live.settings",
                                setting, name));
      *flag->second = true;
    }
    return {};
  };
  auto all = mark(settings.send, "send",
                  {{"pose.hands", &streams.sends_poses},
                   {"landmarks.hands", &streams.sends_landmarks},
                   {"live.settings", &streams.sends_settings}});
  if (all)
    all = mark(settings.receive, "receive",
               {{"pose.hands", &streams.takes_poses},
                {"landmarks.hands", &streams.takes_landmarks},
                {"live.settings", &streams.takes_settings}});
  if (!all) return tl::make_unexpected(all.error());
  return streams;
}

Arrivals::Arrivals(const config::Bridge& settings, const calib::CameraModel& lens, Say say)
    : lens_(lens),
      say_(std::move(say)),
      from_(settings.from),
      poses_(gate_of("pose.hands", settings)),
      landmarks_(gate_of("landmarks.hands", settings)) {}

template <class Message>
std::optional<Message> Arrivals::admit(Gate& gate, const Claim& claim, const Message& message) {
  const auto known = clocks_.find(claim.peer);
  const auto* clock = known == clocks_.end() ? nullptr : &known->second.map;
  const auto time_ns = now_ns();
  const auto unknown = gate.refused(Refusal::clock);
  const auto times = gate.admit(claim, msg::check_guest(message), clock, time_ns);
  if (!times) {
    const bool is_unknown = gate.refused(Refusal::clock) != unknown;
    if (is_unknown && unknown_ns_ == 0) unknown_ns_ = time_ns;  // it is asked at once
    if (!is_unknown || time_ns - unknown_ns_ > kUnknown_ns) complain(times.error().what);
    return std::nullopt;
  }
  Message ours = message;
  ours.header.origin_ns = times->origin_ns;
  ours.calibration = 0;
  brought_.published_ns = times->published_ns;
  brought_.clock_error_ns = clock->at(time_ns)->error_ns;
  return ours;
}

void Arrivals::take(const Claim& claim, const msg::HandPoses& poses) {
  if (auto ours = admit(poses_, claim, poses)) brought_.poses = *ours;
}

void Arrivals::take(const Claim& claim, const msg::Landmarks& landmarks) {
  auto ours = admit(landmarks_, claim, landmarks);
  if (!ours) return;
  for (auto& hand : std::span(ours->hands).first(ours->count))
    for (auto& point : hand.points) {
      const auto bent = lens_.distort({point.x_px, point.y_px});
      point.x_px = static_cast<float>(bent.x);
      point.y_px = static_cast<float>(bent.y);
    }
  brought_.landmarks = *ours;
}

void Arrivals::take(const Claim& claim, std::string_view values) {
  if (claim.version != kWireVersion || !claim.is_its_own) {
    complain(fmt::format("live.settings: those of {} are of another version, or sent in its name",
                         claim.name));
    return;
  }
  if ((!from_.empty() && claim.name != from_) || (mirrored_ && *mirrored_ != claim.peer)) return;
  if (!mirrored_) say_(fmt::format("live.settings are those of {}", claim.name));
  mirrored_ = claim.peer;
  auto changes = mirror_.follow(values);
  brought_.settings.insert(brought_.settings.end(), changes.begin(), changes.end());
  brought_.settings_of = claim.name;
}

/// Forgets the clocks of those that send no stream, if there are too many.
void Arrivals::make_room() {
  if (clocks_.size() < kMostClocks) return;
  std::erase_if(clocks_, [&](const auto& clock) {
    return poses_.holder() != clock.first && landmarks_.holder() != clock.first;
  });
}

void Arrivals::hear(Peer peer, const ClockExchange& exchange) {
  make_room();
  unknown_ns_ = 0;
  auto& [map, exchanges] = clocks_[peer];
  ++exchanges;
  switch (map.add(exchange)) {
    case ClockMap::News::none:
      break;
    case ClockMap::News::jumped:
      exchanges = 1;
      say_("the clock of another computer has jumped; its times are mapped anew");
      break;
    case ClockMap::News::impossible:
      complain("a computer answers with times that cannot be");
      break;
  }
}

void Arrivals::lose(Peer peer) {
  poses_.leave(peer);
  landmarks_.leave(peer);
  if (mirrored_ == peer) mirrored_.reset();
}

void Arrivals::complain(const std::string& sentence) {
  const auto time_ns = now_ns();
  if (complained_ns_ != 0 && time_ns - complained_ns_ < kQuiet_ns) {
    ++unsaid_;
    return;
  }
  complained_ns_ = time_ns;
  say_(unsaid_ == 0 ? sentence
                    : fmt::format("{} ({} more since the last line)", sentence, unsaid_));
  unsaid_ = 0;
}

/// Says who sends, and now and then how well the sender's clock is known.
void Arrivals::tell(std::int64_t time_ns) {
  for (auto* gate : {&poses_, &landmarks_})
    if (const auto news = gate->news(time_ns)) {
      say_(*news);
      told_clock_ns_ = 0;
    }
  if (told_clock_ns_ != 0 && time_ns - told_clock_ns_ < kClockNews_ns) return;
  for (const auto* gate : {&poses_, &landmarks_}) {
    const auto clock = clocks_.find(gate->holder().value_or(0));
    if (clock == clocks_.end() || clock->second.exchanges < kYoung) continue;
    const auto reading = clock->second.map.at(time_ns);
    say_(
        fmt::format("{}: its clock is {:.6f} s {} ours, known to {:.3f} ms, drift {:.2f} ppm; {} "
                    "messages used, {} left out",
                    gate->holder_name(), ns_to_seconds(std::abs(reading->offset_ns)),
                    reading->offset_ns < 0 ? "behind" : "ahead of", ns_to_ms(reading->error_ns),
                    reading->drift_ppm, gate->admitted(), gate->refused()));
    told_clock_ns_ = time_ns;
    return;
  }
}

Brought Arrivals::collect() {
  tell(now_ns());
  return std::exchange(brought_, {});
}

std::int64_t Arrivals::next_question_ns(std::int64_t asked_ns) const {
  const bool is_young = unknown_ns_ != 0 || std::ranges::any_of(clocks_, [](const auto& clock) {
                          return clock.second.exchanges < kYoung;
                        });
  return asked_ns + (is_young ? kSoon_ns : kLater_ns);
}

}  // namespace handcast::bridge
