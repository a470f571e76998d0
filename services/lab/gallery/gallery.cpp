// SPDX-License-Identifier: Apache-2.0
#include "services/lab/gallery/gallery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/write_whole.hpp"
#include "renderer/media/picture.hpp"
#include "services/content/hands.hpp"
#include "services/content/looks_folder.hpp"
#include "services/content/mixer.hpp"
#include "services/lab/gallery/hand_stage.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::gallery {
namespace {

namespace fs = std::filesystem;

/// Pictures that content has drawn before the first that is shown: persistent buffers fill.
constexpr int kSettling = 20;
constexpr double kRate_hz = 30;  ///< at which content is drawn

/// "lava", "film:a.mp4" as the name of a file.
std::string file_name_of(const std::string& content) {
  std::string name = content;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  return name.substr(0, 60) + ".png";
}

std::string escaped(const std::string& text) {
  std::string html;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    const bool is_plain = code >= 0x20 && c != '<' && c != '>' && c != '&' && c != '"';
    html += is_plain ? std::string(1, c) : fmt::format("&#{};", code);
  }
  return html;
}

/// The part of a picture within `from`, in another size, each pixel the mean of what it covers.
/// What is beyond the picture is as its edge.
void shrink_into(renderer::View<const std::uint32_t> picture, const renderer::Rect& from,
                 renderer::View<std::uint32_t> out) {
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const int x0 = from.x0 + x * from.width() / out.width,
                x1 = std::max(x0 + 1, from.x0 + (x + 1) * from.width() / out.width),
                y0 = from.y0 + y * from.height() / out.height,
                y1 = std::max(y0 + 1, from.y0 + (y + 1) * from.height() / out.height);
      std::array<std::uint32_t, 3> sum{};
      for (int v = y0; v < y1; ++v)
        for (int u = x0; u < x1; ++u)
          for (int c = 0; c < 3; ++c)
            sum[c] += picture.at(std::clamp(u, 0, picture.width - 1),
                                 std::clamp(v, 0, picture.height - 1)) >>
                          (8 * c) &
                      0xff;
      const auto count = static_cast<std::uint32_t>((x1 - x0) * (y1 - y0));
      out.at(x, y) = 0xff000000u | sum[0] / count | sum[1] / count << 8 | sum[2] / count << 16;
    }
}

