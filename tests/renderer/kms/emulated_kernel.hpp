// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <xf86drm.h>

#include <array>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "tests/emulation/emulated_device.hpp"
#include "tests/renderer/kms/emulated_card.hpp"

namespace handcast::test {

/// The memory at an address that is a number in the kernel's structs.
template <class T>
T* at(std::uint64_t address) {
  return reinterpret_cast<T*>(address);  // NOLINT(performance-no-int-to-ptr)
}

/// The state of the card and the kernel's rules for it. Any thread.
class EmulatedCard::Kernel final : public EmulatedDevice {
 public:
  Kernel();
  ~Kernel() override;

  bool is_at(std::string_view path) const override { return path == "/dev/dri/card0"; }
  int open() override;
  void close(int fd) override;
  int ioctl(int fd, unsigned long request, void* argument) override;
  bool owns(int fd) const override;
  int map(int /*fd*/, std::size_t /*length*/, std::int64_t /*offset*/) override { return memory_; }

 private:
  friend class EmulatedCard;

  using Id = std::uint32_t;
  static constexpr Id kCrtc0 = 51, kCrtc1 = 52, kPlane0 = 61, kPlane1 = 62, kCursor = 63;
  static constexpr std::array kCrtcs{kCrtc0, kCrtc1};
  static constexpr std::uint64_t kMemory = 64 << 20;
  struct Property {
    std::string name;
    std::uint32_t flags = 0;
  };
  struct Connector {
    Id id, encoder, possible_crtcs;
    std::uint32_t type;
    std::string name;
    std::vector<drmModeModeInfo> modes;  ///< empty: nothing is plugged in
  };
  struct Plane {
    Id id, possible_crtcs;
    std::uint64_t type;
  };
  struct Memory {
    std::uint64_t offset = 0, size = 0;
  };
  struct Framebuffer {
    int owner = -1;  ///< the file; -1: the kernel itself
    std::uint32_t width = 0, height = 0, pitch = 0, format = 0;
    std::uint64_t offset = 0;
  };
  struct File {
    int events = -1;  ///< where its events are written to
    bool is_master = false, is_atomic = false, sees_all_planes = false;
  };
  struct Pending {
    std::map<std::pair<Id, Id>, std::uint64_t> values;
    Id crtc;
    std::uint64_t user;
    int file;
  };
  /// The value of each property of each object.
  using Values = std::map<std::pair<Id, Id>, std::uint64_t>;

  Id property(const std::string& name) const;
  std::uint64_t value(Id object, const std::string& name) const;
  static std::uint64_t value_in(const Values& values, Id object, Id property);
  void add_object(Id id, const std::vector<std::pair<std::string, std::uint64_t>>& values);
  Id add_blob(const void* data, std::size_t bytes);
  Id crtc_of(const std::string& connector) const;
  const Framebuffer* scanned_by(Id crtc) const;
  const drmModeModeInfo* mode_of(Id crtc, const Values& values) const;
  std::uint64_t sum_of(const Framebuffer& framebuffer) const;
  std::uint32_t* pixel(const Framebuffer& framebuffer, int x, int y) const;

  int get_capability(drm_get_cap& cap) const;
  int set_capability(File& file, const drm_set_client_cap& cap) const;
  int get_resources(drm_mode_card_res& resources) const;
  int get_connector(drm_mode_get_connector& connector);
  int get_encoder(drm_mode_get_encoder& encoder) const;
  int get_planes(const File& file, drm_mode_get_plane_res& planes) const;
  int get_plane(drm_mode_get_plane& plane) const;
  int get_properties(drm_mode_obj_get_properties& wanted) const;
  int get_property(drm_mode_get_property& wanted) const;
  int get_blob(drm_mode_get_blob& wanted) const;
  int create_dumb(drm_mode_create_dumb& wanted);
  int add_framebuffer(int fd, drm_mode_fb_cmd2& wanted);
  void remove_framebuffer(Id id);
  int commit(int fd, const drm_mode_atomic& request);
  int take(const drm_mode_atomic& request, Values& values) const;
  int check(const Values& values) const;
  bool changes_mode(const Values& values) const;
  int finish_flip(std::int64_t time_ns);
  void refresh();

  mutable std::mutex mutex_;
  Faults faults_;
  std::map<Id, Property> properties_;
  Values values_;
  std::map<Id, std::vector<std::uint8_t>> blobs_;
  std::map<Id, Memory> dumb_;
  std::map<Id, Framebuffer> framebuffers_;
  std::vector<Connector> connectors_;
  std::vector<Plane> planes_;
  std::map<int, File> files_;
  std::optional<Pending> pending_;
  std::vector<Flip> flips_;
  std::uint64_t shown_sum_ = 0;
  int torn_ = 0, modesets_ = 0, probes_ = 0;
  std::uint32_t sequence_ = 1000;
  Id next_id_ = 1000;
  int memory_ = -1;
  std::uint8_t* pixels_ = nullptr;  ///< the whole of it
  std::uint64_t memory_used_ = 0;
  bool is_ending_ = false;
  std::condition_variable ends_;
  std::thread refreshes_;
};

}  // namespace handcast::test
