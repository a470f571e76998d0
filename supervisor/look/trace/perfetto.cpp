// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/trace/perfetto.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <limits>

#include "ipc/base/clock.hpp"
#include "ipc/msg/frame_delay.hpp"
#include "ipc/msg/rung.hpp"
#include "supervisor/look/trace/made_frames.hpp"
#include "supervisor/look/trace/protobuf.hpp"
#include "supervisor/look/trace/trace_flows.hpp"
#include "supervisor/look/trace/trace_slices.hpp"

/// Field numbers and values of the protobuf messages of a Perfetto trace that perfetto.cpp writes.
/// Source: github.com/google/perfetto, protos/perfetto/trace (trace_packet, clock_snapshot,
/// interned_data, track_event/*).
namespace handcast::supervisor::perfetto {

namespace trace {
inline constexpr int packet = 1;
}
namespace packet {
inline constexpr int clock_snapshot = 6, timestamp = 8, sequence = 10, track_event = 11,
                     interned_data = 12, sequence_flags = 13, clock_id = 58, defaults = 59,
                     track_descriptor = 60;
inline constexpr int state_cleared = 1, needs_state = 2;  // flags
}  // namespace packet
namespace clock_snapshot {
inline constexpr int clock = 1, primary = 2;
inline constexpr int clock_id = 1, clock_time = 2;
inline constexpr int realtime = 1, monotonic = 3, boottime = 6;  // clocks
}  // namespace clock_snapshot
namespace interned {
inline constexpr int event_name = 2, annotation_name = 3;
inline constexpr int id = 1, text = 2;
}  // namespace interned
namespace track {
inline constexpr int uuid = 1, name = 2, process = 3, parent = 5, counter = 8, child_ordering = 11,
                     sibling_rank = 12;
inline constexpr int process_pid = 1, process_name = 6, counter_unit_name = 6;
inline constexpr int by_rank = 3;  // ordering
}  // namespace track
namespace event {
inline constexpr int annotation = 4, type = 9, name_id = 10, track = 11, value = 44, flow = 47;
inline constexpr int slice_begin = 1, slice_end = 2, counter = 4;  // types
inline constexpr int annotation_name_id = 1, annotation_number = 3, annotation_real = 5,
                     annotation_text = 6;
}  // namespace event

}  // namespace handcast::supervisor::perfetto

namespace handcast::supervisor {
namespace {

using namespace perfetto;

constexpr std::uint64_t kSequence = 1, kProcessTrack = 1, kAgeTrack = 2, kFirstServiceTrack = 3;
constexpr std::array<std::string_view, 9> kAnnotations{"frame_id",   "image_id",    "age_ms",
                                                       "marks_lost", "left_hand",   "right_hand",
                                                       "off_cpu_us", "preemptions", "page_faults"};
enum Annotation {
  frame_id,
  image_id,
  age_ms,
  marks_lost,
  left_hand,
  right_hand,
  off_cpu_us,
  preemptions,
  page_faults
};

/// The number of a stage's name in the trace; 0 means no name.
constexpr std::uint64_t name_id(msg::Stage stage) { return static_cast<std::uint64_t>(stage) + 1; }

/// True for stages that represent their whole frame: they carry its flows and annotations.
bool is_leading(msg::Stage stage) {
  using enum msg::Stage;
  return stage == capture || stage == sample || stage == detect || stage == frame ||
         stage == present || stage == light;
}

/// An event that is not yet sorted by time.
struct TimedEvent {
  std::int64_t time_ns;
  Protobuf event;
};

class TraceWriter {
 public:
  TraceWriter(const HistorySnapshot& history, std::string_view rig)
      : history_(history), rig_(rig), flows_(flows_of(history)) {}

