// SPDX-License-Identifier: Apache-2.0
#include "services/recording/arrays/npy.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <span>
#include <string_view>

#include "ipc/base/input_file.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/output_file.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::recording {
namespace {

using std::filesystem::path;

constexpr std::string_view kMagic = "\x93NUMPY";

struct Layout {
  std::string type;
  std::vector<std::size_t> shape;
  std::size_t data_offset = 0;

  std::size_t number_bytes() const { return type[2] == '4' ? 4 : 8; }
};

/// The line of numpy that writes the array as it is read; the end of a sentence.
std::string remedy(const path& file, std::string_view type) {
  const auto name = file.filename().string();
  return fmt::format("; in Python, numpy.save('{0}', numpy.load('{0}').astype('{1}', order='C'))",
                     name, type);
}

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

constexpr std::array<std::string_view, 4> kNumbers{"<f4", "<f8", "<i4", "<i8"};
constexpr std::array<std::string_view, 1> kBytes{"|u1"};

/// Parses the prefix and the header's dictionary (NumPy enhancement proposal NEP 1). `types`: those
/// that the caller can read.
Result<Layout> parse_layout(const path& file, std::string_view bytes,
                            std::span<const std::string_view> types) {
  if (bytes.size() < 12 || bytes.substr(0, 6) != kMagic)
    return damaged(file, bytes.starts_with("MATLAB")
                             ? fmt::format("a file of MATLAB; in Python, numpy.save('{}.npy', "
                                           "scipy.io.loadmat('{}')['the name of the array'])",
                                           file.stem().string(), file.filename().string())
                             : "not a NumPy array file");
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
    return damaged(file, "the header has no plain number type; save one array of numbers");
  layout.type = type.substr(1, 3);
  if (std::ranges::find(types, layout.type) == types.end())
    return damaged(file, fmt::format("the array holds {}; '{}' {} supported{}", quote(layout.type),
                                     join(types, "', '"), types.size() > 1 ? "are" : "is",
                                     types.size() > 1 ? remedy(file, "<f8") : std::string()));
  if (!value_of(header, "fortran_order").starts_with("False"))
    return damaged(file, "the array is not in C order" + remedy(file, layout.type));
  if (!parse_shape(value_of(header, "shape"), layout.shape))
    return damaged(file, "the header has no valid shape");
  return layout;
}

template <class T>
void append(std::string_view data, std::vector<double>& values) {
  for (; data.size() >= sizeof(T); data.remove_prefix(sizeof(T))) {
    T value;
    std::memcpy(&value, data.data(), sizeof(T));
    values.push_back(static_cast<double>(value));
  }
}

Result<void> write_array(const path& file, std::string_view type,
                         const std::vector<std::size_t>& shape, const void* data,
                         std::size_t bytes) {
  if (auto possible = check_output(file); !possible) return possible;
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

/// Reads up to `most` bytes, from the present place of the file.
Result<std::string> read_some(int fd, std::size_t most, const path& file) {
  std::string bytes(most, '\0');
  std::size_t count = 0;
  while (count < most) {
    const auto got = ::read(fd, bytes.data() + count, most - count);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return damaged(file, std::strerror(errno));
    if (got == 0) break;
    count += static_cast<std::size_t>(got);
  }
  bytes.resize(count);
  return bytes;
}

/// Appends the numbers in `data`.
void append(std::string_view type, std::string_view data, std::vector<double>& values) {
  if (type == "<f4") append<float>(data, values);
  if (type == "<f8") append<double>(data, values);
  if (type == "<i4") append<std::int32_t>(data, values);
  if (type == "<i8") append<std::int64_t>(data, values);
}

/// The number of elements. Errors: bad_data (more than kMostNumbers, or not as many as the file
/// has bytes for).
Result<std::size_t> count_of(const path& file, const Layout& layout, std::size_t data_bytes) {
  constexpr std::size_t kMostNumbers = 40'000'000;
  std::size_t count = 1;
  for (const std::size_t extent : layout.shape) {
    if (extent != 0 && count > kMostNumbers / extent)
      return damaged(file, fmt::format("the array has more than {} numbers", kMostNumbers));
    count *= extent;
  }
  const std::size_t needed = count * layout.number_bytes();
  if (data_bytes != needed)
    return damaged(file, fmt::format("the array {}: it has {} bytes, but its shape requires {}",
                                     data_bytes < needed ? "is truncated" : "is too long",
                                     data_bytes, needed));
  return count;
}

}  // namespace

constexpr std::size_t kLongestHeader = 1 << 16;

Result<NpyFile> NpyFile::open(const path& file) {
  auto fd = open_input(file, kMostArray);
  if (!fd) return tl::make_unexpected(fd.error());
  struct stat status {};
  if (::fstat(fd->get(), &status) != 0) return damaged(file, std::strerror(errno));
  const auto size = static_cast<std::uint64_t>(status.st_size);
  const auto begin = read_some(fd->get(), kLongestHeader, file);
  if (!begin) return tl::make_unexpected(begin.error());
  auto layout = parse_layout(file, *begin, kNumbers);
  if (!layout) return tl::make_unexpected(layout.error());
  const auto count = count_of(file, *layout, size - std::min(size, layout->data_offset));
  if (!count) return tl::make_unexpected(count.error());
  return NpyFile(file, std::move(*fd), std::move(layout->type), std::move(layout->shape),
                 layout->data_offset, *count);
}

Result<NpyBytes> open_npy_bytes(const path& file) {
  auto fd = open_input(file, std::numeric_limits<std::int64_t>::max());
  if (!fd) return tl::make_unexpected(fd.error());
  struct stat status {};
  if (::fstat(fd->get(), &status) != 0) return damaged(file, std::strerror(errno));
  const auto begin = read_some(fd->get(), kLongestHeader, file);
  if (!begin) return tl::make_unexpected(begin.error());
  auto layout = parse_layout(file, *begin, kBytes);
  if (!layout) return tl::make_unexpected(layout.error());
  std::uint64_t needed = 1;
  bool fits = true;
  for (const std::size_t extent : layout->shape)
    fits = fits && !__builtin_mul_overflow(needed, extent, &needed);
  const auto bytes = static_cast<std::uint64_t>(status.st_size) - layout->data_offset;
  if (!fits || bytes != needed)
    return damaged(
        file, fmt::format("it has {} bytes of data, which is not what its shape requires", bytes));
  return NpyBytes{std::move(*fd), std::move(layout->shape), layout->data_offset};
}

Result<Npy> NpyFile::read() {
  constexpr std::size_t kPart_bytes = 1 << 20;
  if (::lseek(fd_.get(), static_cast<off_t>(data_offset_), SEEK_SET) < 0)
    return damaged(file_, std::strerror(errno));
  Npy array{shape_, {}};
  array.values.reserve(count_);
  while (array.values.size() < count_) {
    const auto part = read_some(fd_.get(), kPart_bytes, file_);
    if (!part) return tl::make_unexpected(part.error());
    const auto before = array.values.size();
    append(type_, *part, array.values);
    if (array.values.size() == before) return damaged(file_, "the array is truncated");
  }
  array.values.resize(count_);  // the file may have grown
  return array;
}

Result<Npy> read_npy(const path& file) {
  auto opened = NpyFile::open(file);
  if (!opened) return tl::make_unexpected(opened.error());
  return opened->read();
}

Result<void> write_npy_f32(const path& file, const std::vector<std::size_t>& shape,
                           const std::vector<float>& values) {
  return write_array(file, "<f4", shape, values.data(), values.size() * sizeof(float));
}

Result<void> write_npy_i64(const path& file, const std::vector<std::int64_t>& values) {
  return write_array(file, "<i8", {values.size()}, values.data(),
                     values.size() * sizeof(std::int64_t));
}

}  // namespace handcast::recording
