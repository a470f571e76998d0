// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/service_table.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>

#include "ipc/base/clock.hpp"
#include "tests/scratch.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;

/// Services whose programs are shell scripts of the test. They publish nothing.
class Table : public testing::Test {
 protected:
  void SetUp() override {
    launch_.program_folder = scratch_.path();
    launch_.ready_s = 20;
    loop_.watch(timer_.get(), [this] { drain(timer_.get()); });
  }
  Service& add(const std::string& name, std::vector<std::string> needs, const char* script) {
    const auto program = scratch_.path() / ("handcast-" + name);
    std::ofstream(program) << "#!/bin/bash\n" << script << "\n";
    chmod(program.c_str(), 0755);
    auto& service = table_.add({.name = name, .stream = "", .backend = "", .needs = needs});
    service.hold();
    return service;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& service : table_.all()) names.push_back(service->spec().name);
    return names;
  }
  void run_until(const std::function<bool()>& done) {
    for (const auto limit = Deadline::in(std::chrono::seconds(30)); !done() && !limit.passed();)
      loop_.turn();
    ASSERT_TRUE(done());
  }
  Service* next() const { return table_.next_to_begin(now_ns()); }

  test::Scratch scratch_;
  EventLoop loop_ = EventLoop::open().value();
  UniqueFd timer_ = open_timer(5'000'000).value();
  Launch launch_;
  ServiceTable table_{launch_, loop_, [](Service&, Notice) {}};
};

constexpr auto kWorks = "echo >&$HANDCAST_READY_FD; exec sleep 1000";
constexpr auto kSleepsForEver = "exec sleep 1000";
constexpr auto kCannotWork = "exit 100";

TEST_F(Table, AServiceMayBeginWhenItsNeedIsReady) {
  auto& camera = add("camera", {}, kWorks);
  auto& landmarks = add("landmarks", {"camera"}, kWorks);
  EXPECT_EQ(next(), &camera);
  camera.start();
  EXPECT_EQ(next(), nullptr) << "camera is not ready yet";
  EXPECT_FALSE(table_.needs_are_ready(landmarks));
  run_until([&] { return camera.state() == State::ready; });
  EXPECT_EQ(next(), &landmarks);
  EXPECT_TRUE(table_.needs_are_ready(landmarks));
}

TEST_F(Table, ANeedThatHasGivenUpIsNotWaitedFor) {
  auto& camera = add("camera", {}, kCannotWork);
  auto& landmarks = add("landmarks", {"camera"}, kWorks);
  camera.start();
  run_until([&] { return camera.state() == State::failed; });
  EXPECT_EQ(next(), &landmarks);
  EXPECT_FALSE(table_.needs_are_ready(landmarks));
}

TEST_F(Table, ANeedIsWaitedForAsLongAsItMayTakeToBeReady) {
  auto& camera = add("camera", {}, kSleepsForEver);
  auto& landmarks = add("landmarks", {"camera"}, kWorks);
  camera.start();
  const auto started_ns = camera.first_start_ns().value();
  EXPECT_EQ(table_.next_to_begin(started_ns + seconds_to_ns(19)), nullptr);
  EXPECT_EQ(table_.next_to_begin(started_ns + seconds_to_ns(21)), &landmarks);
}

TEST_F(Table, ANeedThatWasBegunWithoutItsOwnNeedGetsNoTimeOfItsOwn) {
  launch_.ready_s = 0.3;
  auto& camera = add("camera", {}, kSleepsForEver);
  auto& landmarks = add("landmarks", {"camera"}, kSleepsForEver);
  auto& projector = add("projector", {"camera", "landmarks"}, kWorks);
  camera.start();
  run_until([&] { return next() == &landmarks; });
  landmarks.start();
  EXPECT_EQ(next(), &projector);
}

TEST_F(Table, ANeedThatIsNotInTheRigIsNoNeed) {
  auto& observer = add("observer", {"projector"}, kWorks);
  EXPECT_EQ(next(), &observer);
  EXPECT_TRUE(table_.needs_are_ready(observer));
}

TEST_F(Table, ARigIsUpWhenEachServiceHasBeenReadyOrHasHadItsTime) {
  auto& camera = add("camera", {}, kWorks);
  auto& pose = add("pose", {}, kSleepsForEver);
  camera.start();
  pose.start();
  run_until([&] { return camera.state() == State::ready; });
  EXPECT_FALSE(table_.has_come_up(now_ns()));
  EXPECT_TRUE(table_.has_come_up(now_ns() + seconds_to_ns(21)));
}

TEST_F(Table, TheLastThatRunsIsTheNextToStop) {
  auto& camera = add("camera", {}, kWorks);
  auto& pose = add("pose", {}, kWorks);
  add("landmarks", {"camera"}, kWorks);
  EXPECT_EQ(table_.next_to_stop(), nullptr);
  camera.start();
  pose.start();
  EXPECT_EQ(table_.next_to_stop(), &pose);
}

TEST_F(Table, AGuestStopsAfterWhatItFeeds) {
  auto& pose = add("pose", {}, kWorks);
  std::ofstream(scratch_.path() / "handcast-guest") << "#!/bin/bash\n" << kWorks << "\n";
  chmod((scratch_.path() / "handcast-guest").c_str(), 0755);
  auto& guest = table_.add({.name = "pose_guest", .needs = {"pose"}, .instance_of = "guest"});
  pose.start();
  guest.start();
  EXPECT_EQ(table_.next_to_stop(), &pose);
  pose.stop();
  run_until([&] { return !pose.is_running(); });
  EXPECT_EQ(table_.next_to_stop(), &guest);
}

TEST_F(Table, AServiceIsAddedAtItsPlaceAndRemovedByItsName) {
  table_.add({.name = "camera"});
  table_.add({.name = "projector"});
  table_.add({.name = "pose"}, 1);
  table_.add({.name = "observer"}, 99);
  EXPECT_THAT(names(), ElementsAre("camera", "pose", "projector", "observer"));
  table_.remove("pose");
  EXPECT_THAT(names(), ElementsAre("camera", "projector", "observer"));
  EXPECT_EQ(table_.find("pose"), nullptr);
}

TEST_F(Table, EveryChangeCountsUp) {
  auto last = table_.revision();
  const auto counts_up = [&] {
    const auto before = std::exchange(last, table_.revision());
    return last > before;
  };
  auto& camera = add("camera", {}, kWorks);
  EXPECT_TRUE(counts_up());
  camera.start();
  EXPECT_TRUE(counts_up());
  run_until([&] { return camera.state() == State::ready; });
  EXPECT_TRUE(counts_up());
  table_.remove("camera");
  EXPECT_TRUE(counts_up()) << "the state of a removed service must not be saved again";
}

}  // namespace
}  // namespace handcast::supervisor
