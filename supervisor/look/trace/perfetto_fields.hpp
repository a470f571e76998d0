// SPDX-License-Identifier: Apache-2.0
#pragma once

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
