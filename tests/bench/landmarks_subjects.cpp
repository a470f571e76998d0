// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/landmarks_subjects.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "services/landmarks/finder/hand_network.hpp"
#include "services/landmarks/finder/models.hpp"
#include "services/landmarks/finder/own_network.hpp"
#include "services/landmarks/inference/cost.hpp"

namespace handcast::bench {
namespace {

using namespace landmarks;
namespace fs = std::filesystem;

/// The next of a row of numbers that look random, 0..1.
float noise(unsigned& seed) {
  seed = seed * 1664525u + 1013904223u;
  return static_cast<float>(seed >> 8) / 16777216.f;
}

/// A bright disc with noise, about as large as a hand, and a look at it.
struct Scene {
  renderer::Image<std::uint8_t> image{720, 540};
  Region region{{361.3f, 268.6f}, 250, 0.7f};
  Points joints_px{};
  LandmarkModel::Times ignored;

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

template <class Looker>
Subject look_with(Looker looker, const char* name, const char* backend, const fs::path& file) {
  const auto shared = std::make_shared<Looker>(std::move(looker));
  const auto scene = std::make_shared<Scene>();
  LandmarkModel* with = shared.get();
  return {name, backend, network_mmac(file).value_or(0), [shared, with, scene] {
            return with
                ->look(scene->image.view(), scene->region, msg::Side::left, scene->joints_px,
                       scene->ignored)
                .has_value();
          }};
}

void report(const std::string& name, const char* backend, const Error& error) {
  fmt::print("{} in {}: not measured: {}\n", name, backend, error.what);
}

}  // namespace

std::vector<Subject> network_subjects(const fs::path& file) {
  std::vector<Subject> subjects;
  const std::string name = file.stem().string();
  for (const auto& backend : network_backends()) {
    auto opened = backend.open(file);
    if (!opened) {
      report(name, backend.name, opened.error());
      continue;
    }
    const std::shared_ptr<Network> network = std::move(*opened);
    unsigned seed = 1;
    for (std::size_t i = 0; i < network->inputs().size(); ++i)
      for (float& number : network->input(i)) number = noise(seed);
    subjects.push_back({name, backend.name, network_mmac(file).value_or(0),
                        [network] { return network->run().has_value(); }});
  }
  return subjects;
}

std::vector<Subject> own_looks(const fs::path& file) {
  std::vector<Subject> subjects;
  for (const auto& backend : network_backends()) {
    auto opened = own::OwnNetwork::open(backend.name, file);
    if (opened)
      subjects.push_back(look_with(std::move(*opened), kOwnLook, backend.name, file));
    else
      report(kOwnLook, backend.name, opened.error());
  }
  return subjects;
}

std::vector<Subject> mediapipe_looks(const fs::path& models) {
  std::vector<Subject> subjects;
  for (const auto& backend : network_backends()) {
    auto opened = HandNetwork::open(backend.name, models);
    if (opened)
      subjects.push_back(
          look_with(std::move(*opened), kMediaPipeLook, backend.name, models / kHandModel));
    else
      report(kMediaPipeLook, backend.name, opened.error());
  }
  return subjects;
}

}  // namespace handcast::bench
