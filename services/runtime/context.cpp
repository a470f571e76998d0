// SPDX-License-Identifier: Apache-2.0
#include "services/runtime/context.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "ipc/base/exit_code.hpp"
#include "ipc/daemon/contract.hpp"
#include "ipc/daemon/stop_signal.hpp"
#include "ipc/msg/guest_streams.hpp"

namespace handcast::service {
namespace {

constexpr std::int64_t kFirstPause_ns = 1'000'000'000, kLongestPause_ns = 3600 * kFirstPause_ns;

bool worth_going_on(Errc code) { return code == Errc::timeout || code == Errc::bad_data; }

}  // namespace

// Does not run destructors: a daemon has no state to save, and its threads may still run.
void give_up(const Error& error) {
  log::error("{}", error.what);
  std::_Exit(exit_code_of(error));
}

Context::Context(const daemon::ServiceDescription& description, config::Rig rig,
                 calib::Calibration calibration)
    : description_(description),
      filed_(std::move(rig)),
      rig_(filed_),
      calibration_(std::move(calibration)),
      supervision_(daemon::Supervision::from_environment(description.name)) {
  if (supervision_.has_ring(msg::kLiveSettings))
    if (auto ring = open_segment(msg::kLiveSettings))
      rig_ = LiveSettings::newest(filed_, std::move(*ring)).rig;
  description_.publishes.push_back(daemon::marks_stream_of(description.name));
  wait_ = config::process_of(rig_, description.name).wait;
  if (!supervision_.is_standby()) open_marks();
}

Result<std::unique_ptr<LiveSettings>> Context::live_settings() const {
  auto ring = open_segment(msg::kLiveSettings);
  if (!ring) return tl::make_unexpected(ring.error());
  return LiveSettings::follow(filed_, std::move(*ring));
}

void Context::open_marks() {
  const auto stream = daemon::marks_stream_of(description_.name);
  if (!supervision_.has_ring(stream)) return;
  auto marks = writer<msg::StageMarks>(stream);
  if (marks)
    marks_ = std::make_unique<ipc::Writer<msg::StageMarks>>(std::move(*marks));
  else
    log::warning("stage marks are dropped: {}", marks.error().what);
}

void Context::stand_by() {
  if (!supervision_.is_standby()) return;
  for (const auto* streams : {&description_.subscribes, &description_.publishes})
    for (const auto& stream : *streams)
      if (auto segment = open_segment(stream)) mapped_.emplace(stream, std::move(*segment));
  supervision_.await_turn();
  writers_until_ = supervision_.predecessor_leaves_by(rig_.supervisor.stop_s);
  open_marks();
}

Result<ipc::Segment> Context::take_segment(std::string_view stream,
                                           const std::vector<std::string>& described) {
  if (std::ranges::find(described, stream) == described.end())
    return fail(Errc::bad_config, fmt::format("ring '{}' is not in the description of {}", stream,
                                              description_.name));
  if (const auto mapped = mapped_.extract(std::string(stream))) return std::move(mapped.mapped());
  return open_segment(stream);
}

Result<ipc::Segment> Context::open_segment(std::string_view stream) const {
  auto fd = supervision_.ring(stream);
  if (!fd) return tl::make_unexpected(fd.error());
  auto segment = ipc::Segment::open(std::move(*fd));
  if (segment) return segment;
  auto error = segment.error();
  // A program outside the rig may have overwritten its header, which the supervisor repairs.
  if (msg::is_for_guests(stream)) error.code = Errc::unavailable;
  return fail_in(fmt::format("ring '{}'", stream), error);
}

void Context::ready() {
  stand_by();
  supervision_.tell_ready();
}

bool Context::running() {
  if (daemon::stop_requested()) {
    if (!may_finish()) marks_.reset();  // the process that replaces this one waits for it
    return false;
  }
  if (const auto now = now_ns(); supervision_.beat_is_due(now)) mark({.origin_ns = now}, {});
  return true;
}

bool Context::may_finish() const { return daemon::requested_stop() == daemon::Stop::for_good; }

void Context::tolerate(const Error& error) {
  if (!worth_going_on(error.code)) give_up(error);
  ++complaints_;
  const auto now = now_ns();
  if (now < next_complaint_ns_) return;
  const bool is_same = std::exchange(complaint_, error.what) == error.what &&
                       now < next_complaint_ns_ + complaint_pause_ns_;
  complaint_pause_ns_ =
      is_same ? std::min(2 * complaint_pause_ns_, kLongestPause_ns) : kFirstPause_ns;
  next_complaint_ns_ = now + complaint_pause_ns_;
  log::warning("{} ({} so far)", error.what, complaints_);
}

void Context::mark(const msg::Header& frame, std::span<const msg::StageMark> stages,
                   const msg::MadeFrom& made_from) {
  supervision_.note_beat(now_ns());
  if (!marks_) return;
  msg::StageMarks marks;
  marks.header = frame;
  marks.made_from = made_from;
  marks.count = static_cast<std::uint32_t>(std::min(stages.size(), marks.marks.size()));
  std::copy_n(stages.begin(), marks.count, marks.marks.begin());
  marks_->publish(marks);
}

}  // namespace handcast::service
