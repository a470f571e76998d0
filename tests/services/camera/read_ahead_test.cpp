// SPDX-License-Identifier: Apache-2.0
#include "services/camera/read_ahead.hpp"

#include <gtest/gtest.h>

#include <atomic>

namespace handcast::camera {
namespace {

using namespace std::chrono_literals;

/// Images whose only pixel is their index. Image 3 is damaged, and image 5 waits for `gate`.
class Numbers final : public PictureSource {
 public:
  explicit Numbers(std::atomic<bool>& gate) : gate_(gate) {}
  Result<void> read(std::size_t index, msg::CameraFrame&, std::span<std::uint8_t> pixels) override {
    while (index == 5 && !gate_) sleep_until_ns(now_ns() + to_ns(1ms));
    if (index == 3) return fail(Errc::bad_data, "damaged");
    pixels[0] = static_cast<std::uint8_t>(index);
    return {};
  }

 private:
  std::atomic<bool>& gate_;
};

class ReadAheadTest : public testing::Test {
 protected:
  std::atomic<bool> gate_{true};
  ReadAhead images_{std::make_unique<Numbers>(gate_), 7, 1, 0};
  int pixel(std::uint64_t number) {
    const auto picture = images_.get(number, Deadline::in(10s));
    return picture ? (*picture)->pixels[0] : -1;
  }
};

TEST_F(ReadAheadTest, GivesEachImageOverManyLaps) {
  for (std::uint64_t number = 0; number < 100; ++number)
    EXPECT_EQ(pixel(number), number % 7 == 3 ? -1 : static_cast<int>(number % 7)) << number;
}

TEST_F(ReadAheadTest, ImagesMayBeLeftOut) {
  for (const std::uint64_t number : {0, 1, 40, 42, 1000, 1000})
    EXPECT_EQ(pixel(number), static_cast<int>(number % 7));
}

TEST_F(ReadAheadTest, ADamagedImageIsAnErrorAndTheNextOneFollows) {
  const auto picture = images_.get(3, Deadline::in(10s));
  ASSERT_FALSE(picture);
  EXPECT_EQ(picture.error().code, Errc::bad_data);
  EXPECT_EQ(pixel(4), 4);
}

TEST_F(ReadAheadTest, AnImageThatIsNotReadYetIsATimeoutAndComesLater) {
  gate_ = false;
  const auto late = images_.get(40, Deadline::now());  // beyond what is read ahead from the first
  gate_ = true;
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, Errc::timeout);
  EXPECT_EQ(pixel(40), 5);
}

}  // namespace
}  // namespace handcast::camera
