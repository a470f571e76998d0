// SPDX-License-Identifier: Apache-2.0
#include "services/recording/arrays/recorded_hands.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/gtc/quaternion.hpp>

#include "services/lab/twin/articulation.hpp"
#include "tests/services/lab/twin/world.hpp"

namespace handcast::recording {
namespace {

using renderer::JointFrames, renderer::Side;
using twin::Articulation, twin::Bend, twin::outside_data, twin::place;

using std::filesystem::path;
using testing::HasSubstr;

class Files : public testing::Test {
 protected:
  Files() {
    folder_ =
        path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~Files() override { std::filesystem::remove_all(folder_); }

  path file(const std::string& name) const { return folder_ / name; }
  static std::string bytes_of(const path& file) {
    std::ifstream in(file, std::ios::binary);
    return std::string((std::istreambuf_iterator<char>(in)), {});
  }
  static void write(const path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
  }
  /// The error message of reading `file`, which must name the file.
  static std::string complaint(const path& file) {
    const auto array = read_npy(file);
    if (array) return "none";
    EXPECT_THAT(array.error().what, HasSubstr(file.filename().string()));
    return array.error().what;
  }

  path folder_;
};

using NpyFiles = Files;
using RecordingFiles = Files;

TEST_F(NpyFiles, AnArrayComesBackAsItWasWritten) {
  ASSERT_TRUE(write_npy_f32(file("a.npy"), {2, 3}, {1, 2, 3, 4, 5, 6.5f}));
  ASSERT_TRUE(write_npy_i64(file("t.npy"), {-5, 1'700'000'000'000'000}));
  const auto a = read_npy(file("a.npy")), t = read_npy(file("t.npy"));
  ASSERT_TRUE(a && t);
  EXPECT_THAT(a->shape, testing::ElementsAre(2, 3));
  EXPECT_THAT(a->values, testing::ElementsAre(1, 2, 3, 4, 5, 6.5));
  EXPECT_THAT(t->shape, testing::ElementsAre(2));
  EXPECT_THAT(t->values, testing::ElementsAre(-5, 1.7e15));
}

TEST_F(NpyFiles, TheHeaderOfAVersion2FileIsRead) {
  ASSERT_TRUE(write_npy_i64(file("t.npy"), {7, 8}));
  std::string bytes = bytes_of(file("t.npy"));
  bytes[6] = 2;
  bytes.insert(10, 2, '\0');
  write(file("t.npy"), bytes);
  const auto t = read_npy(file("t.npy"));
  ASSERT_TRUE(t) << t.error().what;
  EXPECT_THAT(t->values, testing::ElementsAre(7, 8));
}

TEST_F(NpyFiles, EveryFaultIsNamedTogetherWithItsFile) {
  EXPECT_THAT(complaint(file("absent.npy")), HasSubstr("No such file"));
  ASSERT_TRUE(write_npy_f32(file("good.npy"), {2, 2}, {1, 2, 3, 4}));
  const std::string good = bytes_of(file("good.npy"));
  const auto broken = [&](const std::string& what, const std::string& with) {
    std::string bytes = good;
    bytes.replace(bytes.find(what), with.size(), with);
    write(file("broken.npy"), bytes);
    return complaint(file("broken.npy"));
  };
  EXPECT_THAT(broken("NUMPY", "NUMPX"), HasSubstr("not a NumPy array"));
  EXPECT_THAT(broken(std::string("NUMPY\x01"), "NUMPY\x09"), HasSubstr("version 9"));
  EXPECT_THAT(broken("<f4", ">f4"),
              testing::AllOf(HasSubstr(">f4"), HasSubstr("numpy.load('broken.npy').astype('<f8'")));
  EXPECT_THAT(broken("<f4", "|O8"), HasSubstr("|O8"));
  EXPECT_THAT(broken("False", "True "),
              testing::AllOf(HasSubstr("C order"), HasSubstr("astype('<f4', order='C')")));
  EXPECT_THAT(broken("(2, 2", "(2; 2"), HasSubstr("shape"));
  EXPECT_THAT(broken("(2, 2", "(2, 9"), HasSubstr("truncated"));
  EXPECT_THAT(broken("(2, 2", "(2, 1"), HasSubstr("bytes"));
  write(file("broken.npy"), good.substr(0, good.size() - 1));
  EXPECT_THAT(complaint(file("broken.npy")), HasSubstr("bytes"));
  write(file("broken.npy"), good.substr(0, 40));
  EXPECT_THAT(complaint(file("broken.npy")), HasSubstr("header"));
  write(file("broken.npy"), "MATLAB 5.0 MAT-file, Platform: GLNXA64");
  EXPECT_THAT(complaint(file("broken.npy")), HasSubstr("scipy.io.loadmat('broken.npy')"));
  write(file("broken.npy"), "");
  EXPECT_THAT(complaint(file("broken.npy")), HasSubstr("not a NumPy array"));
}

/// Two moving hands, made from joint angles.
RecordedHands made_up_recording() {
  RecordedHands recording;
  const Articulation articulation(renderer::HandShape::mean());
  const auto radii = renderer::joint_radii_m(renderer::HandShape::mean());
  for (int i = 0; i < 5; ++i) {
    recording.time_ns.push_back(i * 9'000'000);
    Bend bend;
    bend.flexion[1] = {0.2 * i, 0.1 * i, 0.05};
    bend.thumb_flexion = 0.1 * i;
    for (const Side side : {Side::left, Side::right}) {
      const glm::dmat4 wrist = glm::mat4_cast(glm::normalize(glm::dquat(0.9, 0.1 * i, 0.3, -0.2)));
      const JointFrames frames = articulation.frames(side, wrist, bend);
      msg::HandPose pose{side, 1, {}};
      for (int j = 0; j < msg::kJoints; ++j) {
        const glm::quat q = glm::normalize(glm::quat_cast(glm::mat3(frames[j])));
        pose.joints[j] = {
            {frames[j][3][0], frames[j][3][1], frames[j][3][2]}, {q.x, q.y, q.z, q.w}, radii[j]};
      }
      for (int c = 0; c < 4; ++c)
        pose.joints[0].orientation_xyzw[c] = pose.joints[1].orientation_xyzw[c];
      recording.hands[static_cast<std::size_t>(side)].push_back(pose);
    }
  }
  return recording;
}

TEST_F(RecordingFiles, WhatIsWrittenIsReadBack) {
  RecordedHands written = made_up_recording();
  written.first_ns = 1'700'000'000'123'456'000;
  ASSERT_TRUE(write_recording(folder_, written));
  const auto read = read_recording(folder_);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->first_ns, written.first_ns);
  EXPECT_EQ(read->time_ns, written.time_ns);
  for (std::size_t side = 0; side < 2; ++side) {
    ASSERT_EQ(read->hands[side].size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(read->hands[side][i].side, static_cast<Side>(side));
      for (int j = 0; j < msg::kJoints; ++j) {
        const auto &a = read->hands[side][i].joints[j], &b = written.hands[side][i].joints[j];
        float dot = 0;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.position_m[c], b.position_m[c], 1e-6) << j;
        for (int c = 0; c < 4; ++c) dot += a.orientation_xyzw[c] * b.orientation_xyzw[c];
        EXPECT_NEAR(std::abs(dot), 1, 1e-5) << renderer::kJointNames[j];
        EXPECT_FLOAT_EQ(a.radius_m, b.radius_m);
      }
    }
  }
}

TEST_F(RecordingFiles, ARecordingInMetresOrMicrometresIsRefusedWithTheSizeOfTheHand) {
  for (const float scale : {1e-3f, 1e3f}) {
    RecordedHands odd = made_up_recording();
    for (auto& hand : odd.hands)
      for (auto& pose : hand)
        for (auto& joint : pose.joints)
          for (float& coordinate : joint.position_m) coordinate *= scale;
    ASSERT_TRUE(write_recording(folder_, odd));
    const auto read = read_recording(folder_);
    ASSERT_FALSE(read) << scale;
    EXPECT_THAT(read.error().what, HasSubstr("joints_left.npy: the palm is "));
    EXPECT_EQ(read.error().what.find("are they in metres?") != std::string::npos, scale < 1);
  }
}

TEST_F(RecordingFiles, TimesThatDoNotAscendAreRefused) {
  ASSERT_TRUE(write_recording(folder_, made_up_recording()));
  ASSERT_TRUE(write_npy_i64(file("timestamps.npy"), {0, 9000, 18000, 17000, 27000}));
  const auto read = read_recording(folder_);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what, HasSubstr("timestamps.npy: time 3"));
}

TEST_F(RecordingFiles, OfTwoSamplesOfOneTimeOneIsLeftOutAndCounted) {
  const auto made_up = made_up_recording();
  ASSERT_TRUE(write_recording(folder_, made_up));
  ASSERT_TRUE(write_npy_i64(file("timestamps.npy"), {0, 9000, 18000, 18000, 27000}));
  testing::internal::CaptureStderr();
  const auto read = read_recording(folder_);
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("timestamps.npy: 1 of 5 samples have the time of the one before"));
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_THAT(read->time_ns, testing::ElementsAre(0, 9'000'000, 18'000'000, 27'000'000));
  for (const auto& hand : read->hands) {
    ASSERT_EQ(hand.size(), 4u);
    EXPECT_NE(std::memcmp(&hand[2], &hand[3], sizeof hand[2]), 0);
  }
  EXPECT_EQ(read_all_stamps_ns(folder_)->front().size(), 4u);
}

TEST_F(RecordingFiles, LostHandsAreRefusedWithTheSampleAndTheRemedy) {
  const auto spoil = [&](const std::string& name, float value) {
    ASSERT_TRUE(write_recording(folder_, made_up_recording()));
    auto array = read_npy(file(name));
    ASSERT_TRUE(array);
    const auto of_a_sample = array->values.size() / 5;
    std::vector<float> values(array->values.begin(), array->values.end());
    std::fill_n(values.begin() + static_cast<long>(3 * of_a_sample), of_a_sample, value);
    ASSERT_TRUE(write_npy_f32(file(name), array->shape, values));
  };
  spoil("joints_left.npy", std::nanf(""));
  EXPECT_THAT(read_recording(folder_).error().what,
              testing::AllOf(HasSubstr("joints_left.npy: sample 3 has a number that is not finite"),
                             HasSubstr("numpy.save('joints_left.npy', j[ok])")));
  spoil("bones_right.npy", 0);
  EXPECT_THAT(read_recording(folder_).error().what,
              testing::AllOf(HasSubstr("bones_right.npy: sample 3 has a bone without axes"),
                             HasSubstr("numpy.save('bones_right.npy', b[ok])")));
}

TEST_F(RecordingFiles, ArraysOfOtherShapesAreRefusedWithTheLineOfNumpy) {
  const auto refusal = [&](const std::vector<std::size_t>& shape) {
    EXPECT_TRUE(write_recording(folder_, made_up_recording()));
    EXPECT_TRUE(write_npy_f32(file("joints_left.npy"), shape, std::vector<float>(5 * 42 * 3)));
    return read_recording(folder_).error().what;
  };
  EXPECT_THAT(refusal({5, 126}), HasSubstr("numpy.load('joints_left.npy').reshape(5, 42, 3)"));
  EXPECT_THAT(refusal({42, 3, 5}),
              HasSubstr("numpy.moveaxis(numpy.load('joints_left.npy'), -1, 0)"));
}

TEST_F(RecordingFiles, CasesThatOnceFailed) {
  const auto folder = outside_data() / "cases/recordings";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "HANDCAST_DATA has no folder 'cases'";
  EXPECT_THAT(read_recording(folder / "lost_as_nan").error().what,
              HasSubstr("sample 55 has a number"));
  const auto read = read_recording(folder / "one_time_twice");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->time_ns.size(), 164u);
}

TEST_F(RecordingFiles, TimesInAnotherUnitAreRefusedWithItsName) {
  ASSERT_TRUE(write_recording(folder_, made_up_recording()));
  const auto refusal = [&](std::int64_t step) {
    EXPECT_TRUE(write_npy_i64(file("timestamps.npy"),
                              {50 * step, 51 * step, 52 * step, 53 * step, 54 * step}));
    const auto read = read_recording(folder_);
    return read ? "(it was read)" : read.error().what;
  };
  EXPECT_EQ(refusal(9'000), "(it was read)");
  EXPECT_THAT(refusal(9'000'000), HasSubstr("timestamps.npy: the times are 9e+06 us apart"));
  EXPECT_THAT(refusal(9'000'000), HasSubstr("are they in nanoseconds?"));
  EXPECT_THAT(refusal(9), HasSubstr("are they in milliseconds?"));
  EXPECT_THAT(refusal(1), HasSubstr("are they in milliseconds?"));
}

TEST_F(RecordingFiles, AHandThatJumpsOrIsFarAwayIsRefusedWithTheSample) {
  const auto refusal = [&](int sample, float by_m) {
    RecordedHands odd = made_up_recording();
    for (std::size_t i = 0; i < odd.hands[1].size(); ++i)
      for (auto& joint : odd.hands[1][i].joints)
        if (std::ssize(odd.hands[1]) - static_cast<int>(i) <= 5 - sample)
          joint.position_m[1] += by_m;
    EXPECT_TRUE(write_recording(folder_, odd));
    const auto read = read_recording(folder_);
    return read ? "(it was read)" : read.error().what;
  };
  EXPECT_EQ(refusal(2, 0.1f), "(it was read)");
  EXPECT_EQ(refusal(0, 1.5f), "(it was read)");
  EXPECT_THAT(refusal(2, 1.5f),
              HasSubstr("joints_right.npy: sample 2: the wrist jumps by 1.5 m within 9 ms"));
  EXPECT_THAT(refusal(0, 1000.f), HasSubstr("sample 0: the wrist is 1e+03 m away"));
}

TEST_F(RecordingFiles, AHandThatChangesItsSizeIsRefused) {
  RecordedHands odd = made_up_recording();
  for (auto& joint : odd.hands[0][3].joints)
    for (float& coordinate : joint.position_m) coordinate *= 3;
  ASSERT_TRUE(write_recording(folder_, odd));
  const auto read = read_recording(folder_);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what, HasSubstr("joints_left.npy: sample 3: the palm is "));
}

/// Its numbers would take memory before the shape is seen to be wrong.
TEST_F(RecordingFiles, AnArrayOfAnotherShapeIsRefusedBeforeItsNumbersAreRead) {
  ASSERT_TRUE(write_npy_i64(file("timestamps.npy"), {1}));
  std::string bytes = bytes_of(file("timestamps.npy"));
  bytes.replace(bytes.find("(1, ), }"), 16, "(30000000, ), } ");
  write(file("timestamps.npy"), bytes);
  std::filesystem::resize_file(file("timestamps.npy"), bytes.size() + 29'999'999 * 8);
  EXPECT_THAT(read_stamps_ns(file("timestamps.npy")).error().what,
              HasSubstr("has 30000000 times; at most 10000000 are read"));
}

TEST_F(RecordingFiles, ATimeThatIsNoneIsRefused) {
  for (const double time_us : {std::nan(""), 1e300, -5e15}) {
    std::string bytes(sizeof time_us, '\0');
    std::memcpy(bytes.data(), &time_us, sizeof time_us);
    ASSERT_TRUE(write_npy_i64(file("timestamps.npy"), {7}));
    std::string whole = bytes_of(file("timestamps.npy"));
    whole.replace(whole.find("<i8"), 3, "<f8").replace(whole.size() - 8, 8, bytes);
    write(file("timestamps.npy"), whole);
    const auto stamps_ns = read_stamps_ns(file("timestamps.npy"));
    ASSERT_FALSE(stamps_ns);
    EXPECT_THAT(stamps_ns.error().what, HasSubstr("timestamps.npy: time 0 is not a time"));
  }
}

TEST_F(RecordingFiles, AHandOfAnEarlierRecordingIsNotLeftAsAGhost) {
  ASSERT_TRUE(write_recording(folder_, made_up_recording()));
  RecordedHands one_hand = made_up_recording();
  one_hand.hands[1].clear();
  ASSERT_TRUE(write_recording(folder_, one_hand));
  const auto read = read_recording(folder_);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->hands[0].size(), 5u);
  EXPECT_TRUE(read->hands[1].empty());
}

TEST_F(RecordingFiles, AMissingOrOddFileIsNamed) {
  ASSERT_TRUE(write_recording(folder_, made_up_recording()));
  ASSERT_TRUE(
      write_npy_f32(file("bones_left.npy"), {5, 22, 4, 3}, std::vector<float>(5 * 22 * 12)));
  const auto odd = read_recording(folder_);
  ASSERT_FALSE(odd);
  EXPECT_THAT(odd.error().what,
              testing::AllOf(HasSubstr("bones_left.npy"), HasSubstr("5, 22, 4, 4")));

  std::filesystem::remove(file("bones_left.npy"));
  EXPECT_THAT(read_recording(folder_).error().what, HasSubstr("bones_left.npy"));
  std::filesystem::remove(file("joints_left.npy"));
  EXPECT_TRUE(read_recording(folder_)) << "the right hand is still there";
  std::filesystem::remove(file("joints_right.npy"));
  EXPECT_EQ(read_recording(folder_).error().code, Errc::bad_config);
}

TEST(LeapRecording, BonesPointFromTheirJointToTheNext) {
  HANDCAST_NEEDS_RECORDINGS();
  for (const char* name : {"translation", "rotation", "deformation", "all_5s"}) {
    const auto recording = read_recording(outside_data() / "lmc" / name);
    ASSERT_TRUE(recording) << recording.error().what;
    EXPECT_NEAR(static_cast<double>(recording->time_ns.back()) * 1e-9, 5, 0.02);
    ASSERT_GT(recording->hands[0].size(), 550u);
    EXPECT_TRUE(recording->hands[1].empty());
    for (const auto& pose : recording->hands[0]) {
      const JointFrames frames = renderer::frames_of(pose);
      for (int j = 2; j < msg::kJoints; ++j) {
        const glm::dmat3 axes(frames[j]);
        EXPECT_NEAR(glm::determinant(axes), 1, 1e-4);
        const bool tip = j == 5 || j % 5 == 0;
        if (tip) continue;
        const glm::dvec3 bone = glm::normalize(place(frames[j + 1]) - place(frames[j]));
        ASSERT_GT(glm::dot(bone, -axes[2]), 0.999) << name << " " << renderer::kJointNames[j];
      }
    }
  }
}

TEST(LeapRecording, TheBackOfTheHandFacesTheCamera) {
  HANDCAST_NEEDS_RECORDINGS();
  const auto recording = read_recording(outside_data() / "lmc" / "translation");
  ASSERT_TRUE(recording);
  const glm::dmat3 camera_from_tracker(calib::reference_rig().camera_from_tracker);
  const JointFrames frames = renderer::frames_of(recording->hands[0][100]);
  EXPECT_LT((camera_from_tracker * glm::dvec3(frames[12][1])).z, -0.7)
      << "+y, out of the back, points to the camera";
  EXPECT_GT((camera_from_tracker * glm::dvec3(frames[12][0])).x, 0.5)
      << "+x, the left hand's thumb side, points right";
}

}  // namespace
}  // namespace handcast::recording
