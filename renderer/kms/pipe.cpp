// SPDX-License-Identifier: Apache-2.0
#include "renderer/kms/pipe.hpp"

#include <drm_fourcc.h>
#include <fmt/format.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace handcast::renderer::kms {
namespace {

/// What a Screen changes.
constexpr std::array<std::string_view, 2> kOfCrtc{"ACTIVE", "VRR_ENABLED"};
constexpr std::array<std::string_view, 4> kBlobsOfCrtc{"MODE_ID", "GAMMA_LUT", "DEGAMMA_LUT",
                                                       "CTM"};
constexpr std::array<std::string_view, 10> kOfPlane{
    "FB_ID", "CRTC_ID", "SRC_X", "SRC_Y", "SRC_W", "SRC_H", "CRTC_X", "CRTC_Y", "CRTC_W", "CRTC_H"};

/// A bit for each CRTC that the connector can be driven by.
std::uint32_t possible_crtcs(int card, std::uint32_t connector_id) {
  const Owned<drmModeConnector> connector(drmModeGetConnectorCurrent(card, connector_id));
  std::uint32_t possible = 0;
  for (int i = 0; connector && i < connector->count_encoders; ++i)
    if (const Owned<drmModeEncoder> encoder(drmModeGetEncoder(card, connector->encoders[i]));
        encoder)
      possible |= encoder->possible_crtcs;
  return possible;
}

std::uint32_t crtc_of(int card, std::uint32_t connector_id) {
  const auto connector = Object::read(card, connector_id, DRM_MODE_OBJECT_CONNECTOR);
  return static_cast<std::uint32_t>(connector.value("CRTC_ID"));
}

/// The index of the CRTC: the one that drives the connector now, or the first free one.
std::optional<int> choose_crtc(int card, const drmModeRes& resources, std::uint32_t connector_id) {
  const std::span crtcs(resources.crtcs, static_cast<std::size_t>(resources.count_crtcs));
  std::uint32_t possible = possible_crtcs(card, connector_id);
  const std::uint32_t present = crtc_of(card, connector_id);
  for (int i = 0; i < resources.count_connectors; ++i) {
    const std::uint32_t other = resources.connectors[i];
    if (const auto taken = std::ranges::find(crtcs, crtc_of(card, other));
        other != connector_id && taken != crtcs.end())
      possible &= ~(1u << (taken - crtcs.begin()));
  }
  std::optional<int> free;
  for (int i = 0; i < resources.count_crtcs; ++i) {
    if ((possible >> i & 1) == 0) continue;
    if (crtcs[static_cast<std::size_t>(i)] == present) return i;
    if (!free) free = i;
  }
  return free;
}

bool has_format(const drmModePlane& plane, std::uint32_t format) {
  return std::find(plane.formats, plane.formats + plane.count_formats, format) !=
         plane.formats + plane.count_formats;
}

/// Finds the plane of the picture and those above it.
void find_planes(int card, int crtc_index, Pipe& pipe) {
  const Owned<drmModePlaneRes> planes(drmModeGetPlaneResources(card));
  for (std::uint32_t i = 0; planes && i < planes->count_planes; ++i) {
    const Owned<drmModePlane> plane(drmModeGetPlane(card, planes->planes[i]));
    if (!plane) continue;
    auto object = Object::read(card, plane->plane_id, DRM_MODE_OBJECT_PLANE);
    const bool is_here = plane->crtc_id == pipe.crtc.id();
    const bool fits = object.value("type") == DRM_PLANE_TYPE_PRIMARY &&
                      (plane->possible_crtcs >> crtc_index & 1) != 0 &&
                      (is_here || plane->crtc_id == 0);
    if (fits && (pipe.plane.id() == 0 || is_here)) {
      pipe.order =
          has_format(*plane, DRM_FORMAT_XBGR8888) ? PixelOrder::red_first : PixelOrder::blue_first;
      pipe.plane = std::move(object);
    } else if (is_here) {
      pipe.other_planes.push_back(std::move(object));
    }
  }
}

}  // namespace

