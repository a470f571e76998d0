// SPDX-License-Identifier: Apache-2.0
// The controls of the emulated camera, as the kernel's control framework treats them.
#include <algorithm>
#include <cerrno>
#include <cstring>

#include "tests/services/camera/v4l2/webcam_kernel.hpp"

namespace handcast::test {

EmulatedControl* EmulatedWebcam::Kernel::control_of(std::uint32_t id) {
  const auto found = std::ranges::find(controls_, id, &EmulatedControl::id);
  return found == controls_.end() ? nullptr : &*found;
}

int EmulatedWebcam::Kernel::query(v4l2_query_ext_ctrl& entry) const {
  constexpr std::uint32_t kNext = V4L2_CTRL_FLAG_NEXT_CTRL | V4L2_CTRL_FLAG_NEXT_COMPOUND;
  const EmulatedControl* found = nullptr;
  for (const auto& control : controls_) {
    const bool fits =
        (entry.id & kNext) != 0 ? control.id > (entry.id & ~kNext) : control.id == entry.id;
    if (fits && (found == nullptr || control.id < found->id)) found = &control;
  }
  if (found == nullptr) return -EINVAL;
  entry = {.id = found->id,
           .type = found->type,
           .minimum = found->least,
           .maximum = found->most,
           .step = static_cast<__u64>(found->step),
           .default_value = found->value,
           .flags = found->flags,
           .elem_size = 4,
           .elems = 1};
  std::memcpy(entry.name, found->title.data(),
              std::min(found->title.size(), sizeof entry.name - 1));
  return 0;
}

int EmulatedWebcam::Kernel::query(v4l2_querymenu& item) const {
  const auto found = std::ranges::find(controls_, item.id, &EmulatedControl::id);
  if (found == controls_.end()) return -EINVAL;
  const auto entry = found->menu.find(item.index);
  if (entry == found->menu.end()) return -EINVAL;
  std::memset(item.name, 0, sizeof item.name);
  if (found->type == V4L2_CTRL_TYPE_INTEGER_MENU)
    item.value = std::stoll(entry->second);
  else
    std::memcpy(item.name, entry->second.data(),
                std::min(entry->second.size(), sizeof item.name - 1));
  return 0;
}

int EmulatedWebcam::Kernel::set(EmulatedControl& control, std::int64_t value) {
  if ((control.flags & V4L2_CTRL_FLAG_READ_ONLY) != 0) return -EACCES;
  if ((control.flags & V4L2_CTRL_FLAG_GRABBED) != 0) return -EBUSY;
  if (control.type == V4L2_CTRL_TYPE_MENU && !control.menu.contains(static_cast<__u32>(value)))
    return -EINVAL;
  control.value = std::clamp(value, control.least, control.most);
  control.value -= (control.value - control.least) % control.step;
  if (auto* exposure = control_of(V4L2_CID_EXPOSURE_ABSOLUTE);
      exposure != nullptr && control.id == V4L2_CID_EXPOSURE_AUTO) {
    const bool is_manual = value == V4L2_EXPOSURE_MANUAL || value == V4L2_EXPOSURE_SHUTTER_PRIORITY;
    exposure->flags = is_manual ? 0 : V4L2_CTRL_FLAG_INACTIVE;
  }
  return 0;
}

int EmulatedWebcam::Kernel::transfer(v4l2_ext_controls& all, bool is_set) {
  for (std::uint32_t i = 0; i < all.count; ++i) {
    auto& one = all.controls[i];
    auto* control = control_of(one.id);
    if (control == nullptr ||
        (all.ctrl_class != 0 && all.ctrl_class != V4L2_CTRL_ID2CLASS(one.id))) {
      all.error_idx = all.count;
      return -EINVAL;
    }
    const bool is_wide = control->type == V4L2_CTRL_TYPE_INTEGER64;
    if (is_set) {
      if (const int answer = set(*control, is_wide ? one.value64 : one.value); answer != 0) {
        all.error_idx = i;
        return answer;
      }
    } else if ((control->flags & V4L2_CTRL_FLAG_WRITE_ONLY) != 0) {
      return -EACCES;
    }
    if (is_wide)
      one.value64 = control->value;
    else
      one.value = static_cast<__s32>(control->value);
  }
  return 0;
}

}  // namespace handcast::test
