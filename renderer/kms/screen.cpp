// SPDX-License-Identifier: Apache-2.0
#include "renderer/kms/screen.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <pthread.h>
#include <xf86drm.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <utility>

#include "ipc/base/log.hpp"
#include "renderer/kms/card.hpp"

namespace handcast::renderer::kms {

namespace {

using namespace std::chrono_literals;

constexpr auto kLastFlip = 200ms;  ///< longest wait for a flip before the picture is changed back
constexpr auto kHang = 2s;         ///< a card that takes longer for a flip hangs
constexpr auto kRetry = 500ms;     ///< time between two attempts to light a display

/// Waits until the card has an event.
bool has_event(int card, Deadline deadline) {
  const std::int64_t left_ns = std::max<std::int64_t>(deadline.time_ns() - now_ns(), 0);
  const timespec left{left_ns / 1'000'000'000, left_ns % 1'000'000'000};
  pollfd event{card, POLLIN, 0};
  return ppoll(&event, 1, &left, nullptr) == 1 && (event.revents & POLLIN) != 0;
}

Error why_not_flipped(int number, const Display& display) {
  const bool may_come = number == EBUSY || number == EINTR || number == ENOMEM;
  return {may_come ? Errc::timeout : Errc::disconnected,
          fmt::format("'{}' refuses a picture for '{}': {}", display.card, display.connector,
                      std::strerror(number))};
}

}  // namespace

PlugWatch::PlugWatch(int card, std::uint32_t connector_id)
    : thread_([this, card, connector_id](const std::stop_token& stop) {
        const sched_param none{};
        pthread_setschedparam(pthread_self(), SCHED_OTHER, &none);  // the daemon may be real-time
        std::mutex mutex;
        std::condition_variable_any stopped;
        std::unique_lock lock(mutex);
        while (!stopped.wait_for(lock, stop, std::chrono::milliseconds(250),
                                 [&] { return stop.stop_requested(); }))
          is_plugged_ = kms::is_plugged(card, connector_id);
      }) {}

Screen::Screen(ScreenSettings settings, UniqueFd card, Display display)
    : settings_(std::move(settings)), card_(std::move(card)), display_(std::move(display)) {}

Result<std::unique_ptr<Screen>> Screen::open(ScreenSettings settings) {
  auto found = find_display(settings.card, settings.connector);
  if (!found) return tl::make_unexpected(found.error());
  std::unique_ptr<Screen> screen(
      new Screen(std::move(settings), std::move(found->card), std::move(found->display)));
  if (auto ready = screen->prepare(); !ready) return tl::make_unexpected(ready.error());
  if (auto lit = screen->light_up(); !lit) return tl::make_unexpected(lit.error());
  return screen;
}

Result<void> Screen::prepare() {
  if (auto chosen = choose_mode(); !chosen) return chosen;
  if (auto ours = take_control(card_.get(), display_.card); !ours) return ours;
  auto pipe = find_pipe(card_.get(), display_);
  if (!pipe) return tl::make_unexpected(pipe.error());
  pipe_ = std::move(*pipe);
  former_ = Former(card_.get(), pipe_);
  for (auto& buffer : buffers_) {
    auto created =
        Buffer::create(card_.get(), settings_.width_px, settings_.height_px, pipe_.order);
    if (!created) return fail_in(display_.card, created.error());
    buffer = std::move(*created);
  }
  watch_ = std::make_unique<PlugWatch>(card_.get(), display_.connector_id);
  return {};
}

Result<void> Screen::choose_mode() {
  const auto chosen = kms::choose_mode(
      display_.modes, settings_.mode, {settings_.width_px, settings_.height_px, settings_.rate_hz});
  if (!chosen) return fail_in(fmt::format("display {}", describe(display_)), chosen.error());
  mode_ = display_.modes[*chosen];
  if (is_scaled() && !settings_.may_scale)
    return fail(
        Errc::bad_config,
        fmt::format("display {}: the mode {} must have the {}x{} pixels of the picture, "
                    "because projector.packing is set: sub-frames cannot be scaled",
                    describe(display_), describe(mode_), settings_.width_px, settings_.height_px));
  refresh_ns_ = seconds_to_ns(1 / mode_.rate_hz);
  mode_blob_ = Blob(card_.get(), &mode_.timing, sizeof mode_.timing);
  return {};
}

/// Adds what gives the display its mode and the front buffer, without what may lie above the
/// picture (the cursor) and without a colour table.
void Screen::add_light(Request& request) const {
  const auto& [connector, crtc, plane, others, order] = pipe_;
  request.set(connector, "CRTC_ID", crtc.id());
  request.set(connector, "link-status", DRM_MODE_LINK_STATUS_GOOD);  // trains a lost link again
  request.set(crtc, "MODE_ID", mode_blob_.id());
  request.set(crtc, "ACTIVE", 1);
  for (const auto* table : {"VRR_ENABLED", "GAMMA_LUT", "DEGAMMA_LUT", "CTM"})
    request.set(crtc, table, 0);
  for (const auto& other : others) {
    request.set(other, "FB_ID", 0);
    request.set(other, "CRTC_ID", 0);
  }
  request.set(plane, "FB_ID", buffers_[front_]->id());
  request.set(plane, "CRTC_ID", crtc.id());
  for (const auto& [name, value] :
       {std::pair("SRC_X", 0), std::pair("SRC_Y", 0), std::pair("CRTC_X", 0),
        std::pair("CRTC_Y", 0), std::pair("SRC_W", settings_.width_px << 16),
        std::pair("SRC_H", settings_.height_px << 16), std::pair("CRTC_W", mode_.width_px),
        std::pair("CRTC_H", mode_.height_px)})
    request.set(plane, name, static_cast<std::uint64_t>(value));
}

Error Screen::why_not_lit(int number) const {
  return {Errc::unavailable,
          fmt::format("'{}' refuses the mode {} for '{}'{}: {}; choose another projector.kms.mode",
                      display_.card, describe(mode_), display_.connector,
                      is_scaled() ? fmt::format(" with the picture of {}x{} pixels scaled",
                                                settings_.width_px, settings_.height_px)
                                  : "",
                      std::strerror(number))};
}

Result<void> Screen::light_up() {
  Request request;
  add_light(request);
  if (const int number = request.commit(card_.get(), DRM_MODE_ATOMIC_ALLOW_MODESET); number != 0)
    return tl::make_unexpected(why_not_lit(number));
  is_on_ = has_changed_ = true;
  last_.reset();
  log::info("light on '{}' of '{}'{}, mode {}", display_.connector, display_.card,
            display_.model.empty() ? "" : " (" + display_.model + ")", describe(mode_));
  if (is_scaled())
    log::warning(
        "the mode {} has another size than the calibration, {}x{}, so the picture is scaled",
        describe(mode_), settings_.width_px, settings_.height_px);
  return {};
}

/// Switches the connector off, so that a display that is plugged in is not lit in a wrong mode.
void Screen::go_dark() {
  (void)await_flip(Deadline::in(kLastFlip));
  Request request;
  request.set(pipe_.connector, "CRTC_ID", 0);
  request.set(pipe_.crtc, "ACTIVE", 0);
  request.set(pipe_.crtc, "MODE_ID", 0);
  request.set(pipe_.plane, "FB_ID", 0);
  request.set(pipe_.plane, "CRTC_ID", 0);
  if (const int number = request.commit(card_.get(), DRM_MODE_ATOMIC_ALLOW_MODESET); number != 0)
    log::warning("'{}' cannot be switched off: {}", display_.connector, std::strerror(number));
  is_on_ = is_flipping_ = false;
}

/// Lights the display that is plugged in again, which may be another one.
Result<void> Screen::come_back() {
  if (now_ns() < retry_ns_)
    return fail(Errc::timeout, fmt::format("display '{}' cannot be lit", display_.connector));
  retry_ns_ = now_ns() + to_ns(kRetry);
  display_ = display_at(card_.get(), display_.card, display_.connector_id);
  if (auto chosen = choose_mode(); !chosen) return fail(Errc::timeout, chosen.error().what);
  if (auto lit = light_up(); !lit) return fail(Errc::timeout, lit.error().what);
  return {};
}

Screen::~Screen() {
  watch_.reset();
  if (!has_changed_) return;
  (void)await_flip(Deadline::in(kLastFlip));
  if (former_.restore(card_.get()) != 0) go_dark();  // the former picture is gone
}

Result<void> Screen::await_flip(Deadline deadline) {
  drmEventContext context{};
  context.version = 3;
  context.page_flip_handler2 = [](int, unsigned sequence, unsigned seconds, unsigned microseconds,
                                  unsigned, void* data) {
    auto& screen = *static_cast<Screen*>(data);
    screen.last_ = {seconds * std::int64_t{1'000'000'000} + microseconds * std::int64_t{1000},
                    sequence};
    screen.is_flipping_ = false;
  };
  while (is_flipping_) {
    if (!has_event(card_.get(), deadline))
      return now_ns() - handed_ns_ > to_ns(kHang)
                 ? fail(Errc::disconnected, fmt::format("'{}' has stopped to show pictures on '{}'",
                                                        display_.card, display_.connector))
                 : fail(Errc::timeout, fmt::format("'{}' has not shown the last picture until the "
                                                   "deadline",
                                                   display_.connector));
    if (drmHandleEvent(card_.get(), &context) != 0)
      return fail(Errc::disconnected, fmt::format("'{}' is gone", display_.card));
  }
  return {};
}

/// Lets the card change the buffers at the next refresh.
Result<void> Screen::commit_flip() {
  const std::int64_t handed_ns = now_ns();
  Request request;
  request.set(pipe_.plane, "FB_ID", buffers_[1 - front_]->id());
  const int number =
      request.commit(card_.get(), DRM_MODE_PAGE_FLIP_EVENT | DRM_MODE_ATOMIC_NONBLOCK, this);
  if (number != 0) return tl::make_unexpected(why_not_flipped(number, display_));
  is_flipping_ = true;
  handed_ns_ = handed_ns;
  front_ = 1 - front_;
  return {};
}

Result<Flip> Screen::show(View<const std::uint32_t> picture, Rect region, Deadline deadline) {
  if (!watch_->is_plugged()) {
    if (is_on_) log::warning("display '{}' is unplugged", display_.connector);
    if (is_on_) go_dark();
    return fail(Errc::timeout, fmt::format("display '{}' is unplugged", display_.connector));
  }
  if (!is_on_)
    if (auto lit = come_back(); !lit) return tl::make_unexpected(lit.error());
  if (deadline.passed())
    return fail(Errc::timeout, fmt::format("'{}' was still busy with the last picture at the "
                                           "deadline",
                                           display_.connector));
  if (auto free = await_flip(deadline); !free) return tl::make_unexpected(free.error());
  buffers_[1 - front_]->draw(picture, region);

  const auto before = last_;
  if (auto committed = commit_flip(); !committed) return tl::make_unexpected(committed.error());
  if (auto shown = await_flip(deadline); !shown) return tl::make_unexpected(shown.error());
  return Flip{handed_ns_, last_->time_ns, before ? last_->sequence - before->sequence : 0};
}

}  // namespace handcast::renderer::kms
