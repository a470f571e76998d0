// SPDX-License-Identifier: Apache-2.0
#include "services/desk/page/picture_feed.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/msg/projection.hpp"
#include "renderer/media/jpeg.hpp"
#include "services/desk/base/low_priority.hpp"
#include "services/desk/page/json_text.hpp"

namespace handcast::desk {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr std::int64_t kPeriod_ns = 60'000'000;
constexpr std::int64_t kWanted_ns = 2'000'000'000;
constexpr int kQuality = 70, kMostWidth_px = 640, kMostLight_px = 400;
constexpr std::array kSides{"left", "right"};
constexpr std::array kLights{"light", "light2"};  // of both projectors

/// libjpeg ends the process at a picture that cannot be one.
bool is_picture(std::uint32_t width_px, std::uint32_t height_px) {
  constexpr std::uint32_t kLeast_px = 8, kMost_px = 8192;
  return width_px >= kLeast_px && height_px >= kLeast_px && width_px <= kMost_px &&
         height_px <= kMost_px;
}

void append_part(std::string& packet, const void* bytes, std::size_t size) {
  for (int shift = 0; shift < 32; shift += 8)
    packet += static_cast<char>(static_cast<std::uint32_t>(size) >> shift & 0xff);
  packet.append(static_cast<const char*>(bytes), size);
}

/// Every 2x2 pixels as one.
renderer::Image<std::uint8_t> half(renderer::View<const std::uint8_t> image) {
  renderer::Image<std::uint8_t> small(image.width / 2, image.height / 2);
  for (int y = 0; y < small.height(); ++y) {
    const auto *above = image.row(2 * y), *below = image.row(2 * y + 1);
    auto* row = small.view().row(y);
    for (int x = 0; x < small.width(); ++x)
      row[x] = static_cast<std::uint8_t>(
          (above[2 * x] + above[2 * x + 1] + below[2 * x] + below[2 * x + 1] + 2) / 4);
  }
  return small;
}

/// Every n-th pixel of every n-th row.
renderer::Image<std::uint32_t> thinned(renderer::View<const std::uint32_t> image, int n) {
  renderer::Image<std::uint32_t> small(image.width / n, image.height / n);
  for (int y = 0; y < small.height(); ++y)
    for (int x = 0; x < small.width(); ++x) small.view().at(x, y) = image.at(n * x, n * y);
  return small;
}

std::vector<std::uint8_t> jpeg_of_camera(const msg::CameraFrame& frame) {
  const auto width = static_cast<int>(frame.width_px), height = static_cast<int>(frame.height_px);
  const renderer::View<const std::uint8_t> whole{frame.pixels(), width, height, width};
  if (width <= kMostWidth_px || height < 64) return renderer::small_jpeg_of(whole, kQuality);
  auto small = half(whole);
  while (small.width() > kMostWidth_px && small.height() >= 16) small = half(small.view());
  return renderer::small_jpeg_of(small.view(), kQuality);
}

std::vector<std::uint8_t> jpeg_of_light(const msg::Projection& light) {
  const auto width = static_cast<int>(light.region_width_px),
             height = static_cast<int>(light.region_height_px);
  const renderer::View<const std::uint32_t> whole{light.pixels(), width, height, width};
  const int n = (std::max(width, height) + kMostLight_px - 1) / kMostLight_px;
  if (n <= 1) return renderer::small_jpeg_of(whole, kQuality);
  if (width < n || height < n) return {};
  return renderer::small_jpeg_of(thinned(whole, n).view(), kQuality);
}

void add_place(json& places, glm::dvec2 px) {
  const bool is_sane = std::abs(px.x) < 1e5 && std::abs(px.y) < 1e5;  // false for NaN
  places.push_back(is_sane ? json(std::round(px.x * 10) / 10) : json());
  places.push_back(is_sane ? json(std::round(px.y * 10) / 10) : json());
}

json place_of(const msg::Projection& light) {
  return {{"width", light.width_px}, {"height", light.height_px},  {"x", light.region_x_px},
          {"y", light.region_y_px},  {"w", light.region_width_px}, {"h", light.region_height_px}};
}

json landmarks_of(const msg::Landmarks& message, const calib::CameraModel& camera) {
  auto hands = json::object();
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    const auto* hand = message.find(side);
    if (!hand) continue;
    auto& places = hands[kSides[static_cast<std::size_t>(side)]] = json::array();
    for (const auto& point : hand->points)
      add_place(places,
                point.confidence > 0 ? camera.distort({point.x_px, point.y_px}) : glm::dvec2(NAN));
  }
  return hands;
}

}  // namespace

/// The rings of the rig while somebody looks.
struct PictureFeed::Inputs {
  std::optional<client::Stream<msg::CameraFrame>> camera;
  std::optional<client::Stream<msg::Landmarks>> landmarks;
  std::array<std::optional<client::Stream<msg::Projection>>, kLights.size()> lights;
  std::int64_t next_try_ns = 0;

