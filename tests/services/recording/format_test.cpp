// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "services/recording/recording_reader.hpp"
#include "tests/scratch.hpp"
#include "tests/services/recording/recordings.hpp"

namespace handcast::recording {
namespace {

using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// The size of a structure that numpy makes of a list of fields.
std::size_t size_of(const json& fields) {
  std::size_t size = 0;
  for (const auto& field : fields) {
    std::size_t one =
        field[1].is_array() ? size_of(field[1]) : std::stoul(field[1].get<std::string>().substr(2));
    if (field.size() > 2) one *= field[2][0].get<std::size_t>();
    size += one;
  }
  return size;
}

class Format : public testing::Test {
 protected:
  handcast::test::Scratch scratch_;
  fs::path folder_ = scratch_.path() / "recording";
};

TEST_F(Format, TheFieldsInTheFileAreThoseOfTheMessages) {
  for (const auto* stream :
       {"camera.frames", "camera2.frames", "pose.hands", "landmarks.hands", "landmarks2.hands",
        "projection.frames", "projection2.frames", "marks.camera"}) {
    const auto& type = *type_of_stream(stream);
    EXPECT_EQ(size_of(json::parse(type.fields)), type.bytes) << stream;
  }
  test::write(folder_, 1);
  const auto about = json::parse(test::contents(folder_ / "recording.json"));
  EXPECT_EQ(size_of(about["index"]), sizeof(IndexRow));
  EXPECT_EQ(about["rig"], "twin");
}

TEST_F(Format, MessagesComeBackBitForBit) {
  test::write(folder_, 5);
  auto frames = StreamReader::open<msg::CameraFrame>(folder_, "camera.frames");
  auto poses = StreamReader::open<msg::HandPoses>(folder_, "pose.hands");
  auto light = StreamReader::open<msg::Projection>(folder_, "projection.frames");
  ASSERT_TRUE(frames && poses && light);
  ASSERT_EQ(frames->rows().size(), 5u);
  for (const std::uint32_t k : {4, 0, 2}) {  // in any order
    msg::CameraFrame frame;
    std::vector<std::uint8_t> pixels(test::kWidth * test::kHeight);
    ASSERT_TRUE(frames->read(k, frame, pixels));
    const auto expected = test::frame(k);
    EXPECT_EQ(std::memcmp(&frame, &*expected, sizeof frame), 0);
    EXPECT_EQ(std::memcmp(pixels.data(), expected->pixels(), pixels.size()), 0);

    msg::HandPoses sample;
    ASSERT_TRUE(poses->read(k, sample));
    auto expected_sample = test::poses(k);
    clear_unused(expected_sample);
    EXPECT_EQ(std::memcmp(&sample, &expected_sample, sizeof sample), 0);

    auto lit = std::make_unique<msg::Projection>();
    std::vector<std::uint8_t> region(48);
    ASSERT_TRUE(light->read(k, *lit, region));
    auto expected_light = test::projection(k);
    clear_unused(*expected_light);
    EXPECT_EQ(std::memcmp(lit.get(), &*expected_light, sizeof *lit), 0);
    EXPECT_EQ(std::memcmp(region.data(), expected_light->pixels(), 48), 0);
  }
}

TEST_F(Format, WhatIsBehindTheLastHandIsNotStored) {
  auto poses = test::poses(1);
  poses.hands[1].confidence = 0.5f;  // of an earlier message in the same slot
  {
    auto writer = test::writer(folder_);
    ASSERT_TRUE(writer.append(1, poses, 0, 0));
  }
  auto reader = StreamReader::open<msg::HandPoses>(folder_, "pose.hands");
  msg::HandPoses again;
  ASSERT_TRUE(reader->read(0, again));
  EXPECT_EQ(again.hands[1].confidence, 0);
  EXPECT_LT(reader->rows()[0].head_bytes, sizeof(msg::HandPoses) / 2 + 100);
}

TEST_F(Format, LostMessagesAreCountedInTheRowsAndInTheSummary) {
  auto writer = test::writer(folder_);
  ASSERT_TRUE(writer.append(0, *test::frame(0), 10, 0));
  ASSERT_TRUE(writer.append(0, *test::frame(1), 14, 3));
  ASSERT_TRUE(writer.finish("the disk is full", {2, 0, 0}));
  const auto reader = StreamReader::open(folder_, "camera.frames");
  EXPECT_EQ(reader->rows()[1].lost, 3u);
  EXPECT_EQ(reader->rows()[1].sequence, 14u);
  const auto summary = json::parse(test::contents(folder_ / "summary.json"));
  EXPECT_EQ(summary["ended"], "the disk is full");
  EXPECT_EQ(summary["streams"]["camera.frames"]["lost"], 5);
  EXPECT_EQ(summary["streams"]["camera.frames"]["messages"], 2);
}

TEST_F(Format, AFolderThatHoldsSomethingIsRefused) {
  fs::create_directories(folder_);
  test::replace(folder_ / "mine.txt", "mine");
  const auto made = RecordingWriter::create(folder_, {}, test::kStreams);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, Errc::bad_config);
  EXPECT_THAT(made.error().what, HasSubstr("not empty"));
  EXPECT_FALSE(fs::exists(folder_ / "recording.json"));
  EXPECT_FALSE(RecordingWriter::create(folder_ / "mine.txt", {}, test::kStreams)) << "a file";
}

TEST_F(Format, AnotherMessageThanThatOfTheStreamIsRefused) {
  auto writer = test::writer(folder_);
  EXPECT_FALSE(writer.append(0, test::poses(0), 0, 0));
  EXPECT_FALSE(RecordingWriter::create(scratch_.path() / "other", {}, {"sound.waves"}));
}

TEST_F(Format, AnotherVersionOfAMessageIsRefusedWithASentence) {
  test::write(folder_, 1);
  auto about = test::contents(folder_ / "recording.json");
  const auto at = about.find("CameraFrame/");
  about.replace(at, std::strlen("CameraFrame/3"), "CameraFrame/0");
  test::replace(folder_ / "recording.json", about);
  const auto reader = StreamReader::open<msg::CameraFrame>(folder_, "camera.frames");
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().code, Errc::bad_config);
  EXPECT_THAT(reader.error().what, HasSubstr("'CameraFrame/0'"));
}

