// SPDX-License-Identifier: Apache-2.0
#include "tests/services/camera/v4l2/emulated_webcam.hpp"

#include "tests/services/camera/v4l2/webcam_kernel.hpp"

namespace handcast::test {
namespace {

[[maybe_unused]] const bool webcam_is_hidden = [] {
  hide("/dev/video");
  return true;
}();

}  // namespace

EmulatedWebcam::EmulatedWebcam(Description description)
    : kernel_(std::make_shared<Kernel>(std::move(description))) {
  attach(kernel_);
}
EmulatedWebcam::~EmulatedWebcam() { detach(kernel_.get()); }

void EmulatedWebcam::set(const Faults& faults) {
  const std::lock_guard lock(kernel_->mutex_);
  kernel_->faults_ = faults;
  kernel_->changed_.notify_all();
}

void EmulatedWebcam::break_images(int count) {
  const std::lock_guard lock(kernel_->mutex_);
  kernel_->to_break_ = count;
}

void EmulatedWebcam::lose_images(int count) {
  const std::lock_guard lock(kernel_->mutex_);
  kernel_->to_lose_ = count;
}

/// As in the kernel, files that are open stay so, and all that they can do is to be closed.
void EmulatedWebcam::unplug() {
  const std::lock_guard lock(kernel_->mutex_);
  kernel_->is_plugged_ = false;
  kernel_->gone_ = kernel_->files_;
  kernel_->streams_ = false;
  kernel_->changed_.notify_all();
}

void EmulatedWebcam::plug_in() {
  const std::lock_guard lock(kernel_->mutex_);
  kernel_->is_plugged_ = true;
  kernel_->release();
}

void EmulatedWebcam::show(std::function<std::vector<std::uint8_t>(std::uint32_t)> image) {
  const std::lock_guard lock(kernel_->mutex_);
  kernel_->image_ = std::move(image);
}

std::vector<EmulatedWebcam::Sent> EmulatedWebcam::sent() const {
  const std::lock_guard lock(kernel_->mutex_);
  return kernel_->sent_;
}

std::int64_t EmulatedWebcam::value_of(std::uint32_t control) const {
  const std::lock_guard lock(kernel_->mutex_);
  return kernel_->control_of(control)->value;
}

int EmulatedWebcam::buffers() const {
  const std::lock_guard lock(kernel_->mutex_);
  return static_cast<int>(kernel_->buffers_.size());
}

bool EmulatedWebcam::streams() const {
  const std::lock_guard lock(kernel_->mutex_);
  return kernel_->streams_;
}

int EmulatedWebcam::misuses() const {
  const std::lock_guard lock(kernel_->mutex_);
  return kernel_->misuses_;
}

std::vector<EmulatedControl> webcam_controls() {
  return {
      {.id = V4L2_CID_GAIN, .title = "Gain", .most = 255, .value = 64},
      {.id = V4L2_CID_POWER_LINE_FREQUENCY,
       .type = V4L2_CTRL_TYPE_MENU,
       .title = "Power Line Frequency",
       .most = 2,
       .value = 2,
       .menu = {{0, "Disabled"}, {1, "50 Hz"}, {2, "60 Hz"}}},
      {.id = V4L2_CID_EXPOSURE_AUTO,
       .type = V4L2_CTRL_TYPE_MENU,
       .title = "Auto Exposure",
       .most = 3,
       .value = V4L2_EXPOSURE_APERTURE_PRIORITY,
       .menu = {{1, "Manual Mode"}, {3, "Aperture Priority Mode"}}},
      {.id = V4L2_CID_EXPOSURE_ABSOLUTE,
       .title = "Exposure Time, Absolute",
       .least = 3,
       .most = 2047,
       .value = 250,
       .flags = V4L2_CTRL_FLAG_INACTIVE},
  };
}

}  // namespace handcast::test
