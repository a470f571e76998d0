// SPDX-License-Identifier: Apache-2.0
#include "services/recording/streams.hpp"

#include <algorithm>
#include <cstring>
#include <tuple>

namespace handcast::recording {
namespace {

const std::string kHeader = R"(["frame_id", "<u8"], ["origin_ns", "<i8"], ["published_ns", "<i8"])";
const std::string kMadeFrom =
    R"(["made_from", [["image_id", "<u8"], ["image_ns", "<i8"], ["pose_ns", "<i8"], )"
    R"(["landmarks_ns", "<i8"]]])";

static_assert(msg::kMaxHands == 2 && msg::kJoints == 26 && msg::kLandmarks == 21 &&
              msg::kMaxVertices == 4096 &&
              std::tuple_size_v<decltype(msg::StageMarks::marks)> == 20);

template <class Items>
void clear_behind(Items& items, std::uint32_t count) {
  if (count >= items.size()) return;
  std::memset(static_cast<void*>(items.data() + count), 0,
              (items.size() - count) * sizeof items[0]);
}

template <class Hands>
bool are_sound(const Hands& hands, std::uint32_t count) {
  if (count > hands.size()) return false;
  return std::all_of(hands.begin(), hands.begin() + count,
                     [](const auto& hand) { return hand.side <= msg::Side::right; });
}

}  // namespace

template <>
const MessageType& type_of<msg::CameraFrame>() {
  static const MessageType kType{
      msg::CameraFrame::layout, sizeof(msg::CameraFrame), 1,
      "[" + kHeader +
          R"(, ["exposure_ns", "<i8"], ["origin_error_ns", "<i8"], )"
          R"(["lost", [["missing", "<u4"], ["incomplete", "<u4"], ["underrun", "<u4"], )"
          R"(["skipped", "<u4"]]], ["width_px", "<u4"], ["height_px", "<u4"], )"
          R"(["calibration", "<u4"], ["reserved", "<u4"]])"};
  return kType;
}

template <>
const MessageType& type_of<msg::HandPoses>() {
  static const MessageType kType{
      msg::HandPoses::layout, sizeof(msg::HandPoses), 0,
      "[" + kHeader +
          R"(, ["count", "<u4"], ["calibration", "<u4"], ["hands", [["side", "<u4"], )"
          R"(["confidence", "<f4"], ["joints", [["position_m", "<f4", [3]], )"
          R"(["orientation_xyzw", "<f4", [4]], ["radius_m", "<f4"]], [26]]], [2]]])"};
  return kType;
}

template <>
const MessageType& type_of<msg::Landmarks>() {
  static const MessageType kType{
      msg::Landmarks::layout, sizeof(msg::Landmarks), 0,
      "[" + kHeader +
          R"(, ["count", "<u4"], ["calibration", "<u4"], ["hands", [["side", "<u4"], )"
          R"(["presence", "<f4"], ["points", [["x_px", "<f4"], ["y_px", "<f4"], )"
          R"(["confidence", "<f4"], ["sigma_px", "<f4"]], [21]]], [2]]])"};
  return kType;
}

template <>
const MessageType& type_of<msg::Projection>() {
  static const MessageType kType{
      msg::Projection::layout, sizeof(msg::Projection), 4,
      "[" + kHeader + ", " + kMadeFrom +
          R"(, ["target_ns", "<i8"], ["lit_ns", "<i8"], ["width_px", "<u4"], )"
          R"(["height_px", "<u4"], ["region_x_px", "<i4"], ["region_y_px", "<i4"], )"
          R"(["region_width_px", "<u4"], ["region_height_px", "<u4"], ["hand_count", "<u4"], )"
          R"(["foldovers", "<u4"], ["hands", [["side", "<u4"], ["vertex_count", "<u4"], )"
          R"(["presence", "<f4"], ["reserved", "<u4"], ["landings", [["x_px", "<f4"], )"
          R"(["y_px", "<f4"]], [4096]]], [2]], ["has_shown", "<u4"], ["reserved", "<u4"], ["test_picture", "<u8"]])"};
  return kType;
}

template <>
const MessageType& type_of<msg::StageMarks>() {
  static const MessageType kType{
      msg::StageMarks::layout, sizeof(msg::StageMarks), 0,
      "[" + kHeader + ", " + kMadeFrom +
          R"(, ["count", "<u4"], ["reserved", "<u4"], ["marks", [["stage", "<u4"], )"
          R"(["detail", "<u4"], ["begin_ns", "<i8"], ["end_ns", "<i8"]], [20]]])"};
  return kType;
}

const MessageType* type_of_stream(std::string_view stream) {
  if (stream == "camera.frames" || stream == "camera2.frames") return &type_of<msg::CameraFrame>();
  if (stream == "pose.hands") return &type_of<msg::HandPoses>();
  if (stream == "landmarks.hands" || stream == "landmarks2.hands")
    return &type_of<msg::Landmarks>();
  if (stream == "projection.frames" || stream == "projection2.frames")
    return &type_of<msg::Projection>();
  if (stream.starts_with("marks.")) return &type_of<msg::StageMarks>();
  return nullptr;
}

ImageShape image_of(const msg::CameraFrame& frame) { return {frame.width_px, frame.height_px, 1}; }
ImageShape image_of(const msg::Projection& projection) {
  return {projection.region_width_px, projection.region_height_px, 4};
}

void clear_unused(msg::CameraFrame&) {}
void clear_unused(msg::HandPoses& poses) { clear_behind(poses.hands, poses.count); }
void clear_unused(msg::Landmarks& landmarks) { clear_behind(landmarks.hands, landmarks.count); }
void clear_unused(msg::Projection& projection) {
  projection.has_shown = 0;  // recordings have only the pixels of the tail
  clear_behind(projection.hands, projection.hand_count);
  for (auto& hand : projection.hands) clear_behind(hand.landings, hand.vertex_count);
}
void clear_unused(msg::StageMarks& marks) { clear_behind(marks.marks, marks.count); }

bool is_sound(const msg::CameraFrame&) { return true; }
bool is_sound(const msg::HandPoses& poses) { return are_sound(poses.hands, poses.count); }
bool is_sound(const msg::Landmarks& landmarks) {
  return are_sound(landmarks.hands, landmarks.count);
}
bool is_sound(const msg::Projection& projection) {
  return are_sound(projection.hands, projection.hand_count) &&
         std::ranges::all_of(projection.hands, [](const auto& hand) {
           return hand.vertex_count <= hand.landings.size();
         });
}
bool is_sound(const msg::StageMarks& marks) { return marks.count <= marks.marks.size(); }

}  // namespace handcast::recording