/// Runs scripts/read_recording.py by any Python that has numpy.
TEST_F(Format, PythonReadsItWithNumpyAlone) {
  test::write(folder_, 4);
  const auto program = scratch_.path() / "read.py";
  test::replace(program, R"(
import sys
sys.path.insert(0, "scripts")
from read_recording import Stream
frames, poses, light = (Stream(sys.argv[1], name) for name in ("camera.frames", "pose.hands", "projection.frames"))
print(len(frames.index), frames.index["origin_ns"].tolist(), frames.image(3).shape, frames.image(3).ravel().tolist())
print(poses.message(2)["hands"]["joints"]["position_m"][0, 3].tolist(), frames.message(1)["exposure_ns"])
print(light.image(1).shape, light.image(1).ravel().tolist(), light.message(1)["hands"][0]["landings"]["y_px"][1])
)");
  std::string python;
  for (const std::string candidate : {HANDCAST_PYTHON, "/usr/bin/python3"})
    if (std::system((candidate + " -c 'import numpy' 2>/dev/null").c_str()) == 0)
      python = candidate;
  if (python.empty()) GTEST_SKIP() << "no Python with numpy: scripts/setup --tests installs it";
  const auto output = scratch_.path() / "output";
  ASSERT_EQ(std::system(
                (python + " " + program.string() + " " + folder_.string() + " > " + output.string())
                    .c_str()),
            0);
  const auto frame = test::frame(3);
  const auto light = test::projection(1);
  const auto list = [](const auto* bytes, std::size_t count) {
    return json(std::vector<int>(bytes, bytes + count)).dump();
  };
  std::string expected =
      "4 [1000000, 2000000, 3000000, 4000000] (5, 7) " + list(frame->pixels(), 35) +
      "\n[0.10000000149011612, 0.20000000298023224, 0.5] 1850000\n(3, 4, 4) " +
      list(reinterpret_cast<const std::uint8_t*>(light->pixels()), 48) + " 2.5\n";
  auto text = test::contents(output);
  std::erase(text, ' ');
  std::erase(expected, ' ');
  EXPECT_EQ(text, expected);
}

}  // namespace
}  // namespace handcast::recording
