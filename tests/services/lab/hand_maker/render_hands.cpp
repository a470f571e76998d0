// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "renderer/skin/skinning.hpp"
#include "tests/renderer/poses.hpp"

// render_hands FOLDER [FILE.glb]: pictures of the hand in five poses, of its wires and of its
// texture layout, to be looked at.
namespace handcast::renderer::samples {
namespace {

constexpr int kSize = 700;
constexpr float kPixelsPerMetre = 2400;

struct Camera {
  glm::mat3 view_from_model;  ///< x right, y up, z to the viewer
  glm::vec3 at;
};

using Shader = std::function<glm::vec3(glm::vec3 bary, int triangle, glm::vec3 normal)>;

void draw(cv::Mat& canvas, const HandMesh& hand, const std::vector<glm::vec3>& positions,
          const std::vector<glm::vec3>& normals, const Camera& camera, const Shader& shade) {
  std::vector<float> depth(static_cast<std::size_t>(kSize) * kSize, -1e9f);
  for (int t = 0; t < std::ssize(hand.triangles); ++t) {
    glm::vec3 p[3];
    for (int c = 0; c < 3; ++c) {
      const glm::vec3 v =
          camera.view_from_model * (positions[hand.triangles[t][c]] - camera.at) * kPixelsPerMetre;
      p[c] = {kSize / 2 + v.x, kSize / 2 - v.y, v.z};
    }
    const float area =
        (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
    if (std::abs(area) < 1e-6f) continue;
    const auto [x0, x1] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y});
    for (int y = std::max(0, int(y0)); y <= std::min(kSize - 1, int(y1) + 1); ++y)
      for (int x = std::max(0, int(x0)); x <= std::min(kSize - 1, int(x1) + 1); ++x) {
        glm::vec3 b;
        for (int c = 0; c < 3; ++c) {
          const glm::vec3 &u = p[(c + 1) % 3], &w = p[(c + 2) % 3];
          b[c] = ((w.x - u.x) * (y - u.y) - (x - u.x) * (w.y - u.y)) / area;
        }
        if (b.x < 0 || b.y < 0 || b.z < 0) continue;
        const float z = b.x * p[0].z + b.y * p[1].z + b.z * p[2].z;
        if (z <= depth[y * kSize + x]) continue;
        depth[y * kSize + x] = z;
        glm::vec3 n(0);
        for (int c = 0; c < 3; ++c) n += b[c] * normals[hand.triangles[t][c]];
        const glm::vec3 colour =
            glm::clamp(shade(b, t, camera.view_from_model * glm::normalize(n)), 0.0f, 1.0f) *
            255.0f;
        canvas.at<cv::Vec3b>(y, x) = {uchar(colour.b), uchar(colour.g), uchar(colour.r)};
      }
  }
}

float light(const glm::vec3& n) {
  return 0.25f + 0.65f * std::max(0.0f, glm::dot(n, glm::normalize(glm::vec3(-0.5f, 0.6f, 0.7f)))) +
         0.15f * std::max(0.0f, n.z);
}

cv::Mat picture(const HandMesh& hand, const JointFrames& frames, const Camera& camera, int style) {
  std::vector<glm::vec3> positions(hand.vertex_count()), normals(hand.vertex_count());
  skin(hand, frames, positions, normals);
  const Shader shade = [&](glm::vec3 b, int t, glm::vec3 n) {
    const auto& v = hand.triangles[t];
    glm::vec3 colour(0.62f, 0.69f, 0.8f);
    if (n.z < -0.3f) colour = {0.9f, 0.2f, 0.2f};
    if (style == 1) {
      const glm::vec2 uv = b.x * hand.uv[v[0]] + b.y * hand.uv[v[1]] + b.z * hand.uv[v[2]];
      const bool dark = (int(std::floor(uv.x * 96)) + int(std::floor(uv.y * 60))) % 2;
      colour =
          hand.chart[v[0]] == 1 ? glm::vec3(0.9f, 0.75f, 0.4f) : glm::vec3(0.35f, 0.75f, 0.85f);
      colour *= dark ? 0.3f : 1.0f;
    }
    if (style == 2 && std::min({b.x, b.y, b.z}) < 0.06f) colour *= 0.35f;
    return colour * light(n);
  };
  cv::Mat canvas(kSize, kSize, CV_8UC3, cv::Scalar::all(255));
  draw(canvas, hand, positions, normals, camera, shade);
  return canvas;
}

/// View directions of a left hand; the picture's up is towards the finger tips.
std::vector<Camera> cameras() {
  const glm::vec3 centre(0, -0.01f, -0.06f);
  const auto looking = [&](glm::vec3 right, glm::vec3 up) {
    return Camera{glm::transpose(glm::mat3(right, up, glm::cross(right, up))), centre};
  };
  return {looking({1, 0, 0}, {0, 0, -1}), looking({-1, 0, 0}, {0, 0, -1}),
          looking({0, 1, 0}, {0, 0, -1}),
          looking(glm::normalize(glm::vec3(-0.7f, -0.7f, 0)), {0, 0, -1})};
}

void draw_poses(const HandMesh& hand, const std::filesystem::path& folder) {
  for (const Pose& pose : kPoses) {
    cv::Mat row;
    for (const auto& [view, style] : {std::pair{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 1}, {1, 1}}) {
      const cv::Mat one = picture(hand, posed(hand, pose), cameras()[view], style);
      row.empty() ? one.copyTo(row) : cv::hconcat(row, one, row);
    }
    cv::putText(row, std::string(pose.name), {10, 40}, cv::FONT_HERSHEY_SIMPLEX, 1.2, {0, 0, 0}, 2);
    cv::imwrite(folder / (std::string(pose.name) + ".png"), row);
  }
  cv::Mat large;
  cv::hconcat(picture(hand, posed(hand, kOpen), cameras()[0], 0),
              picture(hand, posed(hand, kOpen), cameras()[1], 0), large);
  cv::imwrite(folder / "open_large.png", large);
  cv::Mat wires;
  cv::hconcat(picture(hand, posed(hand, kOpen), cameras()[0], 2),
              picture(hand, posed(hand, kOpen), cameras()[1], 2), wires);
  cv::imwrite(folder / "wires.png", wires);
}

void draw_layout(const HandMesh& hand, const std::filesystem::path& folder) {
  cv::Mat atlas(640 * 2, 1024 * 2, CV_8UC3, cv::Scalar::all(255));
  for (const auto& t : hand.triangles)
    for (int c = 0; c < 3; ++c) {
      const glm::vec2 a = hand.uv[t[c]] * glm::vec2(2048, 1280),
                      b = hand.uv[t[(c + 1) % 3]] * glm::vec2(2048, 1280);
      cv::line(atlas, {int(a.x), int(a.y)}, {int(b.x), int(b.y)},
               hand.chart[t[0]] == 1 ? cv::Scalar(20, 120, 200) : cv::Scalar(200, 120, 20));
    }
  cv::imwrite(folder / "layout.png", atlas);
}

}  // namespace
}  // namespace handcast::renderer::samples

int main(int argc, char** argv) {
  using namespace handcast::renderer;
  if (argc < 2) return std::fprintf(stderr, "usage: render_hands FOLDER [FILE.glb]\n"), 2;
  std::filesystem::create_directories(argv[1]);
  const auto hand = load_hand_or_default(argc > 2 ? argv[2] : "", Side::left);
  if (!hand) return std::fprintf(stderr, "%s\n", hand.error().what.c_str()), 1;
  samples::draw_poses(*hand, argv[1]);
  samples::draw_layout(*hand, argv[1]);
}
