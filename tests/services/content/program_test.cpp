// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "ipc/msg/guest_picture.hpp"
#include "ipc/ring/writer.hpp"
#include "tests/services/content/made_hand.hpp"

namespace handcast::content {
namespace {

using msg::GuestPicture;

class ProgramTest : public testing::Test {
 protected:
  static constexpr int kWidth = 16, kHeight = 10;

  static ipc::Segment ring(std::string_view stream) {
    return *ipc::Segment::create(ipc::RingSpec::of<GuestPicture>(std::string(stream), 3, false,
                                                                 GuestPicture::bytes(64, 64)));
  }
  static ipc::Segment again(const ipc::Segment& segment) {
    return *ipc::Segment::open(UniqueFd(::dup(segment.fd())));
  }
  Opening opening(std::string what = {}, Side side = Side::left) const {
    auto opening = opening_of("program", std::move(what), side, kWidth, kHeight);
    opening.ring = [this](std::string_view stream) -> Result<ipc::Segment> {
      return again(stream == "guest.right" ? right_ : left_);
    };
    return opening;
  }
  /// Publishes a picture of one colour; `change` may spoil it.
  template <class Change>
  void publish(std::uint32_t pixel, const Change& change) {
    auto picture = writer_->loan();
    ASSERT_TRUE(picture);
    picture->width_px = kWidth;
    picture->height_px = kHeight;
    std::fill_n(picture->pixels(), kWidth * kHeight, pixel);
    change(*picture);
    writer_->publish(std::move(picture));
  }
  void publish(std::uint32_t pixel) {
    publish(pixel, [](auto&) {});
  }
  Result<bool> draw(double time_s = 0) {
    moment_.time_s = time_s;
    auto drawn = source_->draw(moment_, {}, out_);
    ++moment_.frame;
    return drawn;
  }

