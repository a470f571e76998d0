// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/canvas/canvas.hpp"

#include <cairo-pdf.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace handcast::preview {
namespace {

/// Number of bytes of the UTF-8 character that begins with this byte; 0 if none does.
std::size_t length_of(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0) return 2;
  if (first >= 0xe0 && first < 0xf0) return 3;
  return first >= 0xf0 && first < 0xf5 ? 4 : 0;
}

bool continues(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) == 0x80; }

/// The text with '?' for all that is not UTF-8, control characters, and characters of four bytes:
/// one bad byte would end all drawing with cairo.
std::string drawable(std::string_view text) {
  std::string good;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i]);
    const auto length = length_of(first);
    const auto rest = text.substr(i + 1, length > 0 ? length - 1 : 0);
    // Three and four bytes: overlong forms and surrogates are not distinguished, so all but the
    // common planes are left out.
    const bool is_common =
        length < 4 &&
        (first != 0xe0 || (!rest.empty() && static_cast<unsigned char>(rest[0]) >= 0xa0)) &&
        first != 0xed;
    const bool is_good = length > 0 && is_common && rest.size() == length - 1 &&
                         std::ranges::all_of(rest, continues) && first >= 0x20 && first != 0x7f;
    good += is_good ? std::string(text.substr(i, length)) : "?";
    i += is_good ? length : 1;
  }
  return good;
}

constexpr const char* kFamily = "DejaVu Sans";

bool is_finite(glm::vec2 point) { return std::isfinite(point.x) && std::isfinite(point.y); }
bool is_finite(const Box& box) {
  return std::isfinite(box.x) && std::isfinite(box.y) && std::isfinite(box.width) &&
         std::isfinite(box.height);
}

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

/// A premultiplied copy in cairo's order of bytes.
Surface surface_of(renderer::View<const std::uint32_t> rgba) {
  Surface surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, rgba.width, rgba.height),
                  cairo_surface_destroy);
  auto* data = cairo_image_surface_get_data(surface.get());
  if (!data) return surface;
  const int stride = cairo_image_surface_get_stride(surface.get());
  for (int y = 0; y < rgba.height; ++y) {
    auto* out = reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride);
    for (int x = 0; x < rgba.width; ++x) {
      const auto pixel = rgba.at(x, y), alpha = pixel >> 24;
      const auto part = [&](int shift) { return (pixel >> shift & 255) * alpha / 255; };
      out[x] = alpha << 24 | part(0) << 16 | part(8) << 8 | part(16);
    }
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

}  // namespace

class Canvas::Cairo {
 public:
  Cairo(Surface surface, double width, double height)
      : surface_(std::move(surface)),
        context_(cairo_create(surface_.get()), cairo_destroy),
        width_(width),
        height_(height) {
    cairo_set_line_join(get(), CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(get(), CAIRO_LINE_CAP_ROUND);
  }

  cairo_t* get() const { return context_.get(); }
  cairo_surface_t* surface() const { return surface_.get(); }
  double width() const { return width_; }
  double height() const { return height_; }
  double scale() const {
    cairo_matrix_t matrix;
    cairo_get_matrix(get(), &matrix);
    return matrix.xx;
  }
  void use(Colour colour) const {
    cairo_set_source_rgba(get(), colour.red, colour.green, colour.blue, colour.alpha);
  }
  void stroke(Colour colour, double width_px) const {
    use(colour);
    cairo_set_line_width(get(), width_px);
    cairo_stroke(get());
  }
  void use(Font font) const {
    cairo_select_font_face(get(), kFamily, CAIRO_FONT_SLANT_NORMAL,
                           font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(get(), font.size_px);
  }
  double advance_of(const std::string& text) const {
    cairo_text_extents_t extents;
    cairo_text_extents(get(), text.c_str(), &extents);
    return extents.x_advance;
  }

 private:
  Surface surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
  double width_, height_;
};

Canvas::Canvas(int width_px, int height_px, Colour background, double scale)
    : Canvas(std::make_unique<Cairo>(
          Surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px),
                  cairo_surface_destroy),
          width_px, height_px)) {
  cairo_->use(background);
  cairo_paint(cairo_->get());
  cairo_scale(cairo_->get(), scale, scale);
}

Canvas::Canvas(std::unique_ptr<Cairo> cairo) : cairo_(std::move(cairo)) {}
Canvas::~Canvas() = default;

double Canvas::width() const { return cairo_->width() / cairo_->scale(); }
double Canvas::height() const { return cairo_->height() / cairo_->scale(); }

void Canvas::fill(const Box& box, Colour colour, double radius_px) {
  if (!is_finite(box) || box.width <= 0 || box.height <= 0) return;
  auto* cairo = cairo_->get();
  const double r = std::min({radius_px, box.width / 2, box.height / 2}), pi = std::numbers::pi;
  cairo_new_sub_path(cairo);
  cairo_arc(cairo, box.right() - r, box.y + r, r, -pi / 2, 0);
  cairo_arc(cairo, box.right() - r, box.bottom() - r, r, 0, pi / 2);
  cairo_arc(cairo, box.x + r, box.bottom() - r, r, pi / 2, pi);
  cairo_arc(cairo, box.x + r, box.y + r, r, pi, 3 * pi / 2);
  cairo_close_path(cairo);
  cairo_->use(colour);
  cairo_fill(cairo);
}

void Canvas::fill(std::span<const glm::vec2> corners, Colour colour) {
  if (!std::ranges::all_of(corners, [](auto point) { return is_finite(point); })) return;
  for (const auto point : corners) cairo_line_to(cairo_->get(), point.x, point.y);
  cairo_->use(colour);
  cairo_fill(cairo_->get());
}

