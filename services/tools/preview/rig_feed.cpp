// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/rig_feed.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/control/choose_rig.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/msg/same_calibration.hpp"
#include "services/tools/preview/status_gauges.hpp"

namespace handcast::preview {
namespace {

using namespace std::chrono_literals;

constexpr std::array kStreams{"camera.frames", "pose.hands", "landmarks.hands"};
constexpr std::array kAgesOf{"image", "tracker", "landmarks"};
constexpr std::int64_t kLate_ns = 100'000'000;  ///< later, the poses of the last look are gone
constexpr auto kPatience = 100ms;               ///< with a supervisor that hangs
constexpr std::size_t kMostAtOnce = 64;         ///< messages of one stream at one look

std::string light_of(config::Viewpoint projector) {
  return config::name_at_projector(projector, "projection.frames");
}

/// `applied`: the settings of the rig, TOML.
Result<World> world_of(const std::string& applied, config::Viewpoint projector) {
  const auto config = config::parse_rig(applied, "applied rig");
  if (!config) return tl::make_unexpected(config.error());
  return load_world(*config, projector);
}

}  // namespace

void RigFeed::learn_world() {
  auto applied = control::ask_for_rig(rig_);
  auto world = applied.and_then([&](const auto& text) { return world_of(text, projector_); });
  if (applied) applied_ = std::move(*applied);
  no_world_ = world ? "" : world.error().what;
  maker_ = std::make_unique<SceneMaker>(world ? std::optional(std::move(*world)) : std::nullopt);
  board_.reset();
  if (auto board = config::LiveBoard::open(rig_)) board_.emplace(std::move(*board));
  dimmed_by_.reset();
  learn_light();
}

/// What dims the light on its way out, which the frames in the ring do not have.
void RigFeed::learn_light() {
  if (!board_) return;
  const auto last = board_->now();
  if (!last || dimmed_by_ == last->header.frame_id) return;
  dimmed_by_ = last->header.frame_id;
  const auto rig = board_->rig_now();
  if (!rig) return;
  dark_ = config::why_dark(rig->light);
  const double full = config::rig_at_projector(*rig, projector_).projector.brightness;
  maker_->set_brightness(dark_.empty() ? full * rig->light.master : 0);
}

/// A reload may have applied other settings, e.g. another brightness.
void RigFeed::learn_changes() {
  const auto now = now_ns();
  if (now < next_change_ns_) return;
  next_change_ns_ = now + kChange_ns;
  const auto answer = control::ask_with_descriptors(rig_, {.verb = control::Verb::rig}, kPatience);
  if (!answer) return;
  const auto text = answer->object.find("rig");
  if (text != answer->object.end() && text->is_string() && *text != applied_) learn_world();
}

template <class T>
Result<void> RigFeed::open_input(std::string_view name, Input<T>& input) {
  auto stream = client::open_stream<T>(rig_, name);
  if (!stream) return tl::make_unexpected(std::move(stream.error()));
  input.stream.emplace(std::move(*stream));
  return {};
}

Result<RigFeed> RigFeed::open(const std::string& rig, config::Viewpoint projector) {
  const auto chosen = control::choose_rig(rig);
  if (!chosen) return tl::make_unexpected(chosen.error());
  RigFeed feed(*chosen, projector);
  const std::array opened{feed.open_input(kStreams[0], feed.camera_),
                          feed.open_input(kStreams[1], feed.poses_),
                          feed.open_input(kStreams[2], feed.landmarks_),
                          feed.open_input(light_of(projector), feed.light_)};
  std::size_t absent = 0;
  for (const auto& each : opened) {
    if (each) continue;
    if (each.error().code != Errc::bad_config) return tl::make_unexpected(each.error());
    feed.missing_.push_back(each.error().what);
    ++absent;
  }
  if (absent == opened.size()) return tl::make_unexpected(opened.front().error());
  feed.learn_world();
  if (projector == config::Viewpoint::second && !feed.no_world_.empty())
    return fail(Errc::bad_config, feed.no_world_);
  feed.next_rate_ns_ = now_ns();
  return feed;
}

/// Nothing new, or one unusable message, is no reason to end.
static Result<void> tolerated(Error error) {
  if (error.code == Errc::timeout || error.code == Errc::bad_data) return {};
  return tl::make_unexpected(std::move(error));
}

Result<void> RigFeed::take_pair() {
  if (light_.stream) {
    auto light = light_.stream->latest(Deadline::now());
    if (!light) {
      if (auto well = tolerated(std::move(light.error())); !well) return well;
    } else {
      light_.meter.saw(light->sequence(), (*light)->header.published_ns);
      take_ages(**light);
      newest_.projection.emplace(std::move(*light));
    }
  }
  if (!camera_.stream) return {};
  // Asks for the newest image as well: only that tells whether the rig is up.
  auto frame = camera_.stream->latest(Deadline::now());
  if (!frame) return tolerated(std::move(frame.error()));
  camera_.meter.saw(frame->sequence(), (*frame)->header.published_ns);
  if (newest_.projection && (*newest_.projection)->made_from.image_ns != 0)
    if (auto same = camera_.stream->at((*newest_.projection)->made_from.image_ns)) {
      newest_.frame.emplace(std::move(*same));
      return {};
    }
  newest_.frame.emplace(std::move(*frame));
  return {};
}

template <class T>
Result<void> RigFeed::take_all(Input<T>& input) {
  if (!input.stream) return {};
  for (std::size_t i = 0; i < kMostAtOnce; ++i) {
    auto message = input.stream->next(Deadline::now());
    if (!message) return tolerated(std::move(message.error()));
    input.meter.saw(message->sequence(), (*message)->header.published_ns);
    maker_->push(**message);
  }
  return {};
}

double RigFeed::age_period_s() const {
  if (age_times_.size() < 2) return ns_to_seconds(kPeriod_ns);
  return ns_to_seconds(age_times_.back() - age_times_.front()) /
         static_cast<double>(age_times_.size() - 1);
}

void RigFeed::take_ages(const msg::Projection& projection) {
  age_times_.push_back(now_ns());
  if (age_times_.size() > kAges) age_times_.pop_front();
  const auto& from = projection.made_from;
  const std::int64_t light_ns = projection.lit_ns != 0 ? projection.lit_ns : projection.target_ns;
  constexpr double kMost_ms = 1e4;
  const std::array origins{from.image_ns, from.pose_ns, from.landmarks_ns};
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const double age_ms = 1e-6 * (static_cast<double>(light_ns) - static_cast<double>(origins[i]));
    if (origins[i] != 0 && std::abs(age_ms) < kMost_ms) ages_ms_[i].add(static_cast<float>(age_ms));
  }
}

