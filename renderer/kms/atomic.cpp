// SPDX-License-Identifier: Apache-2.0
#include "renderer/kms/atomic.hpp"

#include <xf86drm.h>
#include <xf86drmMode.h>

#include <utility>

namespace handcast::renderer::kms {

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

}  // namespace handcast::renderer::kms