void Canvas::stroke(std::span<const glm::vec2> points, Colour colour, double width_px) {
  cairo_new_path(cairo_->get());
  for (const auto point : points)
    if (is_finite(point))
      cairo_line_to(cairo_->get(), point.x, point.y);
    else
      cairo_new_sub_path(cairo_->get());
  cairo_->stroke(colour, width_px);
}

void Canvas::stroke(std::span<const Line> lines, Colour colour, double width_px) {
  for (const auto& [from, to] : lines) {
    if (!is_finite(from) || !is_finite(to)) continue;
    cairo_move_to(cairo_->get(), from.x, from.y);
    cairo_line_to(cairo_->get(), to.x, to.y);
  }
  cairo_->stroke(colour, width_px);
}

void Canvas::dash(const Line& line, Colour colour, double width_px) {
  const std::array<double, 2> pattern{3, 4};
  cairo_set_dash(cairo_->get(), pattern.data(), pattern.size(), 0);
  stroke(std::span(&line, 1), colour, width_px);
  cairo_set_dash(cairo_->get(), nullptr, 0, 0);
}

void Canvas::disc(glm::vec2 centre, double radius_px, Colour colour) {
  if (!is_finite(centre) || !std::isfinite(radius_px)) return;
  cairo_new_path(cairo_->get());
  cairo_arc(cairo_->get(), centre.x, centre.y, radius_px, 0, 2 * std::numbers::pi);
  cairo_->use(colour);
  cairo_fill(cairo_->get());
}

void Canvas::ring(glm::vec2 centre, double radius_px, Colour colour, double width_px) {
  if (!is_finite(centre) || !std::isfinite(radius_px)) return;
  cairo_new_path(cairo_->get());
  cairo_arc(cairo_->get(), centre.x, centre.y, radius_px, 0, 2 * std::numbers::pi);
  cairo_->stroke(colour, width_px);
}

void Canvas::text(glm::vec2 at, std::string_view text, Font font, Colour colour, Align align) {
  if (!is_finite(at)) return;
  const auto good = drawable(text);
  cairo_->use(font);
  const double share = align == Align::left ? 0 : align == Align::centre ? 0.5 : 1;
  cairo_move_to(cairo_->get(), at.x - share * cairo_->advance_of(good), at.y);
  cairo_->use(colour);
  cairo_show_text(cairo_->get(), good.c_str());
  cairo_new_path(cairo_->get());
}

double Canvas::width_of(std::string_view text, Font font) const {
  cairo_->use(font);
  return cairo_->advance_of(drawable(text));
}

void Canvas::image(renderer::View<const std::uint32_t> rgba, const Box& box) {
  if (!is_finite(box) || !rgba.data || rgba.width < 1 || rgba.height < 1 || box.width <= 0 ||
      box.height <= 0)
    return;
  const auto surface = surface_of(rgba);
  auto* cairo = cairo_->get();
  cairo_save(cairo);
  cairo_rectangle(cairo, box.x, box.y, box.width, box.height);
  cairo_clip(cairo);
  cairo_translate(cairo, box.x, box.y);
  cairo_scale(cairo, box.width / rgba.width, box.height / rgba.height);
  cairo_set_source_surface(cairo, surface.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cairo), CAIRO_FILTER_BILINEAR);
  cairo_pattern_set_extend(cairo_get_source(cairo), CAIRO_EXTEND_PAD);
  cairo_paint(cairo);
  cairo_restore(cairo);
}

void Canvas::clip(const Box& box) {
  unclip();
  if (!is_finite(box)) return;
  cairo_rectangle(cairo_->get(), box.x, box.y, box.width, box.height);
  cairo_clip(cairo_->get());
}

void Canvas::unclip() { cairo_reset_clip(cairo_->get()); }

renderer::Texture Canvas::picture() const {
  cairo_surface_flush(cairo_->surface());
  renderer::Texture picture(static_cast<int>(cairo_->width()), static_cast<int>(cairo_->height()));
  const auto* data = cairo_image_surface_get_data(cairo_->surface());
  if (!data) return picture;
  const int stride = cairo_image_surface_get_stride(cairo_->surface());
  for (int y = 0; y < picture.height(); ++y) {
    const auto* in =
        reinterpret_cast<const std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride);
    auto* out = picture.row(y);
    for (int x = 0; x < picture.width(); ++x)
      out[x] = 0xff000000u | (in[x] & 0x0000ff00u) | (in[x] >> 16 & 255) | (in[x] & 255) << 16;
  }
  return picture;
}

PaperCanvas::PaperCanvas(double width_pt, double height_pt, const std::string& title)
    : Canvas(nullptr), file_(std::make_unique<std::string>()) {
  constexpr auto append = [](void* file, const unsigned char* bytes, unsigned int count) {
    static_cast<std::string*>(file)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
  };
  Surface surface(cairo_pdf_surface_create_for_stream(append, file_.get(), width_pt, height_pt),
                  cairo_surface_destroy);
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, title.c_str());
  cairo_ = std::make_unique<Cairo>(std::move(surface), width_pt, height_pt);
}

PaperCanvas::~PaperCanvas() {
  cairo_.reset();  // writes the rest of the file
}

void PaperCanvas::end_page() { cairo_show_page(cairo_->get()); }

std::string PaperCanvas::finish() {
  cairo_surface_finish(cairo_->surface());
  return std::move(*file_);
}

}  // namespace handcast::preview
