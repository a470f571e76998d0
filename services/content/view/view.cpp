// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ipc/base/quote.hpp"
#include "services/content/settable_source.hpp"
#include "services/content/skin_print.hpp"

namespace handcast::content {
namespace {

constexpr int kMostSide_px = 2048;  ///< of the picture, whatever the projector has

/// What another source draws in the plane of the projector, unwrapped onto the hand that moves
/// through it. Where the light does not reach the skin, what was there last; where it never did,
/// the colours of the skin around.
class ViewSource final : public SettableSource {
 public:
  ViewSource(const Opening& opening, std::unique_ptr<Source> inner, const Opening& inner_opening,
             Viewer projector)
      : SettableSource(
            {plain_parameter("bake", "Stays on the skin, and no longer moves under it",
                             Parameter::Kind::flag, {0}),
             number_parameter("after", "Seconds of a hand in view until it is baked", 0, 3600, 0),
             plain_parameter("fill", "Skin that was never lit gets the colours around it",
                             Parameter::Kind::flag, {1})}),
        inner_(std::move(inner)),
        projector_(std::move(projector)),
        print_(*opening.meshes[static_cast<std::size_t>(opening.side)], opening.width,
               opening.height),
        picture_(inner_opening.width, inner_opening.height) {
    const auto own = SettableSource::parameters(), its = inner_->parameters();
    all_.assign(own.begin(), own.end());
    all_.insert(all_.end(), its.begin(), its.end());
  }

  Needs needs() const override {
    Needs needs{.surface = true};
    return needs |= inner_->needs();
  }
  std::span<const Parameter> parameters() const override { return all_; }
  Result<void> set(std::string_view name, std::string_view value) override {
    const auto own = SettableSource::parameters();
    if (std::ranges::count(own, name, &Parameter::name) > 0)
      return SettableSource::set(name, value);
    if (std::ranges::count(all_, name, &Parameter::name) > 0) return inner_->set(name, value);
    return SettableSource::set(name, value);
  }
  bool is_stale() const override { return inner_->is_stale(); }

  Result<bool> draw(const Moment& moment, std::span<const renderer::View<const std::uint32_t>>,
                    renderer::Texture& out) override {
    bool has_changed = take_change() || moment.frame == 0;
    if (number("bake") == 0) is_baked_ = false;
    if (!is_baked_) {
      auto looked = look(moment);
      if (!looked) return looked;
      has_changed = *looked || has_changed;
    }
    if (has_changed) print_.show(number("fill") != 0, out);
    return has_changed;
  }

 private:
  /// Draws the picture, and takes it where it falls onto the hand. Returns whether it does.
  Result<bool> look(const Moment& moment) {
    Moment its = moment;
    its.frame = pictures_;
    auto drew = inner_->draw(its, {}, picture_);
    if (!drew) return drew;
    pictures_ += *drew;
    const bool is_there = !moment.hand->positions_m.empty();
    if (!is_there) since_s_ = -1;
    if (!is_there) return false;
    if (since_s_ < 0) since_s_ = moment.time_s;
    const glm::vec2 scale(static_cast<float>(picture_.width()) / projector_.width_px,
                          static_cast<float>(picture_.height()) / projector_.height_px);
    print_.take(projector_, *moment.hand, moment.other, picture_, {scale, 0.5f * scale - 0.5f});
    is_baked_ = number("bake") != 0 && moment.time_s - since_s_ >= number("after");
    return true;
  }

  std::unique_ptr<Source> inner_;
  std::vector<Parameter> all_;  ///< its own, and those of the inner source
  Viewer projector_;
  SkinPrint print_;
  renderer::Texture picture_;   ///< of the inner source
  std::uint64_t pictures_ = 0;  ///< that it has drawn
  double since_s_ = -1;         ///< since when the hand is there; -1: it is not
  bool is_baked_ = false;
};

/// Of the picture that lies in the projector's plane.
Opening inner_opening_of(const Opening& opening, config::ContentElement element,
                         const Viewer& projector) {
  Opening inner = opening;
  inner.element = std::move(element);
  const int longer = std::max(projector.width_px, projector.height_px);
  const double scale = std::min(1., static_cast<double>(kMostSide_px) / longer);
  inner.width = std::max(1, static_cast<int>(projector.width_px * scale));
  inner.height = std::max(1, static_cast<int>(projector.height_px * scale));
  return inner;
}

}  // namespace

Result<std::unique_ptr<Source>> open_view(const Opening& opening) {
  const auto written = config::parse_content(opening.element.what);
  if (!written) return tl::make_unexpected(written.error());
  const auto projector =
      viewer_of(opening.calibration ? *opening.calibration : calib::reference_rig());
  const auto inner = inner_opening_of(opening, (*written)[0], projector);
  auto source = open_source(inner);
  if (!source) return source;
  if (written->size() > 1 || (*source)->inputs() > 0)
    return fail(Errc::bad_config,
                fmt::format("{} is no single source; filters are put behind it, as in "
                            "\"view:film.mp4 | glow.fs\"",
                            quote(opening.element.what)));
  return std::make_unique<ViewSource>(opening, std::move(*source), inner, projector);
}

}  // namespace handcast::content
