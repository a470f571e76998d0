// SPDX-License-Identifier: Apache-2.0
#include "services/studies/pose/run.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "ipc/base/clock.hpp"
#include "ipc/base/command_line.hpp"
#include "ipc/base/write_whole.hpp"
#include "ipc/daemon/stop_signal.hpp"
#include "services/studies/base/rig_hand.hpp"
#include "services/studies/base/study_command.hpp"
#include "services/studies/pose/picture.hpp"
#include "services/studies/pose/sessions.hpp"

namespace handcast::study {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kLogs = "pose";
constexpr int kWidth_px = 640, kHeight_px = 400;
constexpr double kTaught_s = 3, kStill_mm = 6;
constexpr char kNotes[] =
    R"(Start it beside a rig that is up. The hand shows a pose as a drawing; hold your hand so until each bone is green. Times and
the range of motion of each joint are in DIR/pose-NN.csv.

  handcast study pose DIR --person 1                     nine poses
  handcast study pose --teach "letter L" --poses my.csv  adds the pose that is held still for 3 s
  handcast study pose DIR --person 1 --poses my.csv      plays these
  handcast study pose --report DIR --pdf FILE            times and range of motion over the sessions, to print)";

struct Options {
  std::string folder = "poses", rig, poses_file, taught, page_folder, pdf_file;
  std::vector<std::string> reported;
  int person = 1;
  double seed = 1;
  msg::Side side = msg::Side::left;
};

Result<std::string> report(const Options& options) {
  const auto logs = read_logs(options.reported, kLogs);
  if (!logs) return tl::make_unexpected(logs.error());
  std::string written_files;
  if (!options.pdf_file.empty()) {
    const auto pdf = pose_pdf(*logs);
    if (!pdf) return tl::make_unexpected(pdf.error());
    if (auto written = write_whole(options.pdf_file, *pdf); !written)
      return tl::make_unexpected(written.error());
    written_files = options.pdf_file + "\n";
    if (options.page_folder.empty()) return written_files;
  }
  const auto page = pose_report(*logs);
  if (!page) return tl::make_unexpected(page.error());
  return write_page(options.page_folder.empty() ? "pose_report" : options.page_folder, *page)
      .map([&](const auto& file) { return written_files + file.string() + "\n"; });
}

/// Waits until the hand is held still, and keeps its pose.
Result<std::string> teach(const Options& options, RigHand& hand, PosePicture& picture) {
  if (options.poses_file.empty())
    return fail(Errc::bad_config, "--teach needs --poses FILE, to which the pose is added");
  fmt::print("Hold the pose still for {} s.\n", kTaught_s);
  std::fflush(stdout);
  std::optional<HeldPose> first;
  double since_s = 0;
  while (!daemon::stop_requested()) {
    if (auto waited = hand.wait(); !waited) return tl::make_unexpected(waited.error());
    if (!hand.joints()) {
      first.reset();
      continue;
    }
    auto held = held_pose(*hand.joints(), options.side);
    const double now_s = ns_to_seconds(now_ns());
    const auto moved = [&](std::size_t joint) {
      return glm::distance(held.joints_mm[joint], first->joints_mm[joint]) > kStill_mm;
    };
    bool is_new = !first;
    for (std::size_t joint = 0; !is_new && joint < msg::kJoints; ++joint) is_new = moved(joint);
    if (is_new) {
      first = held;
      since_s = now_s;
    }
    if (auto shown = hand.show(picture.draw(&held, score_of(*first, held))); !shown)
      return tl::make_unexpected(shown.error());
    if (now_s - since_s < kTaught_s) continue;
    held.name = options.taught;
    if (auto added = add_pose(options.poses_file, held); !added)
      return tl::make_unexpected(added.error());
    return fmt::format("{}: added \"{}\"\n", options.poses_file, options.taught);
  }
  return std::string("The pose was not taught.\n");
}

