// SPDX-License-Identifier: Apache-2.0
#include "services/runtime/context.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "services/runtime/environment.hpp"
#include "services/runtime/stop_signal.hpp"

namespace handcast::service {
namespace {

constexpr std::int64_t kBeatEvery_ns = 100'000'000;
constexpr std::int64_t kComplainEvery_ns = 1'000'000'000;

constexpr timespec kSignEvery{.tv_sec = 0, .tv_nsec = 500'000'000};

bool worth_going_on(Errc code) { return code == Errc::timeout || code == Errc::bad_data; }

}  // namespace

// Ends without destructors: a daemon has nothing to save that it would not lose to SIGKILL as well,
// and its threads may still run.
void give_up(const Error& error) {
  log::error("{}", error.what);
  const bool lasting = error.code == Errc::bad_config ||
                       error.code == Errc::bad_data;  // a damaged file stays damaged
  std::_Exit(lasting ? kExitConfig : kExitRestart);
}

Context::Context(std::string name, config::Rig rig, calib::Calibration calibration)
    : name_(std::move(name)), rig_(std::move(rig)), calibration_(calibration) {
  if (const char* rings = std::getenv("HANDCAST_RINGS")) ring_fds_ = parse_rings(rings);
  ready_fd_ = static_cast<int>(number_from_environment("HANDCAST_READY_FD").value_or(-1));
  epoch_ns_ = number_from_environment("HANDCAST_EPOCH_NS").value_or(now_ns());
  standby_fd_ = static_cast<int>(number_from_environment("HANDCAST_STANDBY_FD").value_or(-1));
  wait_ = config::process_of(rig_, name_).wait;
  if (standby_fd_ < 0) open_marks();
}

void Context::open_marks() {
  const auto stream = "marks." + name_;
  if (!ring_fds_.contains(stream)) return;
  auto marks = writer<msg::StageMarks>(stream);
  if (marks)
    marks_ = std::make_unique<ipc::Writer<msg::StageMarks>>(std::move(*marks));
  else
    log::warning("stage marks are dropped: {}", marks.error().what);
}

void Context::stand_by(std::initializer_list<std::string_view> streams) {
  if (standby_fd_ < 0) return;
  std::vector<std::string> needed(streams.begin(), streams.end());
  needed.push_back("marks." + name_);
  for (const auto& stream : needed)
    if (auto segment = open_segment(stream)) mapped_.emplace(stream, std::move(*segment));
  wait_for_turn();
  ::close(std::exchange(standby_fd_, -1));
  open_marks();
}

// Signals are let in only while it sleeps, so that none is missed between the look at the flag and
// the sleep.
void Context::wait_for_turn() const {
  sigset_t stops, usual;
  sigemptyset(&stops);
  for (const int number : {SIGTERM, SIGINT}) sigaddset(&stops, number);
  pthread_sigmask(SIG_BLOCK, &stops, &usual);
  pollfd turn{.fd = standby_fd_, .events = POLLIN, .revents = 0};
  do {
    if (stop_requested()) std::_Exit(0);
    if (ready_fd_ >= 0) [[maybe_unused]]
      const auto told = ::write(ready_fd_, "s", 1);
  } while (ppoll(&turn, 1, &kSignEvery, &usual) <= 0);
  pthread_sigmask(SIG_SETMASK, &usual, nullptr);

  char byte = 0;
  if (::read(standby_fd_, &byte, 1) != 1) std::_Exit(0);
}

Result<ipc::Segment> Context::take_segment(std::string_view stream) {
  if (const auto mapped = mapped_.extract(std::string(stream))) return std::move(mapped.mapped());
  return open_segment(stream);
}

// Each caller gets a descriptor of its own, so that one stream can be asked for twice.
Result<ipc::Segment> Context::open_segment(std::string_view stream) const {
  if (ring_fds_.empty())
    return fail(
        Errc::bad_config,
        fmt::format("{} was started by hand, without rings; `handcast up RIG.toml` starts it",
                    name_));
  const auto found = ring_fds_.find(stream);
  if (found == ring_fds_.end())
    return fail(Errc::bad_config,
                fmt::format("{} was given no ring '{}' in HANDCAST_RINGS", name_, stream));

  UniqueFd fd(fcntl(found->second, F_DUPFD_CLOEXEC, 3));
  if (!fd)
    return fail(Errc::unavailable, fmt::format("ring '{}', descriptor {}: {}", stream,
                                               found->second, std::strerror(errno)));
  auto segment = ipc::Segment::open(std::move(fd));
  if (!segment) return fail_in(fmt::format("ring '{}'", stream), segment.error());
  return segment;
}

void Context::ready() {
  stand_by();
  log::info("ready");
  if (ready_fd_ < 0) return;
  if (::write(ready_fd_, "\n", 1) != 1)
    log::warning("the supervisor could not be told: {}", std::strerror(errno));
  ::close(ready_fd_);
  ready_fd_ = -1;
}

bool Context::running() {
  if (const auto now = now_ns(); now - last_beat_ns_ >= kBeatEvery_ns) mark({.origin_ns = now}, {});
  return !stop_requested();
}

void Context::tolerate(const Error& error) {
  if (!worth_going_on(error.code)) give_up(error);
  ++complaints_;
  const auto now = now_ns();
  if (now - last_complaint_ns_ < kComplainEvery_ns) return;
  log::warning("{} ({} so far)", error.what, complaints_);
  last_complaint_ns_ = now;
}

void Context::mark(const msg::Header& frame, std::span<const msg::StageMark> stages,
                   const msg::MadeFrom& made_from) {
  last_beat_ns_ = now_ns();
  if (!marks_) return;
  msg::StageMarks marks;
  marks.header = frame;
  marks.made_from = made_from;
  marks.count = static_cast<std::uint32_t>(std::min(stages.size(), marks.marks.size()));
  std::copy_n(stages.begin(), marks.count, marks.marks.begin());
  marks_->publish(marks);
}

}  // namespace handcast::service