Object Object::read(int card, std::uint32_t id, std::uint32_t type) {
  Object object;
  object.id_ = id;
  const Owned<drmModeObjectProperties> values(drmModeObjectGetProperties(card, id, type));
  for (std::uint32_t i = 0; values && i < values->count_props; ++i)
    if (const Owned<drmModePropertyRes> property(drmModeGetProperty(card, values->props[i]));
        property)
      object.properties_[property->name] = {property->prop_id, values->prop_values[i]};
  return object;
}

std::optional<std::uint32_t> Object::property(std::string_view name) const {
  const auto found = properties_.find(name);
  return found == properties_.end() ? std::nullopt : std::optional(found->second.id);
}

std::uint64_t Object::value(std::string_view name) const {
  const auto found = properties_.find(name);
  return found == properties_.end() ? 0 : found->second.value;
}

Blob::Blob(int card, const void* data, std::size_t bytes) : card_(card) {
  if (drmModeCreatePropertyBlob(card, data, bytes, &id_) != 0) id_ = 0;
}

Blob Blob::copy_of(int card, std::uint64_t id) {
  if (id == 0) return {};
  const Owned<drmModePropertyBlobRes> original(
      drmModeGetPropertyBlob(card, static_cast<std::uint32_t>(id)));
  return original ? Blob(card, original->data, original->length) : Blob();
}

Blob::Blob(Blob&& other) noexcept : card_(other.card_), id_(std::exchange(other.id_, 0)) {}

Blob& Blob::operator=(Blob&& other) noexcept {
  if (this == &other) return *this;
  reset();
  card_ = other.card_;
  id_ = std::exchange(other.id_, 0);
  return *this;
}

void Blob::reset() {
  if (id_ != 0) drmModeDestroyPropertyBlob(card_, id_);
  id_ = 0;
}

void Request::set(const Object& object, std::string_view name, std::uint64_t value) {
  if (const auto property = object.property(name))
    drmModeAtomicAddProperty(values_.get(), object.id(), *property, value);
}

int Request::commit(int card, std::uint32_t flags, void* user) const {
  return -drmModeAtomicCommit(card, values_.get(), flags, user);
}

Result<Pipe> find_pipe(int card, const Display& display) {
  const Owned<drmModeRes> resources(drmModeGetResources(card));
  Pipe pipe;
  if (const auto index =
          resources ? choose_crtc(card, *resources, display.connector_id) : std::nullopt) {
    pipe.connector = Object::read(card, display.connector_id, DRM_MODE_OBJECT_CONNECTOR);
    pipe.crtc = Object::read(card, resources->crtcs[*index], DRM_MODE_OBJECT_CRTC);
    find_planes(card, *index, pipe);
  }
  if (pipe.plane.id() != 0) return pipe;
  return fail(Errc::unavailable,
              fmt::format("'{}' cannot drive '{}' besides its other displays; unplug one of them",
                          display.card, display.connector));
}

Former::Former(int card, const Pipe& pipe) {
  const auto keep = [&](const Object& object, std::string_view name) {
    values_.push_back({object, name, object.value(name)});
  };
  keep(pipe.connector, "CRTC_ID");
  for (const auto name : kOfCrtc) keep(pipe.crtc, name);
  for (const auto name : kBlobsOfCrtc) {
    blobs_.push_back(Blob::copy_of(card, pipe.crtc.value(name)));
    values_.push_back({pipe.crtc, name, blobs_.back().id()});
  }
  for (const auto name : kOfPlane) keep(pipe.plane, name);
  for (const auto& plane : pipe.other_planes)
    for (const auto name : kOfPlane) keep(plane, name);
}

int Former::restore(int card) const {
  Request request;
  for (const auto& [object, name, value] : values_) request.set(object, name, value);
  return request.commit(card, DRM_MODE_ATOMIC_ALLOW_MODESET);
}

}  // namespace handcast::renderer::kms
