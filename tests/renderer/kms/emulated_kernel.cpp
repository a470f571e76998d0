// SPDX-License-Identifier: Apache-2.0
#include "tests/renderer/kms/emulated_kernel.hpp"

#include <drm_fourcc.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>

namespace handcast::test {
namespace {

std::vector<std::pair<std::string, std::uint64_t>> plane_values(std::uint64_t type) {
  return {{"type", type}, {"FB_ID", 0},  {"CRTC_ID", 0}, {"SRC_X", 0},  {"SRC_Y", 0}, {"SRC_W", 0},
          {"SRC_H", 0},   {"CRTC_X", 0}, {"CRTC_Y", 0},  {"CRTC_W", 0}, {"CRTC_H", 0}};
}

std::int64_t now_ns() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

double rate_of(const drmModeModeInfo& mode) {
  return 1e3 * mode.clock / (static_cast<double>(mode.htotal) * mode.vtotal);
}

}  // namespace

EmulatedCard::Kernel::Kernel() {
  memory_ = memfd_create("card", MFD_CLOEXEC);
  if (ftruncate(memory_, kMemory) != 0) std::abort();
  pixels_ = static_cast<std::uint8_t*>(
      mmap(nullptr, kMemory, PROT_READ | PROT_WRITE, MAP_SHARED, memory_, 0));
  const auto add_property = [&](const char* name, std::uint32_t flags) {
    properties_[next_id_++] = {name, flags};
  };
  for (const auto* name : {"EDID", "MODE_ID", "GAMMA_LUT", "CTM"})
    add_property(name, DRM_MODE_PROP_BLOB);
  for (const auto* name : {"CRTC_ID", "FB_ID"}) add_property(name, DRM_MODE_PROP_OBJECT);
  for (const auto* name : {"type", "link-status", "ACTIVE", "SRC_X", "SRC_Y", "SRC_W", "SRC_H",
                           "CRTC_X", "CRTC_Y", "CRTC_W", "CRTC_H"})
    add_property(name, DRM_MODE_PROP_RANGE);

  connectors_ = {{31, 41, 1, DRM_MODE_CONNECTOR_HDMIA, "HDMI-A-1", {}},
                 {32, 42, 3, DRM_MODE_CONNECTOR_DisplayPort, "DP-1", {}}};
  for (const auto& connector : connectors_)
    add_object(connector.id, {{"EDID", 0}, {"CRTC_ID", 0}, {"link-status", 0}});
  for (const auto crtc : kCrtcs)
    add_object(crtc, {{"ACTIVE", 0}, {"MODE_ID", 0}, {"GAMMA_LUT", 0}, {"CTM", 0}});
  planes_ = {{kPlane0, 1, DRM_PLANE_TYPE_PRIMARY},
             {kPlane1, 2, DRM_PLANE_TYPE_PRIMARY},
             {kCursor, 1, DRM_PLANE_TYPE_CURSOR}};
  for (const auto& plane : planes_) add_object(plane.id, plane_values(plane.type));

  // The text screen, with a cursor.
  const auto mode = timing(640, 480, 60);
  framebuffers_[5] = {-1, 640, 480, 2560, DRM_FORMAT_XRGB8888, 0};
  framebuffers_[6] = {-1, 64, 64, 256, DRM_FORMAT_ARGB8888, 2560 * 480};
  memory_used_ = 2 << 20;
  const auto set = [&](Id object, const char* name, std::uint64_t value) {
    values_[{object, property(name)}] = value;
  };
  set(31, "CRTC_ID", kCrtc0);
  set(kCrtc0, "ACTIVE", 1);
  set(kCrtc0, "MODE_ID", add_blob(&mode, sizeof mode));
  for (const auto& [plane, framebuffer, width, height] :
       {std::array<std::uint32_t, 4>{kPlane0, 5, 640, 480}, {kCursor, 6, 64, 64}}) {
    set(plane, "FB_ID", framebuffer);
    set(plane, "CRTC_ID", kCrtc0);
    set(plane, "SRC_W", width << 16);
    set(plane, "SRC_H", height << 16);
    set(plane, "CRTC_W", width);
    set(plane, "CRTC_H", height);
  }
  refreshes_ = std::thread([this] { refresh(); });
}

EmulatedCard::Kernel::~Kernel() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  ends_.notify_all();
  refreshes_.join();
  munmap(pixels_, kMemory);
  ::close(memory_);
}

