// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include "tests/emulation/emulated_device.hpp"
#include "tests/services/camera/v4l2/emulated_webcam.hpp"

namespace handcast::test {

/// The state of the webcam and the kernel's rules for it. Any thread.
class EmulatedWebcam::Kernel final : public EmulatedDevice {
 public:
  explicit Kernel(Description description);
  ~Kernel() override;

  bool is_at(std::string_view path) const override;
  int open() override;
  void close(int fd) override;
  int ioctl(int fd, unsigned long request, void* argument) override;
  bool owns(int fd) const override;
  int map(int fd, std::size_t length, std::int64_t offset) override;
  int stat(struct stat& file) const override;
  bool answers_polls() const override { return true; }
  short poll(int fd, short events, std::int64_t until_ns) override;

 private:
  friend class EmulatedWebcam;

  enum class State { dequeued, queued, done };
  struct Buffer {
    State state = State::dequeued;
    std::uint32_t bytes_used = 0, flags = 0, sequence = 0;
    timeval stamp{};
  };

  /// The questions about what the camera is and can (webcam_answers.cpp).
  /// @{
  int answer(unsigned long request, void* argument);
  int query(v4l2_capability& capability) const;
  int enumerate(v4l2_fmtdesc& entry) const;
  int enumerate(v4l2_frmsizeenum& entry) const;
  int enumerate(v4l2_frmivalenum& entry) const;
  int try_format(v4l2_format& format) const;
  int set_format(int fd, v4l2_format& format);
  int get_rate(v4l2_streamparm& parameters) const;
  int set_rate(v4l2_streamparm& parameters);
  const EmulatedFormat* format_of(std::uint32_t code) const;
  const EmulatedFormat::Size* size_of(std::uint32_t code, std::uint32_t width,
                                      std::uint32_t height) const;
  /// @}
  /// The controls (webcam_controls.cpp).
  /// @{
  int query(v4l2_query_ext_ctrl& entry) const;
  int query(v4l2_querymenu& item) const;
  int transfer(v4l2_ext_controls& all, bool is_set);
  int set(EmulatedControl& control, std::int64_t value);
  EmulatedControl* control_of(std::uint32_t id);
  /// @}
  /// The queue of buffers, as in videobuf2 (webcam_queue.cpp).
  /// @{
  int request(int fd, v4l2_requestbuffers& wanted);
  int query(v4l2_buffer& buffer);
  int queue(int fd, v4l2_buffer& buffer);
  int dequeue(int fd, v4l2_buffer& buffer);
  int start(int fd, int type);
  int stop(int fd, int type);
  int refuse();  ///< counts a wrong call
  bool is_wrong(const v4l2_buffer& buffer) const;
  bool is_of_another(int fd) const { return owner_ >= 0 && owner_ != fd; }
  void fill_in(const Buffer& from, std::uint32_t index, v4l2_buffer& to) const;
  void release();
  /// @}
  /// The camera itself (webcam_images.cpp).
  /// @{
  void film();
  void send(std::int64_t exposed_ns, std::int64_t arrived_ns);
  std::vector<std::uint8_t> image(std::uint32_t sequence) const;
  std::int64_t exposure_ns();
  /// @}

  const Description description_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Faults faults_;
  bool is_plugged_ = true, is_ending_ = false;
  int to_break_ = 0, to_lose_ = 0, misuses_ = 0;
  std::function<std::vector<std::uint8_t>(std::uint32_t)> image_;
  std::vector<EmulatedControl> controls_;
  v4l2_pix_format format_{};
  std::uint32_t rate_hz_ = 30;
  std::set<int> files_;
  std::set<int> gone_;  ///< files of a camera that was unplugged
  int owner_ = -1;      ///< the file that has the buffers
  bool streams_ = false;
  int streams_begun_ = 0;
  std::vector<Buffer> buffers_;
  std::deque<std::uint32_t> queued_, done_;
  std::uint32_t sequence_ = 0;
  std::vector<Sent> sent_;
  int memory_ = -1;
  std::uint8_t* bytes_ = nullptr;  ///< the whole of it
  std::thread films_;
};

}  // namespace handcast::test
