// SPDX-License-Identifier: Apache-2.0
// A page without a rig, for browsers: prints the address for each role, and serves until its
// standard input ends.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/ring/writer.hpp"
#include "services/recording/about.hpp"
#include "services/recording/index_row.hpp"
#include "tests/services/desk/page/fake_rig.hpp"
#include "tests/services/desk/page/open_page.hpp"

using namespace handcast;

namespace {

template <class T>
ipc::Segment ring(const char* stream, bool keep_history, std::size_t bytes = sizeof(T)) {
  return *ipc::Segment::create(ipc::RingSpec::of<T>(stream, 8, keep_history, bytes));
}

template <class T>
ipc::Writer<T> writer(const ipc::Segment& segment) {
  return std::move(
      *ipc::Writer<T>::attach(*ipc::Segment::open(UniqueFd(::dup(segment.fd()))), Deadline::now()));
}

nlohmann::json service(const char* state, const char* backend) {
  return {{"state", state},
          {"backend", backend},
          {"restarts", 0},
          {"uptime_s", 512.0},
          {"reason", nullptr},
          {"instead_of", nullptr},
          {"log", nlohmann::json::array()}};
}

nlohmann::json stream(double hz) { return {{"wanted_hz", hz}, {"held_hz", hz - 0.2}}; }

nlohmann::json status() {
  nlohmann::json status{
      {"uptime_s", 512.3},
      {"services",
       {{"camera", service("ready", "twin")},
        {"pose", service("ready", "twin")},
        {"landmarks", service("failed", "onnx")},
        {"projector", service("ready", "window")},
        {"content", service("ready", "")},
        {"desk", service("ready", "")}}},
      {"rings",
       {{"camera.frames", stream(380)},
        {"pose.hands", stream(90)},
        {"landmarks.hands", stream(120)},
        {"projection.frames", stream(360)}}},
      {"stage_us", nlohmann::json::object()},
      {"light", {{"projector", {{"missed_refreshes", 0}, {"doubled_frames", 2}}}}},
      {"lost_images", {{"missing", 0}, {"skipped", 3}}},
      {"tracker_faults", {{"absent", 1}}},
      {"rungs", {{"hold", 40}, {"register", 3560}}},
      {"tracker_drift", {{"moved", false}, {"across_mm", 0.4}, {"turn_deg", 0.12}, {"places", 9}}}};
  status["services"]["landmarks"]["reason"] = "the model /models/hand.onnx is missing";
  status["services"]["landmarks"]["log"] = {
      "12.3 landmarks error the model /models/hand.onnx is missing"};
  const std::pair<const char*, double> stages[] = {
      {"capture", 410},  {"sample", 900}, {"detect", 2300}, {"predict", 12}, {"mask", 310},
      {"register", 190}, {"skin", 45},    {"correct", 80},  {"draw", 620},   {"warp", 130},
      {"fill", 95},      {"frame", 1530}, {"present", 210}, {"light", 1400}};
  for (const auto& [name, us] : stages)
    status["stage_us"][name] = {{"p50", us}, {"p99", us * 1.7}, {"count", 3600}};
  return status;
}

/// Something bright that moves before a dim ground.
void draw(msg::CameraFrame& frame, double t) {
  for (int y = 0; y < 540; ++y)
    for (int x = 0; x < 720; ++x) {
      const double dx = x - 360 - 120 * std::sin(t), dy = y - 270 - 40 * std::cos(1.3 * t);
      frame.pixels()[y * 720 + x] =
          static_cast<std::uint8_t>(18 + 150 * std::exp(-(dx * dx + dy * dy) / 9000));
    }
}

/// As the cues of TableCues are named.
constexpr const char* kEvening = R"(
[[cue]]
name = "Doors"
on = "at 19:30"
set.light.master = 0

[[cue]]
name = "Empty hands"
on = ["key d", "idle 30"]
fade_s = 3
set.light.master = 0.2

[[cue]]
name = "First light"
on = "left.appears"
fade_s = 8
curve = "s-curve"
both = "light"
set.light.master = 1
set.projector.brightness = { to = 0.8, fade_s = 12, curve = "linear" }

[[cue]]
name = "Water"
on = ["right.pinch", "key w"]
both = "water"
transition = "isf:dissolve.fs"
transition_s = 2

[[cue]]
name = "Skeleton"
on = "after 20"
both = "xray"

[[cue]]
name = "Fire"
both = "lava"

[[cue]]
name = "Out"
on = "at 21:00"
fade_s = 10
set.light.master = 0
)";

