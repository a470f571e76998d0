// SPDX-License-Identifier: Apache-2.0
#include "services/lab/gallery/gallery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/input_file.hpp"
#include "ipc/base/write_whole.hpp"
#include "renderer/media/picture.hpp"
#include "services/content/hands.hpp"
#include "services/content/looks_folder.hpp"
#include "services/content/mixer.hpp"
#include "services/lab/gallery/contact_sheet.hpp"
#include "services/lab/gallery/hand_stage.hpp"
#include "services/lab/gallery/page.hpp"
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

/// What is shown, and how a person reads of it.
struct Shown {
  std::string below;       ///< the content at first, a chain
  std::string transition;  ///< to kSecond; "": none
  std::string sentence;
  std::vector<content::Parameter> parameters;
};
constexpr std::string_view kUnderFilters = "tiger", kFirst = "xray", kSecond = "lava";

/// What DESCRIPTION in the head of a look says.
std::string sentence_of(const std::string& look) {
  const auto text = read_input(content::looks_folder() / (look + ".fs"), 1 << 20);
  constexpr std::string_view kKey = "\"DESCRIPTION\": \"";
  const auto at = text ? text->find(kKey) : std::string::npos;
  if (at == std::string::npos) return "";
  const auto begin = at + kKey.size();
  return text->substr(begin, text->find('"', begin) - begin);
}

/// A filter is shown over a look, a transition between two.
Result<Shown> shown_as(const std::string& content, const config::ContentChain& chain,
                       const content::Opening& like) {
  Shown shown{.below = content, .transition = {}, .sentence = {}, .parameters = {}};
  if (chain.size() != 1) return shown;
  auto opening = like;
  opening.element = chain[0];
  const auto source = content::open_source(opening);
  if (!source) return fail_in(content, source.error());
  const auto parameters = (*source)->parameters();
  shown.parameters.assign(parameters.begin(), parameters.end());
  if (chain[0].kind == "look") shown.sentence = sentence_of(chain[0].what);
  if ((*source)->inputs() == 1) shown.below = fmt::format("{} | {}", kUnderFilters, content);
  if ((*source)->inputs() == 2) {
    shown.below = kFirst;
    shown.transition = content;
  }
  return shown;
}

/// How much light there is in a picture.
std::uint64_t light_in(renderer::View<const std::uint32_t> picture) {
  std::uint64_t sum = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const auto pixel = picture.at(x, y);
      sum += std::max({pixel & 0xff, pixel >> 8 & 0xff, pixel >> 16 & 0xff});
    }
  return sum;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

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
  renderer::Rect last_part;
  std::vector<Entry> entries;
  ContactSheet sheet;

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
  content::Opening like(msg::Side side) const;
  Result<std::vector<content::Mixer>> open(const Shown& shown);
  Result<void> change(std::vector<content::Mixer>& mixers, const std::string& transition) const;
  void keep(renderer::View<const std::uint32_t> picture, int index, renderer::Texture& strip);
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
  const auto room =
      glm::max(glm::dvec2(size_px - glm::ivec2(region.width(), region.height())), 0.) / 2.;
  if (!region.empty())
    middle_px = middle_px
                    ? glm::clamp(glm::mix(*middle_px, middle, kShare), middle - room, middle + room)
                    : middle;
  const glm::ivec2 first(middle_px.value_or(glm::dvec2(size_px) / 2.) - glm::dvec2(size_px) / 2.);
  last_part = {first.x, first.y, first.x + size_px.x, first.y + size_px.y};
  return last_part;
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

content::Opening Gallery::Parts::like(msg::Side side) const {
  content::Opening like;
  like.width = rig.content.width_px;
  like.height = rig.content.height_px;
  like.meshes = hands.meshes();
  like.side = side;
  return like;
}

/// The content of each hand.
Result<std::vector<content::Mixer>> Gallery::Parts::open(const Shown& shown) {
  const auto chain = config::parse_content(shown.below);
  if (!chain) return tl::make_unexpected(chain.error());
  std::vector<content::Mixer> mixers;
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    auto opened = content::Chain::open(*chain, like(side));
    if (!opened) return tl::make_unexpected(opened.error());
    mixers.emplace_back(like(side));
    if (auto set = mixers.back().change(std::move(*opened), "cut", 0); !set)
      return tl::make_unexpected(set.error());
  }
  return mixers;
}

