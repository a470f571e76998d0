// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <xf86drmMode.h>

#include <memory>

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

}  // namespace handcast::renderer::kms
