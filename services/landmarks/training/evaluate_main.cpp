// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "renderer/content/picture.hpp"
#include "services/landmarks/detect/draw.hpp"
#include "services/landmarks/detect/picture.hpp"
#include "services/landmarks/finder/hand_network.hpp"
#include "services/landmarks/finder/own_network.hpp"
#include "services/landmarks/training/trial.hpp"

/// Shows detectors pictures and prints what they see, one JSON object a line; evaluate.py counts.
namespace handcast::landmarks::training {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Detectors {
  own::OwnNetwork own;
  std::optional<HandNetwork> mediapipe;
};

struct Seen {
  Points points_px{};
  std::array<float, msg::kLandmarks> sigma_px{};
  float presence = 0;
};

json to_json(const Points& points_px) {
  json list = json::array();
  for (const glm::vec2 p : points_px) list.push_back({p.x, p.y});
  return list;
}

json to_json(const Seen& seen) {
  return {
      {"points", to_json(seen.points_px)}, {"sigma", seen.sigma_px}, {"presence", seen.presence}};
}

/// As often as `looks`; the first time around `start_px`, then around what was seen.
Result<Seen> look_own(own::OwnNetwork& network, renderer::GreyView image, msg::Side side,
                      const Points& start_px, const std::optional<Points>& tracker_px, int looks) {
  Seen seen{start_px, {}, 0};
  for (int i = 0; i < looks; ++i) {
    LandmarkModel::Times times;
    const auto answer =
        network.look(image, own::region_around(seen.points_px), side, tracker_px, times);
    if (!answer) return tl::make_unexpected(answer.error());
    seen = {answer->points_px, answer->sigma_px, answer->presence};
  }
  return seen;
}

Result<Seen> look_mediapipe(HandNetwork& network, renderer::GreyView image, const Points& start_px,
                            int looks) {
  Seen seen{start_px, {}, 0};
  for (int i = 0; i < looks; ++i) {
    HandNetwork::Times times;
    const auto answer = network.look(image, region_of_landmarks(seen.points_px), times);
    if (!answer) return tl::make_unexpected(answer.error());
    seen = {answer->points_px, {}, answer->presence};
  }
  return seen;
}

/// What every detector makes of one picture; `wrong_px`: a tracker that shows another pose.
Result<json> look_at(Detectors& detectors, renderer::GreyView image, msg::Side side,
                     const Points& tracker_px, const std::optional<Points>& wrong_px) {
  json result;
  const auto note = [&](const char* name, const Result<Seen>& seen) {
    if (seen) result[name] = to_json(*seen);
    return seen.has_value();
  };
  auto& own = detectors.own;
  note("own", look_own(own, image, side, tracker_px, tracker_px, 2));
  note("own_one_look", look_own(own, image, side, tracker_px, tracker_px, 1));
  note("own_alone", look_own(own, image, side, tracker_px, std::nullopt, 2));
  if (wrong_px) {
    note("own_wrong_tracker", look_own(own, image, side, *wrong_px, wrong_px, 2));
    note("own_wrong_region", look_own(own, image, side, *wrong_px, std::nullopt, 2));
  }
  if (detectors.mediapipe)
    note("mediapipe", look_mediapipe(*detectors.mediapipe, image, tracker_px, 2));
  return result;
}

Result<void> run_motion(Detectors& detectors, const std::string& motion, int count,
                        std::uint64_t seed) {
  auto trials = Trials::open(motion, seed);
  if (!trials) return tl::make_unexpected(trials.error());
  for (int i = 0; i < count; ++i) {
    const auto trial = trials->make(i, count);
    if (!trial) continue;
    auto seen = look_at(detectors, trial->image.view(), trial->side, trial->tracker_px,
                        trial->other_pose_px);
    if (!seen) return tl::make_unexpected(seen.error());
    json line{{"source", fs::path(motion).filename().string()},
              {"truth", to_json(trial->truth_px)},
              {"tracker", to_json(trial->tracker_px)},
              {"folded", trial->folded},
              {"seen", *seen}};
    fmt::print("{}\n", line.dump());
  }
  return {};
}

Result<void> draw_into(const fs::path& file, renderer::GreyView picture, const json& points,
                       const Points& tracker_px) {
  FoundHand hand;
  for (std::size_t i = 0; i < hand.points_px.size(); ++i)
    hand.points_px[i] = {points[i][0].get<float>(), points[i][1].get<float>()};
  hand.region = own::region_around(hand.points_px);
  Hints hints;
  hints[0] = tracker_px;
  return renderer::write_png(file, detect::draw(picture, std::span(&hand, 1), hints).view());
}

/// A picture NAME_camera.png of a left hand with NAME_joints_2d_left.npy beside it.
Result<void> run_picture(Detectors& detectors, const fs::path& file, const fs::path& drawings) {
  std::string name = file.filename().string();
  name.resize(name.find('_'));
  const auto picture = detect::read_grey(file);
  if (!picture) return tl::make_unexpected(picture.error());
  const auto tracker_px = detect::read_joints(file.parent_path() / (name + "_joints_2d_left.npy"),
                                              picture->width(), picture->height());
  if (!tracker_px) return tl::make_unexpected(tracker_px.error());
  const auto seen = look_at(detectors, picture->view(), msg::Side::left, *tracker_px, std::nullopt);
  if (!seen) return tl::make_unexpected(seen.error());
  fmt::print("{}\n",
             json{{"source", name}, {"tracker", to_json(*tracker_px)}, {"seen", *seen}}.dump());
  if (drawings.empty()) return {};
  for (const auto& [detector, answer] : seen->items()) {
    auto drawn = draw_into(drawings / fmt::format("{}_{}.png", name, detector), picture->view(),
                           answer["points"], *tracker_px);
    if (!drawn) return drawn;
  }
  return {};
}

Result<Detectors> open(const std::string& backend, const std::string& network,
                       const std::string& models) {
  auto own_network = own::OwnNetwork::open(
      backend, network.empty() ? own::default_network_file() : fs::path(network));
  if (!own_network) return tl::make_unexpected(own_network.error());
  Detectors detectors{std::move(*own_network), {}};
  if (models.empty()) return detectors;
  auto mediapipe = HandNetwork::open(backend, models);
  if (!mediapipe) return tl::make_unexpected(mediapipe.error());
  detectors.mediapipe = std::move(*mediapipe);
  return detectors;
}

}  // namespace
}  // namespace handcast::landmarks::training

