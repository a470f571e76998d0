// SPDX-License-Identifier: Apache-2.0
#include "services/tools/detect/run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/inherited.hpp"
#include "ipc/base/log.hpp"
#include "renderer/media/picture.hpp"
#include "services/landmarks/finder/hand_finder.hpp"
#include "services/landmarks/models/landmark_models.hpp"
#include "services/landmarks/models/models_folder.hpp"
#include "services/tools/detect/draw.hpp"
#include "services/tools/detect/picture.hpp"

namespace handcast::detect {
namespace {

/// The hands in one picture.
struct Result {
  std::filesystem::path image;              ///< file of the picture
  std::vector<landmarks::FoundHand> hands;  ///< the hands
  landmarks::HandFinder::Times times;       ///< medians over the repetitions
};

/// "left" or "right".
const char* name_of(msg::Side side) { return side == msg::Side::left ? "left" : "right"; }

constexpr std::array kFingerNames{"thumb", "index", "middle", "ring", "little"};

std::string table_of(const landmarks::Points& points) {
  std::string text = fmt::format("    wrist   {:7.1f} {:7.1f}\n", points[0].x, points[0].y);
  for (int finger = 0; finger < 5; ++finger) {
    text += fmt::format("    {:7}", kFingerNames[finger]);
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

/// Why there is no hand in a picture, with a remedy; "" if there is one.
std::string why_none(const Result& result, bool has_joints) {
  if (!result.hands.empty()) return {};
  const auto& times = result.times;
  if (has_joints)
    return "the network sees no hand where --joints has it; do they belong to this picture, and is "
           "--side "
           "that of its hand?";
  if (times.model_runs > 0)
    return "the network takes none of the places that were searched for a hand; a whole hand with "
           "its fingers apart is found best, and --joints tells where it is";
  return times.palm_runs > 0
             ? "the palm network finds no palm; --joints tells where the hand is"
             : "no part of it is bright before a dark background, as a hand is in infrared light; "
               "scripts/get-models fetches the palm network, which needs neither, and --joints "
               "tells where the hand is";
}

/// One line for the picture; for each hand one line and a table of its points.
std::string print_text(const Result& result, bool has_joints) {
  const auto& times = result.times;
  std::string text =
      fmt::format("{}: {} hand{}, {:.2f} ms (crop {:.2f}, network {:.2f}{})\n",
                  result.image.string(), result.hands.size(), result.hands.size() == 1 ? "" : "s",
                  ns_to_ms(times.all_ns), ns_to_ms(times.crop_ns), ns_to_ms(times.network_ns),
                  times.palm_runs > 0 ? fmt::format(", palm {:.2f}", ns_to_ms(times.palm_ns)) : "");
  for (const auto& hand : result.hands)
    text += fmt::format("  {} hand, presence {:.3f}; px from palm to tip:\n{}", name_of(hand.side),
                        hand.presence, table_of(hand.points_px));
  if (const auto why = why_none(result, has_joints); !why.empty()) text += "  " + why + '\n';
  return text;
}

/// JSON of all pictures:
/// {"images":[{"image","ms":{"all","crop","network","palm"},"hands":[{"side","presence","points_px":[[x,y],...]}],"why_none"}]}
std::string print_json(const std::vector<Result>& results, bool has_joints) {
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
                      {"hands", hands},
                      {"why_none", why_none(result, has_joints)}});
  }
  return nlohmann::json{{"images", images}}.dump(1, ' ', false,
                                                 nlohmann::json::error_handler_t::replace) +
         "\n";  // a path need not be UTF-8
}

namespace fs = std::filesystem;
using Times = landmarks::HandFinder::Times;

Times median_of(std::vector<Times>& runs) {
  Times median = runs.front();
  for (const auto field : {&Times::all_ns, &Times::crop_ns, &Times::network_ns, &Times::palm_ns}) {
    std::ranges::nth_element(runs, runs.begin() + static_cast<std::ptrdiff_t>(runs.size() / 2), {},
                             field);
    median.*field = runs[runs.size() / 2].*field;
  }
  return median;
}

/// The files of the pictures' drawings, all different. Errors: bad_config (one of them is a picture
/// that is read).
handcast::Result<std::vector<fs::path>> drawings_of(const Options& options) {
  std::vector<fs::path> drawings;
  std::set<std::string> taken;
  for (const auto& image : options.images) {
    const auto stem = image.stem().string();
    auto name = stem + ".png";
    for (int number = 2; !taken.insert(name).second; ++number)
      name = fmt::format("{}_{}.png", stem, number);
    drawings.push_back(options.output / name);
    std::error_code absent;
    for (const auto& read : options.images)
      if (!options.output.empty() && fs::equivalent(drawings.back(), read, absent))
        return fail(Errc::bad_config,
                    fmt::format("--out {}: the drawing would replace the picture {}; name another "
                                "folder",
                                options.output.string(), read.string()));
  }
  return drawings;
}

handcast::Result<void> save(const fs::path& file, const renderer::Texture& drawing) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error)
    return fail(Errc::unavailable, fmt::format("the folder '{}' cannot be created: {}",
                                               file.parent_path().string(), error.message()));
  return renderer::write_png(file, drawing.view());
}

