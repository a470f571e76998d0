// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/layout/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "services/tools/preview/layout/panels.hpp"

namespace handcast::preview {
namespace {

using theme::kGap_px;
using theme::kInset_px;

constexpr double kHead_px = 44, kTitle_px = 34, kLegend_px = 74;

/// The boxes of the panels.
struct Plan {
  Box head, camera, light, rates, ages, stages;
};

Plan plan(double width, double height, double aspect) {
  const double bottom_px = std::clamp(height * 0.235, 140.0, 240.0);
  const double inner = width - 2 * kGap_px;
  const double main_y = kHead_px, main_px = height - kHead_px - bottom_px - 2 * kGap_px;
  // The camera panel is as wide as its image, if that leaves two fifths for the light.
  const double image_px = (main_px - kTitle_px - kInset_px) * aspect + 2 * kInset_px;
  const double camera_px = std::min(image_px, inner * 0.6);
  const double below_y = main_y + main_px + kGap_px;
  const double rates_px = inner * 0.40, ages_px = inner * 0.22;
  Plan boxes;
  boxes.head = {kGap_px, 0, inner, kHead_px};
  boxes.camera = {kGap_px, main_y, camera_px, main_px};
  boxes.light = {2 * kGap_px + camera_px, main_y, inner - camera_px - kGap_px, main_px};
  boxes.rates = {kGap_px, below_y, rates_px, bottom_px};
  boxes.ages = {boxes.rates.right() + kGap_px, below_y, ages_px, bottom_px};
  boxes.stages = {boxes.ages.right() + kGap_px, below_y, inner - rates_px - ages_px - 2 * kGap_px,
                  bottom_px};
  return boxes;
}

std::string time_text(double seconds) {
  const auto whole = static_cast<long>(std::clamp(seconds, 0.0, 1e9));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

/// A small picture is a large one made smaller, so that texts do not collide; a very large one is
/// made larger, so that they can be read.
double scale_of(int width_px, int height_px) {
  const auto fits = [&](double width, double height) {
    return std::min(width_px / width, height_px / height);
  };
  return fits(1400, 780) < 1 ? fits(1400, 780) : std::max(fits(1920, 1080), 1.0);
}

void draw_head(Canvas& canvas, const Box& box, const Scene& scene, const Gauges& gauges,
               const Look& look) {
  const double y = box.y + 28;
  canvas.text({box.x + 2, y}, gauges.rig, theme::kHead, theme::kInk);
  const double name_px = canvas.width_of(gauges.rig, theme::kHead);
  canvas.text({box.x + name_px + 16, y}, "up " + time_text(gauges.uptime_s), theme::kText,
              theme::kQuiet);
  std::vector<std::string> ill = gauges.ill;
  ill.insert(ill.end(), scene.missing.begin(), scene.missing.end());
  auto state = ill.empty() ? "all services are ready" : ill.front();
  if (ill.size() > 1) state += fmt::format("  (and {} more)", ill.size() - 1);
  if (look.frozen) state = "frozen: space goes on";
  if (!look.note.empty()) state = look.note;
  const auto colour = look.frozen || !look.note.empty() ? theme::kTail
                      : ill.empty()                     ? theme::kGood
                                                        : theme::kBad;
  canvas.text({box.right() - 2, y}, state, theme::kText, theme::kInk, Align::right);
  canvas.disc({box.right() - 14 - canvas.width_of(state, theme::kText), y - 4}, 4, colour);
}

/// "last 60 s" for the graphs of rates and of ages.
std::pair<std::string, std::string> spans_of(const Gauges& gauges) {
  std::size_t rates = 0, ages = 0;
  for (const auto& rate : gauges.rates) rates = std::max(rates, rate.held_hz.size());
  for (const auto& age : gauges.ages) ages = std::max(ages, age.age_ms.size());
  const auto text = [](std::size_t count, double period_s) {
    return count == 0 ? "" : fmt::format("last {:.0f} s", static_cast<double>(count) * period_s);
  };
  return {text(rates, gauges.rates_period_s), text(ages, gauges.ages_period_s)};
}

/// What the dots of the stages mean, beside the title of their panel.
void draw_key(Canvas& canvas, const Box& box) {
  glm::vec2 at(box.x + kInset_px + canvas.width_of("Time per stage", theme::kTitle) + 22,
               box.y + 22);
  for (const auto& [name, colour] :
       {std::pair{"p50", theme::kMedian}, std::pair{"p99", theme::kTail}}) {
    canvas.disc(at + glm::vec2(0, -4), 3.2, colour);
    canvas.text(at + glm::vec2(8, 0), name, theme::kSmall, theme::kQuiet);
    at.x += 44;
  }
}

void draw_nothing(Canvas& canvas, const Box& box, std::string_view sentence) {
  canvas.text({box.x + box.width / 2, box.y + box.height / 2}, sentence, theme::kText,
              theme::kQuiet, Align::centre);
}

void draw_camera_panel(Canvas& canvas, const Box& box, const Scene& scene, const Layers& layers) {
  const int width = scene.camera.width(), height = scene.camera.height();
  const auto note = width > 0
                        ? fmt::format("{} × {} px   exposed {:.2f} ms   image {}", width, height,
                                      1e-6 * static_cast<double>(scene.exposure_ns), scene.image_id)
                        : "";
  const auto inside = panel(canvas, box, "Camera", note);
  if (width < 1)
    return draw_nothing(canvas, inside, scene.is_down ? "the rig is down" : "no image yet");
  draw_camera(canvas, fitted(inside, width, height), scene, layers);
}

/// The light of a projection as it is seen: its levels contain the share that is its alpha.
renderer::Texture as_seen(renderer::Texture light) {
  for (std::uint32_t& pixel : light.pixels())
    if (pixel != 0) pixel |= 0xff000000u;
  return light;
}

void draw_light_panel(Canvas& canvas, const Box& box, const Scene& scene) {
  const int width = scene.light.width(), height = scene.light.height();
  auto note = width > 0 ? fmt::format("{} × {} px   frame {}", width, height, scene.light_id) : "";
  if (width > 0 && scene.brightness < 1)
    note = fmt::format("brightness {:.3g}   {}", scene.brightness, note);
  auto inside = panel(canvas, box, "Light as projected", note);
  const bool has_legend = inside.height > 2 * kLegend_px;
  if (has_legend) {
    inside.height -= kLegend_px;
    draw_legend(canvas, {inside.x, inside.bottom() + 6, inside.width, kLegend_px - 6}, scene);
  }
  if (scene.is_down) return draw_nothing(canvas, inside, "dark: the rig is down");
  if (width < 1) return draw_nothing(canvas, inside, "no light yet");
  const auto frame = fitted(inside, width, height);
  canvas.fill(frame, Colour::of(0x000000));
  canvas.image(as_seen(scene.light).view(), frame);
}

void draw_help(Canvas& canvas) {
  struct Key {
    std::string_view key, what;
  };
  constexpr std::array kKeys{
      Key{"1 … 6", "image, regions, light, drawing, joints, landmarks: on or off"},
      Key{"space", "freezes the picture"}, Key{"s", "saves a picture in this folder"},
      Key{"h", "shows these keys, or hides them"}, Key{"q, Esc", "ends the preview"}};
  const Box box{canvas.width() / 2.0 - 250, canvas.height() / 2.0 - 86, 500, 172};
  canvas.fill(box, Colour::of(0x0d1117, 0.94f), 8);
  canvas.text({box.x + 24, box.y + 34}, "Keys", theme::kHead, theme::kInk);
  double y = box.y + 62;
  for (const auto& [key, what] : kKeys) {
    canvas.text({box.x + 24, y}, key, theme::kTitle, theme::kInk);
    canvas.text({box.x + 96, y}, what, theme::kText, theme::kQuiet);
    y += 22;
  }
}

}  // namespace

Box panel(Canvas& canvas, const Box& box, std::string_view title, std::string_view note) {
  canvas.fill(box, theme::kPanel, 6);
  canvas.text({box.x + kInset_px, box.y + 22}, title, theme::kTitle, theme::kInk);
  canvas.text({box.right() - kInset_px, box.y + 22}, note, theme::kSmall, theme::kQuiet,
              Align::right);
  return {box.x + kInset_px, box.y + kTitle_px, box.width - 2 * kInset_px,
          box.height - kTitle_px - kInset_px};
}

Box fitted(const Box& box, double width, double height) {
  const double scale = std::min(box.width / width, box.height / height);
  return {box.x + (box.width - scale * width) / 2, box.y + (box.height - scale * height) / 2,
          scale * width, scale * height};
}

renderer::Texture draw(const Scene& scene, const Gauges& gauges, const Look& look) {
  const auto side = [](int px) { return std::clamp(px, kSmallestSide_px, kLargestSide_px); };
  const int width_px = side(look.width_px), height_px = side(look.height_px);
  Canvas canvas(width_px, height_px, theme::kBackground, scale_of(width_px, height_px));
  const double aspect = scene.camera.width() > 0
                            ? static_cast<double>(scene.camera.width()) / scene.camera.height()
                            : 4.0 / 3;
  const auto boxes = plan(canvas.width(), canvas.height(), aspect);
  draw_head(canvas, boxes.head, scene, gauges, look);
  draw_camera_panel(canvas, boxes.camera, scene, look.layers);
  draw_light_panel(canvas, boxes.light, scene);
  const auto [rates_s, ages_s] = spans_of(gauges);
  draw_rates(canvas, panel(canvas, boxes.rates, "Rates", rates_s), gauges);
  draw_ages(canvas, panel(canvas, boxes.ages, "Age of the inputs when lit", ages_s), gauges);
  draw_stages(canvas, panel(canvas, boxes.stages, "Time per stage", "1 µs to 100 ms, last 10 s"),
              gauges);
  draw_key(canvas, boxes.stages);
  if (look.help) draw_help(canvas);
  return canvas.picture();
}

}  // namespace handcast::preview