void RigFeed::take_rates() {
  const auto now = now_ns();
  if (now < next_rate_ns_ + kRate_ns) return;
  next_rate_ns_ = std::max(next_rate_ns_ + kRate_ns, now - kRate_ns);
  const auto take = [](auto& input) {
    if (!input.stream) return;
    const auto hz = static_cast<float>(input.meter.take_hz());
    if (hz > 0 || !input.held_hz.values().empty()) input.held_hz.add(hz);  // not before the start
  };
  take(camera_), take(poses_), take(landmarks_), take(light_);
  ask_status();
  learn_changes();
  // The rig was reloaded with another calibration.
  if (newest_.frame && !msg::check_calibration(**newest_.frame, maker_->calibration()))
    learn_world();
}

void RigFeed::ask_status() {
  const auto answer =
      control::ask_with_descriptors(rig_, {.verb = control::Verb::status}, kPatience);
  silent_ = answer ? "" : answer.error().what;
  if (answer) status_ = answer->object.value("status", nlohmann::json());
}

Result<void> RigFeed::look() {
  const auto now = now_ns();
  const bool in_time = now - looked_ns_ < kLate_ns;
  looked_ns_ = now;
  shown_ = std::exchange(newest_, {});
  if (auto well = take_pair(); !well) return well;
  // A rig that sends nothing new is shown as it was.
  if (!newest_.projection) newest_.projection = std::exchange(shown_.projection, {});
  if (!newest_.frame) newest_.frame = std::exchange(shown_.frame, {});
  if (!in_time) shown_ = {};
  if (auto well = take_all(poses_); !well) return well;
  if (auto well = take_all(landmarks_); !well) return well;
  take_rates();
  learn_light();
  return {};
}

Scene RigFeed::scene() {
  auto& projection = shown_.projection ? shown_.projection : newest_.projection;
  auto& frame = shown_.frame ? shown_.frame : newest_.frame;
  auto scene = maker_->make(frame ? &**frame : nullptr, projection ? &**projection : nullptr);
  if (!no_world_.empty())
    scene.missing.insert(scene.missing.begin(), "only images are shown: " + no_world_);
  if (!dark_.empty()) scene.missing.insert(scene.missing.begin(), "the light is off: " + dark_);
  scene.missing.insert(scene.missing.begin(), missing_.begin(), missing_.end());
  return scene;
}

Gauges RigFeed::gauges() const {
  Gauges gauges{
      .rig = rig_, .rates_period_s = ns_to_seconds(kRate_ns), .ages_period_s = age_period_s()};
  if (!silent_.empty()) gauges.ill.push_back(silent_);
  read_status(status_, projector_, gauges);
  const auto add = [&](const std::string& name, const auto& input) {
    if (input.stream)
      gauges.rates.push_back({name, wanted_hz(status_, name), input.held_hz.values()});
  };
  add(kStreams[0], camera_), add(kStreams[1], poses_), add(kStreams[2], landmarks_);
  add(light_of(projector_), light_);
  for (std::size_t i = 0; i < ages_ms_.size(); ++i)
    gauges.ages.push_back({kAgesOf[i], ages_ms_[i].values()});
  return gauges;
}

}  // namespace handcast::preview
