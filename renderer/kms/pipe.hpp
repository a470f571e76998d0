// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <xf86drmMode.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "renderer/kms/buffer.hpp"
#include "renderer/kms/display.hpp"

namespace handcast::renderer::kms {

struct Freed {
  void operator()(drmModeRes* resources) const { drmModeFreeResources(resources); }
  void operator()(drmModeConnector* connector) const { drmModeFreeConnector(connector); }
  void operator()(drmModeEncoder* encoder) const { drmModeFreeEncoder(encoder); }
  void operator()(drmModePlaneRes* planes) const { drmModeFreePlaneResources(planes); }
  void operator()(drmModePlane* plane) const { drmModeFreePlane(plane); }
  void operator()(drmModeObjectProperties* values) const { drmModeFreeObjectProperties(values); }
  void operator()(drmModePropertyRes* property) const { drmModeFreeProperty(property); }
  void operator()(drmModePropertyBlobRes* blob) const { drmModeFreePropertyBlob(blob); }
  void operator()(drmModeAtomicReq* request) const { drmModeAtomicFree(request); }
};

/// Owns an answer of libdrm; null if there was none.
template <class T>
using Owned = std::unique_ptr<T, Freed>;

/// A connector, CRTC or plane of a card, and the properties that it had when it was read.
class Object {
 public:
  Object() = default;
  /// Reads it. `type`: DRM_MODE_OBJECT_*.
  static Object read(int card, std::uint32_t id, std::uint32_t type);

  std::uint32_t id() const { return id_; }
  /// The number of a property; empty if the driver does not have it.
  std::optional<std::uint32_t> property(std::string_view name) const;
  /// Its value when it was read; 0 if the driver does not have it.
  std::uint64_t value(std::string_view name) const;

 private:
  struct Property {
    std::uint32_t id = 0;
    std::uint64_t value = 0;
  };
  std::uint32_t id_ = 0;
  std::map<std::string, Property, std::less<>> properties_;
};

/// Data of a property (a mode, a colour table) in the kernel.
class Blob {
 public:
  Blob() = default;
  Blob(int card, const void* data, std::size_t bytes);
  /// A copy of another blob, which its owner may release; empty if there is none.
  static Blob copy_of(int card, std::uint64_t id);
  ~Blob() { reset(); }
  Blob(Blob&& other) noexcept;
  Blob& operator=(Blob&& other) noexcept;

  std::uint32_t id() const { return id_; }  ///< 0: none

 private:
  void reset();
  int card_ = -1;
  std::uint32_t id_ = 0;
};

/// Values that a card takes over all at once, or not at all.
class Request {
 public:
  /// Adds a value. A property that the driver does not have is left out.
  void set(const Object& object, std::string_view name, std::uint64_t value);
  /// Sends the values. `flags`: DRM_MODE_ATOMIC_*, DRM_MODE_PAGE_FLIP_EVENT; `user`: returned with
  /// the event. Returns 0 or an errno.
  int commit(int card, std::uint32_t flags, void* user = nullptr) const;

 private:
  Owned<drmModeAtomicReq> values_{drmModeAtomicAlloc()};
};

/// The parts of a card through which a picture gets to a display, with the properties they had when
/// they were found.
struct Pipe {
  Object connector, crtc, plane;
  std::vector<Object> other_planes;  ///< shown by the CRTC on top of the picture, as the cursor
  PixelOrder order = PixelOrder::blue_first;  ///< red_first if the plane has it
};

/// Finds the parts for a display: those it uses now, or ones that no other display uses. Errors:
/// unavailable (all are in use).
Result<Pipe> find_pipe(int card, const Display& display);

/// The former state of a pipe. Destroyed before the card is closed.
class Former {
 public:
  Former() = default;
  /// Keeps the state that the pipe was found in.
  Former(int card, const Pipe& pipe);
  /// Brings the card back into this state. Returns 0 or an errno.
  int restore(int card) const;

 private:
  struct Value {
    Object object;
    std::string_view name;
    std::uint64_t value = 0;
  };
  std::vector<Value> values_;
  std::vector<Blob> blobs_;
};

}  // namespace handcast::renderer::kms
