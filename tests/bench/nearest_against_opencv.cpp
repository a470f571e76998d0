// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/nearest_against_opencv.hpp"

#include <map>
#include <opencv2/imgproc.hpp>

#include "renderer/draw/cpu/cpu_painter.hpp"
#include "renderer/draw/cpu/nearest_pixel.hpp"
#include "tests/bench/painter_scene.hpp"
#include "tests/bench/percentiles.hpp"

namespace handcast::bench {
namespace {

using renderer::Image;
using renderer::View;
using renderer::cpu::NearestPixel;
using renderer::cpu::NearestSeed;

constexpr int kReach = NearestPixel::kLargestReach;

struct Problem {
  Image<std::uint8_t> seeds, wanted;
};

Problem moved_hand(bool whole_frame) {
  constexpr renderer::Rect kScreen{0, 0, 1024, 768};
  const PainterScene scene("", 1, renderer::samples::kOpen, kScreen.x1, kScreen.y1);
  const auto painter = renderer::make_cpu_painter(kScreen.x1, kScreen.y1);
  painter->draw(scene.drawn, kScreen);
  const renderer::Rect area = whole_frame ? kScreen : scene.region;
  Problem problem{{area.width(), area.height()}, {area.width(), area.height()}};
  for (int y = 0; y < area.height(); ++y) {
    for (int x = 0; x < area.width(); ++x) {
      const std::uint8_t lit = painter->surface().at(x + area.x0, y + area.y0) ? 255 : 0,
                         on_hand = scene.mask.at(x + area.x0, y + area.y0);
      problem.seeds.at(x, y) = lit & on_hand;
      problem.wanted.at(x, y) = on_hand & ~lit;
    }
  }
  return problem;
}

/// Per wanted pixel the square of the distance to its nearest seed by looking at all within reach;
/// only those that have one.
std::map<std::pair<int, int>, int> truth_of(const Problem& problem) {
  std::map<std::pair<int, int>, int> truth;
  for (int y = 0; y < problem.wanted.height(); ++y) {
    for (int x = 0; x < problem.wanted.width(); ++x) {
      if (!problem.wanted.at(x, y)) continue;
      int best = kReach * kReach + 1;
      const renderer::Rect around = renderer::Rect{x, y, x + 1, y + 1}.grown(kReach).within(
          problem.seeds.width(), problem.seeds.height());
      for (int sy = around.y0; sy < around.y1; ++sy) {
        for (int sx = around.x0; sx < around.x1; ++sx) {
          if (problem.seeds.at(sx, sy))
            best = std::min(best, (sx - x) * (sx - x) + (sy - y) * (sy - y));
        }
      }
      if (best <= kReach * kReach) truth[{x, y}] = best;
    }
  }
  return truth;
}

int count_wrong_of_opencv(const Problem& problem, const std::map<std::pair<int, int>, int>& truth,
                          const cv::Mat& labels) {
  std::map<int, std::pair<int, int>> seed_of_label;
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) {
      if (problem.seeds.at(x, y)) seed_of_label[labels.at<int>(y, x)] = {x, y};
    }
  }
  int wrong = 0;
  for (const auto& [pixel, square] : truth) {
    const auto [x, y] = seed_of_label.at(labels.at<int>(pixel.second, pixel.first));
    wrong +=
        (x - pixel.first) * (x - pixel.first) + (y - pixel.second) * (y - pixel.second) != square;
  }
  return wrong;
}

}  // namespace

NearestComparison compare_nearest(bool whole_frame, int rounds) {
  cv::setNumThreads(1);
  const Problem problem = moved_hand(whole_frame);
  cv::Mat unlit(problem.seeds.height(), problem.seeds.width(), CV_8UC1), distance, labels;
  for (int y = 0; y < unlit.rows; ++y) {
    for (int x = 0; x < unlit.cols; ++x)
      unlit.at<std::uint8_t>(y, x) = problem.seeds.at(x, y) ? 0 : 255;
  }
  NearestPixel transform;
  std::span<const NearestSeed> found;
  std::vector<double> ours_us, opencv_us;
  for (int round = 0; round < rounds; ++round) {
    ours_us.push_back(timed_us(
        [&] { found = transform.find(problem.seeds.view(), problem.wanted.view(), kReach); }));
    opencv_us.push_back(timed_us([&] {
      cv::distanceTransform(unlit, distance, labels, cv::DIST_L2, 5, cv::DIST_LABEL_PIXEL);
    }));
  }
  const auto truth = truth_of(problem);
  NearestComparison result{median(ours_us), median(opencv_us), static_cast<int>(truth.size()), 0,
                           0};
  result.wrong_ours = static_cast<int>(truth.size()) - static_cast<int>(found.size());
  for (const NearestSeed& one : found) {
    const auto known = truth.find({one.x, one.y});
    result.wrong_ours += known == truth.end() || known->second != one.dx * one.dx + one.dy * one.dy;
  }
  result.wrong_opencv = count_wrong_of_opencv(problem, truth, labels);
  return result;
}

}  // namespace handcast::bench
