// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>

#include "services/desk/base/panel.hpp"

namespace handcast::desk {

/// What open pages are told about, besides the values of the controls.
enum class Topic : std::uint8_t {
  status,
  content,
  ages,
  hands,
  cues,
  presets,
  midi,
  recordings,
  doctor,
  calibration,
  cue_list
};
inline constexpr std::size_t kTopics = 11;  ///< number of topics
/// The names of their events.
inline constexpr std::array<std::string_view, kTopics> kTopicNames{
    "status", "content",    "ages",   "hands",       "cues",    "presets",
    "midi",   "recordings", "doctor", "calibration", "cue_list"};

/// The newest of everything that open pages are told, from the threads that watch the rig to those
/// of the connections. A page that is slow misses what is in between: nothing queues up. Any
/// thread.
class Board {
 public:
  /// What one page has seen.
  struct Seen {
    std::array<std::uint64_t, kTopics> topics{};
    std::shared_ptr<const Values> values;
  };
  /// A page that is open, from its construction to its destruction.
  class Guest {
   public:
    explicit Guest(Board& board);
    ~Guest();
    Guest(const Guest&) = delete;
    Guest& operator=(const Guest&) = delete;

   private:
    Board& board_;
  };

  /// `controls`: those of the values.
  explicit Board(std::span<const Control> controls) : controls_(controls) {}

  /// Tells something: JSON on one line. The same text as before is no news.
  void tell(Topic topic, std::string json);
  void tell(std::shared_ptr<const Values> values);
  /// Ends all waits, now and later.
  void close();

  /// Appends to `events` what a page has not seen, as server-sent events; waits for some at most
  /// `patience`. False: the board is closed.
  bool wait(Seen& seen, std::string& events, std::chrono::milliseconds patience);

  /// Waits until a page is open. False: the board is closed.
  bool wait_for_guest();
  /// Waits for a time. False: the board is closed.
  bool pause(std::chrono::milliseconds span);
  /// Number of open pages.
  int guests() const;

 private:
  bool has_news(const Seen& seen) const;
  void append_values(const Seen& seen, std::string& events) const;

  std::span<const Control> controls_;
  mutable std::mutex mutex_;
  std::condition_variable news_, arrivals_;
  std::array<std::string, kTopics> texts_;
  std::array<std::uint64_t, kTopics> counts_{};
  std::shared_ptr<const Values> values_;
  int guests_ = 0;
  bool is_closed_ = false;
};

}  // namespace handcast::desk