/// The files of a recording, as far as the page reads them.
void write_recording(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / recording::kAboutFile) << recording::about_text("table", {"pose.hands"});
  std::ofstream(folder / "pose.hands.data") << std::string(3'400'000, ' ');
  std::ofstream index(folder / "pose.hands.index", std::ios::binary);
  for (const std::int64_t seconds : {100, 142}) {
    recording::IndexRow row;
    row.published_ns = seconds * 1'000'000'000;
    index.write(reinterpret_cast<const char*>(&row), sizeof row);
  }
}

desk::Scene scene_at(double t) {
  desk::Scene scene;
  scene.now_ns = now_ns();
  auto& hand = scene.gestures[1];
  hand = {.is_there = true,
          .pinch = static_cast<float>(0.5 + 0.5 * std::sin(t)),
          .spread = 0.7F,
          .fist = 0.1F,
          .palm_up = 0.4F,
          .speed_m_s = 0.3F};
  for (int joint = 0; joint < msg::kJoints; ++joint) {
    const int finger = joint < 2 ? 2 : (joint - 2 + (joint < 6 ? 0 : 1)) / 5,
              along = joint < 2 ? joint : (joint - 2 + (joint < 6 ? 0 : 1)) % 5 + 1;
    scene.joints_m[1][static_cast<std::size_t>(joint)] = {0.01 * std::sin(t) + 0.02 * (finger - 2),
                                                          0.06 - 0.02 * along, 0.5};
  }
  return scene;
}

}  // namespace

int main() {
  test::Scratch scratch;
  ::setenv("XDG_RUNTIME_DIR", scratch.path().c_str(), 1);
  ::setenv("HANDCAST_SCOPE", "serve-page", 1);
  config::Rig rig;
  rig.name = "table" + std::to_string(::getpid());
  rig.desk.page.listen = "127.0.0.1:0";
  const auto frames =
      ring<msg::CameraFrame>("camera.frames", false, msg::CameraFrame::bytes(720, 540));
  const auto marks = ring<msg::StageMarks>("marks.projector", true);
  test::FakeRig fake(rig.name, status());
  fake.give("camera.frames", frames.fd());
  fake.give("marks.projector", marks.fd());
  test::TablePanel panel;
  test::TableCues cues;
  test::TableMidi midi;
  rig.desk.cues = scratch.path() / "evening.toml";
  std::ofstream(rig.desk.cues) << kEvening;
  write_recording(scratch.path() / "recordings" / "rehearsal");
  rig.desk.page.recordings = scratch.path() / "recordings";
  auto page = desk::open_page(rig, {panel, &cues, &midi, scratch.path() / "table.toml"});
  if (!page) return std::fprintf(stderr, "%s\n", page.error().what.c_str()), 1;
  const auto address = *control::read_desk_file(*control::desk_file(rig.name));
  for (std::size_t role = 0; role < control::kRoles; ++role)
    std::printf("%s\n", address.url_for(static_cast<control::Role>(role)).c_str());
  std::fflush(stdout);
  auto camera = writer<msg::CameraFrame>(frames);
  auto marker = writer<msg::StageMarks>(marks);
  pollfd input{STDIN_FILENO, POLLIN, 0};
  for (std::uint64_t turn = 1; ::poll(&input, 1, 16) == 0; ++turn) {
    const double t = static_cast<double>(turn) / 60;
    if (auto frame = camera.loan()) {
      frame->header.frame_id = turn;
      frame->header.origin_ns = now_ns();
      frame->width_px = 720;
      frame->height_px = 540;
      draw(*frame, t);
      camera.publish(std::move(frame));
    }
    msg::StageMarks mark;
    mark.header.frame_id = turn;
    mark.made_from.image_ns =
        now_ns() - 8'000'000 - static_cast<std::int64_t>(turn * 7919 % 4'000'000);
    mark.count = 1;
    mark.marks[0] = {msg::Stage::light, 0, now_ns(), now_ns()};
    marker.publish(mark);
    (*page)->turn(scene_at(t));
    if (turn % 30 == 0) {
      midi.bind();
      auto later = status();
      later["rungs"] = {{"hold", turn / 10}, {"register", turn}};
      fake.say(later);
    }
  }
  return 0;
}
