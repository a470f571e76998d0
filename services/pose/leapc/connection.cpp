// SPDX-License-Identifier: Apache-2.0
#include "services/pose/leapc/connection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <utility>

#include "ipc/base/log.hpp"

namespace handcast::pose::leapc {
namespace {

/// The rebaser learns the two clocks so often.
constexpr std::int64_t kUpdateEvery_ns = 100'000'000;
/// Samples older than this when they arrive are of another clock.
constexpr std::int64_t kOldest_ns = 1'000'000'000;
/// Resolution of the service's clock, and error of the map.
constexpr std::int64_t kSlack_ns = 500'000;
/// Further apart, the rebaser and the clocks themselves contradict each other.
constexpr std::int64_t kAgree_ns = 2'000'000;
/// Products with 1000 of what is less, and of differences, do not overflow.
constexpr std::int64_t kFarthest_us = INT64_MAX / 4000;

bool is_time(std::int64_t time_us) { return time_us > -kFarthest_us && time_us < kFarthest_us; }

/// The age at a time of the service's clock. A stamp of no clock if that is no time.
std::int64_t age_at_ns(std::int64_t now_us, std::int64_t stamp_us) {
  return is_time(now_us) ? (now_us - stamp_us) * 1000 : -kOldest_ns;
}

}  // namespace

HostClock::HostClock(const Functions& call, std::int64_t least_age_ns)
    : call_(call), least_age_ns_(least_age_ns) {
  if (call_.create_rebaser(&rebaser_) != kSuccess) rebaser_ = nullptr;
}

HostClock::~HostClock() {
  if (rebaser_) call_.destroy_rebaser(rebaser_);
}

/// The rebaser maps our clock to the service's, so the age is computed by the service's clock.
std::int64_t HostClock::rebased_age_ns(std::int64_t stamp_us, std::int64_t arrival_ns) {
  const std::int64_t now_us = call_.now_us();
  const std::int64_t plain_ns = age_at_ns(now_us, stamp_us);
  if (!rebaser_) return plain_ns;
  const std::int64_t ours_us = arrival_ns / 1000;
  if (arrival_ns - updated_ns_ >= kUpdateEvery_ns) {
    call_.update_rebaser(rebaser_, ours_us, now_us);
    updated_ns_ = arrival_ns;
  }
  std::int64_t theirs_us = 0;
  if (call_.rebase(rebaser_, ours_us, &theirs_us) != kSuccess) return plain_ns;
  const std::int64_t age_ns = age_at_ns(theirs_us, stamp_us) + arrival_ns % 1000;
  return std::llabs(age_ns - plain_ns) < kAgree_ns ? age_ns : plain_ns;
}

std::int64_t HostClock::origin_ns(std::int64_t stamp_us, std::int64_t arrival_ns) {
  const bool has_time = is_time(stamp_us);
  if (has_time) arrivals_.add(stamp_us * 1000, arrival_ns);
  const std::int64_t age_ns = has_time ? rebased_age_ns(stamp_us, arrival_ns) : -kOldest_ns;
  is_guessed_ = age_ns < -kSlack_ns || age_ns > kOldest_ns;
  if (!is_guessed_) return age_ns < 0 ? arrival_ns : arrival_ns - age_ns;
  if (!has_time) return arrival_ns - least_age_ns_;
  return arrivals_.earliest_arrival(stamp_us * 1000).ns - least_age_ns_;
}

void Mailbox::put(Result<msg::HandPoses> sample) {
  {
    const std::scoped_lock lock(mutex_);
    newest_ = std::move(sample);
  }
  came_.notify_one();
}

void Mailbox::say(std::string trouble) {
  const std::scoped_lock lock(mutex_);
  trouble_ = std::move(trouble);
}

Result<msg::HandPoses> Mailbox::take(Deadline deadline) {
  const std::chrono::steady_clock::time_point until(std::chrono::nanoseconds(deadline.time_ns()));
  std::unique_lock lock(mutex_);
  came_.wait_until(lock, until, [this] { return newest_.has_value(); });
  if (newest_) return *std::exchange(newest_, std::nullopt);
  return fail(Errc::timeout, trouble_.empty() ? "no sample before the deadline" : trouble_);
}

namespace {

constexpr std::string_view kNoService =
    "Ultraleap's service does not answer; start it with: systemctl start "
    "ultraleap-hand-tracking-service";
constexpr std::uint32_t kPoll_ms = 50;
constexpr auto kPause = std::chrono::milliseconds(50);
/// A connection without an answer for so long is made anew.
constexpr std::int64_t kPatience_ns = 2'000'000'000;
/// A turn takes 0.1 s. A library that needs longer than this hangs.
constexpr std::int64_t kHang_ns = 2'000'000'000;
/// A state that lasts for so long is logged.
constexpr std::int64_t kLasting_ns = 500'000'000;
/// A gap in the service's numbers that is longer is a new count.
constexpr std::uint64_t kLongestGap = 10'000;
constexpr std::array<std::uint32_t, 2> kConfigSizes{sizeof(ConnectionConfig),
                                                    offsetof(ConnectionConfig, tracking_origin)};

/// Room for the messages of later versions, which may be longer.
union MessageRoom {
  Message message;
  std::byte room[256];
};

}  // namespace

Connection::Connection(Library library, const config::Leapc& settings, std::uint64_t first_id,
                       Mailbox& mailbox)
    : library_(std::move(library)),
      settings_(settings),
      mailbox_(mailbox),
      clock_(library_.call, ms_to_ns(settings.age_ms)),
      devices_(library_.call, settings.device),
      next_id_(first_id),
      turn_ns_(now_ns()),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void Connection::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    turn_ns_ = now_ns();
    if (!handle_) connect();
    if (handle_)
      poll();
    else
      std::this_thread::sleep_for(kPause);
    say_state();
  }
  disconnect();
}

