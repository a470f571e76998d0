// SPDX-License-Identifier: Apache-2.0
// What an open page is told, and what its changes do.
#include <gmock/gmock.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/projection.hpp"
#include "ipc/ring/writer.hpp"
#include "tests/services/desk/page/fake_rig.hpp"
#include "tests/services/desk/page/open_page.hpp"

namespace handcast::test {
namespace {

using control::Role;
using nlohmann::json;
using testing::HasSubstr;

/// The data of the newest event of a name; null if there is none.
json newest(const std::string& stream, const std::string& name, std::size_t from = 0) {
  const auto at = stream.rfind("event: " + name + "\n");
  if (at == std::string::npos || at < from) return {};
  const auto begin = stream.find("data: ", at) + 6;
  return json::parse(stream.substr(begin, stream.find('\n', begin) - begin), nullptr, false);
}

TEST_F(PageTest, TheStartTellsWhatCanBeTurned) {
  const auto start = json::parse(ask(port_, "GET", "/api/start", as(Role::operator_)).body);
  EXPECT_EQ(start["rig"], rig_.name);
  EXPECT_EQ(start["role"], "operator");
  ASSERT_EQ(start["controls"].size(), panel_.controls().size());
  const auto& cells = start["controls"][1];
  EXPECT_EQ(cells["path"], "projector.fill.cells");
  EXPECT_EQ(cells["kind"], "whole");
  EXPECT_EQ(cells["min"], 1);
  EXPECT_EQ(cells["unit"], "px");
  EXPECT_EQ(start["controls"][2]["min"], json());
}

TEST_F(PageTest, APageGetsAllValuesAndThenThoseThatChange) {
  const auto events = stream("/api/events", Role::viewer, "event: values");
  const auto first = events->receive("\"revision\":1");
  EXPECT_EQ(newest(first, "values")["values"].size(), panel_.controls().size());
  EXPECT_EQ(
      post("/api/set", R"({"set":["light.master=0.25","light.freeze=true"]})", Role::operator_)
          .status,
      200);
  const auto& text = events->receive("\"revision\":2", first.size());
  const auto told = newest(text, "values", first.size());
  EXPECT_EQ(told["values"], (json{{"light.master", "0.25"}, {"light.freeze", "true"}}));
  EXPECT_EQ(told["source"], "page operator 127.0.0.1");
  EXPECT_EQ(told["undo"], true);
}

TEST_F(PageTest, ASettingWithoutAValueGoesBackToTheRigFile) {
  post("/api/set", R"({"set":["light.master=0.25"]})", Role::operator_);
  EXPECT_EQ(post("/api/set", R"({"set":["light.master"]})", Role::operator_).status, 200);
  EXPECT_EQ(panel_.value("light.master"), "1");
}

TEST_F(PageTest, ChangesAreUndoneAndPresetsLoaded) {
  post("/api/set", R"({"set":["light.blackout=true"]})", Role::operator_);
  EXPECT_EQ(post("/api/preset/store", R"({"name":"dark"})", Role::owner).status, 200);
  EXPECT_EQ(post("/api/undo", "{}", Role::operator_).status, 200);
  EXPECT_EQ(panel_.value("light.blackout"), "false");
  EXPECT_EQ(post("/api/undo", "{}", Role::operator_).status, 422);
  EXPECT_EQ(post("/api/redo", "{}", Role::operator_).status, 200);
  EXPECT_EQ(panel_.value("light.blackout"), "true");
  EXPECT_EQ(post("/api/preset/load", R"({"name":"dark"})", Role::operator_).status, 200);
  EXPECT_EQ(post("/api/preset/load", R"({"name":"none"})", Role::operator_).status, 422);
}

TEST_F(PageTest, ContentIsShownOnAHand) {
  EXPECT_EQ(post("/api/show", R"({"hand":"left","content":"wave | isf:glow.fs"})", Role::operator_)
                .status,
            200);
  ASSERT_EQ(panel_.shown.size(), 1u);
  EXPECT_EQ(panel_.shown[0], std::pair(std::string("left"), std::string("wave | isf:glow.fs")));
}

TEST_F(PageTest, CuesAreToldAndWorked) {
  const auto events = stream("/api/events", Role::operator_, "event: cues");
  EXPECT_EQ(post("/api/cue", R"({"do":"go"})", Role::operator_).status, 200);
  EXPECT_EQ(post("/api/cue", R"({"do":"jump","cue":"4"})", Role::operator_).status, 200);
  EXPECT_THAT(events->receive("\"current\":3"), HasSubstr("\"current\":3"));
  EXPECT_EQ(post("/api/cue", R"({"do":"back"})", Role::operator_).status, 200);
  EXPECT_EQ(post("/api/cue", R"({"do":"hold"})", Role::operator_).status, 200);
  EXPECT_THAT(events->receive("\"held\":true"), HasSubstr("\"held\":true"));
  EXPECT_EQ(cues_.place()->current, 2);
}

TEST_F(PageTest, HandsAreToldAsTheyMove) {
  const auto events = stream("/api/events", Role::viewer, "event: hands");
  desk::Scene scene;
  scene.gestures[1] = {.is_there = true, .pinch = 0.5F};
  for (int i = 0; i < 3; ++i) page_->turn(scene);
  EXPECT_THAT(events->receive("\"pinch\":0.5"), HasSubstr("\"pinch\":0.5"));
}

TEST_F(PageTest, TheRigIsToldAndItsServicesAreChangedByTheOwner) {
  FakeRig rig(rig_.name, {{"uptime_s", 12}, {"services", {{"pose", {{"state", "ready"}}}}}});
  const auto events = stream("/api/events", Role::viewer, "\"uptime_s\":12");
  EXPECT_EQ(newest(events->receive("\"uptime_s\":12"), "status")["services"]["pose"]["state"],
            "ready");
  EXPECT_EQ(post("/api/service/restart", R"({"service":"pose"})", Role::owner).status, 200);
  EXPECT_EQ(
      post("/api/service/swap", R"({"service":"pose","backend":"replay"})", Role::owner).status,
      200);
  ASSERT_EQ(rig.asked().size(), 2u);
  EXPECT_THAT(rig.asked()[0], HasSubstr("\"restart\""));
  EXPECT_THAT(rig.asked()[1], HasSubstr("\"replay\""));
  const auto own = post("/api/service/restart", R"({"service":"desk"})", Role::owner);
  EXPECT_EQ(own.status, 422);
  EXPECT_THAT(own.body, HasSubstr("handcast restart desk"));
  EXPECT_EQ(rig.asked().size(), 2u);
}

TEST_F(PageTest, ARigThatIsAwayIsASentence) {
  const auto events = stream("/api/events", Role::viewer, "event: status");
  EXPECT_THAT(newest(events->receive("event: status"), "status").dump(), HasSubstr("fault"));
  EXPECT_EQ(post("/api/service/restart", R"({"service":"pose"})", Role::owner).status, 503);
}

/// A ring of the rig that gets a message every 5 ms. `fill`: all of it but the header.
template <class T>
class Publisher {
 public:
  Publisher(FakeRig& rig, const char* ring, std::size_t bytes, std::function<void(T&)> fill)
      : segment_(*ipc::Segment::create(ipc::RingSpec::of<T>(std::string(ring), 4, false, bytes))),
        writer_(*ipc::Writer<T>::attach(*ipc::Segment::open(UniqueFd(::dup(segment_.fd()))),
                                        Deadline::now())) {
    rig.give(ring, segment_.fd());
    thread_ = std::jthread([this, fill = std::move(fill)](const std::stop_token& stop) {
      for (std::uint64_t id = 1; !stop.stop_requested(); ++id) {
        auto message = writer_.loan();
        message->header.frame_id = id;
        message->header.origin_ns = now_ns();
        fill(*message);
        writer_.publish(std::move(message));
        sleep_until_ns(now_ns() + 5'000'000);
      }
    });
  }

