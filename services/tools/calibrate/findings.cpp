// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/findings.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "config/settings/choice.hpp"

namespace handcast::calibrate {
namespace {

using nlohmann::json;

/// Names of files and devices may be no UTF-8. NaN becomes null.
std::string text_of(const json& value) {
  return value.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

double tenths(double value) { return std::round(10 * value) / 10; }

}  // namespace

Picture dots_picture(int width_px, int height_px, std::span<const glm::dvec2> dots_px,
                     std::string caption) {
  constexpr std::size_t kMost = 2000;
  Picture picture{"dots", std::move(caption)};
  picture.numbers["size_px"] = {static_cast<double>(width_px), static_cast<double>(height_px)};
  auto &right_px = picture.numbers["right_px"], &down_px = picture.numbers["down_px"];
  for (std::size_t i = 0; i < dots_px.size(); i += 1 + dots_px.size() / kMost) {
    right_px.push_back(tenths(dots_px[i].x));
    down_px.push_back(tenths(dots_px[i].y));
  }
  return picture;
}

std::string print_outcome(const Outcome& outcome) {
  json pictures = json::array();
  for (const auto& [kind, caption, numbers] : outcome.pictures)
    pictures.push_back({{"kind", kind}, {"caption", caption}, {"numbers", numbers}});
  return text_of({{"made", outcome.made},
                  {"findings", outcome.findings},
                  {"meaning", outcome.meaning},
                  {"pictures", std::move(pictures)}});
}

std::string print_report(const std::string& rig, const NamedFiles& command,
                         std::span<const Reported> steps) {
  json reported = json::array();
  for (const auto& [step, made, is_done] : steps)
    reported.push_back({{"step", config::word_of(step)}, {"made", made}, {"is_done", is_done}});
  return text_of({{"rig", rig},
                  {"rig_file", command.rig_file},
                  {"board", command.board},
                  {"folder", command.folder},
                  {"option", command.option},
                  {"steps", std::move(reported)}});
}

}  // namespace handcast::calibrate
