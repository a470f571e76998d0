// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/score.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "ipc/base/clock.hpp"
#include "renderer/media/picture.hpp"
#include "services/lab/simulate/detector_tally.hpp"
#include "services/lab/simulate/exchange.hpp"
#include "services/lab/simulate/hand_speed.hpp"
#include "services/lab/simulate/jitter.hpp"
#include "services/lab/simulate/photograph.hpp"
#include "services/lab/simulate/recorder.hpp"
#include "services/lab/simulate/recovery.hpp"
#include "services/lab/simulate/second_light.hpp"
#include "services/lab/simulate/sensor_feed.hpp"
#include "services/lab/simulate/trace.hpp"
#include "services/lab/twin/metrics.hpp"

namespace handcast::simulate {
namespace {

/// Earlier pictures and recordings are replaced, but not the motion that is played, nor the images
/// of a recording by those of --frames.
Result<void> check_recordings_are_spared(const Options& options, const config::Rig& rig) {
  namespace fs = std::filesystem;
  std::error_code unknown;
  if (const fs::path folder(options.record_directory);
      !folder.empty() && fs::equivalent(folder, rig.twin.motion, unknown))
    return fail(Errc::bad_config,
                fmt::format("--record {}: this is the recording that is played (twin.motion); "
                            "name another one",
                            folder.string()));
  if (options.frames_directory.empty()) return {};
  const auto folder = fs::weakly_canonical(options.frames_directory, unknown);
  const auto recorded =
      fs::weakly_canonical(fs::path(options.record_directory) / "camera", unknown);
  const auto holds = [&](const char* times) {
    return fs::exists(folder.parent_path() / times, unknown);
  };
  const bool is_of_recording =
      folder.filename() == "camera" && (holds("timestamps.npy") || holds("camera_timestamps.npy"));
  if (is_of_recording || (!options.record_directory.empty() && folder == recorded))
    return fail(Errc::bad_config,
                fmt::format("--frames {}: this is the folder of the images of a recording; name "
                            "another one",
                            options.frames_directory));
  return {};
}

/// The timed fault whose effect is measured: by a second run without it, so not if results of other
/// methods are scored.
std::optional<FaultTime> fault_of(const config::Rig& rig, const Options& options) {
  const bool has_results = !options.poses_file.empty() || !options.landmarks_file.empty();
  return has_results ? std::nullopt : fault_time(rig.twin);
}

/// The metrics and files that are made from the ticks of one run.
class Products {
 public:
  static Result<std::unique_ptr<Products>> create(const Options& options, const config::Rig& rig,
                                                  const calib::Calibration& calibration,
                                                  const twin::Twin& twin) {
    auto products = std::unique_ptr<Products>(new Products(options, rig, calibration, twin));
    if (!options.frames_directory.empty()) {
      std::error_code failed;
      std::filesystem::create_directories(options.frames_directory, failed);
      if (failed)
        return fail(Errc::bad_config, fmt::format("{}: cannot be created: {}",
                                                  options.frames_directory, failed.message()));
      if (auto removed = remove_numbered_pngs(options.frames_directory); !removed)
        return tl::make_unexpected(removed.error());
      products->photographer_.emplace(twin, calibration);
    }
    if (calibration.projector2 && options.draw_every > 0) {
      auto second = SecondLight::open(rig, calibration, options, twin);
      if (!second) return tl::make_unexpected(second.error());
      products->second_ = std::move(*second);
    }
    // Last, because it empties the file.
    if (!options.trace_file.empty()) {
      auto trace = Trace::open(options.trace_file);
      if (!trace) return tl::make_unexpected(trace.error());
      products->trace_ = std::move(*trace);
    }
    return products;
  }

  /// Adds a tick. `detections`: detections with a hand that had arrived before it.
  Result<void> add(const Tick& tick, int detections) {
    if (tick.is_new) add_landmarks(tick, detections);
    return tick.projection ? add_light(tick) : Result<void>();
  }

  /// Closes the files after the last tick.
  Result<void> finish() {
    metrics_.set_jitter(light_jitter_.rms_px(), landmark_jitter_.rms_px());
    return trace_ ? trace_->close() : Result<void>();
  }

  bool has_fault() const { return fault_.has_value(); }

