// SPDX-License-Identifier: Apache-2.0
// What a rig gives as a ring may be anything.
#include <gmock/gmock.h>
#include <sys/mman.h>

#include "ipc/client/rig_ring.hpp"
#include "tests/ipc/client/rig_with_rings.hpp"

namespace handcast::client {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;

class HostileRings : public RigWithRings {
 protected:
  Result<RigRing> poses() {
    return while_it_turns([] { return rig_ring("desk", "pose.hands"); });
  }
};

TEST_F(HostileRings, ADescriptorThatIsNoRingIsRefusedAndTheStreamIsNamed) {
  const UniqueFd empty(::memfd_create("empty", MFD_CLOEXEC)), null(::open("/dev/null", O_RDONLY));
  for (const auto& file : {empty.get(), null.get()}) {
    give({{"pose.hands", file}});
    const auto ring = poses();
    ASSERT_FALSE(ring);
    EXPECT_EQ(ring.error().code, Errc::bad_data);
    EXPECT_THAT(ring.error().what,
                AllOf(HasSubstr("stream 'pose.hands' of rig 'desk'"), HasSubstr("not a usable")));
  }
}

TEST_F(HostileRings, ARingThatBelongsToAnotherStreamIsRefused) {
  const auto ring = notes("camera.frames");
  give({{"pose.hands", ring.fd()}});
  const auto poses = this->poses();
  ASSERT_FALSE(poses);
  EXPECT_EQ(poses.error().code, Errc::bad_data);
  EXPECT_THAT(poses.error().what, HasSubstr("camera.frames"));
}

TEST_F(HostileRings, NamesThatAreNoTextsDoNotHideTheOthers) {
  const auto ring = notes("pose.hands");
  give({{nullptr, ring.fd()}, {42, ring.fd()}, {"pose.hands", ring.fd()}});
  const auto poses = this->poses();
  ASSERT_TRUE(poses) << poses.error().what;
  EXPECT_EQ(poses->segment.stream(), "pose.hands");
}

TEST_F(HostileRings, AStreamWithoutANameIsNotFound) {
  const auto ring = notes("pose.hands");
  give({{nullptr, ring.fd()}});
  EXPECT_FALSE(while_it_turns([] { return rig_ring("desk", ""); }));
}

TEST_F(HostileRings, NoDescriptorIsLeftOpen) {
  const auto ring = notes("pose.hands");
  give({{"camera.frames", ring.fd()}, {"pose.hands", ring.fd()}, {"x", ring.fd()}});
  for (int i = 0; i < 3; ++i) (void)poses();
  for (int i = 0; i < 1000; ++i) loop_.turn();  // the server hears of the hang-ups when it turns
  const auto before = count_descriptors();
  for (int i = 0; i < 20; ++i) (void)poses();
  for (int i = 0; i < 1000; ++i) loop_.turn();
  EXPECT_EQ(count_descriptors(), before);
}

TEST_F(HostileRings, ASupervisorThatHangsIsTold) {
  give({});  // and the loop does not turn
  const auto ring = rig_ring("desk", "pose.hands", 50ms);
  ASSERT_FALSE(ring);
  EXPECT_EQ(ring.error().code, Errc::unavailable);
  EXPECT_THAT(ring.error().what, HasSubstr("hangs"));
}

}  // namespace
}  // namespace handcast::client
