#include "services/simulate/score.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "ipc/base/clock.hpp"
#include "services/simulate/detector_tally.hpp"
#include "services/simulate/hand_speed.hpp"
#include "services/simulate/jitter.hpp"
#include "services/simulate/photograph.hpp"
#include "services/simulate/png.hpp"
#include "services/simulate/recorder.hpp"
#include "services/simulate/recovery.hpp"
#include "services/simulate/simulation.hpp"
#include "services/simulate/trace.hpp"

namespace handcast::simulate {
namespace {

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
    LightMoment moment{ns_to_seconds(tick.lit_ns)};
    for (const auto& hand : tick.hands) {
      const auto truth = twin_.landmarks(hand.side, tick.lit_ns);
      if (!truth) continue;
      jitter_.add(hand, *truth, tick.index, metrics_);
      moment.error_mm = std::max(moment.error_mm, add_landmarks(hand, *truth, tick.lit_ns));
      if (trace_) trace_->add(tick.lit_ns, hand, *truth);
    }
    if (fault_) {
      moment.dark = has_dark_hand(tick);
      moments_.push_back(moment);
    }
    if (!tick.projection) return {};
    metrics_.add(judge_->score(*tick.projection));
    metrics_.add_stages(tick.frame->stages);
    metrics_.add_foldovers(tick.frame->foldovers);
    for (const auto& hand : tick.hands) metrics_.add_rung(hand.rung);
    if (const auto origin_ns = tick.projection->header.origin_ns; origin_ns > 0) {
      motion_to_photon_ms_ += ns_to_ms(tick.lit_ns - origin_ns);
      ++with_exposure_;
    }
    return picture(drawn_++, *tick.projection);
  }

  nlohmann::json to_json(const config::Rig& rig) const {
    auto json = metrics_.to_json();
    if (drawn_ == 0) json["foldovers"] = nullptr;
    json["rig"] = rig.name;
    json["motion"] = rig.twin.motion;
    json["speed"] = rig.twin.speed;
    json["seed"] = rig.twin.seed;
    json["seconds"] = options_.seconds;
    json["hand_speed_m_s"] = hand_speed_.to_json();
    json["fault"] = simulate::to_json(fault_, moments_);
    json["software_ms"] = rig.projector.software_ms;
    json["motion_to_photon_ms"] =
        with_exposure_ > 0 ? nlohmann::json(motion_to_photon_ms_ / static_cast<double>(with_exposure_)) : nlohmann::json();
    return json;
  }

 private:
  Products(const Options& options, const config::Rig& rig, const calib::Calibration& calibration, const twin::Twin& twin)
      : options_(options),
        calibration_(calibration),
        twin_(twin),
        fault_(fault_time(rig.twin)),
        judge_(options.draw_every > 0 ? twin::Judge::create(twin, calibration, rig.observer.step_px) : nullptr) {}

  /// Camera px become mm at the distance of the joint. Gives the mean of the hand's landmarks, mm.
  double add_landmarks(const renderer::FrameHand& hand, const renderer::LandmarkPoints& truth, std::int64_t lit_ns) {
    const auto joints = twin_.joints(hand.side, lit_ns);
    if (!joints) return 0;
    std::array<glm::dvec3, msg::kLandmarks> places_m;
    double sum_mm = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      places_m[i] = calibration_.camera_from_tracker * (*joints)[msg::kJointOfLandmark[i]][3];
      const double error_px = glm::length(hand.corrected[i] - truth[i]);
      const double error_mm = 1e3 * error_px * places_m[i].z / calibration_.camera.fx_px;
      metrics_.add_landmark(error_px, error_mm);
      sum_mm += error_mm;
    }
    hand_speed_.add(hand.side, places_m, lit_ns);
    return sum_mm / static_cast<double>(truth.size());
  }

  bool has_dark_hand(const Tick& tick) const {
    for (const auto side : {msg::Side::left, msg::Side::right}) {
      const bool lit = std::ranges::any_of(tick.hands, [side](const renderer::FrameHand& hand) { return hand.side == side; });
      if (!lit && twin_.landmarks(side, tick.lit_ns)) return true;
    }
    return false;
  }

  Result<void> picture(std::int64_t frame, const msg::Projection& projection) {
    if (!photographer_ || frame % options_.picture_every != 0) return {};
    return write_png(std::filesystem::path(options_.frames_directory) / fmt::format("{:06}.png", pictures_++),
                     photographer_->take(projection));
  }

  const Options& options_;
  const calib::Calibration& calibration_;
  const twin::Twin& twin_;
  std::optional<FaultTime> fault_;
  std::unique_ptr<twin::Judge> judge_;  ///< null where nothing is drawn: it makes the whole true hand
  twin::Metrics metrics_;
  JitterMeter jitter_;
  HandSpeed hand_speed_;
  std::vector<LightMoment> moments_;  ///< kept where there is a fault
  std::optional<Trace> trace_;
  std::optional<Photographer> photographer_;
  std::int64_t drawn_ = 0, pictures_ = 0, with_exposure_ = 0;
  double motion_to_photon_ms_ = 0;  ///< summed over the frames that show an exposure
};

