// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "ipc/base/log.hpp"
#include "ipc/base/quote.hpp"
#include "services/content/settable_source.hpp"

namespace handcast::content {
namespace {

using renderer::HandMesh;
using renderer::Texture;

template <auto free>
struct FreeBy {
  template <class T>
  void operator()(T* owned) const {
    free(owned);
  }
};
using Surface = std::unique_ptr<cairo_surface_t, FreeBy<cairo_surface_destroy>>;
using Cairo = std::unique_ptr<cairo_t, FreeBy<cairo_destroy>>;
using Layout = std::unique_ptr<PangoLayout, FreeBy<g_object_unref>>;
using Description = std::unique_ptr<PangoFontDescription, FreeBy<pango_font_description_free>>;
using Utf8 = std::unique_ptr<char, FreeBy<g_free>>;

constexpr std::size_t kMostText_bytes = 4096;
constexpr const char* kUsualFont = "DejaVu Sans Bold";

/// A part of the picture, 0..1.
struct Box {
  glm::vec2 low{0}, high{1};
};

/// The charts of the back of a hand, or of its palm.
Box box_of(const HandMesh& hand, bool is_back) {
  std::array<float, 256> outwards{};
  for (std::size_t v = 0; v < hand.vertex_count(); ++v)
    outwards[hand.chart[v]] += glm::dot(hand.normals[v], glm::vec3(hand.rest[1][1]));
  Box box{glm::vec2(1), glm::vec2(0)};
  for (std::size_t v = 0; v < hand.vertex_count(); ++v)
    if ((outwards[hand.chart[v]] >= 0) == is_back) {
      box.low = glm::min(box.low, hand.uv[v]);
      box.high = glm::max(box.high, hand.uv[v]);
    }
  return box.low.x < box.high.x ? box : Box{};
}

std::vector<Parameter> text_parameters() {
  using Kind = Parameter::Kind;
  return {plain_parameter("text", "Text", Kind::text),
          plain_parameter("font", "Font, e.g. DejaVu Sans Bold", Kind::text),
          number_parameter("size", "Size of the font, of the picture's height", 0.01, 2, 0.1),
          plain_parameter("colour", "Colour", Kind::colour, {1, 1, 1, 1}),
          choice_parameter("align", "Where the lines begin", {"left", "center", "right"}, 1),
          number_parameter("x", "Middle of the text from the left, 0..1", -1, 2, 0.5),
          number_parameter("y", "Middle of the text from the top, 0..1", -1, 2, 0.5),
          number_parameter("rotate", "Turned clockwise, in degrees", -360, 360, 0),
          number_parameter("scroll", "Lines per second, upwards", -100, 100, 0),
          choice_parameter("on", "The part of the hand", {"whole", "palm", "back"}, 2)};
}

std::string with_line_breaks(std::string text) {
  for (auto at = text.find("\\n"); at != text.npos; at = text.find("\\n", at + 1))
    text.replace(at, 2, "\n");
  return text;
}

/// RGBA8 from Cairo's ARGB32, which is a number of 32 bits. Both are premultiplied.
void copy_pixels(cairo_surface_t* surface, Texture& out) {
  cairo_surface_flush(surface);
  const auto* data = cairo_image_surface_get_data(surface);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
  for (int y = 0; y < out.height(); ++y) {
    const auto* row = reinterpret_cast<const std::uint32_t*>(data + stride * y);
    for (int x = 0; x < out.width(); ++x) {
      const std::uint32_t argb = row[x];
      out.at(x, y) = (argb & 0xff00ff00u) | (argb >> 16 & 255) | (argb & 255) << 16;
    }
  }
}

class TextSource final : public SettableSource {
 public:
  TextSource(std::string text, bool is_clock, const HandMesh* hand)
      : SettableSource(text_parameters()), written_(std::move(text)), is_clock_(is_clock) {
    if (hand) boxes_ = {Box{}, box_of(*hand, false), box_of(*hand, true)};
  }

  Result<void> set(std::string_view name, std::string_view value) override {
    if (name == "text" && value.size() > kMostText_bytes)
      return fail(Errc::bad_config, fmt::format("text: {} bytes are too many; at most {}",
                                                value.size(), kMostText_bytes));
    if (auto set = SettableSource::set(name, value); !set) return set;
    if (name == "text") written_ = value;
    if (name == "font") has_warned_of_font_ = false;
    return {};
  }

  Result<bool> draw(const Moment& moment, std::span<const renderer::View<const std::uint32_t>>,
                    Texture& out) override {
    const double scroll = number("scroll");
    auto text = text_at(moment);
    if (!take_change() && scroll == 0 && text == shown_) return false;
    shown_ = std::move(text);
    paint(out, moment.time_s * scroll);
    return true;
  }

 private:
  std::string text_at(const Moment& moment) const {
    std::string text = written_;
    if (is_clock_) {
      char buffer[256];
      text.assign(buffer, std::strftime(buffer, sizeof buffer, written_.c_str(), &moment.date));
    }
    const Utf8 valid(g_utf8_make_valid(text.data(), static_cast<gssize>(text.size())));
    return with_line_breaks(valid.get());
  }