  std::string write(const ClockReadings& clocks) {
    add_clocks(clocks);
    add_names();
    add_process();
    std::uint64_t track = kFirstServiceTrack;
    const auto services = lanes_of(history_);
    for (std::size_t i = 0; i < services.size(); ++i) {
      for (const auto& lane : services[i]) {
        if (lane.empty()) continue;  // the service has no marks
        add_track(track, history_.services[i], i);
        add_slices(track++, lane);
      }
    }
    add_ages();
    add_events_in_time();
    return std::move(bytes_);
  }

 private:
  /// Appends a packet. A trace is a sequence of packet fields, so its bytes can be concatenated.
  void add(Protobuf packet) {
    packet.number(packet::sequence, kSequence);
    bytes_ += Protobuf().message(trace::packet, packet).bytes();
  }

  void add_clocks(const ClockReadings& clocks) {
    Protobuf snapshot;
    const auto clock = [&](std::uint64_t id, std::int64_t time_ns) {
      const auto reading = static_cast<std::uint64_t>(time_ns);
      snapshot.message(clock_snapshot::clock, Protobuf()
                                                  .number(clock_snapshot::clock_id, id)
                                                  .number(clock_snapshot::clock_time, reading));
    };
    clock(clock_snapshot::monotonic, clocks.monotonic_ns);
    clock(clock_snapshot::boottime, clocks.boottime_ns);
    clock(clock_snapshot::realtime, clocks.realtime_ns);
    snapshot.number(clock_snapshot::primary, clock_snapshot::monotonic);
    add(Protobuf().message(packet::clock_snapshot, snapshot));
  }

  /// Adds the names that events refer to by number, and the clock of their times.
  void add_names() {
    Protobuf names;
    for (std::size_t i = 0; i < msg::kStageNames.size(); ++i)
      names.message(
          interned::event_name,
          Protobuf().number(interned::id, i + 1).text(interned::text, msg::kStageNames[i]));
    for (std::size_t i = 0; i < kAnnotations.size(); ++i)
      names.message(interned::annotation_name,
                    Protobuf().number(interned::id, i + 1).text(interned::text, kAnnotations[i]));
    add(Protobuf()
            .number(packet::sequence_flags, packet::state_cleared | packet::needs_state)
            .message(packet::defaults,
                     Protobuf().number(packet::clock_id, clock_snapshot::monotonic))
            .message(packet::interned_data, names));
  }

  void add_process() {
    const auto name = fmt::format("handcast {}", rig_);
    const auto pid = static_cast<std::uint64_t>(history_.supervisor);
    add(Protobuf().message(
        packet::track_descriptor,
        Protobuf()
            .number(track::uuid, kProcessTrack)
            .number(track::child_ordering, track::by_rank)
            .message(track::process,
                     Protobuf().number(track::process_pid, pid).text(track::process_name, name))));
    add(Protobuf().message(
        packet::track_descriptor,
        Protobuf()
            .number(track::uuid, kAgeTrack)
            .text(track::name, "age of the image in the light")
            .number(track::parent, kProcessTrack)
            .number(track::sibling_rank, history_.services.size())
            .message(track::counter, Protobuf().text(track::counter_unit_name, "ms"))));
  }

  /// Adds a track. The viewer shows tracks of the same name and parent as one track with lanes.
  void add_track(std::uint64_t uuid, std::string_view service, std::uint64_t rank) {
    add(Protobuf().message(packet::track_descriptor, Protobuf()
                                                         .number(track::uuid, uuid)
                                                         .text(track::name, service)
                                                         .number(track::parent, kProcessTrack)
                                                         .number(track::sibling_rank, rank)));
  }

  void add_slices(std::uint64_t track, const Lane& lane) {
    std::vector<std::int64_t> open;  // the ends of the open slices, innermost last
    const auto close_until = [&](std::int64_t time_ns) {
      for (; !open.empty() && open.back() <= time_ns; open.pop_back())
        events_.push_back(
            {open.back(),
             Protobuf().number(event::type, event::slice_end).number(event::track, track)});
    };
    for (const auto& slice : lane) {
      close_until(slice.mark.begin_ns);
      events_.push_back({slice.mark.begin_ns, slice_begin(track, slice)});
      open.push_back(slice.mark.end_ns);
    }
    close_until(std::numeric_limits<std::int64_t>::max());
  }

