// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/choose/open_painter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "ipc/base/log.hpp"
#include "ipc/base/statistics.hpp"
#include "renderer/draw/cpu/cpu_painter.hpp"

#ifdef HANDCAST_WITH_GL
#include "renderer/draw/gl/gl_painter.hpp"
#endif

namespace handcast::renderer {
namespace {

constexpr int kRings = 45, kSegments = 45;  // 2 x 45 x 45 triangles; a hand has 4046

/// An ellipsoid in the middle of the screen, and the mask of a hand that has moved on.
class Scene {
 public:
  Scene(int width_px, int height_px)
      : texture_(Texture(1024, 640, 0xffc0c0c0), true), mask_(width_px, height_px) {
    const auto unit_px = static_cast<float>(height_px);
    const glm::vec2 centre(width_px / 2, height_px / 2), radius(0.13f * unit_px, 0.19f * unit_px),
        moved = centre + 0.016f * unit_px;
    add_vertices(centre, radius);
    add_triangles();
    for (int y = 0; y < height_px; ++y)
      for (int x = 0; x < width_px; ++x)
        mask_.at(x, y) = glm::length((glm::vec2(x, y) - moved) / radius) < 1 ? 255 : 0;
    const glm::ivec2 low(centre - radius), high(moved + radius);
    region_ = Rect{low.x, low.y, high.x, high.y}.grown(2).within(width_px, height_px);
  }

  void paint(Painter& painter) const {
    const DrawnHand drawn{&mesh_, texture_.view(), position_px_, depth_m_,
                          {},     revision_,       revision_};
    painter.draw({&drawn, 1}, region_);
    painter.fill(mask_.view(), {}, region_);
    painter.colour();
  }

 private:
  void add_vertices(glm::vec2 centre, glm::vec2 radius) {
    constexpr float kHalfTurn = std::numbers::pi_v<float>;
    for (int ring = 0; ring <= kRings; ++ring) {
      for (int segment = 0; segment <= kSegments; ++segment) {
        const glm::vec2 uv(static_cast<float>(segment) / kSegments,
                           static_cast<float>(ring) / kRings);
        const float polar = kHalfTurn * uv.y, turn = 2 * kHalfTurn * uv.x;
        position_px_.push_back(
            centre + radius * glm::vec2(std::sin(polar) * std::cos(turn), -std::cos(polar)));
        depth_m_.push_back(0.7f - 0.04f * std::sin(polar) * std::sin(turn));
        mesh_.positions.emplace_back(0);
        mesh_.uv.push_back(uv);
        mesh_.chart.push_back(1);
      }
    }
  }

  void add_triangles() {
    const auto node = [](int ring, int segment) {
      return static_cast<std::uint16_t>(ring * (kSegments + 1) + segment);
    };
    for (int ring = 0; ring < kRings; ++ring) {
      for (int segment = 0; segment < kSegments; ++segment) {
        mesh_.triangles.push_back(
            {node(ring, segment), node(ring, segment + 1), node(ring + 1, segment)});
        mesh_.triangles.push_back(
            {node(ring, segment + 1), node(ring + 1, segment + 1), node(ring + 1, segment)});
      }
    }
  }

  HandMesh mesh_;
  MipChain texture_;
  std::vector<glm::vec2> position_px_;
  std::vector<float> depth_m_;
  Image<std::uint8_t> mask_;
  Rect region_;
  std::uint64_t revision_ = new_revision();
};

FrameTime time_of(std::vector<double> frames_ms) {
  return {median(std::span(frames_ms)), quantile(std::span(frames_ms), 0.99)};
}

/// One painter of a contest.
class Contestant {
 public:
  Contestant(Painter& painter, const std::function<std::int64_t()>& clock)
      : painter_(painter), clock_(clock) {}

  /// Paints the frames of a round, until `end_ns` if it has drawn before.
  void paint_round(const Scene& scene, std::int64_t end_ns) {
    constexpr int kRound = 4;  // frames, of which the first only warms up
    round_ms_.clear();
    for (int i = 0; i < kRound && (frames_ms_.empty() || clock_() < end_ns); ++i) {
      const std::int64_t begin_ns = clock_();
      scene.paint(painter_);
      if (i == 0) continue;
      round_ms_.push_back(ns_to_ms(clock_() - begin_ns));
      frames_ms_.push_back(round_ms_.back());
    }
  }
  /// Median of the last round; empty if its end was cut off.
  std::optional<double> round_ms() const {
    return round_ms_.empty() ? std::nullopt : std::optional(median(round_ms_));
  }
  FrameTime times() const { return time_of(frames_ms_); }