 private:
  ipc::Segment segment_;
  ipc::Writer<T> writer_;
  std::jthread thread_;
};

TEST_F(PageTest, ThePictureIsSentWithWhatIsInIt) {
  FakeRig rig(rig_.name);
  const Publisher<msg::CameraFrame> camera(
      rig, "camera.frames", msg::CameraFrame::bytes(720, 540), [](msg::CameraFrame& frame) {
        frame.width_px = 720;
        frame.height_px = 540;
        std::fill_n(frame.pixels(), 720 * 540, static_cast<std::uint8_t>(frame.header.frame_id));
      });
  const auto picture = stream("/api/picture", Role::viewer, "\xff\xd9");
  const auto& text = picture->receive("\xff\xd9");
  EXPECT_THAT(text, HasSubstr("\"width\":720"));
  EXPECT_THAT(text, HasSubstr("\xff\xd8\xff"));
}

TEST_F(PageTest, TheLightOfASecondProjectorIsSent) {
  FakeRig rig(rig_.name);
  const Publisher<msg::Projection> light(rig, "projection2.frames", msg::Projection::bytes(64, 48),
                                         [](msg::Projection& frame) {
                                           frame.width_px = 1024;
                                           frame.height_px = 768;
                                           frame.region_x_px = 300;
                                           frame.region_width_px = 64;
                                           frame.region_height_px = 48;
                                           std::fill_n(frame.pixels(), 64 * 48, 0xff00ff00u);
                                         });
  const auto picture = stream("/api/picture", Role::viewer, "\xff\xd9");
  const auto& text = picture->receive("\xff\xd9");
  EXPECT_THAT(text, HasSubstr("\"light2\":"));
  EXPECT_THAT(text, HasSubstr("\"x\":300"));
  EXPECT_THAT(text, testing::Not(HasSubstr("\"light\":")));
}

}  // namespace
}  // namespace handcast::test