Result<void> run_ticks(const Options& options, Simulation& simulation, Products& products, const OnProgress& on_progress) {
  const auto start_ns = seconds_to_ns(options.warm_up_s), end_ns = start_ns + seconds_to_ns(options.seconds);
  Result<void> written;
  while (simulation.now_ns() < end_ns && written) {
    const bool scored = simulation.now_ns() >= start_ns;
    simulation.step([&](const Tick& tick) {
      if (scored) written = products.add(tick);
    });
    if (on_progress) on_progress(ns_to_seconds(simulation.now_ns()));
  }
  return written;
}

/// What is scored begins at `start_ns`.
OnDetection from(std::int64_t start_ns, DetectorTally& tally) {
  return [start_ns, &tally](const Exposure& exposure, const Detection& detection) {
    if (exposure.origin_ns >= start_ns) tally.add(exposure, detection);
  };
}

nlohmann::json to_json(const DetectorTally& tally, const config::Rig& rig) {
  auto json = tally.to_json();
  json["backend"] = simulated_backend(rig);
  json["age_ms"] = rig.twin.detector.age_ms;
  return json;
}

}  // namespace

Result<nlohmann::json> score(const config::Rig& rig, const calib::Calibration& calibration, const Options& options,
                             const OnProgress& on_progress) {
  const auto twin = twin::Twin::create(rig, calibration);
  if (!twin) return tl::make_unexpected(twin.error());
  const auto truth = [&world = **twin](renderer::Side side, std::int64_t time_ns) { return world.landmarks(side, time_ns); };
  auto pipeline = renderer::Pipeline::create(rig.cascade, rig.content, rig.hand, calibration, truth);
  if (!pipeline) return tl::make_unexpected(pipeline.error());
  auto detector = open_frame_detector(rig, calibration, **twin);
  if (!detector) return tl::make_unexpected(detector.error());
  auto products = Products::create(options, rig, calibration, **twin);
  if (!products) return tl::make_unexpected(products.error());

  DetectorTally tally(**twin, calibration.camera);
  auto feed = make_twin_feed(**twin, std::move(*detector), from(seconds_to_ns(options.warm_up_s), tally));
  RecordingFeed* recording = nullptr;
  if (!options.record_directory.empty()) {
    auto recorder = std::make_unique<RecordingFeed>(std::move(feed), options.record_directory);
    recording = recorder.get();
    feed = std::move(recorder);
  }
  Simulation simulation(rig, calibration, **pipeline, *feed, options.draw_every);
  if (auto done = run_ticks(options, simulation, **products, on_progress); !done) return tl::make_unexpected(done.error());
  if (recording)
    if (auto saved = recording->save(); !saved) return tl::make_unexpected(saved.error());
  auto json = (*products)->to_json(rig);
  json["detector"] = to_json(tally, rig);
  return json;
}

}  // namespace handcast::simulate
