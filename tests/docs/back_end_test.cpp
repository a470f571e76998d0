// SPDX-License-Identifier: Apache-2.0
// Runs the contract suite of all cameras on the back end of docs/writing-a-back-end.md.
#include "tests/services/camera/camera_contract.hpp"

namespace handcast::camera {
namespace {

INSTANTIATE_TEST_SUITE_P(Documentation, CameraContract,
                         testing::Values(handcast_camera_back_end.row), name_of_row);

}  // namespace
}  // namespace handcast::camera