void EmulatedCard::Kernel::add_object(
    Id id, const std::vector<std::pair<std::string, std::uint64_t>>& values) {
  for (const auto& [name, value] : values) values_[{id, property(name)}] = value;
}

EmulatedCard::Kernel::Id EmulatedCard::Kernel::property(const std::string& name) const {
  for (const auto& [id, property] : properties_)
    if (property.name == name) return id;
  return 0;
}

std::uint64_t EmulatedCard::Kernel::value_in(const Values& values, Id object, Id property) {
  const auto found = values.find({object, property});
  return found == values.end() ? 0 : found->second;
}

std::uint64_t EmulatedCard::Kernel::value(Id object, const std::string& name) const {
  return value_in(values_, object, property(name));
}

EmulatedCard::Kernel::Id EmulatedCard::Kernel::add_blob(const void* data, std::size_t bytes) {
  const auto* first = static_cast<const std::uint8_t*>(data);
  blobs_[++next_id_] = {first, first + bytes};
  return next_id_;
}

EmulatedCard::Kernel::Id EmulatedCard::Kernel::crtc_of(const std::string& connector) const {
  const auto found = std::ranges::find(connectors_, connector, &Connector::name);
  return static_cast<Id>(value(found->id, "CRTC_ID"));
}

const drmModeModeInfo* EmulatedCard::Kernel::mode_of(Id crtc, const Values& values) const {
  const auto found = blobs_.find(static_cast<Id>(value_in(values, crtc, property("MODE_ID"))));
  if (found == blobs_.end() || found->second.size() != sizeof(drmModeModeInfo)) return nullptr;
  return reinterpret_cast<const drmModeModeInfo*>(found->second.data());
}

const EmulatedCard::Kernel::Framebuffer* EmulatedCard::Kernel::scanned_by(Id crtc) const {
  if (crtc == 0 || value(crtc, "ACTIVE") == 0) return nullptr;
  const auto found =
      framebuffers_.find(static_cast<Id>(value(crtc == kCrtc0 ? kPlane0 : kPlane1, "FB_ID")));
  return found == framebuffers_.end() ? nullptr : &found->second;
}

std::uint32_t* EmulatedCard::Kernel::pixel(const Framebuffer& framebuffer, int x, int y) const {
  return reinterpret_cast<std::uint32_t*>(pixels_ + framebuffer.offset +
                                          std::size_t{framebuffer.pitch} * y) +
         x;
}

std::uint64_t EmulatedCard::Kernel::sum_of(const Framebuffer& framebuffer) const {
  std::uint64_t sum = 0;
  for (int y = 0; y < static_cast<int>(framebuffer.height); ++y)
    for (int x = 0; x < static_cast<int>(framebuffer.width); ++x)
      sum = sum * 31 + *pixel(framebuffer, x, y);
  return sum;
}

int EmulatedCard::Kernel::open() {
  const std::lock_guard lock(mutex_);
  if (faults_.open_fails != 0) return -faults_.open_fails;
  // Reading and polling are real: events are messages of a socket.
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()) != 0)
    return -errno;
  const bool is_free = !faults_.has_other_master && std::ranges::none_of(files_, [](auto& file) {
    return file.second.is_master;
  });
  files_[ends[0]] = {ends[1], is_free};
  return ends[0];
}

bool EmulatedCard::Kernel::owns(int fd) const {
  const std::lock_guard lock(mutex_);
  return files_.contains(fd);
}

void EmulatedCard::Kernel::close(int fd) {
  const std::lock_guard lock(mutex_);
  if (pending_ && pending_->file == fd) pending_.reset();
  std::vector<Id> left;
  for (const auto& [id, framebuffer] : framebuffers_)
    if (framebuffer.owner == fd) left.push_back(id);
  for (const auto id : left) remove_framebuffer(id);
  syscall(SYS_close, files_.at(fd).events);  // close() asks this object
  files_.erase(fd);
}

