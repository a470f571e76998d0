// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/sections/watch.hpp"
#include "ipc/base/result.hpp"

namespace handcast::watch {

/// The times between an image and the light that was made from it.
struct Latencies {
  std::map<int, std::uint64_t> counts;  ///< of frames, by tenths of a millisecond
  double worst_ms = 0;

  void add(double latency_ms);
  /// The latency that a share (0..1) of the frames did not exceed; 0 if there are none.
  double quantile_ms(double share) const;
};

/// Something that was wrong. Times are local: "2026-12-24 18:00:05".
struct Fault {
  std::string kind;       ///< "service pose", "silent camera.frames", "disk"; one of each is open
  std::string sentence;   ///< for a person
  std::string since;      ///< when it was seen first
  std::string until;      ///< when it was over; empty: it is open
  std::string black_box;  ///< the folder of what was before; empty: none
  bool told = false;      ///< an alert was sent
};

/// Something that happened.
struct Event {
  std::string time;  ///< local: "18:00:05"
  std::string text;
};

/// Where the tracker seems to be (DriftFigures of the supervisor).
struct Drift {
  bool moved = false;
  double across_mm = 0, turn_deg = 0;
};

/// What the night watch knows of one day of a rig. It is kept in DATE.json, so that a watch that is
/// started again goes on.
struct Day {
  static constexpr std::size_t kMostFaults = 200;  ///< more are not noted

  std::string rig, date;                                       ///< "2026-12-24"
  double up_s = 0;                                             ///< the rig was up
  double lit_s = 0;                                            ///< of these, it was to be lit
  double dark_s = 0;                                           ///< of these, it was dark on purpose
  int starts = 0;                                              ///< of the rig
  std::map<std::string, std::map<std::string, int>> restarts;  ///< by service and reason
  Latencies latencies;
  std::uint64_t frames = 0, missed_refreshes = 0;
  int visits = 0;  ///< times that hands came
  double hands_s = 0, longest_visit_s = 0;
  std::optional<Drift> drift;  ///< empty: it is not measured
  double disk_free_gb = 0, disk_gb = 0;
  std::vector<Fault> faults;
  std::vector<Event> events;
  /// A letter for each minute: ' ' the rig is down, 'l' lit, 'd' dark, 'f' there was a fault.
  std::string minutes = std::string(24 * 60, ' ');

  /// What a watch that is started again goes on from.
  /// @{
  std::int64_t rig_started_ns = 0;              ///< the rig's start, CLOCK_MONOTONIC
  std::int64_t counted_until = 0;               ///< up to when up_s counts, seconds of Unix time
  std::map<std::string, int> counted;           ///< restarts of the rig that are in `restarts`
  std::optional<bool> lights;                   ///< what the light was told last: on or off
  std::map<std::string, std::int64_t> alerted;  ///< by kind, seconds of Unix time
  /// @}

  /// Adds an event; the oldest is left out if there are too many.
  void note(std::time_t time, std::string text);
  /// The open fault of a kind; null if there is none.
  Fault* open_fault(const std::string& kind);
  /// The day after this one: what is open goes on.
  Day next(const std::string& date) const;
  /// Takes what a watch goes on from over from another day.
  void go_on_from(const Day& before);
};

/// Local times as reports have them.
/// @{
std::string date_of(std::time_t time);        ///< "2026-12-24"
std::string clock_of(std::time_t time);       ///< "18:00:05"
std::size_t minute_of_day(std::time_t time);  ///< 0..1439
bool is_date(const std::string& text);
/// @}

/// The folder of the reports of a rig.
std::filesystem::path folder_of(const config::Watch& settings, std::filesystem::path rig_file);

/// The files of a day.
/// @{
std::filesystem::path json_file(const std::filesystem::path& folder, const std::string& date);
std::filesystem::path page_file(const std::filesystem::path& folder, const std::string& date);
/// @}

std::string to_json(const Day& day);
/// Errors: bad_data (it is no day, or that of a newer handcast).
Result<Day> day_in(const std::string& json);

/// Reads a day; empty if there is none. Errors: unavailable, those of day_in().
Result<std::optional<Day>> load_day(const std::filesystem::path& folder, const std::string& date);
/// The dates that there are, sorted.
std::vector<std::string> dates_in(const std::filesystem::path& folder);
/// Removes all but the newest days.
void keep_days(const std::filesystem::path& folder, int most);

}  // namespace handcast::watch
