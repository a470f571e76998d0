// SPDX-License-Identifier: Apache-2.0
#include "services/content/mixer.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <ctime>
#include <utility>

#include "ipc/base/quote.hpp"

namespace handcast::content {
namespace {

/// Sets the date and the time of the day.
void set_date(Moment& moment) {
  const auto now = std::chrono::system_clock::now();
  const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
  const std::chrono::duration<double> part = now - std::chrono::system_clock::from_time_t(seconds);
  ::localtime_r(&seconds, &moment.date);
  moment.day_s =
      moment.date.tm_hour * 3600. + moment.date.tm_min * 60. + moment.date.tm_sec + part.count();
}

Result<std::unique_ptr<Source>> open_transition(std::string_view written, Opening like,
                                                const OpenSource& open) {
  auto chain = config::parse_content(written);
  if (!chain) return tl::make_unexpected(chain.error());
  like.element = chain->front();
  auto source = open(like);
  if (source && (chain->size() > 1 || (*source)->inputs() != 2))
    return fail(Errc::bad_config,
                fmt::format("{} is no transition; use \"cut\", \"fade\" or one source of two "
                            "pictures",
                            quote(written)));
  return source;
}

bool is_passing(Errc code) { return code == Errc::bad_data || code == Errc::timeout; }

}  // namespace

Mixer::Mixer(Opening like, OpenSource open_source)
    : like_(std::move(like)),
      open_source_(std::move(open_source)),
      between_(like_.width, like_.height) {}

Result<void> Mixer::change(Chain next, std::string_view transition, double seconds) {
  std::unique_ptr<Source> opened;
  if (transition != "cut" && transition != "fade") {
    auto source = open_transition(transition, like_, open_source_);
    if (!source) return fail_in("transition", source.error());
    opened = std::move(*source);
  }
  if (next_ && began_s_) {
    frozen_ = between_;
    now_ = std::move(next_);
  }
  next_ = Shown{std::move(next), renderer::Texture(like_.width, like_.height)};
  transition_ = std::move(opened);
  seconds_ = transition == "cut" ? 0 : seconds;
  began_s_.reset();
  return {};
}

Result<bool> Mixer::draw(const HandState& hand, const HandState& other, double time_s,
                         const CameraView* camera) {
  Moment moment;
  moment.camera = camera;
  moment.hand = &hand;
  moment.other = &other;
  set_date(moment);
  if (next_) return draw_change(moment, time_s);
  return now_ ? draw(*now_, moment, time_s) : false;
}

Result<bool> Mixer::draw(Shown& shown, Moment moment, double time_s) {
  if (shown.calls == 0) shown.opened_s = time_s;
  moment.time_s = time_s - shown.opened_s;
  if (shown.calls > 0) moment.step_s = time_s - shown.drawn_s;
  moment.frame = shown.calls++;
  shown.drawn_s = time_s;
  return shown.chain.draw(moment, shown.picture);
}

Result<bool> Mixer::draw_change(const Moment& moment, double time_s) {
  const auto drew = draw(*next_, moment, time_s);
  if (!drew && !is_passing(drew.error().code)) {
    next_.reset();
    end_change();
    if (now_) (void)draw(*now_, moment, time_s);
    return drew;
  }
  if (!std::exchange(began_s_, began_s_.value_or(time_s))) between_count_ = 0;
  const double passed_s = time_s - *began_s_;
  Result<void> done;
  if (!drew) done = tl::make_unexpected(drew.error());
  if (passed_s >= seconds_) {
    now_ = std::exchange(next_, std::nullopt);
    end_change();
  } else {
    if (now_ && !frozen_)
      if (auto old = draw(*now_, moment, time_s); !old) done = tl::make_unexpected(old.error());
    // Until the first chain there is nothing below, which is what `frozen_` is then.
    if (!now_ && !frozen_) frozen_.emplace(like_.width, like_.height);
    const auto& from = frozen_ ? *frozen_ : now_->picture;
    if (auto between = draw_between(from.view(), moment, time_s); !between) done = between;
  }
  if (!done) return tl::make_unexpected(done.error());
  return true;
}

Result<void> Mixer::draw_between(Pixels from, Moment moment, double time_s) {
  const Pixels to = std::as_const(next_->picture).view();
  moment.time_s = time_s - *began_s_;
  moment.progress = moment.time_s / seconds_;
  if (between_count_ > 0) moment.step_s = time_s - between_s_;
  moment.frame = between_count_++;
  between_s_ = time_s;
  Result<void> done;
  if (transition_) {
    const auto drew = transition_->draw(moment, std::array{from, to}, between_);
    if (drew) return {};
    transition_.reset();
    done = fail_in("transition", drew.error());
  }
  fade(from, to, moment.progress, between_);
  return done;
}

void Mixer::end_change() {
  frozen_.reset();
  transition_.reset();
  began_s_.reset();
}

const renderer::Texture& Mixer::picture() const {
  if (next_ && began_s_) return between_;
  if (frozen_) return *frozen_;
  return now_ ? now_->picture : between_;
}

Chain* Mixer::chain() {
  if (next_) return &next_->chain;
  return now_ ? &now_->chain : nullptr;
}

Needs Mixer::needs() const {
  Needs all;
  for (const auto* shown : {&now_, &next_})
    if (*shown) all |= (*shown)->chain.needs();
  if (transition_) all |= transition_->needs();
  return all;
}

}  // namespace handcast::content