/// Begins the transition to the second look.
Result<void> Gallery::Parts::change(std::vector<content::Mixer>& mixers,
                                    const std::string& transition) const {
  const auto chain = config::parse_content(kSecond);
  if (!chain) return tl::make_unexpected(chain.error());
  for (std::size_t i = 0; i < mixers.size(); ++i) {
    auto opened = content::Chain::open(*chain, like(i == 0 ? msg::Side::left : msg::Side::right));
    if (!opened) return tl::make_unexpected(opened.error());
    constexpr double kShare = 0.7;
    auto set = mixers[i].change(std::move(*opened), transition, kShare * wanted.seconds);
    if (!set) return set;
  }
  return {};
}

/// Puts a picture into the strip.
void Gallery::Parts::keep(renderer::View<const std::uint32_t> picture, int index,
                          renderer::Texture& strip) {
  const auto part = followed();
  if (index < 0) return;
  renderer::View<std::uint32_t> out = strip.view();
  out.width = wanted.width_px;
  out.data += out.width * index;
  shrink_into(picture, part, out);
}

Result<double> Gallery::show(const std::string& content) {
  Parts& all = *parts_;
  const auto chain = config::parse_content(content);
  if (!chain) return tl::make_unexpected(chain.error());
  const auto shown = shown_as(content, *chain, all.like(msg::Side::left));
  if (!shown) return tl::make_unexpected(shown.error());
  all.rewind();
  auto mixers = all.open(*shown);
  if (!mixers) return tl::make_unexpected(mixers.error());
  const int width = all.wanted.width_px, height = width * all.size_px.y / all.size_px.x;
  renderer::Texture strip(width * all.wanted.frames, height), best;
  std::uint64_t most = 0;
  std::vector<double> took_ms;
  int kept = 0;
  for (int step = 0; step < all.steps(); ++step) {
    const auto hands = all.hands_at(all.time_ns(step));
    if (step == kSettling && !shown->transition.empty())
      if (auto begun = all.change(*mixers, shown->transition); !begun)
        return tl::make_unexpected(begun.error());
    for (std::size_t i = 0; i < mixers->size(); ++i) {
      if (!hands[i].is_there) continue;
      const auto begin_ns = now_ns();
      const auto drawn =
          (*mixers)[i].draw(hands[i], hands[1 - i], ns_to_seconds(all.time_ns(step)));
      if (!drawn) return tl::make_unexpected(drawn.error());
      took_ms.push_back(ns_to_ms(now_ns() - begin_ns));
    }
    const auto picture = all.stage.take(hands, {&(*mixers)[0].picture(), &(*mixers)[1].picture()});
    const bool is_kept = all.is_kept(step) && kept < all.wanted.frames;
    all.keep(picture, is_kept ? kept++ : -1, strip);
    // Of a transition, the sheet has the middle; of all else the brightest of the later pictures.
    const int at = 100 * (step - kSettling) / (all.steps() - kSettling);
    const bool is_late = shown->transition.empty() ? at > 35 : at > 28 && at < 40;
    if (const auto light = light_in(picture); is_late && light > most) {
      most = light;
      best = renderer::Texture(width, height);
      shrink_into(picture, all.last_part, best.view());
    }
  }
  if (most > 0) all.sheet.add(content, best);
  const double median_ms = median(std::move(took_ms));
  all.entries.push_back({content, shown->sentence, shown->parameters, file_name_of(content), width,
                         height, median_ms});
  const auto file = fs::path(all.wanted.folder) / all.entries.back().file;
  if (auto written = renderer::write_png(file, strip.view()); !written)
    return tl::make_unexpected(written.error());
  return median_ms;
}

Result<fs::path> Gallery::write_page() const {
  const auto file = fs::path(parts_->wanted.folder) / "index.html";
  const auto page = page_of(parts_->entries, parts_->wanted.frames, parts_->wanted.seconds);
  if (auto written = write_whole(file, page); !written) return tl::make_unexpected(written.error());
  return file;
}

Result<void> Gallery::write_sheet(const fs::path& file) const {
  if (parts_->sheet.empty())
    return fail(Errc::bad_config, fmt::format("{}: nothing could be shown", file.string()));
  return renderer::write_png(file, parts_->sheet.drawn().view());
}

}  // namespace handcast::gallery