  void paint(Texture& out, double scrolled_lines) {
    const Surface surface(
        cairo_image_surface_create(CAIRO_FORMAT_ARGB32, out.width(), out.height()));
    const Cairo cairo(cairo_create(surface.get()));
    const Layout layout(pango_cairo_create_layout(cairo.get()));
    const Box& box = boxes_[static_cast<std::size_t>(number("on"))];
    const glm::vec2 size(out.width(), out.height());
    const glm::vec2 low = box.low * size, wide = (box.high - box.low) * size;
    const double font_px = number("size") * out.height();
    set_up(layout.get(), font_px, static_cast<double>(wide.x));

    int width = 0, height = 0;
    pango_layout_get_pixel_size(layout.get(), &width, &height);
    const double x = low.x + number("x") * wide.x;
    double y = low.y + number("y") * wide.y;
    if (number("scroll") != 0) {
      const double way = wide.y + height;
      const double shift = scrolled_lines * line_height(layout.get(), font_px);
      y = low.y + wide.y + height / 2. - (shift - std::floor(shift / way) * way);
      cairo_rectangle(cairo.get(), low.x, low.y, wide.x, wide.y);
      cairo_clip(cairo.get());
    }
    const auto colour = numbers("colour");
    cairo_set_source_rgba(cairo.get(), colour[0], colour[1], colour[2], colour[3]);
    cairo_translate(cairo.get(), x, y);
    cairo_rotate(cairo.get(), number("rotate") * std::numbers::pi / 180);
    cairo_move_to(cairo.get(), -wide.x / 2., -height / 2.);
    pango_cairo_show_layout(cairo.get(), layout.get());
    copy_pixels(surface.get(), out);
  }

  void set_up(PangoLayout* layout, double font_px, double width_px) {
    const std::string& wanted = SettableSource::text("font");
    const Description font(
        pango_font_description_from_string(wanted.empty() ? kUsualFont : wanted.c_str()));
    pango_font_description_set_absolute_size(font.get(), font_px * PANGO_SCALE);
    pango_layout_set_font_description(layout, font.get());
    pango_layout_set_width(layout, static_cast<int>(width_px * PANGO_SCALE));
    pango_layout_set_wrap(layout, PANGO_WRAP_WORD_CHAR);
    constexpr PangoAlignment kAlign[] = {PANGO_ALIGN_LEFT, PANGO_ALIGN_CENTER, PANGO_ALIGN_RIGHT};
    pango_layout_set_alignment(layout, kAlign[static_cast<int>(number("align"))]);
    pango_layout_set_text(layout, shown_.data(), static_cast<int>(shown_.size()));
    if (!wanted.empty()) warn_of_font(layout, font.get());
    warn_of_glyphs(layout);
  }

  static double line_height(PangoLayout* layout, double font_px) {
    const int lines = pango_layout_get_line_count(layout);
    int height = 0;
    pango_layout_get_pixel_size(layout, nullptr, &height);
    return lines > 0 && height > 0 ? static_cast<double>(height) / lines : font_px;
  }

  void warn_of_font(PangoLayout* layout, const PangoFontDescription* wanted) {
    if (std::exchange(has_warned_of_font_, true)) return;
    auto* context = pango_layout_get_context(layout);
    const std::unique_ptr<PangoFont, FreeBy<g_object_unref>> loaded(
        pango_context_load_font(context, wanted));
    const char* asked = pango_font_description_get_family(wanted);
    if (!loaded || !asked) return;
    const Description found(pango_font_describe(loaded.get()));
    const std::string first = std::string(asked).substr(0, std::string_view(asked).find(','));
    for (const char* alias : {"sans", "serif", "monospace", "sans-serif", "system-ui", "cursive"})
      if (g_ascii_strcasecmp(first.c_str(), alias) == 0) return;
    const char* family = pango_font_description_get_family(found.get());
    if (g_ascii_strcasecmp(first.c_str(), family) != 0)
      log::warning("there is no font {}; text is shown in '{}'; `fc-list` lists the fonts",
                   quote(first), family);
  }

  void warn_of_glyphs(PangoLayout* layout) {
    const int unknown = pango_layout_get_unknown_glyphs_count(layout);
    if (unknown == 0 || std::exchange(has_warned_of_glyphs_, true)) return;
    log::warning(
        "text {}: no installed font has {} of its characters, which are shown as boxes; install a "
        "font of its script, e.g. from Debian's fonts-noto",
        quote(shown_), unknown);
  }

  std::string written_;  ///< the text, or the format of a clock
  const bool is_clock_;
  std::array<Box, 3> boxes_{};  ///< of `on`: whole, palm, back
  std::string shown_;
  bool has_warned_of_font_ = false, has_warned_of_glyphs_ = false;
};

Result<std::unique_ptr<Source>> open_written(const Opening& opening, bool is_clock) {
  const std::string& text = opening.element.what;
  if (text.size() > kMostText_bytes)
    return fail(Errc::bad_config, fmt::format("the text has {} bytes; {} are the most", text.size(),
                                              kMostText_bytes));
  return std::make_unique<TextSource>(text.empty() && is_clock ? "%H:%M" : text, is_clock,
                                      opening.meshes[opening.side == Side::left ? 0 : 1]);
}

}  // namespace

Result<std::unique_ptr<Source>> open_text(const Opening& opening) {
  return open_written(opening, false);
}

Result<std::unique_ptr<Source>> open_clock(const Opening& opening) {
  return open_written(opening, true);
}

}  // namespace handcast::content
