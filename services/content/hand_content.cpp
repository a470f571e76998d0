// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "renderer/base/mip_chain.hpp"
#include "services/content/contents.hpp"

namespace handcast::content {
namespace {

std::string_view name_of(Side side) { return side == Side::left ? "left" : "right"; }

}  // namespace

HandContent::HandContent(Opening like, config::Content settings,
                         ipc::Writer<msg::ContentPicture> pictures)
    : like_(std::move(like)),
      settings_(std::move(settings)),
      mixer_(like_),
      pictures_(std::move(pictures)) {
  state_.settings.set(content_of_settings());
}

/// Errors: bad_config (the content or the transition is wrong), those of their sources.
Result<void> HandContent::change(const std::string& content, std::string_view transition,
                                 double seconds) {
  if (content == distrusted_)
    return fail(Errc::bad_config,
                fmt::format("{}: the content service died with its first picture: does it hang? "
                            "`handcast content` tries it again",
                            content));
  const auto written = config::parse_content(content);
  if (!written) return tl::make_unexpected(written.error());
  auto chain = Chain::open(*written, like_);
  if (!chain) return tl::make_unexpected(chain.error());
  if (auto changed = mixer_.change(std::move(*chain), transition, seconds); !changed)
    return changed;
  state_.content.set(content);
  state_.fault.set("");
  is_new_ = true;
  return {};
}

void HandContent::start(const std::string& content) {
  const auto shown = change(content, "cut", 0);
  if (shown) return;
  (void)change("builtin:white", "cut", 0);
  note_fault(shown.error());
}

bool HandContent::adjust(const config::Content& settings) {
  const auto before = content_of_settings();
  settings_ = settings;
  return content_of_settings() != before;
}

void HandContent::obey(const config::Transition& transition) {
  const auto& content = content_of_settings();
  const auto shown =
      change(content, transition.name.empty() ? settings_.transition : transition.name,
             transition.seconds < 0 ? settings_.transition_s : transition.seconds);
  if (shown)
    log::info("{}: {}", name_of(like_.side), printable(content));
  else
    note_fault(shown.error());
}

Needs HandContent::needs() const { return mixer_.needs(); }

void HandContent::note_fault(const Error& error) {
  state_.trying.set("");
  if (state_.fault.view() == error.what) return;
  state_.fault.set(error.what);
  log::warning("{}: {}", name_of(like_.side), printable(error.what));
}

void HandContent::draw(const HandState& hand, const HandState& other, std::int64_t time_ns,
                       const CameraView* camera) {
  const std::int64_t begin_ns = now_ns();
  const auto drawn = mixer_.draw(hand, other, ns_to_seconds(time_ns), camera);
  if (!drawn) note_fault(drawn.error());
  const bool is_first = std::exchange(is_new_, false) || state_.pictures == 0;
  if (!drawn.value_or(false) && !is_first) return;
  publish(time_ns);
  state_.trying.set("");
  constexpr float kShare = 0.05f;  // of the newest in the mean
  const auto took_ms = static_cast<float>(ns_to_ms(now_ns() - begin_ns));
  // The first picture makes what the others use.
  if (!is_first) state_.draw_ms += (state_.draw_ms == 0 ? 1 : kShare) * (took_ms - state_.draw_ms);
  if (is_first) state_.draw_ms = 0;
}

void HandContent::publish(std::int64_t time_ns) {
  auto slot = pictures_.loan();
  if (!slot) return;  // the picture after this one will find one
  const auto& picture = mixer_.picture();
  slot->header.frame_id = ++state_.pictures;
  slot->header.origin_ns = time_ns;
  slot->width_px = static_cast<std::uint32_t>(picture.width());
  slot->height_px = static_cast<std::uint32_t>(picture.height());
  slot->smooth = settings_.smooth;
  renderer::write_mips(picture.view(), slot->mip_layout(), slot->texels());
  pictures_.publish(std::move(slot));
}

}  // namespace handcast::content
