// SPDX-License-Identifier: Apache-2.0
#include "services/projector/other_light.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "ipc/ring/writer.hpp"

namespace handcast::projector {
namespace {

constexpr std::int64_t kMs_ns = 1'000'000;

class OtherLightTest : public testing::Test {
 protected:
  ipc::Segment ring() const { return *ipc::Segment::open(UniqueFd(::dup(segment_.fd()))); }
  /// Frames of 10 ms for `ms`, of which the other projector sends one each if it is on. Returns the
  /// share at the end.
  float run(int ms, bool is_on) {
    float share = 0;
    for (int i = 0; i < ms / 10; ++i) {
      if (is_on) writer_.publish(writer_.loan());
      share = other_.share(now_ns_ += 10 * kMs_ns);
    }
    return share;
  }

  ipc::Segment segment_ = *ipc::Segment::create(ipc::RingSpec::of<msg::Projection>(
      "projection2.frames", 8, false, msg::Projection::bytes(8, 8)));
  ipc::Writer<msg::Projection> writer_ = *ipc::Writer<msg::Projection>::attach(ring());
  OtherLight other_{*ipc::Reader<msg::Projection>::attach(ring()), 100};
  std::int64_t now_ns_ = 1'000'000'000;
};

TEST_F(OtherLightTest, IsOffUntilItHasShownSomething) {
  EXPECT_EQ(run(500, false), 0);
  EXPECT_NEAR(run(100, true), 0.5, 0.06) << "it comes gently";
  EXPECT_EQ(run(200, true), 1);
}

TEST_F(OtherLightTest, FadesIfNothingMoreCome) {
  ASSERT_EQ(run(400, true), 1);
  EXPECT_EQ(run(80, false), 1) << "some frames may be late";
  EXPECT_NEAR(run(120, false), 0.5, 0.1);
  EXPECT_EQ(run(200, false), 0);
  EXPECT_EQ(run(400, true), 1) << "and it comes back";
}

TEST_F(OtherLightTest, ASlowProjectorIsNotTakenForADeadOne) {
  OtherLight slow(*ipc::Reader<msg::Projection>::attach(ring()), 5);
  float share = 0;
  for (int i = 0; i < 10; ++i) {
    writer_.publish(writer_.loan());
    share = slow.share(now_ns_ += 200 * kMs_ns);
  }
  EXPECT_EQ(share, 1);
  EXPECT_EQ(slow.share(now_ns_ += 300 * kMs_ns), 1);
  slow.share(now_ns_ += 400 * kMs_ns);
  EXPECT_EQ(slow.share(now_ns_ += 400 * kMs_ns), 0);
}

}  // namespace
}  // namespace handcast::projector
