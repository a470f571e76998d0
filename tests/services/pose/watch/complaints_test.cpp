// SPDX-License-Identifier: Apache-2.0
#include "services/pose/watch/complaints.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace handcast::pose {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::int64_t kSecond = 1'000'000'000;

msg::TrackerFaults one(msg::TrackerFault fault) {
  msg::TrackerFaults faults;
  faults.of(fault) = 1;
  return faults;
}

TEST(Complaints, AFreezeIsSaidOnceAndAgainOnlyAfterItHasEnded) {
  Complaints complaints("pose 'x'");
  const auto frozen = one(msg::TrackerFault::frozen);
  EXPECT_THAT(complaints.add(kSecond, {}), IsEmpty());
  EXPECT_THAT(complaints.add(2 * kSecond, frozen),
              ElementsAre(HasSubstr("pose 'x' repeats a pose")));
  EXPECT_THAT(complaints.add(3 * kSecond, frozen), IsEmpty());
  EXPECT_THAT(complaints.add(12 * kSecond, {}), IsEmpty()) << "9 s after the last one";
  EXPECT_THAT(complaints.add(14 * kSecond, {}), ElementsAre(HasSubstr("1 more time")));
  EXPECT_THAT(complaints.add(15 * kSecond, frozen), ElementsAre(HasSubstr("repeats a pose")));
}

TEST(Complaints, ASingleJumpIsNoReasonToSpeak) {
  Complaints complaints("pose 'x'");
  const auto jumped = one(msg::TrackerFault::jumped);
  EXPECT_THAT(complaints.add(1 * kSecond, jumped), IsEmpty());
  EXPECT_THAT(complaints.add(4 * kSecond, jumped), IsEmpty());
  EXPECT_THAT(complaints.add(7 * kSecond, jumped), IsEmpty()) << "three in six seconds";
  EXPECT_THAT(complaints.add(8 * kSecond, jumped), IsEmpty());
  EXPECT_THAT(complaints.add(8 * kSecond + 1, jumped), ElementsAre(HasSubstr("jumps")))
      << "three within two seconds";
}

TEST(Complaints, KindsAreIndependent) {
  Complaints complaints("pose 'x'");
  auto faults = one(msg::TrackerFault::exchanged);
  faults += one(msg::TrackerFault::impossible);
  EXPECT_EQ(complaints.add(kSecond, faults).size(), 2u);
}

}  // namespace
}  // namespace handcast::pose