  void open(const std::string& rig) {
    if (now_ns() < next_try_ns) return;
    next_try_ns = now_ns() + 1'000'000'000;
    open_one(rig, "camera.frames", camera);
    open_one(rig, "landmarks.hands", landmarks);
    open_one(rig, "projection.frames", lights[0]);
    open_one(rig, "projection2.frames", lights[1]);
  }

  template <class T>
  static void open_one(const std::string& rig, std::string_view name,
                       std::optional<client::Stream<T>>& stream) {
    if (stream) return;
    if (auto opened = client::open_stream<T>(rig, name)) stream.emplace(std::move(*opened));
  }

  /// The newest message; empty if there is none, and then the stream is closed if it is over.
  template <class T>
  static std::optional<ipc::Sample<T>> newest(std::optional<client::Stream<T>>& stream) {
    if (!stream) return std::nullopt;
    auto sample = stream->latest(Deadline::now());
    if (sample) return std::move(*sample);
    if (sample.error().code != Errc::timeout && sample.error().code != Errc::bad_data)
      stream.reset();
    return std::nullopt;
  }
};

PictureFeed::PictureFeed(std::string rig, calib::CameraModel camera)
    : rig_(std::move(rig)), camera_(camera), thread_([this] { work(); }) {}

PictureFeed::~PictureFeed() {
  close();
  thread_.join();
}

void PictureFeed::close() {
  {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
  }
  news_.notify_all();
  viewers_.notify_all();
}

void PictureFeed::take(const Scene& scene) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || scene.now_ns > wanted_until_ns_) return;
  joints_.at_m = scene.joints_m;
  for (std::size_t side = 0; side < joints_.there.size(); ++side)
    joints_.there[side] = scene.gestures[side].is_there;
}

bool PictureFeed::wait(std::uint64_t& seen, Packet& packet, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  wanted_until_ns_ = now_ns() + kWanted_ns;
  viewers_.notify_all();
  news_.wait_for(lock, patience, [&] { return is_closed_ || count_ > seen; });
  if (!is_closed_ && count_ > seen) packet = newest_;
  seen = count_;
  return !is_closed_;
}

bool PictureFeed::wait_for_viewer() {
  std::unique_lock lock(mutex_);
  viewers_.wait(lock, [&] { return is_closed_ || now_ns() < wanted_until_ns_; });
  return !is_closed_;
}

void PictureFeed::work() {
  run_at_low_priority();
  std::optional<Inputs> inputs;
  while (wait_for_viewer()) {
    if (!inputs) inputs.emplace();
    const auto begin_ns = now_ns();
    inputs->open(rig_);
    auto packet = picture(*inputs);
    std::unique_lock lock(mutex_);
    if (!packet.empty()) {
      newest_ = std::make_shared<const std::string>(std::move(packet));
      ++count_;
      news_.notify_all();
    }
    if (now_ns() >= wanted_until_ns_) inputs.reset();
    viewers_.wait_for(lock, std::chrono::nanoseconds(begin_ns + kPeriod_ns - now_ns()),
                      [&] { return is_closed_; });
  }
}

/// The next packet; empty if there is nothing new.
std::string PictureFeed::picture(Inputs& inputs) {
  const auto frame = Inputs::newest(inputs.camera);
  std::array<std::optional<ipc::Sample<msg::Projection>>, kLights.size()> lights;
  std::ranges::transform(inputs.lights, lights.begin(),
                         [](auto& stream) { return Inputs::newest(stream); });
  const auto found = Inputs::newest(inputs.landmarks);
  if (!frame && !lights[0] && !lights[1]) return {};
  Joints joints;
  {
    const std::lock_guard lock(mutex_);
    joints = joints_;
  }
  json text;
  std::vector<std::uint8_t> camera_jpeg;
  std::array<std::vector<std::uint8_t>, kLights.size()> light_jpegs;
  if (frame && is_picture((*frame)->width_px, (*frame)->height_px)) {
    text["camera"] = {{"width", (*frame)->width_px},
                      {"height", (*frame)->height_px},
                      {"id", (*frame)->header.frame_id},
                      {"age_ms", std::round(ns_to_ms(now_ns() - (*frame)->header.origin_ns))}};
    camera_jpeg = jpeg_of_camera(**frame);
  }
  auto& places = text["joints"] = json::object();
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    if (!joints.there[side]) continue;
    auto& hand = places[kSides[side]] = json::array();
    for (const auto& joint : joints.at_m[side])
      add_place(hand, joint.z > 0.01 ? camera_.distort(camera_.project(joint)) : glm::dvec2(NAN));
  }
  if (found) text["landmarks"] = landmarks_of(**found, camera_);
  for (std::size_t i = 0; i < kLights.size(); ++i) {
    if (!lights[i]) continue;
    const msg::Projection& light = **lights[i];
    text[kLights[i]] = place_of(light);
    if (is_picture(light.region_width_px, light.region_height_px))
      light_jpegs[i] = jpeg_of_light(light);
  }
  const auto header = json_text(text);
  std::string packet;
  append_part(packet, header.data(), header.size());
  append_part(packet, camera_jpeg.data(), camera_jpeg.size());
  for (const auto& jpeg : light_jpegs) append_part(packet, jpeg.data(), jpeg.size());
  return packet;
}

}  // namespace handcast::desk
