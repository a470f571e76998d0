// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/outbox.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "services/desk/osc/description.hpp"
#include "services/desk/osc/figures.hpp"
#include "services/desk/osc/tuio.hpp"
#include "tests/services/desk/osc/packets.hpp"
#include "tests/services/desk/table_panel.hpp"

namespace handcast::desk::osc {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::kSecond_ns;
using testing::ElementsAre;

/// All messages of packets: address and arguments as text.
std::vector<std::string> print_all(const std::vector<std::string>& packets) {
  std::vector<std::string> lines;
  const std::function<void(Bytes)> print = [&](Bytes bytes) {
    if (is_bundle(bytes)) {
      const auto bundle = read_bundle(bytes);
      for (const auto element : bundle->elements) print(element);
      return;
    }
    const auto message = read_message(bytes);
    if (!message) return lines.push_back(message.error().what);  // more arguments than are read
    auto line = std::string(message->address);
    for (const auto& argument : message->arguments())
      line += argument.is_text() ? " " + std::string(argument.text)
                                 : fmt::format(" {:.3g}", argument.number);
    lines.push_back(line);
  };
  for (const auto& packet : packets) print(bytes_of(packet));
  return lines;
}

Scene scene_with_left_hand(std::int64_t now_ns) {
  Scene scene;
  scene.now_ns = now_ns;
  auto& hand = scene.gestures[0];
  hand.is_there = true;
  hand.pinch = 0.5f;
  hand.speed_m_s = 1.5f;
  for (auto& joint : scene.joints_m[0]) joint = {0, 0, 0.5};
  return scene;
}

TEST(OscValues, TheFirstTurnTellsAllAndLaterOnesTheChanges) {
  test::TablePanel panel;
  const Addresses addresses(panel.controls());
  ValueTeller teller(addresses, "10.0.0.7");
  const auto all = print_all(teller.packets(*panel.values(), 0));
  EXPECT_EQ(all.size(), panel.controls().size());
  EXPECT_THAT(all, testing::IsSupersetOf({"/projector/brightness 1", "/light/blackout 0",
                                          "/content/left builtin:atlas", "/content/gravity 0 1 0",
                                          "/cascade/predict/method hold"}));
  EXPECT_THAT(teller.packets(*panel.values(), 0), ElementsAre());
  ASSERT_TRUE(panel.set(std::vector<std::string>{"projector.brightness=0.25"}, "page"));
  EXPECT_THAT(print_all(teller.packets(*panel.values(), 0)),
              ElementsAre("/projector/brightness 0.25"));
  teller.refresh();
  EXPECT_EQ(teller.packets(*panel.values(), 0).size(), panel.controls().size());
}

TEST(OscValues, WhatAReceiverSetsComesBackToItLaterAndToOthersAtOnce) {
  test::TablePanel panel;
  const Addresses addresses(panel.controls());
  ValueTeller own(addresses, "10.0.0.7"), other(addresses, "10.0.0.8");
  (void)own.packets(*panel.values(), 0);
  (void)other.packets(*panel.values(), 0);
  std::int64_t now_ns = kSecond_ns;
  for (int i = 0; i < 60; ++i, now_ns += kSecond_ns / 60) {
    const auto value = fmt::format("light.master={}", 0.5 + 0.001 * i);
    ASSERT_TRUE(panel.set(std::vector<std::string>{value}, "osc 10.0.0.7"));
    EXPECT_THAT(own.packets(*panel.values(), now_ns), ElementsAre()) << "its fader would jump";
    EXPECT_EQ(other.packets(*panel.values(), now_ns).size(), 1u);
  }
  EXPECT_THAT(print_all(own.packets(*panel.values(), now_ns + kSecond_ns)),
              ElementsAre("/light/master 0.559"));
  ASSERT_TRUE(panel.set(std::vector<std::string>{"light.master=0.1"}, "page"));
  EXPECT_EQ(own.packets(*panel.values(), now_ns + kSecond_ns).size(), 1u) << "of somebody else";
}

TEST(OscFigures, AreThoseOfTheStatus) {
  const auto status = json::parse(R"({"rings": {"camera.frames": {"held_hz": 525.5},
      "content.left": {"held_hz": null}}, "services": {"pose": {"state": "ready"}, "odd": 3},
      "light": {"projector": {"missed_refreshes": 2}, "projector2": {"missed_refreshes": 3}}, "lost_images": {"missing": 3, "skipped": 4},
      "tracker_faults": {"late": 5}, "tracker_drift": {"across_mm": 1.5},
      "stage_us": {"draw": {"p50": 500.0, "p99": 1500.0}}})");
  EXPECT_THAT(print_all({write_figures(status)}),
              testing::UnorderedElementsAre("/rate/camera/frames 526", "/service/pose ready",
                                            "/time/draw 0.5 1.5", "/error/missed_refreshes 5",
                                            "/error/lost_images 7", "/error/tracker_faults 5",
                                            "/error/drift_mm 1.5"));
  for (const auto* odd : {"{}", "[]", "null", R"({"rings": 7, "light": null, "services": []})"})
    EXPECT_EQ(print_all({write_figures(json::parse(odd))}).size(), 3u) << odd;
}

