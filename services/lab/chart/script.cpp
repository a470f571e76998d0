// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/script.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::chart {

double Range::share(double value) const {
  if (log) return std::log(value / low) / std::log(high / low);
  return (value - low) / (high - low);
}

std::string quote(std::string_view words) {
  std::string quoted = "'";
  for (const char c : words) {
    if (c == '\'') {
      quoted += "’";
    } else {
      quoted += c == '\n' ? ' ' : c;
    }
  }
  return quoted + '\'';
}

Script::Script(const std::string& name, int width_px, int height_px)
    : width_px_(width_px), height_px_(height_px) {
  line("set terminal svg size {},{} font \"{},13\" noenhanced background \"{}\" name {} dynamic",
       width_px, height_px, kFont, kPanel.value, quote(name));
  line("set encoding utf8");
  line("set multiplot");
  line("set key off");
  line("set border 3 lc rgb \"{}\" lw 1", kLine.value);
  line("set tics nomirror scale 0.4 textcolor rgb \"{}\" font \",12\"", kQuiet.value);
  line("set grid x y lc rgb \"{}\" lw 0.6 lt 1 back", kLine.value);
}

void Script::panel(const Area& area, const Range& x, const Range& y) {
  area_ = area, x_ = x, y_ = y, series_.clear(), things_ = 0;
  line("reset\nset key off\nset encoding utf8");
  line("set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}", area.left / width_px_,
       area.right / width_px_);
  line("set tmargin at screen {:.5f}\nset bmargin at screen {:.5f}", 1 - area.top / height_px_,
       1 - area.bottom / height_px_);
  line("set border 3 lc rgb \"{}\" lw 1", kLine.value);
  line("set tics nomirror scale 0 textcolor rgb \"{}\" font \",12\"", kQuiet.value);
  line("set grid xtics ytics lc rgb \"{}\" lw 0.6 lt 1 back", kLine.value);
  if (x.log) line("set logscale x 10");
  if (y.log) line("set logscale y 10");
  line("set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]", x.low, x.high, y.low, y.high);
  tics("x", nice_tics(x));
  tics("y", nice_tics(y));
}

void Script::x_axis(std::string_view title) {
  text((area_.left + area_.right) / 2, area_.bottom + 38, title, {kQuiet, "center", 12});
}

void Script::y_axis(std::string_view title) {
  text(area_.left - 34, area_.top - 14, title, {kQuiet, "left", 12});
}

void Script::tics(std::string_view axis, std::span<const double> values) {
  std::string listed;
  for (const double value : values)
    listed += fmt::format("{}\"{:.6g}\" {:.6g}", listed.empty() ? "" : ", ", value, value);
  line("set {}tics ({})", axis, listed);
}

std::string Script::on_screen(double x_px, double y_px) const {
  return fmt::format("screen {:.5f}, screen {:.5f}", x_px / width_px_, 1 - y_px / height_px_);
}

void Script::text(double x_px, double y_px, std::string_view words, const TextStyle& style) {
  line("set label {} {} at {} {} front textcolor rgb \"{}\" font \"{},{}\"", ++things_,
       quote(words), on_screen(x_px, y_px), style.align, style.colour.value,
       style.bold ? kBoldFont : kFont, style.size);
}

void Script::stroke(Point from_px, Point to_px, const Colour& colour, double width) {
  line("set arrow {} from {} to {} nohead back lc rgb \"{}\" lw {}", ++things_,
       on_screen(from_px.x, from_px.y), on_screen(to_px.x, to_px.y), colour.value, width);
}

void Script::band(double from, double to, const Colour& colour) {
  line(
      "set object {} rectangle from first {:.6g}, graph 0 to first {:.6g}, graph 1 behind "
      "fillcolor rgb \"{}\" fillstyle solid noborder",
      ++things_, std::max(from, x_.low), std::min(to, x_.high), colour.value);
}

void Script::series(std::span<const Point> points, std::string_view how) {
  if (points.empty()) return;
  line("$block{} << END", ++blocks_);
  for (const auto& point : points) line("{:.6g} {:.6g}", point.x, point.y);
  line("END");
  series_ += fmt::format("{}$block{} using 1:2 with {}", series_.empty() ? "" : ", ", blocks_, how);
}

void Script::plot() { line("plot {}", series_.empty() ? "NaN" : series_); }

Point Script::place_px(const Point& of_axes) const {
  return {area_.left + x_.share(of_axes.x) * (area_.right - area_.left),
          area_.bottom - y_.share(of_axes.y) * (area_.bottom - area_.top)};
}

std::vector<double> nice_tics(const Range& range, int count) {
  std::vector<double> tics;
  if (range.log) {
    const int first = static_cast<int>(std::floor(std::log10(range.low))),
              last = static_cast<int>(std::floor(std::log10(range.high)));
    for (int power = first; power <= last; ++power)
      for (const double digit : {1, 2, 5})
        if (const double tic = digit * std::pow(10, power);
            tic >= range.low * 0.999 && tic <= range.high * 1.001)
          tics.push_back(tic);
    return tics;
  }
  const double rough = (range.high - range.low) / count,
               decade = std::pow(10, std::floor(std::log10(rough)));
  const double step = decade * (rough < 1.5 * decade   ? 1
                                : rough < 3.5 * decade ? 2
                                : rough < 7.5 * decade ? 5
                                                       : 10);
  for (int i = static_cast<int>(std::ceil(range.low / step - 1e-6));
       i * step <= range.high + 1e-6 * step; ++i)
    tics.push_back(i * step);
  return tics;
}

Range range_of(std::span<const double> values, bool log) {
  if (values.empty()) return {log ? 1.0 : 0.0, log ? 10.0 : 1.0, log};
  const auto [least, most] = std::ranges::minmax(values);
  if (log) return {0.85 * least, 1.18 * most, true};
  return {0, most > 0 ? 1.06 * most : 1, false};
}

void label_beside(Script& script, std::span<const Label> labels, double gap_px) {
  std::vector<double> heights_px;
  for (const auto& label : labels) heights_px.push_back(script.place_px(label.point).y);
  const auto& area = script.area();
  const auto spread_px = spread_apart(heights_px, gap_px, area.top + 4, area.bottom - 4);
  const double elbow_px = area.right + 12, words_px = area.right + 30;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto from_px = script.place_px(labels[i].point);
    script.stroke({from_px.x + 6, from_px.y}, {elbow_px, from_px.y}, kLine);
    script.stroke({elbow_px, from_px.y}, {words_px - 4, spread_px[i]}, kLine);
    script.text(words_px, spread_px[i], labels[i].words,
                {labels[i].colour, "left", 12, labels[i].bold});
  }
}

}  // namespace handcast::chart
