// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/landmarks_subjects.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "services/landmarks/inference/cost.hpp"
#include "services/landmarks/inference/network.hpp"
#include "services/landmarks/models/landmark_models.hpp"
#ifdef HANDCAST_WITH_OPENCV_DNN
#include "tests/services/landmarks/inference/opencv_network.hpp"
#endif

namespace handcast::bench {
namespace {

using namespace landmarks;
namespace fs = std::filesystem;

/// The next number of a pseudorandom sequence, 0..1.
float noise(unsigned& seed) {
  seed = seed * 1664525u + 1013904223u;
  return static_cast<float>(seed >> 8) / 16777216.f;
}

/// A bright disc about as large as a hand, with noise, and a region around it.
struct Scene {
  renderer::Image<std::uint8_t> image{720, 540};
  Region region{{361.3f, 268.6f}, 250, 0.7f};
  Points joints_px{};
  EstimateTimes ignored;

  Scene() {
    unsigned seed = 1;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        image.at(x, y) = static_cast<std::uint8_t>((std::hypot(x - 360, y - 270) < 100 ? 120 : 8) +
                                                   16 * noise(seed));
    for (glm::vec2& joint : joints_px)
      joint = region.to_image({0.8f * noise(seed) - 0.4f, 0.8f * noise(seed) - 0.4f});
  }
};

Subject estimate_with(std::unique_ptr<LandmarkModel> model, const std::string& name) {
  const std::shared_ptr<LandmarkModel> shared = std::move(model);
  const auto scene = std::make_shared<Scene>();
  return {name, "onednn", 0, [shared, scene] {
            return shared
                ->estimate(scene->image.view(), scene->region, msg::Side::left, scene->joints_px,
                           scene->ignored)
                .has_value();
          }};
}

void report(const std::string& name, std::string_view executor, const Error& error) {
  fmt::print("{} in {}: not measured: {}\n", name, executor, error.what);
}

}  // namespace

std::string estimate_of(const std::string& model) { return model + ", whole estimate"; }

std::vector<Subject> network_subjects(const fs::path& file) {
  using Open = Result<std::unique_ptr<Network>> (*)(const fs::path& file);
  std::vector<Subject> subjects;
  const std::string name = file.stem().string();
  for (const auto& [executor, open] : {
           std::pair{"onednn", Open{open_network}},
#ifdef HANDCAST_WITH_OPENCV_DNN
           std::pair{"opencv", Open{open_opencv_network}},
#endif
       }) {
    auto opened = open(file);
    if (!opened) {
      report(name, executor, opened.error());
      continue;
    }
    const std::shared_ptr<Network> network = std::move(*opened);
    unsigned seed = 1;
    for (std::size_t i = 0; i < network->inputs().size(); ++i)
      for (float& number : network->input(i)) number = noise(seed);
    subjects.push_back({name, executor, network_mmac(file).value_or(0),
                        [network] { return network->run().has_value(); }});
  }
  return subjects;
}

std::vector<Subject> estimate_subjects(const fs::path& models) {
  std::vector<Subject> subjects;
  for (const auto& model : landmark_models()) {
    const auto name = estimate_of(std::string(model.name));
    auto opened = model.open({.folder = models});
    if (opened)
      subjects.push_back(estimate_with(std::move(opened->landmarks), name));
    else
      report(name, "onednn", opened.error());
  }
  return subjects;
}

}  // namespace handcast::bench
