// SPDX-License-Identifier: Apache-2.0
#include "services/watch/black_box.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "ipc/base/clock.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/ring/writer.hpp"
#include "services/recording/recording_reader.hpp"
#include "tests/scratch.hpp"

namespace handcast::watch {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

template <class T>
struct Ring {
  ipc::Segment segment;
  ipc::Writer<T> writer;

  explicit Ring(const char* stream, std::size_t bytes = sizeof(T), bool history = true)
      : segment(*ipc::Segment::create(ipc::RingSpec::of<T>(stream, 64, history, bytes))),
        writer(*ipc::Writer<T>::attach(again())) {}
  ipc::Segment again() const { return *ipc::Segment::open(UniqueFd(::dup(segment.fd()))); }
};

class BlackBoxTest : public testing::Test {
 protected:
  /// Writes a box and waits for it.
  std::filesystem::path write(const std::string& name, BoxContents contents, int most = 3,
                              const config::Rig& rig = {}) const {
    BlackBoxes boxes(scratch_.path() / "faults", most, rig, "width_px = 720\n");
    boxes.write(name, std::move(contents));
    return boxes.place_of(name);
  }
  static BoxContents contents(std::string stream, Track& track) {
    BoxContents contents{.fault = "pose dies", .changes = "12:00:00 desk: light.master=0.5\n"};
    contents.streams.emplace_back(std::move(stream), track.give());
    return contents;
  }
  static std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
  ::handcast::test::Scratch scratch_;
};

TEST_F(BlackBoxTest, IsARecordingOfTheLastSeconds) {
  Ring<msg::HandPoses> ring("pose.hands");
  int heard = 0;
  auto track = *track_poses(ring.again(), [&](const auto&) { ++heard; });
  for (std::uint64_t i = 0; i < 10; ++i) ring.writer.publish({.header = {.frame_id = i}});
  const auto middle_ns = now_ns();
  for (std::uint64_t i = 10; i < 15; ++i) ring.writer.publish({.header = {.frame_id = i}});
  track->take(middle_ns);
  EXPECT_EQ(heard, 15);
  const auto folder = write("2026-12-24_12-00-00", contents("pose.hands", *track));
  EXPECT_EQ(track->give()->count(), 0u);
  auto reader = recording::StreamReader::open<msg::HandPoses>(folder, "pose.hands");
  ASSERT_TRUE(reader) << reader.error().what;
  std::vector<std::uint64_t> ids;
  for (const auto& row : reader->rows()) ids.push_back(row.frame_id);
  EXPECT_THAT(ids, ElementsAre(10, 11, 12, 13, 14));
  EXPECT_EQ(text_of(folder / "fault.txt"), "pose dies\n");
  EXPECT_THAT(text_of(folder / "changes.txt"), HasSubstr("light.master=0.5"));
  EXPECT_THAT(text_of(folder / "summary.json"), HasSubstr("pose dies"));
}

TEST_F(BlackBoxTest, WhoPlaysItAlarmsNobody) {
  Ring<msg::Landmarks> ring("landmarks.hands");
  auto track = *track_landmarks(ring.again());
  config::Rig rig;
  rig.watch.enabled = true;
  rig.watch.alert.command = {"curl", "https://example.org/secret"};
  const auto text = text_of(write("box", contents("landmarks.hands", *track), 3, rig) / "rig.toml");
  EXPECT_THAT(text, testing::AllOf(Not(HasSubstr("secret")), HasSubstr("calibration.toml")));
}

TEST_F(BlackBoxTest, MissingMessagesAreCounted) {
  Ring<msg::HandPoses> ring("pose.hands");
  auto track = *track_poses(ring.again(), {});
  ring.writer.publish({});
  track->take(0);
  for (int i = 0; i < 500; ++i) ring.writer.publish({});
  track->take(0);
  const auto folder = write("box", contents("pose.hands", *track));
  auto reader = recording::StreamReader::open<msg::HandPoses>(folder, "pose.hands");
  ASSERT_TRUE(reader);
  std::uint64_t all = reader->rows().size();
  for (const auto& row : reader->rows()) all += row.lost;
  EXPECT_EQ(all, 501u);
}

TEST_F(BlackBoxTest, ImagesAreFiveASecond) {
  Ring<msg::CameraFrame> ring("camera.frames", msg::CameraFrame::bytes(8, 8), false);
  auto track = *track_images(ring.again());
  const auto publish = [&] {
    auto slot = ring.writer.loan();
    slot->width_px = slot->height_px = 8;
    ring.writer.publish(std::move(slot));
    track->take(0);
  };
  const auto begin_ns = now_ns();
  while (now_ns() < begin_ns + 500'000'000) publish();
  const auto most = static_cast<std::size_t>((now_ns() - begin_ns) / 200'000'000 + 1);
  const auto kept = track->give()->count();
  EXPECT_GE(kept, 1u);
  EXPECT_LE(kept, most);
}

TEST_F(BlackBoxTest, OnlyTheNewestAreKeptAndNothingElseIsRemoved) {
  Ring<msg::HandPoses> ring("pose.hands");
  auto track = *track_poses(ring.again(), {});
  std::filesystem::create_directories(scratch_.path() / "faults" / "0_mine");
  for (const auto* name : {"2026-12-24_1", "2026-12-24_2", "2026-12-24_3"})
    write(name, contents("pose.hands", *track), 2);
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(scratch_.path() / "faults"))
    names.push_back(entry.path().filename());
  EXPECT_THAT(names, testing::UnorderedElementsAre("0_mine", "2026-12-24_2", "2026-12-24_3"));
}

TEST_F(BlackBoxTest, AFullDiskIsAWarningAndNoCrash) {
  Ring<msg::HandPoses> ring("pose.hands");
  auto track = *track_poses(ring.again(), {});
  std::ofstream(scratch_.path() / "faults") << "a file where the folder should be";
  write("box", contents("pose.hands", *track));
  EXPECT_TRUE(std::filesystem::is_regular_file(scratch_.path() / "faults"));
}

}  // namespace
}  // namespace handcast::watch
