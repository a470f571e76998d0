// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/evaluation/chart/analysis.hpp"
#include "services/evaluation/chart/palette.hpp"

namespace handcast::chart {

/// Fonts as gnuplot is told of them; as_file() makes them real ones.
inline constexpr std::string_view kFont = "sans-serif", kBoldFont = "bold";

/// A rectangle of the picture in pixels, y down.
struct Area {
  double left = 0, top = 0, right = 0, bottom = 0;
};

/// Where a text stands, and how.
struct TextStyle {
  Colour colour = kInk;
  std::string_view align = "left";
  int size = 13;
  bool bold = false;
};

/// From where to where an axis goes.
struct Range {
  double low = 0, high = 1;
  bool log = false;
  double share(double value) const;  ///< 0 at low, 1 at high
};

/// Text for gnuplot, panel by panel. Places are pixels of the picture where they are not said to be
/// of the axes.
class Script {
 public:
  Script(const std::string& name, int width_px, int height_px);

  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  /// What follows is drawn here, until plot().
  void panel(const Area& area, const Range& x, const Range& y);
  void x_axis(std::string_view title);
  void y_axis(std::string_view title);
  void tics(std::string_view axis, std::span<const double> values);

  void text(double x_px, double y_px, std::string_view words, const TextStyle& style);
  /// Between two places of the picture.
  void stroke(Point from_px, Point to_px, const Colour& colour, double width = 1);
  /// The panel between two values of x.
  void band(double from, double to, const Colour& colour);

  /// A series; `how` as after gnuplot's "with".
  void series(std::span<const Point> points, std::string_view how);
  /// Draws the panel with what was said since panel().
  void plot();

  Point place_px(const Point& of_axes) const;  ///< in the panel under way
  const Area& area() const { return area_; }
  std::string finish() const { return text_ + "unset multiplot\n"; }

 private:
  std::string on_screen(double x_px, double y_px) const;

  int width_px_, height_px_;
  std::string text_, series_;
  Area area_;
  Range x_, y_;
  int blocks_ = 0, things_ = 0;
};

/// In single quotes: in others gnuplot runs what stands in backticks. An apostrophe becomes one
/// that ends no quote.
std::string quote(std::string_view words);

/// Ticks 1, 2, 5, 10, ... within a logarithmic range; about `count` round ones within another.
std::vector<double> nice_tics(const Range& range, int count = 6);
/// Wide enough for all values; from 0 unless logarithmic.
Range range_of(std::span<const double> values, bool log);

/// Words beside points, in a column to the right of the panel, moved apart and each tied to its
/// point.
struct Label {
  Point point;  ///< of the axes
  std::string words;
  Colour colour = kInk;
  bool bold = false;
};
void label_beside(Script& script, std::span<const Label> labels, double gap_px = 17);

}  // namespace handcast::chart