bool Connection::hangs() const { return now_ns() - turn_ns_ > kHang_ns; }

/// Older versions know a smaller configuration.
bool Connection::create() {
  const auto create = [&](const ConnectionConfig* config) {
    return library_.call.create_connection(config, &handle_) == kSuccess && handle_;
  };
  if (settings_.device.empty()) return create(nullptr);
  return std::ranges::any_of(kConfigSizes, [&](std::uint32_t size) {
    const ConnectionConfig config{size, kManyDevices, nullptr, 0};
    return create(&config);
  });
}

void Connection::connect() {
  silent_since_ns_ = now_ns();
  if (!create()) {
    handle_ = nullptr;
    return;
  }
  if (library_.call.open_connection(handle_) != kSuccess) disconnect();
}

void Connection::disconnect() {
  if (!handle_) return;
  lose_service();
  library_.call.close_connection(handle_);
  library_.call.destroy_connection(handle_);
  handle_ = nullptr;
}

void Connection::poll() {
  MessageRoom room{};
  room.message.size = sizeof(Message);
  const Status status = library_.call.poll(handle_, kPoll_ms, &room.message);
  if (status == kSuccess) {
    read(room.message);
  } else if (status != kTimeout) {
    if (is_up_) lose_service();
    std::this_thread::sleep_for(kPause);
  }
  if (!is_up_ && now_ns() - silent_since_ns_ > kPatience_ns) disconnect();
}

void Connection::read(const Message& message) {
  switch (message.type) {
    case kConnection:
      return begin();
    case kConnectionLost:
      return lose_service();
    case kDevice:
    case kDeviceLost:
      return device_event(message);
    case kTrackingMode:
      return mode_event(message);
    case kTracking:
      return track(message);
    default:
      return;
  }
}

void Connection::begin() {
  is_up_ = true;
  library_.call.set_policies(handle_, kBackgroundFrames, 0);
  if (settings_.mode != config::LeapMode::unchanged &&
      library_.call.set_mode(handle_, static_cast<std::int32_t>(settings_.mode)) != kSuccess)
    log::warning("pose 'leapc': the service has refused pose.leapc.mode = \"{}\"",
                 config::words_of(settings_.mode)[static_cast<std::size_t>(settings_.mode)]);
  log::info("pose 'leapc': connected to Ultraleap's service by {}{}{}", library_.path,
            library_.version.empty() ? "" : " of version ", library_.version);
}

void Connection::device_event(const Message& message) {
  DeviceEvent event{};
  if (!copy_memory(static_cast<const DeviceEvent*>(message.event), event)) return;
  if (message.type == kDevice)
    devices_.attached(handle_, event);
  else
    devices_.lost(event);
}

void Connection::mode_event(const Message& message) {
  ModeEvent event{};
  if (!copy_memory(static_cast<const ModeEvent*>(message.event), event)) return;
  const bool is_ours = settings_.mode == config::LeapMode::unchanged ||
                       event.mode == static_cast<std::int32_t>(settings_.mode);
  if (!is_ours)
    log::warning("pose 'leapc': another program has changed the tracking mode of the service");
}

void Connection::track(const Message& message) {
  const std::int64_t arrival_ns = now_ns();
  if (!devices_.is_wanted(message.device_id)) return;
  auto tracked = message.size >= offsetof(Message, device_id)
                     ? read_tracking(message)
                     : fail(Errc::bad_data, "a message that is too short");
  if (!tracked) return mailbox_.put(tl::make_unexpected(tracked.error()));
  const std::int64_t origin_ns = clock_.origin_ns(tracked->stamp_us, arrival_ns);
  if (clock_.is_guessed() && !std::exchange(has_said_guess_, true))
    log::warning(
        "pose 'leapc': the service's time stamps are not of its clock; samples are taken to be "
        "{:g} ms old when they arrive (pose.leapc.age_ms)",
        settings_.age_ms);
  if (origin_ns <= last_origin_ns_)
    return mailbox_.put(fail(Errc::bad_data, "a sample that is not newer than the one before it"));
  tracked->poses.header.origin_ns = last_origin_ns_ = origin_ns;
  tracked->poses.header.frame_id = next_id(tracked->frame_id);
  mailbox_.put(tracked->poses);
}

/// The service's number counts on ours, so that gaps are seen; it may begin anew.
std::uint64_t Connection::next_id(std::int64_t frame) {
  const auto number = static_cast<std::uint64_t>(frame);  // differences may not overflow
  const std::uint64_t gap = last_frame_ ? number - *last_frame_ : 1;
  last_frame_ = number;
  if (gap > 1 && gap < kLongestGap) next_id_ += gap - 1;
  return next_id_++;
}

/// The library connects anew by itself while it is polled.
void Connection::lose_service() {
  is_up_ = false;
  silent_since_ns_ = now_ns();
  devices_.clear();
  last_frame_.reset();
}

/// Logs what keeps frames away, once it has lasted; the service announces its devices one by one.
void Connection::say_state() {
  auto trouble = is_up_ ? devices_.trouble() : std::string(kNoService);
  if (trouble != trouble_) {
    trouble_ = std::move(trouble);
    trouble_since_ns_ = now_ns();
    mailbox_.say(trouble_);
  }
  if (trouble_ == said_ || now_ns() - trouble_since_ns_ < kLasting_ns) return;
  if (!trouble_.empty()) log::warning("pose 'leapc': {}", trouble_);
  said_ = trouble_;
}

}  // namespace handcast::pose::leapc
