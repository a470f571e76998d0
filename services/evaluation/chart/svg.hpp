// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace handcast::chart {

/// What gnuplot drew as a file of its own: a title for those who do not see it, and the reader's
/// own font.
std::string as_file(std::string svg, const std::string& title);

/// The same as a part of a page: names that no other chart there has, and the page's colours for
/// kColours.
std::string as_part_of_page(std::string svg, const std::string& name);

}  // namespace handcast::chart
