// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "services/content/source.hpp"

namespace handcast::gallery {

/// One content of the page.
struct Entry {
  std::string title, sentence;
  std::vector<content::Parameter> parameters;
  std::string file;  ///< its pictures, side by side
  int width_px, height_px;
  double took_ms;
};

/// The page of all entries, HTML: each runs through its `frames` pictures in `seconds`, there and
/// back.
std::string page_of(const std::vector<Entry>& entries, int frames, double seconds);

}  // namespace handcast::gallery
