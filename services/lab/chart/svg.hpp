// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace handcast::chart {

/// Prepares an SVG of gnuplot for a file: sets the title, which screen readers use, and the
/// system's fonts.
std::string as_file(std::string svg, const std::string& title);

/// Prepares an SVG for a page: prefixes its ids with `name`, which must be unique on the page, and
/// replaces kColours by the CSS variables of the page.
std::string as_part_of_page(std::string svg, const std::string& name);

}  // namespace handcast::chart
