// SPDX-License-Identifier: Apache-2.0
#include "services/camera/aravis/image.hpp"

#include <utility>

namespace handcast::camera::aravis {

Image& Image::operator=(Image&& other) noexcept {
  std::swap(stream_, other.stream_);
  std::swap(buffer_, other.buffer_);
  number = other.number;
  exposed_ns = other.exposed_ns;
  exposed_error_ns = other.exposed_error_ns;
  exposure_ns = other.exposure_ns;
  lost = other.lost;
  return *this;
}

Image::~Image() {
  if (buffer_) arv_stream_push_buffer(stream_.get(), buffer_.release());
}

}  // namespace handcast::camera::aravis