Result<void> keep_ranges(const Options& options, StudyLog& log, const std::string& time,
                         const RangeOfMotion& motion) {
  const auto ranges = motion.ranges();
  if (!ranges) return {};
  std::vector<CsvRow> rows;
  for (std::size_t joint = 0; joint < ranges->size(); ++joint)
    rows.push_back({fmt::format("{}", options.person), time, "range", flexion_name(joint),
                    fmt::format("{:.0f}", (*ranges)[joint].least_deg),
                    fmt::format("{:.0f}", (*ranges)[joint].most_deg)});
  return log.add(rows);
}

Result<std::string> play(const Options& options, RigHand& hand, PosePicture& picture) {
  auto poses = options.poses_file.empty() ? Result<std::vector<HeldPose>>(builtin_poses())
                                          : read_poses(options.poses_file);
  if (!poses) return tl::make_unexpected(poses.error());
  auto log =
      StudyLog::open(fs::path(options.folder) / log_name(kLogs, options.person), pose_columns());
  if (!log) return tl::make_unexpected(log.error());
  const auto time = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  const auto seed = static_cast<std::uint64_t>(options.seed) + log->earlier().rows.size();
  PoseGame game(std::move(*poses), seed);
  RangeOfMotion motion;
  double last_s = ns_to_seconds(now_ns()), all_s = 0;
  while (game.wanted() && !daemon::stop_requested()) {
    if (auto waited = hand.wait(); !waited) {
      (void)keep_ranges(options, *log, time, motion);  // the error of the rig is what is told
      return tl::make_unexpected(waited.error());
    }
    const double now_s = ns_to_seconds(now_ns());
    std::optional<HeldPose> held;
    if (hand.joints()) motion.see(held.emplace(held_pose(*hand.joints(), options.side)));
    const auto before = game.matched().size();
    game.step(now_s - last_s, held ? &*held : nullptr);
    last_s = now_s;
    if (auto shown = hand.show(picture.draw(game.wanted(), game.score())); !shown)
      return tl::make_unexpected(shown.error());
    if (game.matched().size() == before) continue;
    const auto& [name, seconds] = game.matched().back();
    all_s += seconds;
    fmt::print("  {:12} {:6.2f} s\n", name, seconds);
    std::fflush(stdout);
    if (auto kept = log->add(CsvRow{fmt::format("{}", options.person), time, "pose", name,
                                    fmt::format("{:.3f}", seconds), ""});
        !kept)
      return tl::make_unexpected(kept.error());
  }
  if (auto kept = keep_ranges(options, *log, time, motion); !kept)
    return tl::make_unexpected(kept.error());
  return fmt::format("{} poses in {:.1f} s\n", game.matched().size(), all_s);
}

Result<std::string> run(const Options& options) {
  if (!options.reported.empty()) return report(options);
  auto hand = RigHand::open(options.rig, options.side, kWidth_px, kHeight_px, "study pose");
  if (!hand) return tl::make_unexpected(hand.error());
  const auto mesh = hand->mesh();
  if (!mesh) return tl::make_unexpected(mesh.error());
  PosePicture picture(*mesh, kWidth_px, kHeight_px);
  return options.taught.empty() ? play(options, *hand, picture) : teach(options, *hand, picture);
}

}  // namespace

int run_pose(int argc, char** argv) {
  Options options;
  CommandLine line("handcast study pose",
                   "Guess the Pose: poses to match, for play and for rehabilitation.", kNotes);
  line.add("[DIR]", options.folder, "The folder of the logs");
  line.add("--person N", options.person, "The person, a number instead of a name",
           {1, kMostSubjects});
  line.add("--poses FILE.csv", options.poses_file, "Poses that somebody has taught");
  line.add("--teach NAME", options.taught, "Adds the pose that is held still to --poses");
  line.add("--report FILE", options.reported, "Reports on logs, or a folder of logs");
  line.add("--page DIR", options.page_folder, "Writes the report as DIR/index.html");
  line.add("--pdf FILE", options.pdf_file, "Writes the report as a PDF file, A4");
  add_rig_hand(line, options.rig, options.side);
  line.add("--seed S", options.seed, "Seed of the order of the poses", {0, 1e15});
  if (const auto code = line.answered(argc, argv)) return *code;
  daemon::install_stop_signals();  // so that the rig shows again what it showed before
  return end_of("handcast study pose", run(options));
}

}  // namespace handcast::study