TEST(OscOutbox, AHandIsToldAtItsRateAndOnceMoreWhenItIsGone) {
  Outbox outbox(10);
  auto scene = scene_with_left_hand(kSecond_ns);
  const auto told = print_all(outbox.packets(scene));
  EXPECT_THAT(told, testing::IsSupersetOf(
                        {"/hand/left/there 1", "/hand/left/pinch 0.5", "/hand/left/speed 1.5"}));
  scene.now_ns += kSecond_ns / 60;
  EXPECT_THAT(outbox.packets(scene), ElementsAre());
  scene.gestures[0].is_there = false;
  scene.now_ns += kSecond_ns;
  EXPECT_THAT(print_all(outbox.packets(scene)), ElementsAre("/hand/left/there 0"));
  scene.now_ns += kSecond_ns;
  EXPECT_THAT(outbox.packets(scene), ElementsAre());
}

TEST(OscOutbox, AHandFitsIntoOneFrameOfTheNetwork) {
  Outbox outbox(60);
  const auto packets = outbox.packets(scene_with_left_hand(kSecond_ns));
  ASSERT_EQ(packets.size(), 1u);
  EXPECT_GT(packets[0].size(), 26 * 5 * sizeof(float));
  EXPECT_LE(packets[0].size(), 1472u);
}

TEST(OscOutbox, EventsAreTold) {
  Outbox outbox(60);
  Scene scene;
  scene.events = {"left.appears", "idle"};
  EXPECT_THAT(print_all(outbox.packets(scene)),
              ElementsAre("/event/left/appears 1", "/event/idle 1"));
}

TEST(OscTuio, FingerTipsAreCursorsInTheImage) {
  const calib::CameraModel camera;
  Tuio tuio(camera);
  auto scene = scene_with_left_hand(kSecond_ns);
  const auto first = print_all({tuio.bundle(scene)});
  ASSERT_EQ(first.size(), 8u);
  EXPECT_EQ(first[0], "/tuio/2Dcur source handcast");
  EXPECT_EQ(first[1], "/tuio/2Dcur alive 1 2 3 4 5");
  EXPECT_EQ(first[2], "/tuio/2Dcur set 1 0.5 0.5 0 0 0") << "the middle of the image";
  EXPECT_EQ(first[7], "/tuio/2Dcur fseq 1");

  scene.now_ns += kSecond_ns / 2;
  // A quarter of the image to the right of its middle.
  scene.joints_m[0][5].x = static_cast<float>(0.5 * camera.width_px / 4 / camera.fx_px);
  EXPECT_EQ(print_all({tuio.bundle(scene)})[2], "/tuio/2Dcur set 1 0.75 0.5 0.5 0 1");
}

TEST(OscTuio, AFingerThatComesBackHasAnotherNumber) {
  Tuio tuio(calib::CameraModel{});
  auto scene = scene_with_left_hand(kSecond_ns);
  (void)tuio.bundle(scene);
  scene.gestures[0].is_there = false;
  EXPECT_EQ(print_all({tuio.bundle(scene)})[1], "/tuio/2Dcur alive");
  EXPECT_EQ(tuio.bundle(scene), "") << "nothing new";
  scene.now_ns += 2 * kSecond_ns;
  EXPECT_NE(tuio.bundle(scene), "") << "once a second";
  scene.gestures[0].is_there = true;
  EXPECT_EQ(print_all({tuio.bundle(scene)})[1], "/tuio/2Dcur alive 6 7 8 9 10");
  for (auto& joint : scene.joints_m[0]) joint.x = 5;
  EXPECT_EQ(print_all({tuio.bundle(scene)})[1], "/tuio/2Dcur alive") << "outside the image";
}

TEST(OscQuery, ASettingIsDescribed) {
  test::TablePanel panel;
  const auto describe = [&](std::string_view query) {
    const auto text = describe_address(query, {"rig", 9000}, panel.controls(), *panel.values(),
                                       std::vector<std::string>{"evening"});
    return text && !text->empty() ? json::parse(*text) : json(text ? "no attribute" : "nothing");
  };
  EXPECT_EQ(describe("/projector/brightness"), json::parse(R"({
    "FULL_PATH": "/projector/brightness", "TYPE": "f", "ACCESS": 3, "VALUE": [1],
    "RANGE": [{"MIN": 0.0, "MAX": 1.0}], "DESCRIPTION": "Share of the light."})"));
  EXPECT_EQ(describe("/cascade/predict/method")["RANGE"],
            json::parse(R"([{"VALS": ["hold", "velocity", "acceleration"]}])"));
  EXPECT_EQ(describe("/content/gravity")["TYPE"], "fff");
  EXPECT_EQ(describe("/content/gravity?VALUE"), json::parse(R"({"VALUE": [0, 1, 0]})"));
  EXPECT_EQ(describe("/light/blackout")["VALUE"], json::parse("[false]"));
  EXPECT_EQ(describe("/")["CONTENTS"]["light"]["CONTENTS"]["master"]["FULL_PATH"], "/light/master");
  EXPECT_EQ(describe("/light")["ACCESS"], 0);
  EXPECT_EQ(describe("/preset/evening")["ACCESS"], 2);
  EXPECT_EQ(describe("/?HOST_INFO")["OSC_PORT"], 9000);
  EXPECT_EQ(describe("/light?VALUE"), "no attribute");
  EXPECT_EQ(describe("/no/such"), "nothing");
  EXPECT_EQ(describe("/light/master/more"), "nothing");
}

}  // namespace
}  // namespace handcast::desk::osc
