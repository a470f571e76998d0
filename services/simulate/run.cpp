#include "services/simulate/run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "calib/calibration.hpp"
#include "ipc/base/clock.hpp"
#include "services/simulate/jitter.hpp"
#include "services/simulate/photograph.hpp"
#include "services/simulate/png.hpp"
#include "services/simulate/recorder.hpp"
#include "services/simulate/simulation.hpp"
#include "services/simulate/trace.hpp"

namespace handcast::simulate {
namespace {

/// One line on the terminal that is written over; every tenth where there is none.
class Progress {
 public:
  Progress(std::string rig, double seconds, bool quiet)
      : rig_(std::move(rig)), seconds_(seconds), quiet_(quiet), tty_(isatty(STDERR_FILENO)) {}
  ~Progress() {
    if (tty_ && !quiet_) fmt::print(stderr, "\n");
  }

  void at(double done_s) {
    const int percent = static_cast<int>(100 * done_s / seconds_);
    if (quiet_ || percent < shown_ + (tty_ ? 1 : 10)) return;
    shown_ = percent;
    const auto elapsed_s = ns_to_seconds(now_ns() - start_ns_);
    fmt::print(stderr, "{}simulate {}: {:4.1f} of {:.1f} s, {:3d} %, about {:.0f} s left {}", tty_ ? "\r" : "", rig_, done_s, seconds_,
               percent, done_s > 0 ? elapsed_s * (seconds_ - done_s) / done_s : 0.0, tty_ ? "  " : "\n");
  }

 private:
  std::string rig_;
  double seconds_;
  bool quiet_, tty_;
  int shown_ = -10;
  std::int64_t start_ns_ = now_ns();
};

/// Everything that is made of the ticks of one run.
class Products {
 public:
  static Result<std::unique_ptr<Products>> create(const Options& options, const config::Rig& rig, const calib::Calibration& calibration,
                                                  const twin::Twin& twin) {
    auto products = std::unique_ptr<Products>(new Products(options, rig, calibration, twin));
    if (!options.trace_file.empty()) {
      auto trace = Trace::open(options.trace_file);
      if (!trace) return tl::make_unexpected(trace.error());
      products->trace_ = std::move(*trace);
    }
    if (!options.frames_directory.empty()) {
      std::error_code failed;
      std::filesystem::create_directories(options.frames_directory, failed);
      if (failed) return fail(Errc::bad_config, fmt::format("{}: {}", options.frames_directory, failed.message()));
      products->photographer_.emplace(twin, calibration);
    }
    return products;
  }

  Result<void> add(const Tick& tick) {
    for (const auto& hand : tick.hands) {
      const auto truth = twin_.landmarks(hand.side, tick.lit_ns);
      if (!truth) continue;
      jitter_.add(hand, *truth, tick.index, metrics_);
      add_landmarks(hand, *truth, tick.lit_ns);
      if (trace_) trace_->add(tick.lit_ns, hand, *truth);
    }
    if (!tick.projection) return {};
    metrics_.add(judge_->score(*tick.projection));
    metrics_.add_stages(tick.frame->stages);
    metrics_.add_foldovers(tick.frame->foldovers);
    return picture(tick);
  }

  Result<void> write_json(const config::Rig& rig) const {
    if (options_.json_file.empty()) return {};
    auto json = metrics_.to_json();
    json["rig"] = rig.name;
    json["motion"] = rig.twin.motion;
    json["speed"] = rig.twin.speed;
    json["seed"] = rig.twin.seed;
    json["seconds"] = options_.seconds;
    json["software_ms"] = rig.projector.software_ms;
    std::ofstream file(options_.json_file);
    file << json.dump(2) << "\n";
    if (!file.flush()) return fail(Errc::bad_config, fmt::format("{}: cannot be written", options_.json_file));
    return {};
  }

  void print_summary(const config::Rig& rig) const {
    const auto json = metrics_.to_json();
    const auto number = [&](const char* group, const char* key) {
      return json.contains(group) && json[group].contains(key) && json[group][key].is_number() ? json[group][key].get<double>() : 0.0;
    };
    const auto plain = [&](const char* key) { return json.contains(key) && json[key].is_number() ? json[key].get<double>() : 0.0; };
    if (options_.draw_every == 0) {
      fmt::print("{} on {}: landmark error mean {:.2f} mm, p95 {:.2f} mm; jitter {:.3f} px\n", rig.name, rig.twin.motion,
                 number("landmark_mm", "mean"), number("landmark_mm", "p95"), plain("jitter_px"));
      return;
    }
    fmt::print(
        "{} on {}: interior error mean {:.2f} mm, p95 {:.2f} mm; coverage {:.4f}, spill {:.4f}; jitter {:.3f} px; {} frames, {:.0f} us "
        "each (p50)\n",
        rig.name, rig.twin.motion, number("interior_mm", "mean"), number("interior_mm", "p95"), plain("coverage"), plain("spill"),
        plain("jitter_px"), static_cast<long>(plain("frames")), number("frame_us", "p50"));
  }

