// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "config/sections/twin/world_settings.hpp"
#include "ipc/base/write_whole.hpp"
#include "ipc/daemon/contract.hpp"
#include "services/observer/judge.hpp"
#include "services/observer/score_log.hpp"
#include "services/runtime/context.hpp"
#include "services/runtime/scheduling.hpp"

using namespace handcast;
using namespace std::chrono_literals;
using service::must;

/// The true hand is the one that the camera sees. Any tracker and detector may have found it.
static bool has_truth(const config::Rig& rig) { return rig.camera.backend == "twin"; }

/// Writes observer.json to the folder for kept files. Without one the scores are only logged.
static void save(const observer::Judge& judge, service::Context& context) {
  const auto folder = daemon::out_folder();
  if (!folder || judge.empty()) return;
  const auto written = write_whole(*folder / "observer.json", judge.scores().dump(2) + "\n");
  if (!written) context.tolerate({Errc::bad_data, "observer: " + written.error().what});
}

static double number(const nlohmann::json& json, const char* pointer) {
  const auto found = nlohmann::json::json_pointer(pointer);
  return json.contains(found) && json.at(found).is_number() ? json.at(found).get<double>() : 0.0;
}

static observer::LoggedScores scores_of(const observer::Judge& judge) {
  const auto json = judge.scores();
  return {number(json, "/interior_mm/p95"), number(json, "/coverage"), number(json, "/spill")};
}

static void log_scores(const observer::LoggedScores& scores) {
  log::info("interior p95 {:.2f} mm, coverage {:.3f}, spill {:.3f}", scores.interior_p95_mm,
            scores.coverage, scores.spill);
}

/// Scores the newest projected frame, observer.rate_hz times per second, at low priority.
static void run_observer(service::Context& context) {
  service::give_way();
  auto judge = must(observer::open_judge(context.rig(), context.calibration(), context.epoch_ns()));
  context.stand_by();
  auto projections = must(context.reader<msg::Projection>("projection.frames"));
  if (!has_truth(context.rig()))
    log::warning(
        "nothing is scored: the camera does not see the twin's hand, so there is no true hand to "
        "compare with");

  const auto period_ns = seconds_to_ns(1 / context.rig().observer.rate_hz);
  std::int64_t score_ns = now_ns(), save_ns = score_ns + to_ns(2s), log_ns = score_ns + to_ns(5s);
  observer::ScoreLog score_log;
  context.ready();
  while (context.running()) {
    sleep_until_ns(std::min(score_ns, now_ns() + to_ns(50ms)));
    const std::int64_t time_ns = now_ns();
    if (time_ns >= score_ns) {
      score_ns = std::max(score_ns + period_ns, time_ns);
      if (!has_truth(context.rig())) continue;
      if (const auto seen = projections.latest(Deadline::in(20ms))) judge->add(**seen);
    }
    if (time_ns >= save_ns) {
      save(*judge, context);
      save_ns = time_ns + to_ns(2s);
    }
    if (time_ns >= log_ns) {
      if (const auto scores = scores_of(*judge);
          !judge->empty() && score_log.is_due(time_ns, scores))
        log_scores(scores);
      log_ns = time_ns + to_ns(5s);
    }
  }
  save(*judge, context);
  if (!judge->empty()) log_scores(scores_of(*judge));
}

static Result<void> check_observer(const config::Rig& rig, const calib::Calibration& calibration) {
  const auto judge = observer::open_judge(rig, calibration, now_ns());
  return judge ? Result<void>() : tl::make_unexpected(judge.error());
}

/// The true hand comes from the twin's world, if there is one.
static std::vector<std::string> settings() {
  const auto world = config::kTwinWorldSettings.paths();
  std::vector<std::string> all{"observer", "camera.backend"};
  all.insert(all.end(), world.begin(), world.end());
  return all;
}

int main(int argc, char** argv) {
  return service::run({.name = "observer",
                       .summary = "Scores the projected light against the true hand of the twin.",
                       .paced_by = "observer.rate_hz",
                       .subscribes = {"projection.frames"},
                       .settings = settings()},
                      argc, argv, run_observer, check_observer);
}