  /// The metrics. `clean`: the light of the same run without the fault; empty without a fault.
  nlohmann::json to_json(const config::Rig& rig, std::span<const LightMoment> clean) const {
    auto json = metrics_.to_json();
    if (drawn_ == 0) json["foldovers"] = nullptr;
    json["rig"] = rig.name;
    json["motion"] = rig.twin.motion;
    json["mesh"] = twin_.hands().mesh_name();
    json["speed"] = rig.twin.speed;
    json["seed"] = rig.twin.seed;
    json["seconds"] = options_.seconds;
    json["hand_speed_m_s"] = hand_speed_.to_json();
    json["fault"] = simulate::to_json(fault_, moments_, clean);
    json["shared"] = second_ ? second_->to_json() : nlohmann::json();
    json["software_ms"] = rig.projector.software_ms;
    json["motion_to_photon_ms"] =
        with_exposure_ > 0
            ? nlohmann::json(motion_to_photon_ms_ / static_cast<double>(with_exposure_))
            : nlohmann::json();
    return json;
  }

 private:
  Products(const Options& options, const config::Rig& rig, const calib::Calibration& calibration,
           const twin::Twin& twin)
      : options_(options),
        calibration_(calibration),
        twin_(twin),
        fault_(fault_of(rig, options)),
        judge_(options.draw_every > 0 ? twin::Judge::create(twin, rig.observer.step_px) : nullptr) {
  }

  /// What is said of the tracked landmarks, drawn or not: at the light for which they were
  /// computed.
  void add_landmarks(const Tick& tick, int detections) {
    add_speeds(tick.target_ns);
    for (const auto& hand : tick.hands) {
      const auto truth = twin_.landmarks(hand.side, tick.target_ns);
      const auto errors = landmark_errors(hand, tick.target_ns, twin_, calibration_);
      if (!truth || !errors) continue;
      landmark_jitter_.add(hand.side, tick.target_ns, landmark_points(hand, *truth),
                           speed_m_s_[static_cast<std::size_t>(hand.side)]);
      for (std::size_t i = 0; i < errors->px.size(); ++i)
        metrics_.add_landmark(errors->px[i], errors->mm[i]);
      if (trace_) trace_->add(tick.target_ns, hand, *truth);
    }
    if (fault_) moments_.push_back(moment_of(tick, detections, twin_, calibration_));
  }

  /// What is said of the light: when it is on.
  Result<void> add_light(const Tick& tick) {
    const auto score = judge_->score(*tick.projection);
    metrics_.add(score);
    for (const auto& hand : score.hands)
      light_jitter_.add(hand.side, tick.display_ns, light_points(hand),
                        speed_m_s_[static_cast<std::size_t>(hand.side)]);
    metrics_.add_stages(tick.frame->stages);
    metrics_.add_foldovers(tick.frame->foldovers);
    for (const auto& hand : tick.hands) metrics_.add_rung(hand.rung);
    if (const auto origin_ns = tick.projection->header.origin_ns; origin_ns > 0) {
      motion_to_photon_ms_ += ns_to_ms(tick.display_ns - origin_ns);
      ++with_exposure_;
    }
    if (second_) second_->judge(*tick.projection, tick.begin_ns);
    return picture(drawn_++, *tick.projection);
  }

  void add_speeds(std::int64_t display_ns) {
    for (const auto side : {msg::Side::left, msg::Side::right}) {
      const auto joints = twin_.joints(side, display_ns);
      if (!joints) continue;
      std::array<glm::dvec3, msg::kLandmarks> places_m;
      for (std::size_t i = 0; i < places_m.size(); ++i)
        places_m[i] = (*joints)[msg::kJointOfLandmark[i]][3];
      speed_m_s_[static_cast<std::size_t>(side)] = hand_speed_.add(side, places_m, display_ns);
    }
  }

  Result<void> picture(std::int64_t frame, const msg::Projection& projection) {
    if (!photographer_ || frame % options_.picture_every != 0) return {};
    return renderer::write_png(numbered_png(options_.frames_directory, pictures_++),
                               second_ ? second_->picture() : photographer_->take(projection));
  }

