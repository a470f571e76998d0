// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>

#include "ipc/base/input_file.hpp"
#include "services/evaluation/twin/recording.hpp"

namespace handcast::twin {
namespace {

using std::filesystem::path;

constexpr std::string_view kMagic = "\x93NUMPY";

struct Layout {
  std::string type;
  std::vector<std::size_t> shape;
  std::size_t data_offset = 0;
};

tl::unexpected<Error> damaged(const path& file, std::string_view what) {
  return fail(Errc::bad_data, fmt::format("{}: {}", file.string(), what));
}

/// The header from the value of `key` on; empty if the key is missing.
std::string_view value_of(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(fmt::format("'{}':", key));
  if (at == std::string_view::npos) return {};
  std::string_view value = header.substr(at + key.size() + 3);
  value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
  return value;
}

/// Parses a tuple: "(553, 42, 3)" -> {553, 42, 3}. Returns false if `text` does not begin with one.
bool parse_shape(std::string_view text, std::vector<std::size_t>& shape) {
  if (text.empty() || text.front() != '(') return false;
  const std::size_t end = text.find(')');
  if (end == std::string_view::npos) return false;
  std::size_t number = 0;
  bool digits = false;
  for (const char c : text.substr(1, end)) {
    if (c >= '0' && c <= '9') {
      if (number > std::numeric_limits<std::uint32_t>::max()) return false;
      number = number * 10 + static_cast<std::size_t>(c - '0');
      digits = true;
    } else if (c == ',' || c == ')') {
      if (digits) shape.push_back(number);
      number = 0;
      digits = false;
    } else if (c != ' ') {
      return false;
    }
  }
  return true;
}

/// Parses the prefix and the header's dictionary (NumPy enhancement proposal NEP 1).
Result<Layout> parse_layout(const path& file, std::string_view bytes) {
  if (bytes.size() < 12 || bytes.substr(0, 6) != kMagic)
    return damaged(file, "not a NumPy array file");
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i]));
  };
  const std::size_t version = byte(6);
  if (version < 1 || version > 3)
    return damaged(
        file, fmt::format("NumPy format version {} is unknown; 1 to 3 are supported", version));
  const std::size_t start = version == 1 ? 10 : 12;
  std::size_t length = byte(8) | byte(9) << 8;
  if (version > 1) length |= byte(10) << 16 | byte(11) << 24;
  if (length > bytes.size() - start) return damaged(file, "the header is truncated");

  const std::string_view header = bytes.substr(start, length);
  Layout layout;
  layout.data_offset = start + length;
  const std::string_view type = value_of(header, "descr");
  if (type.size() < 5 || type[0] != '\'' || type[4] != '\'')
    return damaged(file, "the header has no plain number type");
  layout.type = type.substr(1, 3);
  if (!value_of(header, "fortran_order").starts_with("False"))
    return damaged(file, "the array is not in C order");
  if (!parse_shape(value_of(header, "shape"), layout.shape))
    return damaged(file, "the header has no valid shape");
  return layout;
}

template <class T>
void convert(std::string_view data, std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    T value;
    std::memcpy(&value, data.data() + i * sizeof(T), sizeof(T));
    values[i] = static_cast<double>(value);
  }
}

Result<void> write_array(const path& file, std::string_view type,
                         const std::vector<std::size_t>& shape, const void* data,
                         std::size_t bytes) {
  std::string tuple;
  for (const std::size_t extent : shape) tuple += fmt::format("{}, ", extent);
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, tuple);
  header.append(63 - (10 + header.size()) % 64, ' ');
  header += '\n';

  std::ofstream out(file, std::ios::binary);
  out << kMagic << '\x01' << '\0' << static_cast<char>(header.size() & 255)
      << static_cast<char>(header.size() >> 8) << header;
  out.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
  if (!out.flush())
    return fail(Errc::unavailable, fmt::format("{}: cannot be written", file.string()));
  return {};
}

}  // namespace

Result<Npy> read_npy(const path& file) {
  const auto bytes = read_input(file, kMostArray);
  if (!bytes) return tl::make_unexpected(bytes.error());
  const auto layout = parse_layout(file, *bytes);
  if (!layout) return tl::make_unexpected(layout.error());

  const std::string& type = layout->type;
  if (type != "<f4" && type != "<f8" && type != "<i4" && type != "<i8")
    return damaged(
        file,
        fmt::format("the array holds '{}'; '<f4', '<f8', '<i4' and '<i8' are supported", type));
  const std::size_t size = type[2] == '4' ? 4 : 8;
  const std::string_view data = std::string_view(*bytes).substr(layout->data_offset);
  std::size_t count = 1;
  for (const std::size_t extent : layout->shape) {
    if (extent != 0 && count > data.size() / extent) return damaged(file, "the array is truncated");
    count *= extent;
  }
  if (data.size() != count * size)
    return damaged(file, fmt::format("the array has {} bytes, but its shape requires {}",
                                     data.size(), count * size));

  Npy array{layout->shape, std::vector<double>(count)};
  if (type == "<f4") convert<float>(data, array.values);
  if (type == "<f8") convert<double>(data, array.values);
  if (type == "<i4") convert<std::int32_t>(data, array.values);
  if (type == "<i8") convert<std::int64_t>(data, array.values);
  return array;
}

Result<void> write_npy_f32(const path& file, const std::vector<std::size_t>& shape,
                           const std::vector<float>& values) {
  return write_array(file, "<f4", shape, values.data(), values.size() * sizeof(float));
}

Result<void> write_npy_i64(const path& file, const std::vector<std::int64_t>& values) {
  return write_array(file, "<i8", {values.size()}, values.data(),
                     values.size() * sizeof(std::int64_t));
}

}  // namespace handcast::twin
