// SPDX-License-Identifier: Apache-2.0
// A webcam for programs of handcast that are not tests: it is plugged in while the file exists that
// HANDCAST_EMULATED_WEBCAM names. Its size is that of the paper's camera.
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <string_view>
#include <thread>

#include "tests/services/camera/v4l2/emulated_webcam.hpp"

namespace handcast::test {
namespace {

void follow(EmulatedWebcam& webcam, const char* file) {
  for (bool was_there = true;; std::this_thread::sleep_for(std::chrono::milliseconds(2))) {
    const bool is_there = access(file, F_OK) == 0;
    if (is_there && !was_there) webcam.plug_in();
    if (!is_there && was_there) webcam.unplug();
    was_there = is_there;
  }
}

bool is_reader(std::string_view program) {
  return program == "handcast-camera" || program == "handcast-devices" ||
         program == "handcast-init" || program == "handcast-doctor";
}

[[maybe_unused]] const bool from_environment = [] {
  const char* file = std::getenv("HANDCAST_EMULATED_WEBCAM");
  if (file == nullptr || !is_reader(program_invocation_short_name)) return false;
  // It lives until the process ends.
  auto* webcam = new EmulatedWebcam(
      {.formats = {{.sizes = {{720, 540, {60, 100}}}}}, .controls = webcam_controls()});
  if (access(file, F_OK) != 0) webcam->unplug();
  std::thread([webcam, file] { follow(*webcam, file); }).detach();
  return true;
}();

}  // namespace
}  // namespace handcast::test