/// As in the kernel, a plane that shows it goes off, and the CRTC with its primary plane.
void EmulatedCard::Kernel::remove_framebuffer(Id id) {
  framebuffers_.erase(id);
  for (const auto& plane : planes_) {
    if (value(plane.id, "FB_ID") != id) continue;
    const auto crtc = static_cast<Id>(value(plane.id, "CRTC_ID"));
    values_[{plane.id, property("FB_ID")}] = values_[{plane.id, property("CRTC_ID")}] = 0;
    if (plane.type != DRM_PLANE_TYPE_PRIMARY) continue;
    values_[{crtc, property("ACTIVE")}] = 0;
    values_[{crtc, property("MODE_ID")}] = 0;
    for (const auto& connector : connectors_)
      if (value(connector.id, "CRTC_ID") == crtc) values_[{connector.id, property("CRTC_ID")}] = 0;
  }
}

/// Adds the values of a request.
int EmulatedCard::Kernel::take(const drm_mode_atomic& request, Values& values) const {
  const auto* objects = at<const Id>(request.objs_ptr);
  const auto* counts = at<const std::uint32_t>(request.count_props_ptr);
  const auto* properties = at<const Id>(request.props_ptr);
  const auto* new_values = at<const std::uint64_t>(request.prop_values_ptr);
  for (std::uint32_t i = 0, at = 0; i < request.count_objs; ++i) {
    for (std::uint32_t k = 0; k < counts[i]; ++k, ++at) {
      const auto found = values.find({objects[i], properties[at]});
      if (found == values.end()) return -ENOENT;
      if (properties_.at(properties[at]).name == "type") return -EINVAL;
      if ((properties_.at(properties[at]).flags & DRM_MODE_PROP_BLOB) != 0 && new_values[at] != 0 &&
          !blobs_.contains(static_cast<Id>(new_values[at])))
        return -EINVAL;
      found->second = new_values[at];
    }
  }
  return 0;
}

/// The checks of a driver.
int EmulatedCard::Kernel::check(const Values& values) const {
  const auto get = [&](Id object, const char* name) {
    return value_in(values, object, property(name));
  };
  for (const auto crtc : kCrtcs) {
    const bool has_connector = std::ranges::any_of(
        connectors_, [&](const auto& connector) { return get(connector.id, "CRTC_ID") == crtc; });
    const auto* mode = mode_of(crtc, values);
    if ((mode != nullptr) != has_connector) return -EINVAL;
    if (get(crtc, "ACTIVE") != 0 && mode == nullptr) return -EINVAL;
    if (mode != nullptr && mode->clock > faults_.most_clock_khz) return -EINVAL;
  }
  for (const auto& connector : connectors_)
    if (const auto crtc = get(connector.id, "CRTC_ID");
        crtc != 0 && (connector.possible_crtcs >> (crtc - kCrtc0) & 1) == 0)
      return -EINVAL;
  for (const auto& plane : planes_) {
    const auto crtc = static_cast<Id>(get(plane.id, "CRTC_ID"));
    const auto framebuffer = framebuffers_.find(static_cast<Id>(get(plane.id, "FB_ID")));
    const bool has_framebuffer = framebuffer != framebuffers_.end();
    if ((crtc != 0) != has_framebuffer) return -EINVAL;
    if (!has_framebuffer) continue;
    if ((plane.possible_crtcs >> (crtc - kCrtc0) & 1) == 0) return -EINVAL;
    const auto width = get(plane.id, "SRC_W") >> 16, height = get(plane.id, "SRC_H") >> 16;
    if (width > framebuffer->second.width || height > framebuffer->second.height) return -ENOSPC;
    if (!faults_.can_scale &&
        (width != get(plane.id, "CRTC_W") || height != get(plane.id, "CRTC_H")))
      return -ERANGE;
    const auto* mode = mode_of(crtc, values);
    if (mode == nullptr) return -EINVAL;
    if (plane.type == DRM_PLANE_TYPE_PRIMARY &&
        (get(plane.id, "CRTC_W") != mode->hdisplay || get(plane.id, "CRTC_H") != mode->vdisplay))
      return -EINVAL;
  }
  return 0;
}

