// SPDX-License-Identifier: Apache-2.0
#include "renderer/hand/array_reader.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace handcast::renderer {
namespace {

template <class Component>
double component_at(const unsigned char* row, int k, bool normalized) {
  Component value;
  std::memcpy(&value, row + sizeof(Component) * k, sizeof value);
  return normalized ? double(value) / double(std::numeric_limits<Component>::max()) : double(value);
}

double number(const tinygltf::Accessor& accessor, const unsigned char* row, int k) {
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return component_at<std::uint8_t>(row, k, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return component_at<std::int8_t>(row, k, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return component_at<std::uint16_t>(row, k, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return component_at<std::int16_t>(row, k, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return component_at<std::uint32_t>(row, k, accessor.normalized);
    case TINYGLTF_COMPONENT_TYPE_DOUBLE:
      return component_at<double>(row, k, false);
    default:
      return component_at<float>(row, k, false);
  }
}

}  // namespace

std::optional<ArrayReader::Rows> ArrayReader::locate(int index, int width, const char* what) {
  const auto refuse = [&](const char* why) {
    complain(fmt::format("its {} {}", what, why));
    return std::nullopt;
  };
  if (index < 0 || index >= std::ssize(model_.accessors)) return refuse("are missing");
  const tinygltf::Accessor& accessor = model_.accessors[index];
  if (accessor.bufferView < 0 || accessor.bufferView >= std::ssize(model_.bufferViews))
    return refuse("have no buffer view");
  const tinygltf::BufferView& view = model_.bufferViews[accessor.bufferView];
  if (view.buffer < 0 || view.buffer >= std::ssize(model_.buffers)) return refuse("have no buffer");
  const auto& buffer = model_.buffers[view.buffer].data;
  const int component =
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
  if (component <= 0 ||
      tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) != width)
    return refuse("have an unexpected type");
  const std::size_t row = static_cast<std::size_t>(component) * width,
                    stride = view.byteStride ? view.byteStride : row;
  if (accessor.count == 0) return refuse("are empty");
  if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset)
    return refuse("lie outside their buffer");
  if (accessor.byteOffset > view.byteLength || row > view.byteLength - accessor.byteOffset ||
      (accessor.count - 1) > (view.byteLength - accessor.byteOffset - row) / stride)
    return refuse("lie outside their buffer view");
  if (accessor.count > 3 * kMaxTriangles) return refuse("are too many");
  if (stride < row) return refuse("overlap");
  return Rows{buffer.data() + view.byteOffset + accessor.byteOffset, stride};
}

template <class T>
std::vector<T> ArrayReader::read(int accessor_index, int width, const char* what) {
  std::vector<T> numbers;
  const auto bytes = locate(accessor_index, width, what);
  if (!bytes) return numbers;
  const tinygltf::Accessor& accessor = model_.accessors[accessor_index];
  numbers.reserve(accessor.count * width);
  for (std::size_t row = 0; row < accessor.count; ++row)
    for (int k = 0; k < width; ++k) {
      const double value = number(accessor, bytes->data + row * bytes->stride, k);
      if (!std::isfinite(value))
        return complain(fmt::format("its {} contain a number that is not finite", what)),
               std::vector<T>{};
      if (value < double(std::numeric_limits<T>::lowest()) ||
          value > double(std::numeric_limits<T>::max()))
        return complain(fmt::format("its {} contain {:.6g}, which is out of range", what, value)),
               std::vector<T>{};
      numbers.push_back(static_cast<T>(value));
    }
  return numbers;
}

template std::vector<float> ArrayReader::read(int, int, const char*);
template std::vector<std::uint32_t> ArrayReader::read(int, int, const char*);

}  // namespace handcast::renderer
