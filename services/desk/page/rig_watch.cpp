// SPDX-License-Identifier: Apache-2.0
#include "services/desk/page/rig_watch.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <nlohmann/json.hpp>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/daemon/contract.hpp"
#include "ipc/msg/content_state.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "services/desk/base/low_priority.hpp"
#include "services/desk/page/json_text.hpp"

namespace handcast::desk {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr auto kTurn = 33ms;
constexpr auto kStatusPatience = 200ms;            ///< with a supervisor that hangs
constexpr int kHandsEvery = 3, kStatusEvery = 15;  ///< turns
constexpr std::int64_t kAgesOver_ns = 10'000'000'000;
constexpr std::size_t kMostAges = 2500, kBins = 60;  ///< bins of 1 ms
constexpr std::size_t kMostAtOnce = 500;             ///< messages of a stream in one turn

double rounded(double value) { return std::round(value * 1000) / 1000; }

/// The time between an image and the light that was made from it; empty if the marks do not tell.
std::optional<double> age_ms(const msg::StageMarks& marks) {
  const std::size_t count = std::min<std::size_t>(marks.count, marks.marks.size());
  for (std::size_t i = 0; i < count; ++i) {
    const auto& mark = marks.marks[i];
    if (mark.stage != msg::Stage::light || marks.made_from.image_ns == 0) continue;
    const double age =
        1e-6 * (static_cast<double>(mark.end_ns) - static_cast<double>(marks.made_from.image_ns));
    if (age >= 0 && age < 1e4) return age;
  }
  return std::nullopt;
}

}  // namespace

struct RigWatch::Streams {
  /// A stream that is opened again, but not at once, after the rig or the stream was away.
  template <class T>
  struct Followed {
    std::optional<client::Stream<T>> stream{};
    std::int64_t next_try_ns = 0;

    client::Stream<T>* get(const std::string& rig, std::string_view name) {
      if (stream) return &*stream;
      if (now_ns() < next_try_ns) return nullptr;
      next_try_ns = now_ns() + 2'000'000'000;
      if (auto opened = client::open_stream<T>(rig, name)) stream.emplace(std::move(*opened));
      return stream ? &*stream : nullptr;
    }
    /// Handles an error of the stream.
    void failed(const Error& error) {
      if (error.code != Errc::timeout && error.code != Errc::bad_data) stream.reset();
    }
  };

  Followed<msg::ContentState> content;
  Followed<msg::StageMarks> marks;
  std::deque<std::pair<std::int64_t, double>> ages;  ///< when, and ms
};

RigWatch::RigWatch(const Worked& worked, Board& board)
    : worked_(worked),
      board_(board),
      streams_(std::make_unique<Streams>()),
      thread_([this] { watch(); }) {}

RigWatch::~RigWatch() {
  board_.close();
  thread_.join();
}

void RigWatch::take(const Scene& scene) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (lock) gestures_ = scene.gestures;
}

void RigWatch::watch() {
  run_at_low_priority();
  for (unsigned turn = 0; board_.wait_for_guest(); ++turn) {
    board_.tell(worked_.panel.values());
    if (turn % kHandsEvery == 0) tell_hands(), tell_cues(), tell_midi();
    if (turn % kStatusEvery == 0) {
      tell_status(), tell_content(), tell_ages();
      board_.tell(Topic::recordings, worked_.programs.recordings());
      board_.tell(Topic::doctor, worked_.programs.doctor());
    }
    if (board_.guests() == 0) *streams_ = {};
    if (!board_.pause(kTurn)) return;
  }
}

void RigWatch::tell_hands() {
  std::array<Gesture, msg::kMaxHands> gestures;
  {
    const std::lock_guard lock(mutex_);
    gestures = gestures_;
  }
  auto hands = json::array();
  for (const auto& hand : gestures)
    hands.push_back({{"there", hand.is_there},
                     {"pinch", rounded(hand.pinch)},
                     {"spread", rounded(hand.spread)},
                     {"fist", rounded(hand.fist)},
                     {"palm_up", rounded(hand.palm_up)},
                     {"speed", rounded(hand.speed_m_s)},
                     {"pointing", hand.is_pointing},
                     {"touching", hand.touches_other}});
  board_.tell(Topic::hands, json_text(hands));
}

void RigWatch::tell_cues() {
  if (!worked_.cues) return board_.tell(Topic::cues, "null");
  const auto place = worked_.cues->place();
  board_.tell(Topic::cues, json_text({{"names", place->names},
                                      {"current", place->current},
                                      {"next", place->next},
                                      {"held", place->is_held},
                                      {"faded", std::round(place->faded * 100) / 100}}));
}

void RigWatch::tell_midi() {
  if (!worked_.midi) return board_.tell(Topic::midi, "null");
  const auto state = worked_.midi->state();
  auto bindings = json::array();
  for (const auto& [path, source] : state.bindings)
    bindings.push_back({{"path", path}, {"source", source}});
  board_.tell(Topic::midi, json_text({{"device", state.device},
                                      {"learning", state.learning},
                                      {"bindings", std::move(bindings)}}));
}

void RigWatch::tell_status() {
  board_.tell(Topic::presets, json_text(worked_.panel.presets()));
  const auto answer =
      control::ask_with_descriptors(worked_.rig, {.verb = control::Verb::status}, kStatusPatience);
  board_.tell(Topic::status, answer ? json_text(answer->object.value("status", json::object()))
                                    : json_text({{"fault", answer.error().what}}));
}

void RigWatch::tell_content() {
  auto* stream = streams_->content.get(worked_.rig, "content.state");
  if (!stream) return;
  const auto state = stream->latest(Deadline::now());
  if (!state) return streams_->content.failed(state.error());
  auto hands = json::array();
  for (const auto& hand : (*state)->hands)
    hands.push_back({{"content", std::string(hand.content.view())},
                     {"draw_ms", rounded(hand.draw_ms)},
                     {"fault", std::string(hand.fault.view())}});
  board_.tell(Topic::content, json_text(hands));
}

/// The ages of the light of the last ten seconds, as a histogram.
void RigWatch::tell_ages() {
  auto* stream = streams_->marks.get(worked_.rig, daemon::marks_stream_of("projector"));
  if (!stream) return;
  auto& ages = streams_->ages;
  for (std::size_t i = 0; i < kMostAtOnce; ++i) {
    const auto marks = stream->next(Deadline::now());
    if (!marks) {
      streams_->marks.failed(marks.error());
      break;
    }
    if (const auto age = age_ms(**marks)) ages.emplace_back(now_ns(), *age);
  }
  while (!ages.empty() && (ages.size() > kMostAges || ages.front().first < now_ns() - kAgesOver_ns))
    ages.pop_front();
  std::array<std::size_t, kBins> bins{};
  std::vector<double> sorted;
  for (const auto& [when, age] : ages) {
    ++bins[std::min(static_cast<std::size_t>(age), kBins - 1)];
    sorted.push_back(age);
  }
  std::ranges::sort(sorted);
  const auto at = [&](double share) {
    return sorted.empty() ? json()
                          : json(rounded(sorted[static_cast<std::size_t>(
                                share * static_cast<double>(sorted.size() - 1))]));
  };
  board_.tell(Topic::ages, json_text({{"bins", bins}, {"p50", at(0.5)}, {"p99", at(0.99)}}));
}

}  // namespace handcast::desk