handcast::Result<landmarks::Hints> read_hints(const Options& options, std::size_t i,
                                              renderer::GreyView picture) {
  landmarks::Hints hints;
  if (options.joints.empty()) return hints;
  const auto joints = read_joints(options.joints[i], picture.width, picture.height);
  if (!joints) return tl::make_unexpected(joints.error());
  hints[static_cast<std::size_t>(options.joints_side)] = *joints;
  return hints;
}

handcast::Result<Result> detect_in(landmarks::HandFinder& finder, const Options& options,
                                   std::size_t i, const fs::path& drawing) {
  const auto picture = read_grey(options.images[i]);
  if (!picture) return tl::make_unexpected(picture.error());
  const auto hints = read_hints(options, i, picture->view());
  if (!hints) return tl::make_unexpected(hints.error());
  Result result{options.images[i], {}, {}};
  std::vector<Times> runs;
  for (int k = 0; k < options.repeat; ++k) {
    finder.forget();
    const auto found = finder.find(picture->view(), *hints, 0);
    if (!found) return tl::make_unexpected(found.error());
    result.hands.assign(found->begin(), found->end());
    runs.push_back(finder.times());
  }
  result.times = median_of(runs);
  if (!options.output.empty())
    if (const auto saved = save(drawing, draw(picture->view(), result.hands, *hints)); !saved)
      return tl::make_unexpected(saved.error());
  return result;
}

/// Opens the landmark model. Without a choice it is MediaPipe, whose palm network finds hands that
/// no tracker has seen, or, if its files are not where they are looked for, our own.
handcast::Result<landmarks::OpenedModel> open_model(const Options& options) {
  const auto folder = landmarks::models_folder(options.models);
  if (!folder) return tl::make_unexpected(folder.error());
  const landmarks::ModelOptions settings{.folder = *folder};
  if (!options.backend.empty()) return landmarks::open_landmark_model(options.backend, settings);
  auto mediapipe = landmarks::open_landmark_model("mediapipe", settings);
  if (mediapipe || !options.models.empty()) return mediapipe;
  if (!options.quiet)
    fmt::print(stderr, "handcast detect: with handcast's own network, because {}\n",
               printable(mediapipe.error().what));
  return landmarks::open_landmark_model("handcast", settings);
}

}  // namespace

handcast::Result<Report> run(const Options& options) {
  if (!options.joints.empty() && options.joints.size() != options.images.size())
    return fail(
        Errc::bad_config,
        fmt::format(
            "{} pictures, but {} files of joints; give one --joints per picture, in the same order",
            options.images.size(), options.joints.size()));
  const auto drawings = drawings_of(options);
  if (!drawings) return tl::make_unexpected(drawings.error());
  auto model = open_model(options);
  if (!model) return tl::make_unexpected(model.error());
  // Without a tracker's joints, only the picture tells where a hand is.
  const bool has_joints = !options.joints.empty();
  using Poses = landmarks::HandFinder::Poses;
  constexpr int kPlaces = 6;  // nobody waits for the next image
  landmarks::HandFinder finder(std::move(*model), options.hands,
                               has_joints ? Poses::of_a_tracker : Poses::of_landmarks, kPlaces);
  const bool shows_progress =
      !options.quiet && inherited::is_terminal(STDERR_FILENO) && options.images.size() > 1;
  std::vector<Result> results;
  std::string text;
  for (std::size_t i = 0; i < options.images.size(); ++i) {
    if (shows_progress)
      fmt::print(stderr, "\r{}/{} {}\033[K", i + 1, options.images.size(),
                 printable(options.images[i].filename().string()));
    auto result = detect_in(finder, options, i, (*drawings)[i]);
    if (!result) {
      // What was found so far is not lost.
      if (!results.empty()) fmt::print("{}", options.json ? print_json(results, has_joints) : text);
      return fail_in(options.images[i].string(), result.error());
    }
    if (!options.json) text += print_text(*result, has_joints);
    results.push_back(std::move(*result));
  }
  if (shows_progress) fmt::print(stderr, "\r\033[K");
  const bool has_hand =
      std::ranges::any_of(results, [](const Result& result) { return !result.hands.empty(); });
  return Report{options.json ? print_json(results, has_joints) : text, has_hand};
}

}  // namespace handcast::detect
