// SPDX-License-Identifier: Apache-2.0
// A controller that fails, and comes back.
#include <gmock/gmock.h>

#include "tests/services/camera/leap/leap_test.hpp"

namespace handcast::camera {
namespace {

using namespace std::chrono_literals;
using test::LeapFault;
using test::LeapModel;
using test::number_in;
using testing::HasSubstr;

class LeapFaults : public test::LeapTest {
 protected:
  /// Captures until all faults have happened and `more` images came. Checks that each image is
  /// whole, and that between two images as many are counted as are missing.
  void expect_all_counted(int more) {
    auto last = number_in(frame());
    const auto until = Deadline::in(60s);
    for (int left = more; left > 0 && !until.passed();) {
      if (!capture(50ms)) continue;
      expect_whole();
      const auto number = number_in(frame());
      ASSERT_GT(number, last);
      if (test::are_of_one_start(number, last)) {
        EXPECT_EQ(test::total(frame().lost), number - last - 1) << "from image " << last;
      }
      sum_.missing += frame().lost.missing;
      sum_.incomplete += frame().lost.incomplete;
      last = number;
      left -= device_->with_model([](const LeapModel& model) { return model.faults_left() == 0; });
    }
    EXPECT_FALSE(until.passed());
  }

  msg::FrameLosses sum_;
};

TEST_F(LeapFaults, EveryTornAndEveryLostImageIsCounted) {
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  for (const auto fault : {LeapFault::short_payload, LeapFault::garbage_header,
                           LeapFault::error_bit, LeapFault::lost_payload, LeapFault::lost_end,
                           LeapFault::lost_frame, LeapFault::stall, LeapFault::transfer_error}) {
    sum_ = {};
    for (int i = 0; i < 5; ++i) {
      device_->with_model([&](LeapModel& model) { model.inject(fault); });
      expect_all_counted(2);
    }
    EXPECT_GE(sum_.missing + sum_.incomplete, 5u) << static_cast<int>(fault);
    if (fault == LeapFault::lost_frame) {
      EXPECT_GE(sum_.missing, 5u);
    }
  }
  EXPECT_EQ(device_->counts().halts_cleared, 5);
}

TEST_F(LeapFaults, WithoutStampsATornImageIsCountedToo) {
  device_->with_model([](LeapModel& model) { model.has_stamps = false; });
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  for (const auto fault : {LeapFault::short_payload, LeapFault::lost_end, LeapFault::lost_frame}) {
    sum_ = {};
    device_->with_model([&](LeapModel& model) { model.inject(fault); });
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(capture());
      sum_.missing += frame().lost.missing;
      sum_.incomplete += frame().lost.incomplete;
    }
    EXPECT_GE(sum_.missing + sum_.incomplete, 1u) << static_cast<int>(fault);
  }
}

TEST_F(LeapFaults, AControllerThatHangsIsOpenedAgain) {
  ASSERT_TRUE(open());
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(capture());
    const auto id = frame().header.frame_id;
    const auto origin_ns = frame().header.origin_ns;
    device_->with_model([](LeapModel& model) { model.inject(LeapFault::hang); });
    sleep_until_ns(now_ns() + 300'000'000);
    capture(1ms);  // an image that was there
    const auto error = capture_again();
    EXPECT_TRUE(error.code == Errc::timeout) << error.what;
    EXPECT_GT(frame().header.frame_id, id);
    EXPECT_GT(frame().header.origin_ns, origin_ns);
    expect_whole();
  }
}

TEST_F(LeapFaults, AnUnpluggedControllerIsOpenedAgainWhenItIsBack) {
  ASSERT_TRUE(open());
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(capture());
    const auto id = frame().header.frame_id;
    device_->unplug();
    std::string why;
    for (int k = 0; k < 20; ++k)
      if (const auto captured = capture(20ms); !captured) why = captured.error().what;
    EXPECT_THAT(why, HasSubstr("opened again as soon as it answers"));
    device_->plug_in();
    EXPECT_EQ(capture_again().code, Errc::timeout);
    EXPECT_GT(frame().header.frame_id, id);
    expect_whole();
  }
}

TEST_F(LeapFaults, DeadlinesAreKeptWhateverHappens) {
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  device_->unplug();
  for (int i = 0; i < 20; ++i) {
    const auto before_ns = now_ns();
    capture(10ms);
    // Not a measure of speed: a call of USB that is stuck takes half a second.
    EXPECT_LT(now_ns() - before_ns, 400'000'000);
  }
  camera_.reset();
}

TEST_F(LeapFaults, OneThatIsClosedWhileItHangsIsClosed) {
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  device_->with_model([](LeapModel& model) { model.inject(LeapFault::hang); });
  sleep_until_ns(now_ns() + 20'000'000);
  camera_.reset();
  EXPECT_TRUE(open());
  EXPECT_TRUE(capture());
}

}  // namespace
}  // namespace handcast::camera
