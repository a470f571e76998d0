// SPDX-License-Identifier: Apache-2.0
// handcast-evaluate-landmarks: runs landmark models on test pictures and prints their estimates,
// one JSON object per picture and line, for evaluate.py.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "ipc/base/command_line.hpp"
#include "ipc/base/log.hpp"
#include "renderer/media/picture.hpp"
#include "services/lab/training/trial.hpp"
#include "services/landmarks/models/landmark_models.hpp"
#include "services/landmarks/models/models_folder.hpp"
#include "services/tools/detect/draw.hpp"
#include "services/tools/detect/picture.hpp"

namespace handcast::landmarks::training {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct NamedModel {
  std::string name;
  std::unique_ptr<LandmarkModel> model;
};

/// The inputs of a model in addition to the picture.
struct Condition {
  Points start_px{};                 ///< the region of the first pass is around these points
  std::optional<Points> tracker_px;  ///< the model's input
  int passes = 2;
};

/// The last estimate of a model under one condition.
struct Answer {
  std::string name;  ///< of model and condition, as in evaluate.py
  LandmarkEstimate estimate;
  Region region;
};

json to_json(const Points& points_px) {
  json list = json::array();
  for (const glm::vec2 p : points_px) list.push_back({p.x, p.y});
  return list;
}

json to_json(const std::vector<Answer>& answers) {
  json object = json::object();
  for (const auto& [name, estimate, region] : answers)
    object[name] = {{"points", to_json(estimate.points_px)},
                    {"sigma", estimate.sigma_px},
                    {"presence", estimate.presence}};
  return object;
}

Result<Answer> run(const std::string& name, LandmarkModel& model, renderer::GreyView image,
                   msg::Side side, const Condition& condition) {
  Answer answer{name, {.points_px = condition.start_px}, {}};
  for (int i = 0; i < condition.passes; ++i) {
    EstimateTimes times;
    answer.region = model.region_around(answer.estimate.points_px);
    auto estimate = model.estimate(image, answer.region, side, condition.tracker_px, times);
    if (!estimate) return tl::make_unexpected(estimate.error());
    answer.estimate = *estimate;
  }
  return answer;
}

/// The answers of every model to one picture; those that fail are left out. `wrong_px`: the joints
/// of a tracker that has the hand in another pose.
std::vector<Answer> run_all(const std::vector<NamedModel>& models, renderer::GreyView image,
                            msg::Side side, const Points& tracker_px,
                            const std::optional<Points>& wrong_px) {
  std::vector<Answer> answers;
  for (const auto& [name, model] : models) {
    std::vector<std::pair<std::string, Condition>> conditions{{name, {tracker_px, tracker_px}}};
    if (model->traits().reads_tracker) {
      conditions.push_back({name + "_one_pass", {tracker_px, tracker_px, 1}});
      conditions.push_back({name + "_alone", {tracker_px, std::nullopt}});
      if (wrong_px) {
        conditions.push_back({name + "_wrong_tracker", {*wrong_px, wrong_px}});
        conditions.push_back({name + "_wrong_region", {*wrong_px, std::nullopt}});
      }
    }
    for (const auto& [title, condition] : conditions)
      if (auto answer = run(title, *model, image, side, condition))
        answers.push_back(std::move(*answer));
  }
  return answers;
}

Result<void> run_motion(const std::vector<NamedModel>& models, const std::string& motion, int count,
                        std::uint64_t seed, const std::string& mesh) {
  auto trials = Trials::open(motion, seed, mesh);
  if (!trials) return tl::make_unexpected(trials.error());
  for (int i = 0; i < count; ++i) {
    const auto trial = trials->make(i, count);
    if (!trial) continue;
    const auto answers =
        run_all(models, trial->image.view(), trial->side, trial->tracker_px, trial->other_pose_px);
    json line{{"source", fs::path(motion).filename().string()},
              {"truth", to_json(trial->truth_px)},
              {"tracker", to_json(trial->tracker_px)},
              {"folded", trial->folded},
              {"seen", to_json(answers)}};
    fmt::print("{}\n", line.dump());
  }
  return {};
}

Result<void> draw_into(const fs::path& file, renderer::GreyView picture, const Answer& answer,
                       const Points& tracker_px) {
  const FoundHand hand{.points_px = answer.estimate.points_px, .region = answer.region};
  Hints hints;
  hints[0] = tracker_px;
  return renderer::write_png(file, detect::draw(picture, std::span(&hand, 1), hints).view());
}

/// `file`: NAME_camera.png, a picture of a left hand; NAME_joints_2d_left.npy lies beside it.
Result<void> run_picture(const std::vector<NamedModel>& models, const fs::path& file,
                         const fs::path& drawings) {
  std::string name = file.filename().string();
  name.resize(name.find('_'));
  const auto picture = detect::read_grey(file);
  if (!picture) return tl::make_unexpected(picture.error());
  const auto tracker_px = detect::read_joints(file.parent_path() / (name + "_joints_2d_left.npy"),
                                              picture->width(), picture->height());
  if (!tracker_px) return tl::make_unexpected(tracker_px.error());
  const auto answers = run_all(models, picture->view(), msg::Side::left, *tracker_px, std::nullopt);
  const json line{{"source", name}, {"tracker", to_json(*tracker_px)}, {"seen", to_json(answers)}};
  fmt::print("{}\n", line.dump());
  if (drawings.empty()) return {};
  for (const auto& answer : answers) {
    auto drawn = draw_into(drawings / fmt::format("{}_{}.png", name, answer.name), picture->view(),
                           answer, *tracker_px);
    if (!drawn) return drawn;
  }
  return {};
}

Result<std::vector<NamedModel>> open(const std::vector<std::string>& names,
                                     const ModelOptions& options) {
  std::vector<NamedModel> models;
  for (const auto& name : names) {
    auto opened = open_landmark_model(name, options);
    if (!opened) return tl::make_unexpected(opened.error());
    models.push_back({name, std::move(opened->landmarks)});
  }
  return models;
}

std::vector<std::string> all_models() {
  std::vector<std::string> names;
  for (const auto& model : landmark_models()) names.emplace_back(model.name);
  return names;
}

}  // namespace
}  // namespace handcast::landmarks::training

