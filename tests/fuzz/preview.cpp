// SPDX-License-Identifier: Apache-2.0
// The messages of a rig, as `handcast preview` finds them in rings that anybody may have written:
// any bytes, but for the sizes that a ring checks. The input is a sequence of messages: kind, the
// struct, and a few bytes that are repeated as pixels or vertices.
// Limits: 10 s and 1 GB per input.
#include <cmath>
#include <cstddef>

#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/largest_images.hpp"
#include "ipc/msg/owned.hpp"
#include "ipc/msg/projection.hpp"
#include "services/tools/preview/layout/layout.hpp"
#include "services/tools/preview/scene/scene_maker.hpp"
#include "tests/fuzz/input.hpp"

namespace {

using namespace handcast;
using preview::Scene;
using preview::SceneMaker;

constexpr int kMostScenes = 4;

/// The reference rig with small images, whose hands are squares of four vertices.
preview::World small_world() {
  constexpr double kScale = 0.125;
  preview::World world{
      .calibration = calib::reference_rig(), .mask = {}, .predict = {}, .hands = {}};
  auto& rig = world.calibration;
  rig.camera.width_px = 90, rig.camera.height_px = 68;
  for (double* length :
       {&rig.camera.fx_px, &rig.camera.fy_px, &rig.camera.cx_px, &rig.camera.cy_px})
    *length *= kScale;
  rig.projector.width_px = 128, rig.projector.height_px = 96;
  const glm::dmat3 smaller(kScale, 0, 0, 0, kScale, 0, 0, 0, 1),
      larger(1 / kScale, 0, 0, 0, 1 / kScale, 0, 0, 0, 1);
  rig.projector.from_camera = smaller * rig.projector.from_camera * larger;
  for (auto& mesh : world.hands) {
    mesh.positions.resize(4);
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  }
  return world;
}

/// Fills memory with bytes of the input, from its front.
void read_into(void* memory, std::size_t size, fuzz::Reader& reader) {
  const auto bytes = reader.take(size);
  if (!bytes.empty()) std::memcpy(memory, bytes.data(), bytes.size());
}

/// Repeats up to 16 bytes of the input.
void repeat_into(void* memory, std::size_t size, fuzz::Reader& reader) {
  const auto bytes = reader.take(16);
  auto* out = static_cast<std::uint8_t*>(memory);
  for (std::size_t i = 0; i < size; ++i) out[i] = bytes.empty() ? 0 : bytes[i % bytes.size()];
}

template <class T>
T plain_message(fuzz::Reader& reader) {
  T message;
  read_into(static_cast<void*>(&message), sizeof message, reader);
  return message;
}

void read_frame(msg::CameraFrame& frame, fuzz::Reader& reader) {
  frame = plain_message<msg::CameraFrame>(reader);
  repeat_into(frame.pixels(), 90 * 68, reader);
}

void read_light(msg::Projection& light, fuzz::Reader& reader) {
  read_into(static_cast<void*>(&light), offsetof(msg::Projection, hands), reader);
  for (auto& hand : light.hands) {
    hand.side = reader.number<msg::Side>();
    hand.vertex_count = reader.number<std::uint32_t>();
    read_into(hand.landings.data(), 4 * sizeof hand.landings[0], reader);
  }
  repeat_into(light.pixels(), 128 * 96 * 4, reader);
}

bool is_finite(glm::vec2 px) { return std::isfinite(px.x) && std::isfinite(px.y); }

void check(const Scene& scene, std::uint8_t layers) {
  fuzz::require(scene.hands.size() <= msg::kMaxHands);
  for (const auto& hand : scene.hands) {
    for (const auto& joint : hand.joints_px) fuzz::require(is_finite(joint));
    for (const auto& mark : hand.landmarks)
      fuzz::require(!mark || (is_finite(mark->px) && mark->sigma_px >= 0));
  }
  for (const auto& [from, to] : scene.drawing) fuzz::require(is_finite(from) && is_finite(to));
  preview::Look look{.width_px = 320, .height_px = 320};
  look.layers = preview::Layers(layers);
  fuzz::require(preview::draw(scene, {}, look).width() == 320);
}

}  // namespace

/// Fontconfig leaks.
extern "C" [[gnu::weak]] const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto world = small_world();
  static msg::Owned<msg::CameraFrame> frame(
      msg::CameraFrame::bytes(msg::kLargestCameraWidth_px, msg::kLargestCameraHeight_px));
  static msg::Owned<msg::Projection> light(
      msg::Projection::bytes(msg::kLargestProjectorWidth_px, msg::kLargestProjectorHeight_px));
  *frame = {};
  *light = {};
  fuzz::Reader reader({data, size});
  SceneMaker maker(world);
  for (int scenes = 0; scenes < kMostScenes && !reader.at_end();) {
    const auto kind = reader.number<std::uint8_t>();
    if (kind % 4 == 0) maker.push(plain_message<msg::HandPoses>(reader));
    if (kind % 4 == 1) maker.push(plain_message<msg::Landmarks>(reader));
    if (kind % 4 == 2) read_light(*light, reader);
    if (kind % 4 != 3) continue;
    read_frame(*frame, reader);
    check(maker.make(&*frame, &*light), kind >> 2);
    ++scenes;
  }
  return 0;
}
