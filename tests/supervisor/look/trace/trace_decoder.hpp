// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace handcast::supervisor::test {

/// One slice of a trace as a viewer would see it.
struct SeenSlice {
  std::string track, name;
  std::uint64_t track_id = 0;
  std::int64_t begin_ns = 0, end_ns = -1;
  int parent = -1;  ///< index of the slice around it; -1: none
  std::vector<std::uint64_t> flows;
  std::map<std::string, double> annotations;
  std::map<std::string, std::string> texts;  ///< annotations that are words
};

struct SeenTrace {
  std::string process;
  std::uint64_t pid = 0;
  std::uint64_t primary_clock = 0;
  std::map<std::uint64_t, std::int64_t> clocks;
  std::map<std::uint64_t, std::string> tracks;  ///< by id, without the process's own
  std::vector<SeenSlice> slices;                ///< by begin
  std::vector<double> ages_ms;                  ///< the counter's values
  std::string fault;  ///< the first error in the trace; "" if there is none

  std::vector<SeenSlice> named(std::string_view name) const;
  /// The slices that flow `id` passes through, by begin.
  std::vector<SeenSlice> along(std::uint64_t flow) const;
};

/// Reads a Perfetto trace without the code that wrote it: from the published field numbers and the
/// rules of TrackEvent alone (times do not go back, every slice ends, the last begun first; every
/// name and track is declared before it is used).
SeenTrace decode_trace(std::string_view bytes);

}  // namespace handcast::supervisor::test
