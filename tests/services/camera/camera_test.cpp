// SPDX-License-Identifier: Apache-2.0
#include "services/camera/camera.hpp"

#include "tests/services/camera/camera_contract.hpp"

namespace handcast::camera {
namespace {

/// Those that need no device. The tests of the others emulate theirs.
std::vector<CameraBackend> rows_without_a_device() {
  std::vector<CameraBackend> rows(camera_backends().begin(), camera_backends().end());
  std::erase_if(rows, [](const CameraBackend& row) { return row.exclusive; });
  return rows;
}
INSTANTIATE_TEST_SUITE_P(Backends, CameraContract, testing::ValuesIn(rows_without_a_device()),
                         name_of_row);

TEST(Camera, AnUnknownBackEndIsRefusedWithTheKnownOnesNamed) {
  config::Rig rig;
  rig.camera.backend = "polaroid";
  const auto opened = open_camera(rig, calib::reference_rig(), 0);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::bad_config);
  EXPECT_THAT(opened.error().what,
              testing::AllOf(testing::HasSubstr("polaroid"), testing::HasSubstr("twin, replay")));
}

}  // namespace
}  // namespace handcast::camera
