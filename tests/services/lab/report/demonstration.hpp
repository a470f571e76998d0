// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace handcast::test {

/// Metrics in the format of the simulator. `error_mm` is the mean error; most others follow from
/// it.
inline nlohmann::json metrics_of(const std::string& rig, double error_mm) {
  const auto spread = [](double value) {
    return nlohmann::json{{"mean", value}, {"p95", 2.2 * value}, {"p99", 3 * value}};
  };
  nlohmann::json json{{"frames", 590},
                      {"interior_mm", spread(error_mm)},
                      {"interior_px", spread(2.4 * error_mm)},
                      {"coverage", 0.9912},
                      {"spill", 0.004 * error_mm},
                      {"iou", 0.985},
                      {"seam_px", 12.5},
                      {"jitter_px", 0.08},
                      {"foldovers", 0},
                      {"rig", rig},
                      {"motion", "builtin:open_close"},
                      {"seconds", 2},
                      {"seed", 1},
                      {"frame_us", {{"p50", 812.0}, {"p99", 1240.0}}}};
  json["equivalent_latency_ms"] = 4 * error_mm;
  double speed = 1;
  for (const char* bin : {"0-0.1", "0.1-0.3", "0.3-0.6", "0.6-1.0"}) {
    json["bins"][bin] = {
        {"frames", 100}, {"interior_mm", spread(0.5 * speed * error_mm)}, {"coverage", 0.99}};
    speed += 0.8;
  }
  json["bins"][">1.0"] = {
      {"frames", 0}, {"interior_mm", {{"mean", nullptr}, {"p95", nullptr}}}, {"coverage", nullptr}};
  double time_us = 20;
  for (const char* stage : {"predict", "skin", "correct", "mask", "draw", "fill"}) {
    json["stage_us"][stage] = {{"p50", time_us}, {"p99", 1.6 * time_us}};
    time_us += 35;
  }
  json["stage_us"]["frame"] = {{"p50", 812.0}, {"p99", 1240.0}};
  return json;
}

/// The supervisor's record of a live run.
inline nlohmann::json live_of() {
  nlohmann::json live{{"rig", "twin"}, {"seconds", 20.02}};
  live["services"] = {{"camera", {{"restarts", 0}, {"backend", "twin"}}},
                      {"pose", {{"restarts", 0}, {"backend", "twin"}}},
                      {"landmarks", {{"restarts", 1}, {"backend", "twin"}}},
                      {"projector", {{"restarts", 0}, {"backend", "twin"}}}};
  live["rates"] = {{"camera", {{"wanted_hz", 525.0}, {"held_hz", 498.21}}},
                   {"landmarks", {{"wanted_hz", nullptr}, {"held_hz", 61.4}}},
                   {"projector", {{"wanted_hz", 946.0}, {"held_hz", 903.5}}}};
  live["stage_us"] = metrics_of("twin", 1)["stage_us"];
  live["stage_us"]["capture"] = {{"p50", 1240.0}, {"p99", 2600.0}, {"count", 9960}};
  live["stage_us"]["sample"] = {{"p50", 9110.0}, {"p99", 10020.0}, {"count", 2210}};
  live["stage_us"]["detect"] = {{"p50", 15010.0}, {"p99", 19800.0}, {"count", 1230}};
  live["stage_us"]["present"] = {{"p50", 3.0}, {"p99", 410.0}, {"count", 18000}};
  return live;
}

inline void write_json(const std::filesystem::path& file, const nlohmann::json& json) {
  std::ofstream(file) << json.dump(2);
}

/// Pictures of a shape like a hand that moves to and fro, with light that is displaced by `off_px`.
inline void write_frames(const std::filesystem::path& folder, int count, int off_px) {
  std::filesystem::create_directories(folder);
  for (int i = 0; i < count; ++i) {
    const cv::Point centre(512 + static_cast<int>(120 * std::sin(i * 0.2)), 400);
    cv::Mat picture(768, 1024, CV_8UC3, cv::Scalar(22, 20, 20));
    cv::ellipse(picture, centre, {70, 90}, 0, 0, 360, {60, 70, 95}, cv::FILLED, cv::LINE_AA);
    for (int finger = -2; finger <= 2; ++finger)
      cv::line(picture, centre + cv::Point(finger * 28, -60), centre + cv::Point(finger * 45, -190),
               {60, 70, 95}, 26, cv::LINE_AA);
    cv::ellipse(picture, centre + cv::Point(off_px, 0), {60, 80}, 0, 0, 360, {90, 200, 120},
                cv::FILLED, cv::LINE_AA);
    cv::imwrite((folder / fmt::format("{:06}.png", i)).string(), picture);
  }
}

/// Writes all files of a demonstration to a folder.
inline void write_demonstration(const std::filesystem::path& folder, int pictures) {
  write_json(folder / "baseline.json", metrics_of("baseline", 7.6));
  write_json(folder / "paper.json", metrics_of("paper", 1.83));
  write_json(folder / "twin.json", metrics_of("twin", 1.21));
  write_json(folder / "live.json", live_of());
  write_json(folder / "observer.json", metrics_of("twin", 1.3));
  write_frames(folder / "frames" / "baseline", pictures, 30);
  write_frames(folder / "frames" / "paper", pictures, 12);
  write_frames(folder / "frames" / "twin", pictures, 2);
}

}  // namespace handcast::test
