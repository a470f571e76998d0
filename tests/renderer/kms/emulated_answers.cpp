// SPDX-License-Identifier: Apache-2.0
// The ioctls that ask the card for something or make an object.
#include <drm_fourcc.h>

#include <algorithm>
#include <cerrno>

#include "tests/renderer/kms/emulated_kernel.hpp"

namespace handcast::test {
namespace {

/// The struct that an ioctl points to.
template <class T>
T& in(void* argument) {
  return *static_cast<T*>(argument);
}

/// Answers a question for a list as the kernel does: how many there are, and as many as fit.
template <class T, class Count>
void answer_list(const std::vector<T>& list, std::uint64_t pointer, Count& count) {
  if (count >= list.size() && pointer != 0) std::copy(list.begin(), list.end(), at<T>(pointer));
  count = static_cast<Count>(list.size());
}

}  // namespace

int EmulatedCard::Kernel::get_capability(drm_get_cap& cap) const {
  cap.value = 0;
  if (cap.capability == DRM_CAP_DUMB_BUFFER) cap.value = faults_.has_dumb_buffers ? 1 : 0;
  if (cap.capability == DRM_CAP_TIMESTAMP_MONOTONIC)
    cap.value = faults_.has_monotonic_times ? 1 : 0;
  return 0;
}

int EmulatedCard::Kernel::set_capability(File& file, const drm_set_client_cap& cap) const {
  if (cap.capability == DRM_CLIENT_CAP_UNIVERSAL_PLANES) file.sees_all_planes = cap.value != 0;
  if (cap.capability != DRM_CLIENT_CAP_ATOMIC) return 0;
  if (!faults_.has_atomic) return -EOPNOTSUPP;
  file.is_atomic = file.sees_all_planes = cap.value != 0;
  return 0;
}

int EmulatedCard::Kernel::get_resources(drm_mode_card_res& resources) const {
  if (!faults_.has_displays) return -EOPNOTSUPP;
  std::vector<Id> connectors, encoders;
  for (const auto& connector : connectors_) {
    connectors.push_back(connector.id);
    encoders.push_back(connector.encoder);
  }
  answer_list(std::vector<Id>(kCrtcs.begin(), kCrtcs.end()), resources.crtc_id_ptr,
              resources.count_crtcs);
  answer_list(connectors, resources.connector_id_ptr, resources.count_connectors);
  answer_list(encoders, resources.encoder_id_ptr, resources.count_encoders);
  resources.count_fbs = 0;
  resources.max_width = resources.max_height = 8192;
  return 0;
}

int EmulatedCard::Kernel::get_connector(drm_mode_get_connector& wanted) {
  const auto found = std::ranges::find(connectors_, wanted.connector_id, &Connector::id);
  if (found == connectors_.end()) return -ENOENT;
  if (wanted.count_modes == 0) ++probes_;
  wanted.connector_type = found->type;
  wanted.connector_type_id = 1;
  wanted.connection = found->modes.empty() ? DRM_MODE_DISCONNECTED : DRM_MODE_CONNECTED;
  wanted.encoder_id = value(found->id, "CRTC_ID") != 0 ? found->encoder : 0;
  answer_list(found->modes, wanted.modes_ptr, wanted.count_modes);
  answer_list(std::vector<Id>{found->encoder}, wanted.encoders_ptr, wanted.count_encoders);
  drm_mode_obj_get_properties properties{wanted.props_ptr, wanted.prop_values_ptr,
                                         wanted.count_props, found->id, 0};
  get_properties(properties);
  wanted.count_props = properties.count_props;
  return 0;
}

int EmulatedCard::Kernel::get_encoder(drm_mode_get_encoder& encoder) const {
  const auto found = std::ranges::find(connectors_, encoder.encoder_id, &Connector::encoder);
  if (found == connectors_.end()) return -ENOENT;
  encoder.possible_crtcs = found->possible_crtcs;
  encoder.crtc_id = static_cast<Id>(value(found->id, "CRTC_ID"));
  return 0;
}

int EmulatedCard::Kernel::get_planes(const File& file, drm_mode_get_plane_res& planes) const {
  std::vector<Id> ids;
  for (const auto& plane : planes_)
    if (file.sees_all_planes) ids.push_back(plane.id);
  answer_list(ids, planes.plane_id_ptr, planes.count_planes);
  return 0;
}

int EmulatedCard::Kernel::get_plane(drm_mode_get_plane& plane) const {
  const auto found = std::ranges::find(planes_, plane.plane_id, &Plane::id);
  if (found == planes_.end()) return -ENOENT;
  plane.crtc_id = static_cast<Id>(value(found->id, "CRTC_ID"));
  plane.fb_id = static_cast<Id>(value(found->id, "FB_ID"));
  plane.possible_crtcs = found->possible_crtcs;
  std::vector<std::uint32_t> formats{DRM_FORMAT_XRGB8888};
  if (faults_.has_red_first) formats.push_back(DRM_FORMAT_XBGR8888);
  answer_list(formats, plane.format_type_ptr, plane.count_format_types);
  return 0;
}

int EmulatedCard::Kernel::get_properties(drm_mode_obj_get_properties& wanted) const {
  std::vector<Id> ids;
  std::vector<std::uint64_t> values;
  for (const auto& [key, value] : values_) {
    if (key.first != wanted.obj_id) continue;
    ids.push_back(key.second);
    values.push_back(value);
  }
  if (ids.empty()) return -ENOENT;
  auto count = wanted.count_props;
  answer_list(ids, wanted.props_ptr, count);
  answer_list(values, wanted.prop_values_ptr, wanted.count_props);
  return 0;
}

int EmulatedCard::Kernel::get_property(drm_mode_get_property& wanted) const {
  const auto found = properties_.find(wanted.prop_id);
  if (found == properties_.end()) return -ENOENT;
  wanted.flags = found->second.flags;
  found->second.name.copy(wanted.name, sizeof wanted.name - 1);
  wanted.count_values = wanted.count_enum_blobs = 0;
  return 0;
}

int EmulatedCard::Kernel::get_blob(drm_mode_get_blob& wanted) const {
  const auto found = blobs_.find(wanted.blob_id);
  if (found == blobs_.end()) return -ENOENT;
  answer_list(found->second, wanted.data, wanted.length);
  return 0;
}

int EmulatedCard::Kernel::create_dumb(drm_mode_create_dumb& wanted) {
  wanted.pitch = (wanted.width * wanted.bpp / 8 + 255) / 256 * 256;  // longer than a row
  wanted.size = (std::uint64_t{wanted.pitch} * wanted.height + 4095) / 4096 * 4096;
  if (memory_used_ + wanted.size > kMemory) return -ENOMEM;
  wanted.handle = ++next_id_;
  dumb_[wanted.handle] = {memory_used_, wanted.size};
  memory_used_ += wanted.size;
  return 0;
}

int EmulatedCard::Kernel::add_framebuffer(int fd, drm_mode_fb_cmd2& wanted) {
  const auto memory = dumb_.find(wanted.handles[0]);
  if (memory == dumb_.end()) return -ENOENT;
  const bool is_known = wanted.pixel_format == DRM_FORMAT_XRGB8888 ||
                        (wanted.pixel_format == DRM_FORMAT_XBGR8888 && faults_.has_red_first);
  if (!is_known || wanted.pitches[0] < 4 * wanted.width ||
      std::uint64_t{wanted.pitches[0]} * wanted.height > memory->second.size)
    return -EINVAL;
  wanted.fb_id = ++next_id_;
  framebuffers_[wanted.fb_id] = {fd,
                                 wanted.width,
                                 wanted.height,
                                 wanted.pitches[0],
                                 wanted.pixel_format,
                                 memory->second.offset};
  return 0;
}

int EmulatedCard::Kernel::ioctl(int fd, unsigned long request, void* argument) {
  const std::lock_guard lock(mutex_);
  auto& file = files_.at(fd);
  switch (request) {
    case DRM_IOCTL_GET_CAP:
      return get_capability(in<drm_get_cap>(argument));
    case DRM_IOCTL_SET_CLIENT_CAP:
      return set_capability(file, in<drm_set_client_cap>(argument));
    case DRM_IOCTL_AUTH_MAGIC:
      return file.is_master ? -EINVAL : -EACCES;
    case DRM_IOCTL_SET_MASTER:
      return file.is_master ? 0 : faults_.has_other_master ? -EBUSY : -EACCES;
    case DRM_IOCTL_MODE_GETRESOURCES:
      return get_resources(in<drm_mode_card_res>(argument));
    case DRM_IOCTL_MODE_GETCONNECTOR:
      return get_connector(in<drm_mode_get_connector>(argument));
    case DRM_IOCTL_MODE_GETENCODER:
      return get_encoder(in<drm_mode_get_encoder>(argument));
    case DRM_IOCTL_MODE_GETPLANERESOURCES:
      return get_planes(file, in<drm_mode_get_plane_res>(argument));
    case DRM_IOCTL_MODE_GETPLANE:
      return get_plane(in<drm_mode_get_plane>(argument));
    case DRM_IOCTL_MODE_OBJ_GETPROPERTIES:
      return get_properties(in<drm_mode_obj_get_properties>(argument));
    case DRM_IOCTL_MODE_GETPROPERTY:
      return get_property(in<drm_mode_get_property>(argument));
    case DRM_IOCTL_MODE_GETPROPBLOB:
      return get_blob(in<drm_mode_get_blob>(argument));
    case DRM_IOCTL_MODE_CREATEPROPBLOB: {
      auto& blob = in<drm_mode_create_blob>(argument);
      blob.blob_id = add_blob(at<const void>(blob.data), blob.length);
      return 0;
    }
    case DRM_IOCTL_MODE_DESTROYPROPBLOB: {
      const auto id = in<drm_mode_destroy_blob>(argument).blob_id;
      const bool is_used =
          std::ranges::any_of(values_, [&](const auto& value) { return value.second == id; });
      if (!is_used) blobs_.erase(id);  // a state that uses it keeps it
      return 0;
    }
    case DRM_IOCTL_MODE_CREATE_DUMB:
      return create_dumb(in<drm_mode_create_dumb>(argument));
    case DRM_IOCTL_MODE_MAP_DUMB: {
      auto& map = in<drm_mode_map_dumb>(argument);
      if (!dumb_.contains(map.handle)) return -ENOENT;
      map.offset = dumb_.at(map.handle).offset;
      return 0;
    }
    case DRM_IOCTL_MODE_DESTROY_DUMB:
      dumb_.erase(in<drm_mode_destroy_dumb>(argument).handle);
      return 0;
    case DRM_IOCTL_MODE_ADDFB2:
      return add_framebuffer(fd, in<drm_mode_fb_cmd2>(argument));
    case DRM_IOCTL_MODE_RMFB:
      remove_framebuffer(in<std::uint32_t>(argument));
      return 0;
    case DRM_IOCTL_MODE_ATOMIC:
      return commit(fd, in<drm_mode_atomic>(argument));
    default:
      return -EINVAL;
  }
}

}  // namespace handcast::test