int main(int argc, char** argv) try {
  using namespace handcast::landmarks::training;
  std::string backend = "opencv", network, models, drawings;
  std::vector<std::string> motions, pictures;
  int count = 200;
  CLI::App app{
      "What landmark detectors see on renders of motions and on real pictures: JSON lines for "
      "evaluate.py."};
  app.add_option("--backend", backend, "What runs the networks");
  app.add_option("--network", network,
                 "Our network's file, if not the one that comes with handcast");
  app.add_option("--models", models, "Folder of MediaPipe's network, to compare with");
  app.add_option("--motion", motions, "Folders of recordings of a left hand, or builtin:NAME");
  app.add_option("--picture", pictures,
                 "Files NAME_camera.png of a left hand, NAME_joints_2d_left.npy beside them");
  app.add_option("--drawings", drawings, "A folder to draw what is seen in the pictures into");
  app.add_option("--count", count, "Frames of each motion")->check(CLI::Range(10, 100000));
  CLI11_PARSE(app, argc, argv);

  auto detectors = open(backend, network, models);
  handcast::Result<void> done;
  if (!detectors) done = tl::make_unexpected(detectors.error());
  for (std::size_t i = 0; done && i < motions.size(); ++i)
    done = run_motion(*detectors, motions[i], count, i + 1);
  for (std::size_t i = 0; done && i < pictures.size(); ++i)
    done = run_picture(*detectors, pictures[i], drawings);
  if (!done) fmt::print(stderr, "handcast-evaluate-landmarks: {}\n", done.error().what);
  return done ? 0 : 1;
} catch (const std::exception& problem) {
  std::fprintf(stderr, "handcast-evaluate-landmarks: %s\n", problem.what());
  return 1;
}
