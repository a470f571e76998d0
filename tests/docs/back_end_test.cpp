// SPDX-License-Identifier: Apache-2.0
// Runs the contract suite of all cameras on the back end of docs/writing-a-back-end.md.
#include "tests/services/camera/camera_contract.hpp"

namespace handcast::camera {

Result<std::unique_ptr<Camera>> open_noise(const Opening& with);

namespace {

constexpr std::array kDocumented{
#include "back_end_row.inc"
};

INSTANTIATE_TEST_SUITE_P(Documentation, CameraContract, testing::ValuesIn(kDocumented),
                         name_of_row);

}  // namespace
}  // namespace handcast::camera