bool EmulatedCard::Kernel::changes_mode(const Values& values) const {
  const auto differs = [&](Id object, const char* name) {
    return value_in(values, object, property(name)) != value(object, name);
  };
  return std::ranges::any_of(
             kCrtcs,
             [&](Id crtc) { return differs(crtc, "ACTIVE") || differs(crtc, "MODE_ID"); }) ||
         std::ranges::any_of(
             connectors_, [&](const auto& connector) { return differs(connector.id, "CRTC_ID"); });
}

int EmulatedCard::Kernel::commit(int fd, const drm_mode_atomic& request) {
  constexpr std::uint32_t kFlip = DRM_MODE_PAGE_FLIP_EVENT | DRM_MODE_ATOMIC_NONBLOCK;
  const auto& file = files_.at(fd);
  if (!file.is_atomic) return -EINVAL;
  if (!file.is_master) return -EACCES;
  const bool is_test = (request.flags & DRM_MODE_ATOMIC_TEST_ONLY) != 0;
  const bool has_event = (request.flags & DRM_MODE_PAGE_FLIP_EVENT) != 0;
  if (is_test && has_event) return -EINVAL;
  if (!is_test && pending_ && (request.flags & DRM_MODE_ATOMIC_NONBLOCK) != 0) return -EBUSY;
  if (!is_test && pending_) finish_flip(now_ns());  // a commit that may wait waits for the flip
  auto values = values_;
  if (const int refused = take(request, values); refused != 0) return refused;
  if (const int refused = check(values); refused != 0) return refused;
  const bool is_modeset = changes_mode(values);
  if (is_modeset && (request.flags & DRM_MODE_ATOMIC_ALLOW_MODESET) == 0) return -EINVAL;
  if (is_test) return 0;
  if ((request.flags & kFlip) == kFlip) {
    if (faults_.flip_fails != 0) return -faults_.flip_fails;
    const auto plane = *at<const Id>(request.objs_ptr);
    const auto crtc = static_cast<Id>(value_in(values, plane, property("CRTC_ID")));
    if (crtc == 0 || value(crtc, "ACTIVE") == 0) return -EINVAL;
    pending_ = {std::move(values), crtc, request.user_data, fd};
    return 0;
  }
  values_ = std::move(values);
  modesets_ += is_modeset ? 1 : 0;
  if (const auto* shown = scanned_by(kCrtc0)) shown_sum_ = sum_of(*shown);
  return 0;
}

/// Shows the picture that waits for the refresh, and writes its event.
int EmulatedCard::Kernel::finish_flip(std::int64_t time_ns) {
  if (const auto* shown = scanned_by(pending_->crtc); shown && !flips_.empty())
    torn_ += sum_of(*shown) != shown_sum_ ? 1 : 0;
  values_ = std::move(pending_->values);
  if (const auto* shown = scanned_by(pending_->crtc)) shown_sum_ = sum_of(*shown);
  const std::int64_t time_us = time_ns / 1000;
  flips_.push_back({time_us * 1000, sequence_});
  drm_event_vblank event{};
  event.base = {DRM_EVENT_FLIP_COMPLETE, sizeof event};
  event.user_data = pending_->user;
  event.tv_sec = static_cast<std::uint32_t>(time_us / 1'000'000);
  event.tv_usec = static_cast<std::uint32_t>(time_us % 1'000'000);
  event.sequence = sequence_;
  event.crtc_id = pending_->crtc;
  const int events = files_.at(pending_->file).events;
  pending_.reset();
  return send(events, &event, sizeof event, MSG_NOSIGNAL) == sizeof event ? 0 : -errno;
}

/// Counts refreshes at the rate of the first CRTC that is lit.
void EmulatedCard::Kernel::refresh() {
  std::unique_lock lock(mutex_);
  std::int64_t next_ns = now_ns();
  while (!is_ending_) {
    double rate_hz = 60;
    for (const auto crtc : kCrtcs)
      if (const auto* mode = mode_of(crtc, values_)) rate_hz = rate_of(*mode);
    next_ns = std::max(next_ns + static_cast<std::int64_t>(1e9 / rate_hz), now_ns());
    ends_.wait_until(lock, std::chrono::steady_clock::time_point(std::chrono::nanoseconds(next_ns)),
                     [&] { return is_ending_; });
    ++sequence_;
    if (pending_ && !faults_.never_flips && !is_ending_) finish_flip(next_ns);
  }
}

}  // namespace handcast::test
