// SPDX-License-Identifier: Apache-2.0
#include "services/tools/detect/result.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ipc/base/clock.hpp"

namespace handcast::detect {
namespace {

constexpr std::array kFinger{"thumb", "index", "middle", "ring", "little"};

std::string table_of(const landmarks::Points& points) {
  std::string text = fmt::format("    wrist   {:7.1f} {:7.1f}\n", points[0].x, points[0].y);
  for (int finger = 0; finger < 5; ++finger) {
    text += fmt::format("    {:7}", kFinger[finger]);
    for (int k = 1; k <= 4; ++k)
      text += fmt::format(" {:7.1f} {:7.1f} {}", points[4 * finger + k].x, points[4 * finger + k].y,
                          k < 4 ? " " : "");
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

nlohmann::json json_of(const landmarks::FoundHand& hand) {
  auto points = nlohmann::json::array();
  for (const auto& point : hand.points_px) points.push_back({point.x, point.y});
  return {{"side", name_of(hand.side)}, {"presence", hand.presence}, {"points_px", points}};
}

}  // namespace

const char* name_of(msg::Side side) { return side == msg::Side::left ? "left" : "right"; }

std::string print_text(const Result& result) {
  const auto& times = result.times;
  std::string text =
      fmt::format("{}: {} hand{}, {:.2f} ms (crop {:.2f}, network {:.2f}{})\n",
                  result.image.string(), result.hands.size(), result.hands.size() == 1 ? "" : "s",
                  ns_to_ms(times.all_ns), ns_to_ms(times.crop_ns), ns_to_ms(times.network_ns),
                  times.palm_runs > 0 ? fmt::format(", palm {:.2f}", ns_to_ms(times.palm_ns)) : "");
  for (const auto& hand : result.hands)
    text += fmt::format("  {} hand, presence {:.3f}; px from palm to tip:\n{}", name_of(hand.side),
                        hand.presence, table_of(hand.points_px));
  return text;
}

std::string print_json(const std::vector<Result>& results) {
  auto images = nlohmann::json::array();
  for (const auto& result : results) {
    auto hands = nlohmann::json::array();
    for (const auto& hand : result.hands) hands.push_back(json_of(hand));
    const auto& times = result.times;
    images.push_back({{"image", result.image.string()},
                      {"ms",
                       {{"all", ns_to_ms(times.all_ns)},
                        {"crop", ns_to_ms(times.crop_ns)},
                        {"network", ns_to_ms(times.network_ns)},
                        {"palm", ns_to_ms(times.palm_ns)}}},
                      {"hands", hands}});
  }
  return nlohmann::json{{"images", images}}.dump(1, ' ', false,
                                                 nlohmann::json::error_handler_t::replace) +
         "\n";  // a path need not be UTF-8
}

}  // namespace handcast::detect