  ipc::Segment left_ = ring("guest.left"), right_ = ring("guest.right");
  std::optional<ipc::Writer<GuestPicture>> writer_ =
      *ipc::Writer<GuestPicture>::attach(again(left_));
  std::unique_ptr<Source> source_ = opened(opening());
  renderer::Texture out_{kWidth, kHeight, 7};
  HandState hand_;
  Moment moment_{.hand = &hand_, .other = &hand_};
};

TEST_F(ProgramTest, WithoutAPictureItIsTransparent) {
  EXPECT_TRUE(*draw());
  EXPECT_EQ(out_.at(0, 0), 0u);
  EXPECT_FALSE(*draw(1));
}

TEST_F(ProgramTest, ShowsTheNewestPictureOnce) {
  publish(0xff0000ff);
  publish(0xff00ff00);
  EXPECT_TRUE(*draw());
  EXPECT_EQ(out_.at(kWidth - 1, kHeight - 1), 0xff00ff00u);
  EXPECT_FALSE(*draw(1));
}

TEST_F(ProgramTest, APictureOfAnotherSizeIsStretched) {
  publish(0, [](GuestPicture& picture) {
    picture.width_px = 2;
    picture.height_px = 1;
    picture.pixels()[0] = 0xff0000ff;
    picture.pixels()[1] = 0xff00ff00;
  });
  ASSERT_TRUE(*draw());
  EXPECT_EQ(out_.at(0, 0), 0xff0000ffu);
  EXPECT_EQ(out_.at(kWidth - 1, kHeight - 1), 0xff00ff00u);
}

TEST_F(ProgramTest, StraightColoursAreMultipliedByAlpha) {
  publish(0x80ffffff, [](GuestPicture& picture) { picture.is_straight = 1; });
  ASSERT_TRUE(*draw());
  EXPECT_EQ(out_.at(0, 0), 0x80808080u);
}

TEST_F(ProgramTest, PremultipliedColoursAreNeverAboveAlpha) {
  publish(0x40ff2000);
  ASSERT_TRUE(*draw());
  EXPECT_EQ(out_.at(0, 0), 0x40402000u);
}

TEST_F(ProgramTest, APictureEndsAfterItsTime) {
  publish(0xffffffff, [](GuestPicture& picture) { picture.lasts_ns = 3'600'000'000'000; });
  ASSERT_TRUE(*draw(10));
  EXPECT_FALSE(*draw(10 + 3500));
  EXPECT_TRUE(*draw(10 + 3601));
  EXPECT_EQ(out_.at(0, 0), 0u);
  EXPECT_FALSE(*draw(10 + 3602));
}

TEST_F(ProgramTest, APictureWithoutATimeOutlivesItsWriter) {
  publish(0xffffffff);
  ASSERT_TRUE(*draw());
  writer_.reset();
  EXPECT_FALSE(*draw(1e6));
  EXPECT_EQ(out_.at(0, 0), 0xffffffffu);
  writer_.emplace(*ipc::Writer<GuestPicture>::attach(again(left_)));
  publish(0xff112233);
  EXPECT_TRUE(*draw(1e6 + 1));
  EXPECT_EQ(out_.at(0, 0), 0xff112233u);
}

TEST_F(ProgramTest, AWriterThatStopsInTheMiddleLeavesTheLastPicture) {
  publish(0xffffffff);
  ASSERT_TRUE(*draw());
  {
    auto begun = writer_->loan();
    std::fill_n(begun->pixels(), kWidth * kHeight, 0u);
    EXPECT_FALSE(*draw(1));
    EXPECT_EQ(out_.at(0, 0), 0xffffffffu);
  }
  EXPECT_FALSE(*draw(2));
}

TEST_F(ProgramTest, ImpossibleSizesAreLeftOutAndTheLastPictureStays) {
  publish(0xffffffff);
  ASSERT_TRUE(*draw());
  for (const auto& [width, height] :
       {std::pair{0u, 10u}, {4000u, 1u}, {0xffffffffu, 0xffffffffu}, {2000u, 2000u}, {10u, 0u}}) {
    publish(0, [&, w = width, h = height](GuestPicture& picture) {
      picture.width_px = w;
      picture.height_px = h;
    });
    const auto drawn = draw(1);
    ASSERT_FALSE(drawn) << width << "x" << height;
    EXPECT_EQ(drawn.error().code, Errc::bad_data);
    EXPECT_EQ(out_.at(0, 0), 0xffffffffu);
  }
  publish(0xff112233);
  EXPECT_TRUE(*draw(2));
  EXPECT_EQ(out_.at(0, 0), 0xff112233u);
}

TEST_F(ProgramTest, TimesThatAreNoiseDoNoHarm) {
  for (const std::int64_t lasts_ns : {std::numeric_limits<std::int64_t>::max(),
                                      std::numeric_limits<std::int64_t>::min(), std::int64_t{-1}}) {
    publish(0xff445566, [&](GuestPicture& picture) { picture.lasts_ns = lasts_ns; });
    EXPECT_TRUE(*draw());
    EXPECT_EQ(out_.at(0, 0), 0xff445566u);
  }
}

TEST_F(ProgramTest, TheWholeRingMayBeNoise) {
  std::uint32_t random = 1;
  for (int round = 0; round < 50; ++round) {
    auto* const bytes = reinterpret_cast<std::uint8_t*>(left_.data());
    for (std::size_t i = 4096; i < left_.size(); ++i)
      bytes[i] = static_cast<std::uint8_t>((random = random * 1664525 + 1013904223) >> 24);
    const auto drawn = draw(round);
    EXPECT_TRUE(drawn || !drawn.error().what.empty());
  }
}

TEST_F(ProgramTest, EachHandHasItsOwnPicturesUnlessAnotherIsNamed) {
  publish(0xff0000ff);
  const auto shows = [&](const Opening& opening) {
    source_ = opened(opening);
    moment_.frame = 0;
    EXPECT_TRUE(*draw());
    return out_.at(0, 0);
  };
  EXPECT_EQ(shows(opening({}, Side::right)), 0u);
  EXPECT_EQ(shows(opening("left", Side::right)), 0xff0000ffu);
  EXPECT_EQ(shows(opening("right", Side::left)), 0u);
}

TEST_F(ProgramTest, OtherNamesAndNoRigAreErrors) {
  EXPECT_EQ(open_source(opening("middle")).error().code, Errc::bad_config);
  EXPECT_EQ(open_source(opening_of("program")).error().code, Errc::unavailable);
}

}  // namespace
}  // namespace handcast::content
