// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/show.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "services/lab/gallery/lit_skin.hpp"
#include "services/tools/preview/canvas/canvas.hpp"

namespace handcast::study {
namespace {

constexpr auto kInk = preview::Colour::of(0xdfe3e8), kPaper = preview::Colour::of(0x07080a);
constexpr double kTooLate = 0.5;  ///< periods: a frame that is this late was in another refresh
constexpr int kBrush_px = 14;

void press(renderer::Image<std::uint8_t>& marks, const renderer::PointerEvent& at) {
  const int cx = static_cast<int>(at.x_px), cy = static_cast<int>(at.y_px);
  for (int y = std::max(0, cy - kBrush_px); y < std::min(marks.height(), cy + kBrush_px); ++y)
    for (int x = std::max(0, cx - kBrush_px); x < std::min(marks.width(), cx + kBrush_px); ++x)
      if (std::hypot(x - cx, y - cy) < kBrush_px) marks.at(x, y) = 255;
}

}  // namespace

bool has_waited(std::span<const std::int64_t> shown_ns, std::int64_t refresh_ns) {
  constexpr double kFastest = 0.7, kLeastPhase = 0.7;
  const auto count = static_cast<double>(shown_ns.size()),
             refreshes = static_cast<double>(shown_ns.back() - shown_ns.front()) /
                         static_cast<double>(refresh_ns);
  if (refreshes < kFastest * (count - 1)) return false;
  std::complex<double> phase;
  for (const auto shown : shown_ns)
    phase += std::polar(1.0, 2 * std::numbers::pi *
                                 static_cast<double>((shown - shown_ns.front()) % refresh_ns) /
                                 static_cast<double>(refresh_ns));
  return std::abs(phase) > kLeastPhase * count;
}

Result<std::unique_ptr<StudyScreen>> StudyScreen::open(renderer::WindowSettings settings,
                                                       double rate_hz) {
  const int width_px = settings.width_px, height_px = settings.height_px;
  auto window = renderer::Window::open(std::move(settings));
  if (!window) return tl::make_unexpected(window.error());
  auto screen = std::unique_ptr<StudyScreen>(
      new StudyScreen(std::move(*window), width_px, height_px, rate_hz));
  if (auto found = screen->find_rhythm(); !found) return tl::make_unexpected(found.error());
  return screen;
}

Result<void> StudyScreen::find_rhythm() {
  const auto refresh_ns = window_->refresh_ns();
  const renderer::Texture dark(width_px_, height_px_, gallery::kNight);
  constexpr int kSettling = 5, kShown = 21;
  std::vector<std::int64_t> shown_ns;
  shown_ns.reserve(kShown);
  for (int picture = 0; picture < kSettling + kShown; ++picture) {
    const auto shown = window_->show(dark.view(), {0, 0, width_px_, height_px_});
    if (!shown) return tl::make_unexpected(shown.error());
    if (picture >= kSettling) shown_ns.push_back(shown->shown_ns);
  }
  last_ns_ = shown_ns.back();
  waits_ = refresh_ns && has_waited(shown_ns, *refresh_ns);
  if (!waits_)
    log::warning(
        "the window does not wait for the monitor: what is known of its refreshes is only "
        "when pictures were handed over");
  return {};
}

double StudyScreen::period_ms() const {
  return waits_ ? ns_to_ms(*window_->refresh_ns()) : 1e3 / rate_hz_;
}

Result<renderer::Shown> StudyScreen::show(renderer::View<const std::uint32_t> picture,
                                          const renderer::Rect& region) {
  if (window_->is_closed()) return fail(Errc::disconnected, "the window was closed");
  if (!waits_) sleep_until_ns(last_ns_ + ms_to_ns(period_ms()));
  auto shown = window_->show(picture, region);
  if (shown) last_ns_ = shown->shown_ns;
  return shown;
}

renderer::Texture StudyScreen::page(const std::vector<std::string>& lines) const {
  preview::Canvas canvas(width_px_, height_px_, kPaper);
  const double size_px = std::clamp(height_px_ / 32.0, 14.0, 30.0);
  double y = 0.5 * (height_px_ - 1.9 * size_px * static_cast<double>(lines.size()));
  for (std::size_t i = 0; i < lines.size(); ++i, y += 1.9 * size_px)
    canvas.text({0.5f * static_cast<float>(width_px_), static_cast<float>(y)}, lines[i],
                {.size_px = i == 0 ? 1.5 * size_px : size_px, .bold = i == 0}, kInk,
                preview::Align::centre);
  return canvas.picture();
}

Result<std::string> StudyScreen::ask(const std::vector<std::string>& lines,
                                     const std::vector<std::string_view>& keys,
                                     const TakeKeys& take_others) {
  const auto picture = page(lines);
  const auto take = [&] {
    auto taken = window_->take_keys();
    if (take_others) std::ranges::move(take_others(), std::back_inserter(taken));
    return taken;
  };
  take();  // those of before were no answer
  for (;;) {
    if (auto shown = show(picture.view(), {0, 0, width_px_, height_px_}); !shown)
      return tl::make_unexpected(shown.error());
    for (const auto& key : take())
      if (std::ranges::find(keys, key) != keys.end()) return key;
  }
}

bool StudyScreen::is_escape_pressed() {
  const auto keys = window_->take_keys();
  return std::ranges::find(keys, kEscape) != keys.end();
}

Result<bool> StudyScreen::tell(const std::vector<std::string>& lines, double seconds) {
  const auto picture = page(lines);
  const auto end_ns = now_ns() + seconds_to_ns(seconds);
  do {
    if (auto shown = show(picture.view(), {0, 0, width_px_, height_px_}); !shown)
      return tl::make_unexpected(shown.error());
    if (is_escape_pressed()) return false;
  } while (now_ns() < end_ns);
  return true;
}

Result<ShownInterval> StudyScreen::play(Stimulus& stimulus, double from_s, double seconds,
                                        double delay_ms, Condition condition) {
  ShownInterval interval;
  std::int64_t begin_ns = 0;
  const std::int64_t period_ns = ms_to_ns(period_ms());
  for (;;) {
    const std::int64_t next_ns = std::max(last_ns_ + period_ns, now_ns());
    if (begin_ns == 0) begin_ns = next_ns;
    const double hand_s = from_s + ns_to_seconds(next_ns - begin_ns);
    if (hand_s > from_s + seconds) return interval;
    const auto picture = stimulus.draw(hand_s, delay_ms, condition);
    const auto shown = show(picture, stimulus.region());
    if (!shown) return tl::make_unexpected(shown.error());
    const ShownFrame frame{.hand_s = hand_s,
                           .light_s = hand_s - 1e-3 * delay_ms,
                           .shown_ns = shown->shown_ns,
                           .error_ms = ns_to_ms(shown->shown_ns - next_ns)};
    // The first frame finds the rhythm of the monitor.
    const bool is_late = std::abs(frame.error_ms) > kTooLate * ns_to_ms(period_ns);
    if (!interval.frames.empty()) {
      interval.missed += is_late;
      interval.worst_error_ms = std::max(interval.worst_error_ms, std::abs(frame.error_ms));
    }
    interval.frames.push_back(frame);
    if ((interval.is_left = is_escape_pressed())) return interval;
  }
}

Result<renderer::Image<std::uint8_t>> StudyScreen::paint(
    renderer::View<const std::uint32_t> picture, const std::string& sentence) {
  renderer::Image<std::uint8_t> marks(picture.width, picture.height);
  window_->take_keys();
  window_->take_pointer();
  for (;;) {
    preview::Canvas canvas(picture.width, picture.height, kPaper);
    canvas.image(picture,
                 {0, 0, static_cast<double>(picture.width), static_cast<double>(picture.height)});
    canvas.text({0.5f * static_cast<float>(picture.width), 40}, sentence, {.size_px = 20}, kInk,
                preview::Align::centre);
    auto painted = canvas.picture();
    for (std::size_t i = 0; i < marks.pixels().size(); ++i)
      if (marks.pixels()[i]) painted.pixels()[i] = 0xff2a2adcu;
    if (auto shown = show(painted.view(), {0, 0, picture.width, picture.height}); !shown)
      return tl::make_unexpected(shown.error());
    for (const auto& event : window_->take_pointer())
      if (event.kind != renderer::PointerEvent::Kind::release) press(marks, event);
    for (const auto& key : window_->take_keys())
      if (key == kGoOn || key == kEscape) return marks;
  }
}

}  // namespace handcast::study