  Protobuf slice_begin(std::uint64_t track, const Slice& slice) const {
    Protobuf begin;
    begin.number(event::type, event::slice_begin)
        .number(event::track, track)
        .number(event::name_id, name_id(slice.mark.stage));
    const auto annotate = [&](Annotation name, auto put) {
      Protobuf annotation;
      put(annotation.number(event::annotation_name_id, name + 1u));
      begin.message(event::annotation, annotation);
    };
    if (slice.mark.stage == msg::Stage::correct)
      for (const auto side : {msg::Side::left, msg::Side::right})
        if (const auto rung = msg::rung_in(slice.mark.detail, side))
          annotate(side == msg::Side::left ? left_hand : right_hand, [&](Protobuf& value) {
            value.text(event::annotation_text, msg::name_of(*rung));
          });
    if (slice.mark.stage == msg::Stage::frame) {
      const auto delay = msg::frame_delay_in(slice.mark.detail);
      for (const auto& cost :
           {std::pair(off_cpu_us, delay.off_cpu_us), std::pair(preemptions, delay.preemptions),
            std::pair(page_faults, delay.faults)})
        if (cost.second > 0)
          annotate(cost.first,
                   [&](Protobuf& value) { value.number(event::annotation_number, cost.second); });
    }
    if (!is_leading(slice.mark.stage)) return begin;
    const auto& frame = history_.frames[slice.frame];
    for (const auto flow : flows_[slice.frame]) begin.fixed64(event::flow, flow);
    annotate(frame_id, [&](Protobuf& value) {
      value.number(event::annotation_number, frame.header.frame_id);
    });
    if (frame.made_from.image_ns > 0)
      annotate(image_id, [&](Protobuf& value) {
        value.number(event::annotation_number, frame.made_from.image_id);
      });
    if (const auto age_ns = age_of(frame.header.origin_ns, slice.mark))
      annotate(age_ms,
               [&](Protobuf& value) { value.real(event::annotation_real, ns_to_ms(*age_ns)); });
    if (frame.missed > 0)
      annotate(marks_lost,
               [&](Protobuf& value) { value.number(event::annotation_number, frame.missed); });
    return begin;
  }

  void add_ages() {
    for (const auto& frame : history_.frames) {
      const auto* light = find_light(frame);
      const auto age_ns = light ? age_of(frame.header.origin_ns, *light) : std::nullopt;
      if (!age_ns) continue;
      events_.push_back({light->end_ns, Protobuf()
                                            .number(event::type, event::counter)
                                            .number(event::track, kAgeTrack)
                                            .real(event::value, ns_to_ms(*age_ns))});
    }
  }

  void add_events_in_time() {
    std::ranges::stable_sort(events_, {}, &TimedEvent::time_ns);
    for (const auto& [time_ns, event] : events_)
      add(Protobuf()
              .number(packet::timestamp, static_cast<std::uint64_t>(time_ns))
              .number(packet::sequence_flags, packet::needs_state)
              .message(packet::track_event, event));
  }

  const HistorySnapshot& history_;
  std::string_view rig_;
  std::vector<std::vector<std::uint64_t>> flows_;
  std::vector<TimedEvent> events_;
  std::string bytes_;
};

std::int64_t read_clock(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return time.tv_sec * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

ClockReadings ClockReadings::now() {
  return {read_clock(CLOCK_MONOTONIC), read_clock(CLOCK_BOOTTIME), read_clock(CLOCK_REALTIME)};
}

std::string perfetto_trace(const HistorySnapshot& history, std::string_view rig,
                           const ClockReadings& clocks) {
  return TraceWriter(history, rig).write(clocks);
}

}  // namespace handcast::supervisor
