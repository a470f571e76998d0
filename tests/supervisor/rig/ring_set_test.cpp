// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/ring_set.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/resource.h>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/stage_mark.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Key;
using testing::Pair;

ipc::RingSpec marks(const std::string& service, int slots = 8) {
  return ipc::RingSpec::of<msg::StageMarks>("marks." + service, slots, true);
}

/// Limits the descriptors of this process to those below a number during the lifetime of the
/// object.
class NoDescriptorsFrom {
 public:
  explicit NoDescriptorsFrom(int number) {
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit less{.rlim_cur = static_cast<rlim_t>(number), .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &less);
  }
  ~NoDescriptorsFrom() { setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

TEST(RingSet, MakesWhatIsMissingAndReturnsIt) {
  RingSet rings;
  EXPECT_THAT(rings.add({marks("camera")}).value(), ElementsAre(Key("marks.camera")));
  const auto more = rings.add({marks("camera"), marks("pose")}).value();
  ASSERT_THAT(more, ElementsAre(Key("marks.pose")));
  EXPECT_THAT(rings.descriptors(),
              ElementsAre(Key("marks.camera"), Pair("marks.pose", more[0].second)));
}

TEST(RingSet, MakesAllOrNone) {
  RingSet rings;
  const auto first = rings.add({marks("camera")}).value()[0].second;
  {
    const NoDescriptorsFrom one_more(first + 2);
    const auto failed = rings.add({marks("pose"), marks("landmarks")});
    ASSERT_FALSE(failed);
    EXPECT_THAT(failed.error().what, HasSubstr("ring marks.landmarks"));
  }
  EXPECT_THAT(rings.descriptors(), ElementsAre(Key("marks.camera")));
  EXPECT_EQ(fcntl(first + 1, F_GETFD), -1) << "the ring of pose is gone again";
}

TEST(RingSet, ARingCannotChangeItsSizeOrType) {
  RingSet rings;
  ASSERT_TRUE(rings.add({marks("camera", 8)}));
  EXPECT_TRUE(rings.check_sizes({marks("camera", 8), marks("pose", 4)}, "desk"));
  const auto larger = rings.check_sizes({marks("camera", 16)}, "desk");
  ASSERT_FALSE(larger);
  EXPECT_EQ(larger.error().code, Errc::bad_config);
  EXPECT_THAT(larger.error().what, HasSubstr("ring 'marks.camera' would need 16 slots, not 8"));
  EXPECT_THAT(larger.error().what, HasSubstr("`handcast down --rig desk`"));

  EXPECT_TRUE(rings.check_types({marks("camera", 16)}));
  const auto other =
      rings.check_types({ipc::RingSpec::of<msg::HandPoses>("marks.camera", 8, true)});
  EXPECT_THAT(other.error().what, HasSubstr("belongs to another version"));
}

TEST(RingSet, EachRingIsSavedWithItsFileAndNumber) {
  RingSet rings;
  EXPECT_THAT(rings.saved(), IsEmpty());
  const auto fd = rings.add({marks("camera")}).value()[0].second;
  const auto saved = rings.saved();
  ASSERT_EQ(saved.size(), 1u);
  EXPECT_EQ(saved[0].stream, "marks.camera");
  EXPECT_EQ(saved[0].fd, fd);
  EXPECT_GT(saved[0].inode, 0u);
}

}  // namespace
}  // namespace handcast::supervisor