constexpr std::string_view kHead = R"(<!doctype html>
<html lang="en"><meta charset="utf-8"><title>handcast: looks</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>
body { background: #0b0d10; color: #dfe3e8; font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 1180px; padding: 0 1rem; }
h1 { font-weight: 500; } p { color: #98a2ad; }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(320px, 1fr)); gap: 1.2rem; }
figure { margin: 0; background: #14181d; border-radius: 8px; overflow: hidden; }
figcaption { padding: .6rem .9rem; font-family: ui-monospace, monospace; font-size: .85rem; overflow-wrap: anywhere; }
.strip { margin: 0 auto; background-repeat: no-repeat; }
@media (prefers-reduced-motion: reduce) { .strip { animation: none !important; } }
</style>
<h1>Looks</h1>
<p>Drawn by handcast on the digital twin's hands. <code>handcast content NAME</code> puts one on the hands of a running rig.</p>
<main>
)";

}  // namespace

/// One content of the page.
struct Gallery::Entry {
  std::string title, file;
  int width_px, height_px;
};

struct Gallery::Parts {
  Wanted wanted;
  config::Rig rig;
  calib::Calibration calibration;
  std::unique_ptr<twin::Twin> twin;
  content::Hands hands;
  HandStage stage;
  std::uint64_t next_sample = 0;
  glm::ivec2 size_px{0};                ///< of what is kept of a picture
  std::optional<glm::dvec2> middle_px;  ///< of it, smoothed
  std::vector<Entry> entries;

  /// The hands at a time of the motion. Times go on; rewind() begins again.
  content::BothHands hands_at(std::int64_t time_ns) {
    for (; twin->tracker_time_ns(next_sample) <= time_ns; ++next_sample)
      hands.push(twin->tracker_sample(next_sample).poses);
    return hands.at(time_ns);
  }
  void rewind() {
    hands = *content::Hands::load(rig, calibration);
    hands.needs_surface(true);
    next_sample = 0;
    middle_px.reset();
  }
  std::int64_t time_ns(int step) const { return seconds_to_ns(0.5 + step / kRate_hz); }
  int steps() const { return kSettling + static_cast<int>(wanted.seconds * kRate_hz); }
  /// The steps whose pictures are kept.
  bool is_kept(int step) const {
    const int shown = step - kSettling, all = steps() - kSettling;
    return shown >= 0 &&
           shown * wanted.frames / all != (shown - 1 + all) * wanted.frames / all - wanted.frames;
  }
  void find_size();
  renderer::Rect followed();
};

/// The size of a picture: the largest that a hand has in the motion, and a margin.
void Gallery::Parts::find_size() {
  const renderer::Texture white(8, 5, 0xffffffff);
  rewind();
  for (int step = 0; step < steps(); step += 4) {
    stage.take(hands_at(time_ns(step)), {&white, &white});
    size_px = glm::max(size_px, glm::ivec2(stage.region().width(), stage.region().height()));
  }
  constexpr int kMargin_px = 12;
  size_px += 2 * kMargin_px;
}

/// The part of the last picture that is kept: it follows the hands, but not their trembling.
renderer::Rect Gallery::Parts::followed() {
  const auto& region = stage.region();
  const glm::dvec2 middle(0.5 * (region.x0 + region.x1), 0.5 * (region.y0 + region.y1));
  constexpr double kShare = 0.2;
  if (!region.empty()) middle_px = middle_px ? glm::mix(*middle_px, middle, kShare) : middle;
  const glm::ivec2 first(middle_px.value_or(glm::dvec2(size_px) / 2.) - glm::dvec2(size_px) / 2.);
  return {first.x, first.y, first.x + size_px.x, first.y + size_px.y};
}

Result<Gallery> Gallery::open(const Wanted& wanted) {
  auto rig = config::parse_rig("", "gallery", {"twin.motion=" + wanted.motion});
  if (!rig) return tl::make_unexpected(rig.error());
  const auto calibration = calib::reference_rig();
  auto twin = twin::Twin::create(*rig, calibration);
  if (!twin) return tl::make_unexpected(twin.error());
  auto hands = content::Hands::load(*rig, calibration);
  if (!hands) return tl::make_unexpected(hands.error());
  std::error_code failed;
  fs::create_directories(wanted.folder, failed);
  if (failed)
    return fail(Errc::bad_config,
                fmt::format("{}: cannot be created: {}", wanted.folder, failed.message()));
  auto parts = std::unique_ptr<Parts>(new Parts{.wanted = wanted,
                                                .rig = std::move(*rig),
                                                .calibration = calibration,
                                                .twin = std::move(*twin),
                                                .hands = std::move(*hands),
                                                .stage = HandStage(calibration)});
  parts->find_size();
  if (parts->size_px.x < 40)
    return fail(Errc::bad_config, fmt::format("{}: no hand is seen", wanted.motion));
  return Gallery(std::move(parts));
}

Gallery::Gallery(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Gallery::Gallery(Gallery&&) noexcept = default;
Gallery::~Gallery() = default;

Result<double> Gallery::show(const std::string& content) {
  Parts& all = *parts_;
  const auto chain = config::parse_content(content);
  if (!chain) return tl::make_unexpected(chain.error());
  all.rewind();
  std::vector<content::Mixer> mixers;
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    content::Opening like;
    like.width = all.rig.content.width_px;
    like.height = all.rig.content.height_px;
    like.meshes = all.hands.meshes();
    like.side = side;
    auto opened = content::Chain::open(*chain, like);
    if (!opened) return tl::make_unexpected(opened.error());
    mixers.emplace_back(like);
    if (auto set = mixers.back().change(std::move(*opened), "cut", 0); !set)
      return tl::make_unexpected(set.error());
  }
  const int width = all.wanted.width_px, height = width * all.size_px.y / all.size_px.x;
  renderer::Texture strip(width * all.wanted.frames, height);
  std::vector<double> took_ms;
  int kept = 0;
  for (int step = 0; step < all.steps(); ++step) {
    const auto hands = all.hands_at(all.time_ns(step));
    for (std::size_t i = 0; i < mixers.size(); ++i) {
      if (!hands[i].is_there) continue;
      const auto begin_ns = now_ns();
      const auto drawn = mixers[i].draw(hands[i], hands[1 - i], ns_to_seconds(all.time_ns(step)));
      if (!drawn) return tl::make_unexpected(drawn.error());
      took_ms.push_back(ns_to_ms(now_ns() - begin_ns));
    }
    const auto picture = all.stage.take(hands, {&mixers[0].picture(), &mixers[1].picture()});
    const auto part = all.followed();
    if (!all.is_kept(step) || kept == all.wanted.frames) continue;
    renderer::View<std::uint32_t> out = strip.view();
    out.data += width * kept++;
    out.width = width;
    shrink_into(picture, part, out);
  }
  const Entry entry{content, file_name_of(content), width, height};
  const auto written = renderer::write_png(fs::path(all.wanted.folder) / entry.file, strip.view());
  if (!written) return tl::make_unexpected(written.error());
  all.entries.push_back(entry);
  if (took_ms.empty()) return 0.0;
  std::ranges::nth_element(took_ms, took_ms.begin() + std::ssize(took_ms) / 2);
  return took_ms[took_ms.size() / 2];
}

Result<fs::path> Gallery::write_page() const {
  const Parts& all = *parts_;
  std::string page(kHead);
  for (std::size_t i = 0; i < all.entries.size(); ++i) {
    const auto& entry = all.entries[i];
    page += fmt::format(
        "<figure><style>@keyframes s{0} {{ to {{ background-position: -{1}px 0; }} }}</style>"
        "<div class=\"strip\" role=\"img\" aria-label=\"{2}\" style=\"width: {3}px; height: {4}px; "
        "background-image: url('{5}'); animation: s{0} {6:.1f}s steps({7}) infinite "
        "alternate\"></div><figcaption>{2}</figcaption></figure>\n",
        i, entry.width_px * all.wanted.frames, escaped(entry.title), entry.width_px,
        entry.height_px, entry.file, all.wanted.seconds, all.wanted.frames);
  }
  page += "</main></html>\n";
  const auto file = fs::path(all.wanted.folder) / "index.html";
  if (auto written = write_whole(file, page); !written) return tl::make_unexpected(written.error());
  return file;
}

}  // namespace handcast::gallery
