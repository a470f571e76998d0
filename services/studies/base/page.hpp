// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "services/studies/base/comparison.hpp"

/// Parts of the pages of results, HTML.
namespace handcast::study {

/// All that is before the first paragraph.
std::string page_head(std::string_view title);
/// Bars of the conditions by subject, as the figures of the paper, SVG.
std::string bars_of(const Comparison& comparison, const std::string& unit);

}  // namespace handcast::study
