// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/packet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace handcast::desk::osc {
namespace {

constexpr std::string_view kBundle("#bundle\0", 8);

/// Takes a packet apart from its front. All lengths are multiples of 4.
class PacketReader {
 public:
  explicit PacketReader(Bytes bytes) : rest_(bytes) {}

  bool at_end() const { return rest_.empty(); }
  std::size_t size() const { return rest_.size(); }

  /// The bytes that follow; fewer than `count` are none, and false.
  bool take(std::size_t count, Bytes& taken) {
    if (count > rest_.size()) return false;
    taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return true;
  }
  bool text(std::string_view& text) {
    const auto end = std::ranges::find(rest_, 0);
    if (end == rest_.end()) return false;
    const auto length = static_cast<std::size_t>(end - rest_.begin());
    Bytes taken;
    if (!take((length / 4 + 1) * 4, taken)) return false;
    text = {reinterpret_cast<const char*>(taken.data()), length};
    return true;
  }
  template <class T>
  bool number(T& number) {
    Bytes taken;
    if (!take(sizeof number, taken)) return false;
    number = 0;
    for (const auto byte : taken) number = static_cast<T>(number << 8 | byte);
    return true;
  }

 private:
  Bytes rest_;
};

bool read_blob(PacketReader& reader) {
  std::uint32_t size = 0;
  Bytes ignored;
  return reader.number(size) && size <= reader.size() &&
         reader.take((static_cast<std::size_t>(size) + 3) / 4 * 4, ignored);
}

/// Reads what belongs to the type of an argument. False: the bytes are not there.
bool read_argument(PacketReader& reader, Argument& argument) {
  std::uint32_t four = 0;
  std::uint64_t eight = 0;
  switch (argument.type) {
    case 'i':
      if (!reader.number(four)) return false;
      argument.number = static_cast<std::int32_t>(four);
      return true;
    case 'f':
      if (!reader.number(four)) return false;
      argument.number = static_cast<double>(std::bit_cast<float>(four));
      return true;
    case 'h':
      if (!reader.number(eight)) return false;
      argument.number = static_cast<double>(static_cast<std::int64_t>(eight));
      return true;
    case 'd':
      if (!reader.number(eight)) return false;
      argument.number = std::bit_cast<double>(eight);
      return true;
    case 's':
    case 'S':
      return reader.text(argument.text);
    case 'b':
      return read_blob(reader);
    case 't':
      return reader.number(eight);
    case 'c':
    case 'r':
    case 'm':
      return reader.number(four);
    case 'T':
      argument.number = 1;
      return true;
    default:
      return true;  // F, N, I
  }
}

template <class T>
void put_number(std::string& bytes, T number) {
  for (int shift = 8 * (static_cast<int>(sizeof number) - 1); shift >= 0; shift -= 8)
    bytes += static_cast<char>(number >> shift & 0xff);
}

}  // namespace

bool is_bundle(Bytes packet) { return !packet.empty() && packet.front() == '#'; }

Result<Message> read_message(Bytes packet) {
  PacketReader reader(packet);
  Message message;
  if (!reader.text(message.address))
    return fail(Errc::bad_data, "a message whose address does not end was dropped");
  if (!message.address.starts_with('/'))
    return fail(Errc::bad_data,
                "a packet that is no OSC was dropped: its address begins without '/'");
  if (reader.at_end()) return message;  // of old senders: no type tags, no arguments
  std::string_view types;
  if (!reader.text(types) || !types.starts_with(','))
    return fail(Errc::bad_data, "a message without type tags was dropped");
  for (const char type : types.substr(1)) {
    if (type == '[' || type == ']') continue;  // a list counts as its elements
    if (std::string_view("ihfdsSbtcrmTFNI").find(type) == std::string_view::npos)
      return fail(Errc::bad_data, "a message with an unknown type of argument was dropped");
    if (message.count == kMostArguments)
      return fail(Errc::bad_data,
                  fmt::format("a message with more than {} arguments was dropped", kMostArguments));
    auto& argument = message.all[message.count++];
    argument.type = type;
    if (!read_argument(reader, argument))
      return fail(Errc::bad_data, "a message that ends within its arguments was dropped");
  }
  if (!reader.at_end())
    return fail(Errc::bad_data, "a message with bytes behind its arguments was dropped");
  return message;
}

Result<Bundle> read_bundle(Bytes packet) {
  PacketReader reader(packet);
  Bundle bundle;
  Bytes head;
  if (!reader.take(kBundle.size(), head) ||
      std::memcmp(head.data(), kBundle.data(), kBundle.size()) != 0 ||
      !reader.number(bundle.time_tag))
    return fail(Errc::bad_data, "a bundle without a time was dropped");
  while (!reader.at_end()) {
    std::uint32_t size = 0;
    Bytes element;
    if (!reader.number(size) || size == 0 || size % 4 != 0 || !reader.take(size, element))
      return fail(Errc::bad_data, "a bundle was dropped: the length of an element is impossible");
    bundle.elements.push_back(element);
  }
  return bundle;
}

MessageWriter& MessageWriter::add(float number) {
  types_ += 'f';
  put_number(arguments_, std::bit_cast<std::uint32_t>(number));
  return *this;
}

MessageWriter& MessageWriter::add(std::int32_t number) {
  types_ += 'i';
  put_number(arguments_, static_cast<std::uint32_t>(number));
  return *this;
}

MessageWriter& MessageWriter::add(std::string_view text) {
  types_ += 's';
  put_text(arguments_, text);
  return *this;
}

MessageWriter& MessageWriter::add(bool flag) {
  types_ += flag ? 'T' : 'F';
  return *this;
}

std::string MessageWriter::packet() const {
  std::string packet = packet_;
  put_text(packet, types_);
  return packet + arguments_;
}

void MessageWriter::put_text(std::string& bytes, std::string_view text) {
  bytes += text.substr(0, text.find('\0'));
  do bytes += '\0';
  while (bytes.size() % 4 != 0);
}

std::string write_bundle(std::span<const std::string> packets) {
  std::string bundle(kBundle);
  put_number(bundle, kAtOnce);
  for (const auto& packet : packets) {
    put_number(bundle, static_cast<std::uint32_t>(packet.size()));
    bundle += packet;
  }
  return bundle;
}

}  // namespace handcast::desk::osc
