// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "ipc/base/command_line.hpp"

namespace handcast::preview {
namespace {

constexpr double kLongest_s = 3600;

/// "1600x900".
Result<void> set_size(const std::string& text, Look& look) {
  int width = 0, height = 0;
  char after = 0;
  const bool is_size = std::sscanf(text.c_str(), "%5dx%5d%c", &width, &height, &after) == 2;
  if (!is_size || std::min(width, height) < kSmallestSide_px ||
      std::max(width, height) > kLargestSide_px)
    return fail(Errc::bad_config,
                fmt::format("--size: '{}' is no size like 1600x900, with {} to {} px on a side",
                            text, kSmallestSide_px, kLargestSide_px));
  look.width_px = width;
  look.height_px = height;
  return {};
}

}  // namespace

Result<Parsed> parse(int argc, char** argv) {
  Parsed parsed;
  auto& options = parsed.options;
  std::string size, layers;
  bool is_second = false;
  CommandLine line("handcast preview",
                   "Shows what a running rig sees and does, in a window or as a picture.");
  line.add("--rig NAME", options.rig, "Which rig, if several are up");
  line.add("--second-projector", is_second, "Shows the light of the second projector");
  line.add("--shot FILE.png", options.shot, "Writes a PNG file instead; needs no display");
  line.add("--after N", options.after_s, "Seconds for which the rig is watched before the picture",
           {0.1, kLongest_s});
  line.add("--layers LIST", layers,
           "What is shown over one another: all, or some of image, regions, light, drawing, "
           "joints, landmarks, separated by commas; default: image,light");
  line.add("--size WIDTHxHEIGHT", size, "Size in pixels; default: 1600x900");
  auto text = line.parse(argc, argv);
  if (!text) return tl::make_unexpected(text.error());
  parsed.text = std::move(*text);
  if (is_second) options.projector = config::Viewpoint::second;
  if (!size.empty())
    if (auto set = set_size(size, options.look); !set) return tl::make_unexpected(set.error());
  if (layers.empty()) return parsed;
  const auto chosen = parse_layers(layers);
  if (!chosen) return fail_in("--layers", chosen.error());
  options.look.layers = *chosen;
  return parsed;
}

}  // namespace handcast::preview
