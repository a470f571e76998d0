// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <ctime>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "config/opening_hours.hpp"
#include "config/rig.hpp"
#include "services/watch/black_box.hpp"
#include "services/watch/errands.hpp"
#include "services/watch/fault_book.hpp"
#include "services/watch/lights.hpp"
#include "services/watch/tally.hpp"
#include "services/watch/tracks.hpp"

namespace handcast::watch {

/// A moment by both clocks.
struct Moment {
  std::int64_t ns = 0;   ///< CLOCK_MONOTONIC
  std::time_t time = 0;  ///< Unix time

  static Moment now();
};

/// Looks after a rig: light by the opening hours, the report of the day, alerts, black boxes. One
/// thread.
class NightWatch {
 public:
  /// What it works with.
  struct Rig {
    config::Rig settings;     ///< as its file has them
    std::string calibration;  ///< the text of its file; empty: unknown
    std::int64_t started_ns = 0;
    /// The ring of a stream.
    std::function<Result<ipc::Segment>(std::string_view)> ring;
  };

  /// Errors: bad_config (watch.hours), unavailable (the folder cannot be made).
  static Result<std::unique_ptr<NightWatch>> open(Rig rig, Lights lights, Moment now);

  /// Looks; call it 20 times a second.
  void turn(Moment now);
  /// Writes the report for the last time.
  void stop(Moment now);

 private:
  NightWatch(Rig rig, Lights lights, config::OpeningHours hours, std::filesystem::path folder,
             Day day, Moment now);

  void look(Moment now);
  void follow_hours(Moment now);
  void follow_changes(Moment now);
  void ask_supervisor(Moment now);
  void track(const std::string& stream);
  void tell(const FaultBook::Notice& notice, Moment now);
  void alert(const std::string& text);
  void give_up(Moment now);
  std::string keep_box(const FaultBook::Notice& notice, Moment now);
  enum class Lasting { minute, day };
  void save(Lasting lasting);

  Rig rig_;
  const config::Watch& settings_;
  Lights lights_;
  config::OpeningHours hours_;
  std::filesystem::path folder_;
  Day day_;
  Tally tally_;
  FaultFinder finder_;
  FaultBook book_;
  Errands errands_;
  BlackBoxes boxes_;
  std::vector<std::pair<std::string, std::unique_ptr<Track>>> tracks_;  ///< by stream
  bool gives_up_ = false;
  std::set<std::string> tracked_;  ///< streams, also those that cannot be
  struct Note {
    std::int64_t time_ns;
    std::string text;
  };
  std::deque<Note> changes_;  ///< of settings, of the last seconds
  std::int64_t next_look_ns_ = 0, next_save_ns_ = 0, next_try_ns_ = 0;
};

}  // namespace handcast::watch