int main(int argc, char** argv) try {
  using namespace handcast;
  using namespace handcast::landmarks::training;
  landmarks::ModelOptions options{.folder = landmarks::models_folder("").value()};
  std::filesystem::path drawings;
  std::vector<std::string> names, motions, pictures;
  int count = 200;
  std::string mesh = config::TwinShape{}.mesh;
  CommandLine line("handcast-evaluate-landmarks",
                   "Runs landmark models on renders of motions and on real pictures; prints JSON "
                   "lines for evaluate.py.");
  line.add("--backend NAME", names, "A landmark model to compare; default: all");
  line.add("--network FILE", options.handcast_network,
           "The file of handcast's network, if not the one that comes with handcast");
  line.add("--models DIR", options.folder, "The folder of MediaPipe's files");
  line.add("--motion DIR", motions, "A folder of a recording of a left hand, or builtin:NAME");
  line.add("--mesh NAME", mesh, "The ground-truth mesh that the renders show, as twin.shape.mesh");
  line.add("--picture FILE", pictures,
           "A picture NAME_camera.png of a left hand, with NAME_joints_2d_left.npy beside it");
  line.add("--drawings DIR", drawings, "A folder for drawings of the results on pictures");
  line.add("--count N", count, "Frames of each motion", {10, 100000});
  if (const auto code = line.answered(argc, argv)) return *code;
  if (names.empty()) names = all_models();

  const auto models = open(names, options);
  Result<void> done;
  if (!models) done = tl::make_unexpected(models.error());
  for (std::size_t i = 0; done && i < motions.size(); ++i)
    done = run_motion(*models, motions[i], count, i + 1, mesh);
  for (std::size_t i = 0; done && i < pictures.size(); ++i)
    done = run_picture(*models, pictures[i], drawings);
  if (!done) fmt::print(stderr, "handcast-evaluate-landmarks: {}\n", printable(done.error().what));
  return done ? 0 : 1;
} catch (const std::exception& problem) {
  std::fprintf(stderr, "handcast-evaluate-landmarks: %s\n", problem.what());
  return 1;
}
