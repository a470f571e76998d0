// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "renderer/base/image.hpp"

namespace handcast::preview {

/// A colour with opacity, each part 0..1.
struct Colour {
  /// Red, green, blue and opacity.
  /// @{
  float red = 0, green = 0, blue = 0, alpha = 1;
  /// @}

  /// The colour 0xrrggbb.
  static constexpr Colour of(std::uint32_t hex, float alpha = 1) {
    const auto part = [hex](int shift) { return static_cast<float>(hex >> shift & 255) / 255; };
    return {part(16), part(8), part(0), alpha};
  }
  /// The same colour with another opacity.
  constexpr Colour with_alpha(float opacity) const { return {red, green, blue, opacity}; }
};

/// A rectangle of the canvas, px from its top left corner.
struct Box {
  /// Left and top edge, width and height.
  /// @{
  double x = 0, y = 0, width = 0, height = 0;
  /// @}

  /// Right and lower edge.
  /// @{
  double right() const { return x + width; }
  double bottom() const { return y + height; }
  /// @}
};

/// The side of a text that lies at its position.
enum class Align { left, centre, right };

/// How a text is written.
struct Font {
  double size_px = 12;  ///< height of a line without leading
  bool bold = false;    ///< bold instead of regular
};

/// A straight line.
using Line = std::pair<glm::vec2, glm::vec2>;

/// A picture that is drawn on with antialiased lines, shapes, text and images, by cairo. Positions
/// in px from the top left corner, y down. Numbers that are not finite draw nothing. One thread.
class Canvas {
 public:
  /// A canvas of one colour. Both sizes at least 1. All positions and sizes that are given to its
  /// functions are multiplied by `scale`.
  Canvas(int width_px, int height_px, Colour background, double scale = 1);
  virtual ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  /// Size in the unit of positions: pixels divided by the scale.
  /// @{
  double width() const;
  double height() const;
  /// @}

  /// Fills a rectangle with round corners.
  void fill(const Box& box, Colour colour, double radius_px = 0);
  /// Fills a polygon.
  void fill(std::span<const glm::vec2> corners, Colour colour);
  /// Draws a line through points.
  void stroke(std::span<const glm::vec2> points, Colour colour, double width_px = 1);
  /// Draws separate lines.
  void stroke(std::span<const Line> lines, Colour colour, double width_px = 1);
  /// Draws a dashed line.
  void dash(const Line& line, Colour colour, double width_px = 1);
  /// Fills a circle.
  void disc(glm::vec2 centre, double radius_px, Colour colour);
  /// Draws a circle.
  void ring(glm::vec2 centre, double radius_px, Colour colour, double width_px = 1);
  /// Writes a text; `at` is on its baseline. Invalid UTF-8 and control characters become '?'.
  void text(glm::vec2 at, std::string_view text, Font font, Colour colour,
            Align align = Align::left);
  /// Width of a text in pixels.
  double width_of(std::string_view text, Font font) const;
  /// Draws RGBA8 scaled to a box, bilinear.
  void image(renderer::View<const std::uint32_t> rgba, const Box& box);

  /// Draws only inside of a box from now on, until the next call of unclip().
  /// @{
  void clip(const Box& box);
  void unclip();
  /// @}

  /// The picture so far, RGBA8, opaque. Not of a PaperCanvas.
  renderer::Texture picture() const;

 protected:
  class Cairo;
  explicit Canvas(std::unique_ptr<Cairo> cairo);
  std::unique_ptr<Cairo> cairo_;
};

/// White pages of a PDF file that are drawn on one after another. Positions in points, 1/72 inch.
class PaperCanvas : public Canvas {
 public:
  PaperCanvas(double width_pt, double height_pt, const std::string& title);
  ~PaperCanvas() override;

  /// Ends a page; what is drawn next is on the next one.
  void end_page();
  /// The file. Nothing may be drawn afterwards.
  std::string finish();

 private:
  std::unique_ptr<std::string> file_;
};

}  // namespace handcast::preview