 private:
  Products(const Options& options, const config::Rig& rig, const calib::Calibration& calibration, const twin::Twin& twin)
      : options_(options), calibration_(calibration), twin_(twin), judge_(twin::Judge::create(twin, calibration, rig.observer.step_px)) {}

  /// Camera px become mm at the distance of the joint.
  void add_landmarks(const renderer::FrameHand& hand, const renderer::LandmarkPoints& truth, std::int64_t lit_ns) {
    const auto joints = twin_.joints(hand.side, lit_ns);
    for (std::size_t i = 0; joints && i < truth.size(); ++i) {
      const glm::dvec4 joint_m = (*joints)[msg::kJointOfLandmark[i]][3];
      const double distance_m = (calibration_.camera_from_tracker * joint_m).z;
      const double error_px = glm::length(hand.corrected[i] - truth[i]);
      metrics_.add_landmark(error_px, 1e3 * error_px * distance_m / calibration_.camera.fx_px);
    }
  }

  Result<void> picture(const Tick& tick) {
    if (!photographer_ || drawn_++ % options_.picture_every != 0) return {};
    return write_png(std::filesystem::path(options_.frames_directory) / fmt::format("{:06}.png", pictures_++),
                     photographer_->take(*tick.projection));
  }

  const Options& options_;
  const calib::Calibration& calibration_;
  const twin::Twin& twin_;
  std::unique_ptr<twin::Judge> judge_;
  twin::Metrics metrics_;
  JitterMeter jitter_;
  std::optional<Trace> trace_;
  std::optional<Photographer> photographer_;
  std::int64_t drawn_ = 0, pictures_ = 0;
};

Result<void> run_ticks(const Options& options, const config::Rig& rig, Simulation& simulation, Products& products) {
  Progress progress(rig.name, options.warm_up_s + options.seconds, options.quiet);
  const auto start_ns = seconds_to_ns(options.warm_up_s), end_ns = start_ns + seconds_to_ns(options.seconds);
  Result<void> written;
  while (simulation.now_ns() < end_ns && written) {
    const bool scored = simulation.now_ns() >= start_ns;
    simulation.step([&](const Tick& tick) {
      if (scored) written = products.add(tick);
    });
    progress.at(ns_to_seconds(simulation.now_ns()));
  }
  return written;
}

}  // namespace

Result<void> run(const Options& options) {
  const auto rig = config::load_rig(options.rig_file, options.settings);
  if (!rig) return tl::make_unexpected(rig.error());
  const auto calibration = calib::load_calibration(rig->calibration);
  if (!calibration) return tl::make_unexpected(calibration.error());
  const auto twin = twin::Twin::create(*rig, *calibration);
  if (!twin) return tl::make_unexpected(twin.error());
  const auto truth = [&world = **twin](renderer::Side side, std::int64_t time_ns) { return world.landmarks(side, time_ns); };
  auto pipeline = renderer::Pipeline::create(rig->cascade, rig->content, rig->hand, *calibration, truth);
  if (!pipeline) return tl::make_unexpected(pipeline.error());
  auto products = Products::create(options, *rig, *calibration, **twin);
  if (!products) return tl::make_unexpected(products.error());

  auto feed = make_twin_feed(**twin);
  RecordingFeed* recording = nullptr;
  if (!options.record_directory.empty()) {
    auto recorder = std::make_unique<RecordingFeed>(std::move(feed), options.record_directory);
    recording = recorder.get();
    feed = std::move(recorder);
  }
  Simulation simulation(*rig, *calibration, **pipeline, *feed, options.draw_every);
  if (auto done = run_ticks(options, *rig, simulation, **products); !done) return done;
  if (recording)
    if (auto saved = recording->save(); !saved) return saved;
  if (auto written = (*products)->write_json(*rig); !written) return written;
  (*products)->print_summary(*rig);
  return {};
}

}  // namespace handcast::simulate
