// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <vector>

#include "ipc/daemon/attached.hpp"
#include "services/camera/aravis/glib.hpp"

namespace handcast::camera::aravis {

/// A camera that Aravis has found.
struct Device {
  std::string id;       ///< Aravis's name of it: "Basler-23456789"
  std::string serial;   ///< its serial number
  std::string address;  ///< GigE Vision: its IP address; USB3 Vision: its GUID
  std::string vendor;
  std::string model;
  std::string protocol;  ///< "GigEVision", "USB3Vision", "Fake"

  bool is_gige() const { return protocol == "GigEVision"; }
};

/// Asks the networks and the USB for cameras, which takes about a second.
std::vector<Device> list_devices();

/// The cameras that `name` means: serial number, id, address or model; empty: all. One that answers
/// at its address need not be on a network that is asked.
std::vector<Device> devices_called(const std::string& name);

/// The only camera that `name` means. Errors: unavailable (no camera, none of this name),
/// bad_config (several fit). The sentence lists those that are there.
Result<Device> find_device(const std::string& name);

/// Opens a camera. If its address is known, without looking for it. Errors: unavailable (it does
/// not answer, or another program controls it).
Result<Owned<ArvCamera>> open_device(const Device& device);

/// The device with the names that the open camera says of itself. They are not known of one that
/// was found by its address, and another camera may have taken its place since.
Device with_its_names(ArvCamera* camera, Device device);

/// What the sensor of a camera can do, as the camera is set now.
struct Sensor {
  int least_width_px = 0, least_height_px = 0;  ///< of a region
  int width_px = 0, height_px = 0;              ///< of all of it
  double rate_hz = 0;                           ///< the highest; 0: the camera does not say
};
/// Changes nothing in the camera. Errors: unavailable, bad_config (it has no such features).
Result<Sensor> sensor_of(ArvCamera* camera);

/// What a calibration may call the camera: its serial number, Aravis's name, address, and vendor
/// with model. Parts that are not known are empty.
std::array<std::string, 4> names_of(const Device& device);

/// The cameras for `handcast devices` and the doctor. Takes about a second.
std::vector<daemon::Attached> attached(const daemon::Search& search);

/// Finds out quickly, without Aravis, whether an absent camera has come back.
class Presence {
 public:
  explicit Presence(const Device& device) : device_(device) {}
  /// True if the camera answers. Takes at most 20 ms (GigE Vision), or the time to list the USB.
  bool is_there() const;

 private:
  Device device_;
};

}  // namespace handcast::camera::aravis
