// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/lab/chart/analysis.hpp"
#include "services/lab/chart/palette.hpp"

namespace handcast::chart {

/// Font names in the script. as_file() replaces them by real fonts.
/// @{
inline constexpr std::string_view kFont = "sans-serif", kBoldFont = "bold";
/// @}

/// A rectangle of the picture in pixels, y down.
struct Area {
  double left = 0;    ///< x
  double top = 0;     ///< y
  double right = 0;   ///< x
  double bottom = 0;  ///< y
};

/// The style of a text.
struct TextStyle {
  Colour colour = kInk;             ///< of the letters
  std::string_view align = "left";  ///< side of the text at its place: left, center, right
  int size = 13;                    ///< of the font, px
  bool bold = false;                ///< kBoldFont instead of kFont
};

/// The range of an axis.
struct Range {
  double low = 0;    ///< first value; greater than 0 if logarithmic
  double high = 1;   ///< last value
  bool log = false;  ///< logarithmic
  /// The place of a value on the axis: 0 at low, 1 at high.
  double share(double value) const;
};

/// Writes a gnuplot script that draws a picture panel by panel. Positions are pixels of the
/// picture, y down, unless they are said to be values of the axes.
class Script {
 public:
  /// Begins a picture. `name` prefixes the ids in the SVG.
  Script(const std::string& name, int width_px, int height_px);

  /// Appends a line of gnuplot commands.
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  /// Begins a panel with linear or logarithmic axes and their tics. plot() must end it.
  void panel(const Area& area, const Range& x, const Range& y);
  /// Writes a title below the panel.
  void x_axis(std::string_view title);
  /// Writes a title above the panel.
  void y_axis(std::string_view title);
  /// Replaces the tics of axis "x" or "y".
  void tics(std::string_view axis, std::span<const double> values);

  /// Writes a text, vertically centred.
  void text(double x_px, double y_px, std::string_view words, const TextStyle& style);
  /// Draws a line between two points of the picture.
  void stroke(Point from_px, Point to_px, const Colour& colour, double width = 1);
  /// Fills the panel between two values of the x axis.
  void band(double from, double to, const Colour& colour);

  /// Adds a series of points, in values of the axes. `how` is a gnuplot style, as after "with".
  void series(std::span<const Point> points, std::string_view how);
  /// Draws the panel.
  void plot();

  /// The position of a point given in values of the axes of the current panel.
  Point place_px(const Point& of_axes) const;
  /// The area of the current panel.
  const Area& area() const { return area_; }
  /// The whole script.
  std::string finish() const { return text_ + "unset multiplot\n"; }

 private:
  std::string on_screen(double x_px, double y_px) const;

  int width_px_, height_px_;
  std::string text_, series_;
  Area area_;
  Range x_, y_;
  int blocks_ = 0, things_ = 0;
};

/// Puts text in single quotes, in which gnuplot does not execute backticks. An apostrophe becomes a
/// typographic one, a line break a space.
std::string quote(std::string_view words);

/// Tics at 1, 2, 5, 10, ... of a logarithmic range, or about `count` round values of a linear one.
std::vector<double> nice_tics(const Range& range, int count = 6);
/// A range that holds all values with a margin. A linear one begins at 0.
Range range_of(std::span<const double> values, bool log);

/// A text that names a point.
struct Label {
  Point point;           ///< in values of the axes
  std::string words;     ///< the text
  Colour colour = kInk;  ///< of the text
  bool bold = false;     ///< kBoldFont instead of kFont
};
/// Writes labels in a column to the right of the current panel, at least `gap_px` apart, and draws
/// a line from each to its point.
void label_beside(Script& script, std::span<const Label> labels, double gap_px = 17);

}  // namespace handcast::chart
