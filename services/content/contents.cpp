// SPDX-License-Identifier: Apache-2.0
#include "services/content/contents.hpp"

#include <algorithm>
#include <utility>

#include "config/live/live_values.hpp"
#include "ipc/base/clock.hpp"

namespace handcast::content {
namespace {

constexpr std::array kSides{Side::left, Side::right};

Opening opening_for(Side side, const Hands& hands, const config::Content& settings,
                    const calib::Calibration& calibration) {
  Opening opening;
  opening.width = settings.width_px;
  opening.height = settings.height_px;
  opening.meshes = hands.meshes();
  opening.side = side;
  opening.calibration = &calibration;
  opening.sound = settings.sound;
  return opening;
}

/// What a ring gives at once; empty, and tolerated if it is an error, if that is nothing.
template <class T>
std::optional<T> given(Result<T> result, const std::function<void(const Error&)>& tolerate) {
  if (result) return std::move(*result);
  if (result.error().code != Errc::timeout) tolerate(result.error());
  return std::nullopt;
}

}  // namespace

Contents::Contents(Hands hands, const config::Rig& filed, const calib::Calibration& calibration,
                   Streams streams, const ipc::OpenRing& ring,
                   std::function<void(const Error&)> tolerate, std::function<void()> beat)
    : filed_(filed),
      hands_(std::move(hands)),
      calibration_(calibration),
      streams_(std::move(streams)),
      tolerate_(std::move(tolerate)),
      beat_(std::move(beat)) {
  for (const Side side : kSides) {
    auto like = opening_for(side, hands_, filed.content, calibration);
    like.ring = ring;
    worn_.emplace_back(std::move(like), filed.content,
                       std::move(streams_.pictures[static_cast<std::size_t>(side)]));
  }
}

void Contents::start(const std::optional<msg::ContentState>& before) {
  const auto live = take_change();
  if (live) hands_.adjust(live->rig);
  for (auto& worn : worn_)
    if (live) worn.adjust(live->rig.content);
  std::array<std::string, 2> first;
  for (std::size_t i = 0; i < worn_.size(); ++i) {
    first[i] = worn_[i].content_of_settings();
    if (before && !before->hands[i].trying.view().empty()) {
      worn_[i].distrust(before->hands[i].trying.view());
      if (const auto shown = before->hands[i].content.view(); !shown.empty()) first[i] = shown;
    }
    worn_[i].announce(first[i]);
  }
  publish_state();
  for (std::size_t i = 0; i < worn_.size(); ++i) {
    worn_[i].start(first[i]);
    if (first[i] != worn_[i].content_of_settings()) worn_[i].obey({"cut", 0});
    worn_[i].trust();
    if (live) worn_[i].took(live->settings.header.frame_id);
  }
}

bool Contents::obey_until(std::int64_t time_ns) {
  if (!streams_.live.await(Deadline::at_ns(time_ns))) return false;
  const auto live = take_change();
  if (live) obey(*live);
  return live.has_value();
}

/// The newest live settings, if they are new and fit to the file.
std::optional<service::LiveRig> Contents::take_change() {
  const auto settings = given(streams_.live.latest(Deadline::now()), tolerate_);
  if (!settings) return std::nullopt;
  auto rig = given(config::with_live(filed_, (*settings)->values.view()), tolerate_);
  if (!rig) return std::nullopt;
  return service::LiveRig{std::move(*rig), **settings};
}

/// A content that the change names is shown again, also if it was refused before. What is begun is
/// announced before, because it may end this process.
void Contents::obey(const service::LiveRig& live) {
  const auto& settings = live.settings;
  hands_.adjust(live.rig);
  std::vector<HandContent*> begun;
  for (auto& worn : worn_) {
    const bool is_named = settings.change.view().find(worn.setting()) != std::string_view::npos;
    if (worn.adjust(live.rig.content) || is_named) begun.push_back(&worn);
  }
  for (auto* worn : begun) worn->announce(worn->content_of_settings());
  if (!begun.empty()) publish_state();
  for (auto* worn : begun) {
    worn->obey({std::string(settings.transition.view()), settings.transition_s});
    beat_();
  }
  for (auto& worn : worn_) worn.took(settings.header.frame_id);
}

void Contents::take_poses() {
  while (streams_.poses.await(Deadline::now())) {
    const auto sample = given(streams_.poses.next(Deadline::now()), tolerate_);
    if (!sample) return;
    hands_.push(**sample);
  }
}

/// The newest image, without the hands that it shows; empty if no content needs it.
std::optional<CameraView> Contents::newest_view(bool is_needed) {
  if (!is_needed) image_.reset();
  if (!is_needed) return std::nullopt;
  if (auto newest = given(streams_.images.latest(Deadline::now()), tolerate_))
    image_ = std::move(*newest);
  if (!image_) return std::nullopt;
  const msg::CameraFrame& frame = **image_;
  const auto width = static_cast<int>(frame.width_px);
  return CameraView{{{frame.pixels(), width, static_cast<int>(frame.height_px), width},
                     frame.header.origin_ns,
                     frame.header.frame_id},
                    &calibration_.camera};
}

void Contents::draw(std::int64_t time_ns) {
  take_poses();
  Needs needs;
  for (const auto& worn : worn_) needs |= worn.needs();
  hands_.needs_surface(needs.surface || needs.camera);
  const auto hands = hands_.at(time_ns);
  auto view = newest_view(needs.camera);
  BothHands seen;
  if (view) seen = hands_.seen_at(view->image.origin_ns);
  for (std::size_t i = 0; i < worn_.size(); ++i) {
    if (!hands[i].is_there && !worn_[i].is_due()) continue;
    if (view) {
      view->hand = &seen[i];
      view->other = &seen[1 - i];
    }
    worn_[i].draw(hands[i], hands[1 - i], time_ns, view ? &*view : nullptr);
    beat_();
  }
}

void Contents::publish_state() {
  auto state = streams_.states.loan();
  if (!state) return;
  state->header.frame_id = ++published_;
  state->header.origin_ns = now_ns();
  for (std::size_t i = 0; i < worn_.size(); ++i) state->hands[i] = worn_[i].state();
  streams_.states.publish(std::move(state));
}

Result<void> check_contents(const Hands& hands, const config::Content& settings,
                            const calib::Calibration& calibration,
                            const std::optional<msg::ContentState>& known) {
  for (const Side side : kSides) {
    const bool is_left = side == Side::left;
    const auto& text = is_left ? settings.left : settings.right;
    if (known && known->hands[static_cast<std::size_t>(side)].settings.view() == text) continue;
    const auto* const name = is_left ? "content.left" : "content.right";
    const auto written = config::parse_content(text);
    if (!written) return fail_in(name, written.error());
    const auto chain = Chain::open(*written, opening_for(side, hands, settings, calibration));
    if (!chain && chain.error().code == Errc::bad_config) return fail_in(name, chain.error());
  }
  return {};
}

}  // namespace handcast::content
