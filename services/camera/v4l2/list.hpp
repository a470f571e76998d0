// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "services/camera/v4l2/device.hpp"
#include "services/camera/v4l2/mode.hpp"

namespace handcast::camera::v4l2 {

/// A camera that is attached.
struct ListedCamera {
  Identity identity;                 ///< only its path is known if it cannot be opened
  std::vector<FormatSizes> formats;  ///< empty if it cannot be opened
  /// Why it cannot be used now, with the remedy: no permission (and which group has it), in use, a
  /// driver that handcast does not read, no format that it reads. Empty if it can.
  std::string trouble;
};

/// All cameras /dev/videoN, in their order. Devices that only deliver metadata or play are left
/// out. A camera that streams for another program goes on.
std::vector<ListedCamera> list_cameras();

}  // namespace handcast::camera::v4l2
