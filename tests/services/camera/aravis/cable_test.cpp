// SPDX-License-Identifier: Apache-2.0
// The camera is a process in a network namespace of its own, behind a virtual network cable.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <thread>

#include "ipc/base/unique_fd.hpp"
#include "services/camera/camera.hpp"

namespace handcast::camera {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

bool run(const std::string& command) {
  return std::system((command + " 2>/dev/null >/dev/null").c_str()) == 0;
}

/// The program of fake_gige_main.cpp. It waits for a byte before it uses the network, and ends with
/// its standard input.
class CameraProcess {
 public:
  CameraProcess() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return;
    const std::string program = fmt::format("{}/handcast_fake_gige", std::getenv("HANDCAST_BIN"));
    pid_ = fork();
    if (pid_ == 0) {
      dup2(ends[0], STDIN_FILENO);
      execl(program.c_str(), program.c_str(), "veth-camera", nullptr);
      _exit(127);
    }
    close(ends[0]);
    input_.reset(ends[1]);
  }
  CameraProcess(const CameraProcess&) = delete;
  CameraProcess& operator=(const CameraProcess&) = delete;
  ~CameraProcess() {
    input_.reset();
    waitpid(pid_, nullptr, 0);
  }
  bool begin() const { return write(input_.get(), "1", 1) == 1; }
  pid_t pid() const { return pid_; }

 private:
  UniqueFd input_;
  pid_t pid_ = -1;
};

class Cable : public testing::Test {
 protected:
  void SetUp() override {
    if (unshare(CLONE_NEWNET) != 0) GTEST_SKIP() << "this user may not make network namespaces";
    if (!connect()) GTEST_SKIP() << "this machine has no virtual network cables (ip, nsenter)";
    rig_.camera.backend = "aravis";
    rig_.camera.rate_hz = 100;
    rig_.camera.exposure_ms = 1;
    rig_.camera.aravis.device = "10.77.0.2";
    rig_.camera.aravis.packet_bytes = 1400;
    calibration_.camera.width_px = kWidth;
    calibration_.camera.height_px = kHeight;
    memory_.resize(msg::CameraFrame::bytes(kWidth, kHeight));
    for (const auto until = Deadline::in(10s); !camera_ && !until.passed();)
      if (auto opened = open_camera(rig_, calibration_, now_ns())) camera_ = std::move(*opened);
    ASSERT_TRUE(camera_);
  }
  void TearDown() override { camera_.reset(); }

  /// The namespace of the camera exists a moment after its process.
  bool connect() {
    const auto in_camera = fmt::format("nsenter -t {} -n ", process_.pid());
    const auto link = fmt::format("ip link add veth-host type veth peer name veth-camera netns {}",
                                  process_.pid());
    for (const auto until = Deadline::in(2s); !run(in_camera + "ip link show veth-camera");) {
      if (until.passed()) return false;
      std::this_thread::sleep_for(20ms);
      run(link);
    }
    return run("ip link set lo up") && run("ip addr add 10.77.0.1/24 dev veth-host") &&
           run("ip link set veth-host up") &&
           run(in_camera + "ip addr add 10.77.0.2/24 dev veth-camera") &&
           run(in_camera + "ip link set veth-camera up") && process_.begin();
  }

  msg::CameraFrame& frame() { return *reinterpret_cast<msg::CameraFrame*>(memory_.data()); }
  Result<void> capture(std::chrono::nanoseconds within) {
    return camera_->capture(frame(), kWidth * kHeight, Deadline::in(within));
  }
  /// Captures for a time. The last error.
  std::string errors_within(std::chrono::nanoseconds span) {
    std::string error;
    for (const auto until = Deadline::in(span); !until.passed();)
      if (const auto captured = capture(20ms); !captured) error = captured.error().what;
    return error;
  }

  static constexpr int kWidth = 160, kHeight = 120;
  CameraProcess process_;
  config::Rig rig_;
  calib::Calibration calibration_ = calib::reference_rig();
  std::vector<std::byte> memory_;
  std::unique_ptr<Camera> camera_;
};

TEST_F(Cable, ImagesGoOnWhenItIsPluggedInAgain) {
  ASSERT_TRUE(capture(5s));
  for (const auto pulled : {300ms, 4000ms}) {  // the camera gives its control up after 3 s
    const auto before = frame().header;
    ASSERT_TRUE(run("ip link set veth-host down"));
    EXPECT_THAT(errors_within(pulled), HasSubstr("sends no images"));
    ASSERT_TRUE(run("ip link set veth-host up"));
    const std::int64_t back_ns = now_ns();
    bool is_back = false;
    for (const auto until = Deadline::in(20s); !is_back && !until.passed();)
      is_back = static_cast<bool>(capture(20ms));
    ASSERT_TRUE(is_back);
    std::printf("  pulled for %.1f s: an image %.0f ms after the cable is back\n",
                ns_to_seconds(to_ns(pulled)), ns_to_ms(now_ns() - back_ns));
    EXPECT_GT(frame().header.frame_id, before.frame_id);
    EXPECT_GT(frame().header.origin_ns, before.origin_ns);
  }
}

}  // namespace
}  // namespace handcast::camera
