// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/device.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::camera::v4l2 {
namespace {

constexpr int kMostDevices = 256;  // VIDEO_NUM_DEVICES of the kernel

/// The group that may read and write the device; empty if none may.
std::string group_of(const std::string& path) {
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0 || (file.st_mode & S_IRGRP) == 0 ||
      (file.st_mode & S_IWGRP) == 0)
    return {};
  group entry{};
  group* found = nullptr;
  std::array<char, 4096> texts{};
  if (getgrgid_r(file.st_gid, &entry, texts.data(), texts.size(), &found) != 0 || found == nullptr)
    return fmt::format("{}", file.st_gid);
  return found->gr_name;
}

Error not_permitted(const std::string& path) {
  const auto group = group_of(path);
  if (group.empty())
    return {Errc::bad_config,
            fmt::format("'{}' may not be opened by this user, nor by any group; see its rights "
                        "with `ls -l {}`",
                        path, path)};
  return {Errc::bad_config,
          fmt::format("'{}' may not be opened; add this user to the group {} (`sudo usermod -aG {} "
                      "$USER`), and log in again",
                      path, group, group)};
}

Error why_not_opened(const std::string& path, int number) {
  switch (number) {
    case EACCES:
    case EPERM:
      return not_permitted(path);
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return {Errc::unavailable, "there is no camera " + quote(path)};
    case EBUSY:
      return {
          Errc::unavailable,
          fmt::format("'{}' is used by another program; `fuser {}` shows which one", path, path)};
    default:
      return {Errc::unavailable,
              fmt::format("'{}' cannot be opened: {}", path, std::strerror(number))};
  }
}

/// A text of the driver: at most `size` bytes, and without control characters.
template <std::size_t size>
std::string text_in(const __u8 (&bytes)[size]) {
  const auto* text = reinterpret_cast<const char*>(bytes);
  return printable({text, strnlen(text, size)});
}

std::string fault_of(std::uint32_t capabilities) {
  if ((capabilities & V4L2_CAP_VIDEO_CAPTURE) == 0)
    return (capabilities & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0
               ? "its driver delivers images only in several planes, which handcast does not read"
               : "it captures no images";
  if ((capabilities & V4L2_CAP_STREAMING) == 0)
    return "its driver does not share its buffers (no streaming)";
  return {};
}

}  // namespace

int call(int fd, unsigned long request, void* argument) {
  while (::ioctl(fd, request, argument) < 0)
    if (errno != EINTR) return errno;
  return 0;
}

Error error_of(const Identity& identity, Errc code, std::string_view what, int number) {
  if (number == EBUSY)
    return {Errc::unavailable, fmt::format("{} is used by another program; `fuser {}` shows which "
                                           "one",
                                           describe(identity), identity.path)};
  if (number == ENODEV)
    return {Errc::disconnected, fmt::format("{} was unplugged", describe(identity))};
  return {code, fmt::format("{}: {}: {}", describe(identity), what, std::strerror(number))};
}

Result<Device> open_device(const std::string& path) {
  Device device{UniqueFd(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)), {.path = path}};
  if (!device.fd) return tl::make_unexpected(why_not_opened(path, errno));
  v4l2_capability capability{};
  if (const int number = call(device.fd.get(), VIDIOC_QUERYCAP, &capability); number != 0)
    return fail(Errc::bad_config, number == ENOTTY ? fmt::format("'{}' is not a video device", path)
                                                   : fmt::format("'{}' does not say what it is: {}",
                                                                 path, std::strerror(number)));
  const std::uint32_t capabilities = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                         ? capability.device_caps
                                         : capability.capabilities;
  device.identity.card = text_in(capability.card);
  device.identity.bus = text_in(capability.bus_info);
  device.identity.films =
      (capabilities & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) != 0;
  device.identity.fault = fault_of(capabilities);
  return device;
}

std::vector<std::string> device_paths() {
  std::vector<std::string> paths;
  for (int i = 0; i < kMostDevices; ++i) {
    auto path = fmt::format("/dev/video{}", i);
    struct stat file {};
    if (::stat(path.c_str(), &file) == 0) paths.push_back(std::move(path));
  }
  return paths;
}

std::string describe(const Identity& identity) {
  return fmt::format("'{}' ({}, {})", identity.card, identity.path, identity.bus);
}

namespace {

constexpr std::string_view kRemedy = "set v4l2.device to a path, a name or a bus";

Result<Device> usable(Device device) {
  if (device.identity.fault.empty()) return device;
  return fail(Errc::bad_config,
              fmt::format("{}: {}", describe(device.identity), device.identity.fault));
}

/// What was found among the video devices.
struct Search {
  std::vector<Device> fit;
  std::vector<std::string> listed;  ///< every camera, described
  std::optional<Error> refused;     ///< of one that could not be opened
};

Search search(std::string_view wanted) {
  Search found;
  for (const auto& path : device_paths()) {
    auto device = open_device(path);
    if (!device) {
      if (!found.refused) found.refused = device.error();
      continue;
    }
    const auto& identity = device->identity;
    if (!identity.films) continue;
    found.listed.push_back(describe(identity));
    if (wanted.empty() || wanted == identity.card || wanted == identity.bus)
      found.fit.push_back(std::move(*device));
  }
  if (found.fit.size() > 1)
    std::erase_if(found.fit, [](const Device& device) { return !device.identity.fault.empty(); });
  return found;
}

std::string list_of(const Search& found) {
  auto text = found.listed.empty() ? "no camera is attached"
                                   : "the cameras are " + join(found.listed, ", ");
  if (found.refused) text += "; " + found.refused->what;
  return text;
}

Error refusal(const Search& found, const std::string& wanted) {
  if (found.fit.size() > 1)
    return {Errc::bad_config,
            fmt::format("{}; {}; {}",
                        wanted.empty() ? "several cameras are attached"
                                       : "several cameras are called " + quote(wanted),
                        list_of(found), kRemedy)};
  if (found.listed.empty() && found.refused) return *found.refused;
  if (wanted.empty())
    return {Errc::unavailable, "no camera is attached (there is no /dev/videoN that captures)"};
  return {Errc::unavailable,
          fmt::format("there is no camera {}; {}; {}", quote(wanted), list_of(found), kRemedy)};
}

}  // namespace

Result<Device> find_device(const std::string& wanted) {
  if (wanted.starts_with('/')) {
    auto device = open_device(wanted);
    return device ? usable(std::move(*device)) : std::move(device);
  }
  auto found = search(wanted);
  if (found.fit.size() == 1) return usable(std::move(found.fit.front()));
  return tl::make_unexpected(refusal(found, wanted));
}

}  // namespace handcast::camera::v4l2