 private:
  Painter& painter_;
  const std::function<std::int64_t()>& clock_;
  std::vector<double> round_ms_, frames_ms_;
};

}  // namespace

std::pair<FrameTime, FrameTime> contest(Painter& one, Painter& other, int width_px, int height_px,
                                        const ContestEnd& end,
                                        const std::function<std::int64_t()>& clock) {
  const Scene scene(width_px, height_px);
  std::array contestants{Contestant(one, clock), Contestant(other, clock)};
  std::array<int, 2> clear_wins{};  // in succession
  const std::int64_t end_ns = clock() + seconds_to_ns(end.limit_s);
  do {
    for (Contestant& each : contestants) each.paint_round(scene, end_ns);
    const auto one_ms = contestants[0].round_ms(), other_ms = contestants[1].round_ms();
    if (!one_ms || !other_ms) break;
    clear_wins[0] = *one_ms * end.clear_factor < *other_ms ? clear_wins[0] + 1 : 0;
    clear_wins[1] = *other_ms * end.clear_factor < *one_ms ? clear_wins[1] + 1 : 0;
  } while (std::ranges::max(clear_wins) < end.clear_rounds && clock() < end_ns);
  return {contestants[0].times(), contestants[1].times()};
}

namespace {

/// A painter on a GPU, and what the log calls that GPU.
struct OpenedGl {
  std::unique_ptr<Painter> painter;
  std::string gpu;
};

Result<OpenedGl> open_gl([[maybe_unused]] int width_px, [[maybe_unused]] int height_px,
                         [[maybe_unused]] const ShareGroup& shares) {
#ifdef HANDCAST_WITH_GL
  auto painter = open_gl_painter(width_px, height_px, {.is_timed = true, .shares = shares});
  if (!painter && shares) {
    log::warning("painter gl cannot draw for the window: {}; its images are copied instead",
                 painter.error().what);
    painter = open_gl_painter(width_px, height_px, {.is_timed = true});
  }
  if (!painter) return tl::make_unexpected(painter.error());
  const gl::Gpu& gpu = (*painter)->gpu();
  std::string name = fmt::format("{} (EGL {})", gpu.sentence(), gpu.platform);
  return OpenedGl{std::move(*painter), std::move(name)};
#else
  return fail(Errc::bad_config, "this handcast was built without it (HANDCAST_WITH_GL)");
#endif
}

/// The faster of two painters.
std::unique_ptr<Painter> faster_of(std::unique_ptr<Painter> cpu, OpenedGl gl, int width_px,
                                   int height_px) {
  const auto [cpu_times, gl_times] = contest(*cpu, *gl.painter, width_px, height_px);
  if (const auto failure = gl.painter->failure()) {
    log::warning("{}; drawing with cpu", failure->what);
    return cpu;
  }
  const bool gl_wins = gl_times.p50_ms < cpu_times.p50_ms;
  log::info(
      "painter auto: {} is faster: a frame takes {:.2f} ms (p99 {:.2f}) with cpu, {:.2f} ms (p99 "
      "{:.2f}) with gl on {}",
      gl_wins ? "gl" : "cpu", cpu_times.p50_ms, cpu_times.p99_ms, gl_times.p50_ms, gl_times.p99_ms,
      gl.gpu);
  return gl_wins ? std::move(gl.painter) : std::move(cpu);
}

}  // namespace

std::unique_ptr<Painter> open_painter(config::PainterChoice choice, int width_px, int height_px,
                                      const ShareGroup& shares, int threads) {
  if (choice == config::PainterChoice::cpu) return make_cpu_painter(width_px, height_px, threads);
  auto gl = open_gl(width_px, height_px, shares);
  if (!gl) {
    log::warning("painter gl cannot be opened: {}; drawing with cpu", gl.error().what);
    return make_cpu_painter(width_px, height_px, threads);
  }
  if (choice == config::PainterChoice::automatic)
    return faster_of(make_cpu_painter(width_px, height_px, threads), std::move(*gl), width_px,
                     height_px);
  log::info("painter gl: {}", gl->gpu);
  return std::move(gl->painter);
}

}  // namespace handcast::renderer
