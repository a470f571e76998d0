// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/svg.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string_view>

#include "services/lab/chart/palette.hpp"
#include "services/lab/chart/script.hpp"
#include "services/tools/page/html.hpp"

namespace handcast::chart {
namespace {

void replace_all(std::string& text, std::string_view what, std::string_view by) {
  for (auto at = text.find(what); at != text.npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

const Colour* known_colour(std::string_view value) {
  for (const auto& colour : kColours)
    if (colour.value == value) return &colour;
  return nullptr;
}

/// Converts "rgb( 20, 128, 106)" to "#14806a"; empty if it is malformed.
std::optional<std::string> as_hexadecimal(std::string_view rgb) {
  std::string hexadecimal = "#";
  for (std::size_t i = 0; i < rgb.size();) {
    int value = 0;
    const auto read = std::from_chars(rgb.data() + i, rgb.data() + rgb.size(), value);
    if (read.ec == std::errc{}) hexadecimal += fmt::format("{:02x}", value);
    i = read.ec == std::errc{} ? static_cast<std::size_t>(read.ptr - rgb.data()) : i + 1;
  }
  return hexadecimal.size() == 7 ? std::optional(hexadecimal) : std::nullopt;
}

void use_page_colours(std::string& svg) {
  for (auto at = svg.find("rgb("); at != svg.npos; at = svg.find("rgb(", at + 1)) {
    const auto end = svg.find(')', at);
    const auto value = as_hexadecimal(std::string_view(svg).substr(at, end - at));
    if (const auto* colour = value ? known_colour(*value) : nullptr)
      svg.replace(at, end + 1 - at, fmt::format("var(--{})", colour->name));
  }
  for (const auto& colour : kColours)
    replace_all(svg, fmt::format("\"{}\"", colour.value),
                fmt::format("\"var(--{})\"", colour.name));
}

}  // namespace

std::string as_file(std::string svg, const std::string& title) {
  if (const auto begin = svg.find("<title>"), end = svg.find("</title>");
      begin != svg.npos && end != svg.npos)
    svg.replace(begin + 7, end - begin - 7, page::escape(title));
  replace_all(svg, fmt::format("font-family=\"{}\"", kBoldFont),
              "font-weight=\"650\" font-family=\"system-ui, sans-serif\"");
  replace_all(svg, fmt::format("font-family=\"{}\"", kFont),
              "font-family=\"system-ui, sans-serif\"");
  return svg;
}

std::string as_part_of_page(std::string svg, const std::string& name) {
  svg.erase(0, svg.find("<svg"));
  replace_all(svg, " id='", " id='" + name + "_");
  replace_all(svg, " id=\"", " id=\"" + name + "_");
  replace_all(svg, "'#gp", "'#" + name + "_gp");
  replace_all(svg, "url(#", "url(#" + name + "_");
  replace_all(svg, "\"#gp", "\"#" + name + "_gp");
  use_page_colours(svg);
  return svg;
}

}  // namespace handcast::chart
