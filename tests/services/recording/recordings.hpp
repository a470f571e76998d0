// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "ipc/msg/owned.hpp"
#include "services/recording/recording_writer.hpp"

/// Small recordings.
namespace handcast::recording::test {

inline constexpr int kWidth = 7, kHeight = 5;
inline const std::vector<std::string> kStreams{"camera.frames", "pose.hands", "projection.frames"};

/// Image `k` of noise; equal numbers give equal images.
inline msg::Owned<msg::CameraFrame> frame(std::uint32_t k) {
  msg::Owned<msg::CameraFrame> frame(msg::CameraFrame::bytes(kWidth, kHeight));
  frame->header = {100 + k, 1'000'000 * (k + 1), 1'000'000 * (k + 1) + 300};
  frame->exposure_ns = 1'850'000;
  frame->width_px = kWidth;
  frame->height_px = kHeight;
  std::uint32_t noise = k;
  for (int i = 0; i < kWidth * kHeight; ++i)
    frame->pixels()[i] = static_cast<std::uint8_t>((noise = noise * 1664525u + 1013904223u) >> 27);
  return frame;
}

inline msg::HandPoses poses(std::uint32_t k) {
  msg::HandPoses poses;
  poses.header = {k, 900'000 * (k + 1), 900'000 * (k + 1) + 9'000'000};
  poses.count = 1;
  poses.hands[0].side = msg::Side::right;
  poses.hands[0].joints[3].position_m = {0.1f, 0.2f, 0.25f * static_cast<float>(k)};
  return poses;
}

inline msg::Owned<msg::Projection> projection(std::uint32_t k) {
  msg::Owned<msg::Projection> projection(msg::Projection::bytes(4, 3));
  projection->header = {k, 5'000 * (k + 1), 6'000 * (k + 1)};
  projection->region_width_px = 4;
  projection->region_height_px = 3;
  projection->hand_count = 1;
  projection->hands[0].vertex_count = 2;
  projection->hands[0].landings[1] = {1.5f, 2.5f};
  for (std::uint32_t i = 0; i < 12; ++i) projection->pixels()[i] = 0x10203040u * (i + k);
  return projection;
}

inline RecordingWriter writer(const std::filesystem::path& folder) {
  auto writer = RecordingWriter::create(folder, {"twin", "name = \"twin\"\n"}, kStreams);
  if (!writer) throw std::runtime_error(writer.error().what);
  return std::move(*writer);
}

/// Writes a recording of `count` messages in each of kStreams.
inline void write(const std::filesystem::path& folder, std::uint32_t count) {
  auto to = writer(folder);
  for (std::uint32_t k = 0; k < count; ++k) {
    EXPECT_TRUE(to.append(0, *frame(k), k, 0));
    EXPECT_TRUE(to.append(1, poses(k), k, 0));
    EXPECT_TRUE(to.append(2, *projection(k), k, 0));
  }
  EXPECT_TRUE(to.finish("it was stopped", {0, 0, 0}));
}

inline std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
inline void replace(const std::filesystem::path& file, const std::string& contents) {
  std::ofstream(file, std::ios::binary) << contents;
}

}  // namespace handcast::recording::test
