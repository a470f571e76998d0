// SPDX-License-Identifier: Apache-2.0
// The real hidapi on an emulated device.
#include "services/projector/dlp/hid_device.hpp"

#include <gmock/gmock.h>

#include "tests/services/projector/dlp/emulated_hid.hpp"

namespace handcast::dlp {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class Hid : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::sees_emulated_devices())
      GTEST_SKIP() << "there are no emulated devices: umockdev-wrapper is not installed, or "
                      "sanitizers must be loaded first";
    device_ = std::make_unique<test::EmulatedHid>(0x6401, "LCR7",
                                                  [this](const auto& report) { came_ = report; });
  }
  std::unique_ptr<HidDevice> open() const {
    const auto found = list_hid_devices(0x0451);
    if (found.size() != 1) throw std::runtime_error("there is no device");
    return std::move(HidDevice::open(found.front()).value());
  }

  test::NumberedReport came_{};
  std::unique_ptr<test::EmulatedHid> device_;
};

TEST_F(Hid, ADeviceIsListedWithItsSerialNumberAndPath) {
  const auto found = list_hid_devices(0x0451);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].path, "/dev/hidraw0");
  EXPECT_EQ(found[0].serial, "LCR7");
  EXPECT_EQ(found[0].product_id, 0x6401);
  EXPECT_THAT(list_hid_devices(0x1234), IsEmpty());
}

TEST_F(Hid, NoAnswerIsATimeoutNotAHang) {
  const auto device = open();
  protocol::Report report;
  for (const auto deadline : {Deadline::now(), Deadline::in(5ms)}) {
    const auto count = device->read(report, deadline);
    ASSERT_FALSE(count);
    EXPECT_EQ(count.error().code, Errc::timeout);
  }
}

TEST_F(Hid, AShortReportComesWithItsLength) {
  const auto device = open();
  device_->send("abc", 3);
  protocol::Report report{};
  EXPECT_EQ(device->read(report, Deadline::in(5s)).value(), 3u);
  EXPECT_EQ(report[2], 'c');
}

// The kernel's buffer is full after some reports; a write without a deadline would wait for ever.
TEST_F(Hid, ADeviceThatTakesNoReportsIsLostNotWaitedFor) {
  const auto device = open();
  device_->stall(true);
  Result<void> written;
  for (int i = 0; i < 10'000 && written; ++i) written = device->write({}, Deadline::in(100ms));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::disconnected);
  EXPECT_EQ(device->write({}, Deadline::in(1h)).error().code, Errc::disconnected);
  protocol::Report report;
  EXPECT_EQ(device->read(report, Deadline::in(1h)).error().code, Errc::disconnected);
}

TEST_F(Hid, AnUnpluggedDeviceIsDisconnected) {
  const auto device = open();
  device_.reset();
  protocol::Report report;
  const auto count = device->read(report, Deadline::in(10s));
  ASSERT_FALSE(count);
  EXPECT_EQ(count.error().code, Errc::disconnected);
  EXPECT_THAT(list_hid_devices(0x0451), IsEmpty());
}

TEST_F(Hid, ADeviceThatIsGoneBeforeItIsOpenedIsNamed) {
  const auto found = list_hid_devices(0x0451);
  device_.reset();
  const auto opened = HidDevice::open(found.at(0));
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::unavailable);
  EXPECT_THAT(opened.error().what, HasSubstr("/dev/hidraw0"));
}

}  // namespace
}  // namespace handcast::dlp