  const Options& options_;
  const calib::Calibration& calibration_;
  const twin::Twin& twin_;
  std::optional<FaultTime> fault_;
  std::unique_ptr<twin::Judge> judge_;  ///< null if nothing is drawn: it makes the true hands
  twin::Metrics metrics_;
  JitterMeter light_jitter_, landmark_jitter_;
  std::array<double, msg::kMaxHands> speed_m_s_{};  ///< of the true hands in this tick
  HandSpeed hand_speed_;
  std::vector<LightMoment> moments_;  ///< empty without a fault
  std::optional<Trace> trace_;
  std::optional<Photographer> photographer_;
  std::unique_ptr<SecondLight> second_;  ///< null if the rig has one projector
  std::int64_t drawn_ = 0, with_exposure_ = 0;
  std::size_t pictures_ = 0;
  double motion_to_photon_ms_ = 0;  ///< sum over the drawn frames that have an image
};

/// Adds the detections of frames from `start_ns` on to the tally.
OnDetection from(std::int64_t start_ns, DetectorTally& tally) {
  return [start_ns, &tally](const Exposure& exposure, const Detection& detection) {
    if (exposure.origin_ns >= start_ns) tally.add(exposure, detection);
  };
}

Result<void> save(const RecordingFeed& recording, const std::filesystem::path& folder,
                  const twin::Twin& twin, const calib::CameraModel& lens) {
  if (auto saved = recording.save(); !saved) return saved;
  return write_exchange(folder, recording.events(), recording.exposures(), twin, lens);
}

nlohmann::json to_json(const DetectorTally& tally, const config::Rig& rig, const Options& options) {
  auto json = tally.to_json();
  json["used"] = rig.cascade.filter.method != config::FilterMethod::none;
  if (!options.landmarks_file.empty()) {
    json["backend"] = options.landmarks_file;
    json["why"] = json["age_ms"] = nullptr;
    return json;
  }
  const auto choice = landmarks::choose_detector(rig);
  json["backend"] = choice.backend;
  json["why"] = choice.why.empty() ? nlohmann::json() : nlohmann::json(choice.why);
  json["age_ms"] = rig.twin.detector.age_ms;
  return json;
}

}  // namespace

std::string why_nothing_was_scored(const nlohmann::json& metrics, const Options& options) {
  const auto has = [&](const char* pointer) {
    const nlohmann::json::json_pointer place(pointer);
    return metrics.contains(place) && metrics[place].is_number();
  };
  if (options.draw_every == 0)
    return has("/landmark_mm/mean") ? "" : "no hand was tracked: there is nothing to score";
  if (has("/coverage")) return "";
  return metrics.value("frames", 0) == 0
             ? "no frame was drawn: with projector.software_ms and twin.projector.work_ms, the "
               "light "
               "is never in time"
             : "no true hand was in the image of the projector: there is nothing to score";
}

double simulated_s(const config::Rig& rig, const Options& options) {
  return (fault_of(rig, options) ? 2 : 1) * (options.warm_up_s + options.seconds);
}

Result<nlohmann::json> score(const config::Rig& rig, const calib::Calibration& calibration,
                             const Options& options, const OnProgress& on_progress) {
  if (auto spared = check_recordings_are_spared(options, rig); !spared)
    return tl::make_unexpected(spared.error());
  auto parts = open_virtual_rig(rig, calibration, options);
  if (!parts) return tl::make_unexpected(parts.error());
  const auto& twin = *parts->twin;
  auto products = Products::create(options, rig, calibration, twin);
  if (!products) return tl::make_unexpected(products.error());

  DetectorTally tally(twin, calibration.camera);
  auto feed = make_twin_feed(twin, std::move(parts->detector),
                             from(seconds_to_ns(options.warm_up_s), tally), parts->lifter,
                             parts->second, parts->sent);
  RecordingFeed* recording = nullptr;
  if (!options.record_directory.empty()) {
    auto recorder =
        RecordingFeed::create(std::move(feed), calibration.camera, options.record_directory);
    if (!recorder) return tl::make_unexpected(recorder.error());
    recording = recorder->get();
    feed = std::move(*recorder);
  }
  CountingFeed counted(std::move(feed));
  Simulation simulation(rig, calibration, *parts->pipeline, counted, options.draw_every);
  const auto add = [&](const Tick& tick) { return (*products)->add(tick, counted.detections()); };
  if (auto done = run_ticks(options, simulation, add, on_progress); !done)
    return tl::make_unexpected(done.error());
  if (auto finished = (*products)->finish(); !finished)
    return tl::make_unexpected(finished.error());
  if (recording)
    if (auto saved = save(*recording, options.record_directory, twin, calibration.camera); !saved)
      return tl::make_unexpected(saved.error());
  Result<std::vector<LightMoment>> clean;
  const auto go_on = [&](double done_s) {
    if (on_progress) on_progress(options.warm_up_s + options.seconds + done_s);
  };
  if ((*products)->has_fault()) clean = moments_without_fault(rig, calibration, options, go_on);
  if (!clean) return tl::make_unexpected(clean.error());
  auto json = (*products)->to_json(rig, *clean);
  json["detector"] = to_json(tally, rig, options);
  json["poses"] =
      options.poses_file.empty() ? nlohmann::json() : nlohmann::json(options.poses_file);
  return json;
}

}  // namespace handcast::simulate
