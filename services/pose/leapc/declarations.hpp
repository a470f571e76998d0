// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

/// What we use of Ultraleap's LeapC, versions 5 and 6, in declarations of our own: the library is
/// not free, and its header is not needed to call it. Structures are packed. Lengths are mm, times
/// microseconds of the service's clock, axes x to the right, y up from the device, z to the user.
namespace handcast::pose::leapc {

using Status = std::int32_t;  ///< what a function returns; negative: an error
inline constexpr Status kSuccess = 0;
inline constexpr auto kTimeout = static_cast<Status>(0xE2010004);
inline constexpr auto kNotConnected = static_cast<Status>(0xE2010005);
inline constexpr auto kNotAvailable = static_cast<Status>(0xE7010002);
inline constexpr auto kUnsupported = static_cast<Status>(0xE7010006);

/// Kinds of messages that are read.
/// @{
inline constexpr std::int32_t kConnection = 1;
inline constexpr std::int32_t kConnectionLost = 2;
inline constexpr std::int32_t kDevice = 3;
inline constexpr std::int32_t kTracking = 0x100;
inline constexpr std::int32_t kDeviceLost = 0x104;
inline constexpr std::int32_t kTrackingMode = 0x10b;
/// @}

inline constexpr std::uint32_t kManyDevices = 1;       ///< flag of a connection
inline constexpr std::uint64_t kBackgroundFrames = 1;  ///< policy: frames without the focus

#pragma pack(push, 1)

/// Handles, which only the library can read.
/// @{
using ConnectionHandle = struct OpaqueConnection*;
using DeviceHandle = struct OpaqueDevice*;
using RebaserHandle = struct OpaqueRebaser*;
/// @}

/// How a connection is made.
struct ConnectionConfig {
  std::uint32_t size;
  std::uint32_t flags;
  const char* server_namespace;
  std::uint32_t tracking_origin;
};

/// The newest message of a connection. Valid until the next poll.
struct Message {
  std::uint32_t size;
  std::int32_t type;
  const void* event;
  std::uint32_t device_id;
};

/// A device that can be opened.
struct DeviceRef {
  void* handle;
  std::uint32_t id;
};

/// Of kDevice and kDeviceLost.
struct DeviceEvent {
  std::uint32_t flags;
  DeviceRef device;
  std::uint32_t status;
};

/// The properties of a device up to its serial number.
struct DeviceInfo {
  std::uint32_t size;
  std::uint32_t status;
  std::uint32_t caps;
  std::uint32_t product;
  std::uint32_t baseline_um;
  std::uint32_t serial_length;
  char* serial;
  float horizontal_fov_rad, vertical_fov_rad;
  std::uint32_t range_um;
  char firmware[16];
};

/// Of kTrackingMode.
struct ModeEvent {
  std::uint32_t reserved;
  std::int32_t mode;
};

struct Vector {
  float x, y, z;
};
struct Quaternion {
  float x, y, z, w;
};

/// A bone from its root to its tip.
struct Bone {
  Vector root;
  Vector tip;
  float width;          ///< of the flesh around it
  Quaternion rotation;  ///< device from bone: +y out of the back of the hand, -z to the tip
};

/// A finger: metacarpal, proximal, intermediate and distal bone. The thumb's first one has no
/// length.
struct Digit {
  std::int32_t finger;
  Bone bones[4];
  std::uint32_t is_extended;
};

struct Palm {
  Vector position, stabilized_position, velocity;
  Vector normal;  ///< out of the palm
  float width;
  Vector direction;  ///< to the fingers
  Quaternion orientation;
};

struct Hand {
  std::uint32_t id;
  std::uint32_t flags;
  std::int32_t type;  ///< 0: left, 1: right
  float confidence;   ///< today's services always say 1
  std::uint64_t visible_us;
  float pinch_distance, grab_angle, pinch_strength, grab_strength;
  Palm palm;
  Digit digits[5];  ///< thumb to little finger
  Bone arm;         ///< from the elbow to the wrist
};

/// Of kTracking.
struct TrackingEvent {
  void* reserved;
  std::int64_t frame_id;
  std::int64_t timestamp_us;
  std::int64_t tracking_frame_id;
  std::uint32_t hand_count;
  const Hand* hands;
  float framerate;
};

/// A version; part 0 is that of the library, 2 that of the service.
struct Version {
  std::int32_t major, minor, patch;
};

#pragma pack(pop)

// The layout of LeapC 5 and 6 on 64-bit machines.
static_assert(sizeof(ConnectionConfig) == 20);
static_assert(sizeof(Message) == 20 && offsetof(Message, event) == 8);
static_assert(sizeof(DeviceEvent) == 20 && offsetof(DeviceEvent, status) == 16);
static_assert(offsetof(DeviceInfo, serial) == 24 && sizeof(DeviceInfo) == 60);
static_assert(sizeof(Bone) == 44 && offsetof(Bone, rotation) == 28);
static_assert(sizeof(Digit) == 184 && offsetof(Digit, bones) == 4);
static_assert(sizeof(Palm) == 80 && offsetof(Palm, orientation) == 64);
static_assert(offsetof(Hand, palm) == 40 && offsetof(Hand, digits) == 120);
static_assert(offsetof(Hand, arm) == 1040 && sizeof(Hand) == 1084);
static_assert(offsetof(TrackingEvent, tracking_frame_id) == 24);
static_assert(offsetof(TrackingEvent, hands) == 36 && sizeof(TrackingEvent) == 48);

/// The functions that are called.
struct Functions {
  std::int64_t (*now_us)();
  Status (*create_connection)(const ConnectionConfig*, ConnectionHandle*);
  Status (*open_connection)(ConnectionHandle);
  Status (*poll)(ConnectionHandle, std::uint32_t timeout_ms, Message*);
  void (*close_connection)(ConnectionHandle);
  void (*destroy_connection)(ConnectionHandle);
  Status (*set_policies)(ConnectionHandle, std::uint64_t set, std::uint64_t clear);
  Status (*set_mode)(ConnectionHandle, std::int32_t mode);
  Status (*open_device)(DeviceRef, DeviceHandle*);
  void (*close_device)(DeviceHandle);
  Status (*device_info)(DeviceHandle, DeviceInfo*);
  Status (*create_rebaser)(RebaserHandle*);
  Status (*update_rebaser)(RebaserHandle, std::int64_t ours_us, std::int64_t theirs_us);
  Status (*rebase)(RebaserHandle, std::int64_t ours_us, std::int64_t* theirs_us);
  void (*destroy_rebaser)(RebaserHandle);
  /// Since version 5.2 and 5.4; null in older ones.
  /// @{
  Status (*version)(ConnectionHandle, std::int32_t part, Version*);
  Status (*subscribe)(ConnectionHandle, DeviceHandle);
  /// @}
};

}  // namespace handcast::pose::leapc
