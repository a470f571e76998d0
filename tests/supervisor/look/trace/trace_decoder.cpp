// SPDX-License-Identifier: Apache-2.0
#include "tests/supervisor/look/trace/trace_decoder.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace handcast::supervisor::test {
namespace {

struct Field {
  std::uint64_t number = 0;  ///< of a varint or fixed64
  std::string_view bytes;    ///< of what has a length
};
using Message = std::multimap<int, Field>;

[[noreturn]] void reject(const std::string& why) { throw std::runtime_error(why); }

std::uint64_t take_varint(std::string_view& bytes) {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 64; shift += 7) {
    if (bytes.empty()) reject("a number ends early");
    const auto byte = static_cast<unsigned char>(bytes.front());
    bytes.remove_prefix(1);
    value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
    if (byte < 0x80) return value;
  }
  reject("a number without an end");
}

std::string_view take_bytes(std::string_view& bytes, std::uint64_t count) {
  if (count > bytes.size()) reject("a field ends early");
  const auto taken = bytes.substr(0, count);
  bytes.remove_prefix(count);
  return taken;
}

Message parse(std::string_view bytes) {
  Message message;
  while (!bytes.empty()) {
    const auto tag = take_varint(bytes);
    const int field = static_cast<int>(tag >> 3);
    if (field == 0) reject("field 0");
    switch (tag & 7) {
      case 0:
        message.insert({field, {take_varint(bytes), {}}});
        break;
      case 1: {
        std::uint64_t value = 0;
        const auto little_endian = take_bytes(bytes, 8);
        for (int i = 7; i >= 0; --i)
          value = value << 8 | static_cast<unsigned char>(little_endian[i]);
        message.insert({field, {value, {}}});
        break;
      }
      case 2:
        message.insert({field, {0, take_bytes(bytes, take_varint(bytes))}});
        break;
      default:
        reject("a wire type that is not written here");
    }
  }
  return message;
}

const Field* find(const Message& message, int field) {
  const auto found = message.find(field);
  return found == message.end() ? nullptr : &found->second;
}
std::uint64_t number(const Message& message, int field) {
  const auto* found = find(message, field);
  if (!found) reject("field " + std::to_string(field) + " is missing");
  return found->number;
}

class Reader {
 public:
  SeenTrace read(std::string_view bytes) {
    const auto packets = parse(bytes);
    for (const auto& [field, packet] : packets) {
      if (field != 1) reject("a trace is made of packets");
      read_packet(parse(packet.bytes));
    }
    for (const auto& [track, open] : open_)
      if (!open.empty()) reject("a slice on track " + seen_.tracks[track] + " does not end");
    return std::move(seen_);
  }

 private:
  void read_packet(const Message& packet) {
    if (number(packet, 10) == 0) reject("a packet of no sequence");
    const auto* flags = find(packet, 13);
    if (flags && flags->number & 1) names_.clear(), annotations_.clear(), state_valid_ = true;
    if (const auto* clocks = find(packet, 6)) read_clocks(parse(clocks->bytes));
    if (const auto* defaults = find(packet, 59))
      default_clock_ = number(parse(defaults->bytes), 58);
    if (const auto* interned = find(packet, 12)) read_names(parse(interned->bytes));
    if (const auto* track = find(packet, 60)) read_track(parse(track->bytes));
    const auto* event = find(packet, 11);
    if (!event) return;
    if (!flags || !(flags->number & 2) || !state_valid_)
      reject("an event without the state it needs");
    if (!seen_.clocks.contains(default_clock_)) reject("a clock without a reading");
    const auto time_ns = static_cast<std::int64_t>(number(packet, 8));
    if (time_ns < last_ns_) reject("time goes back");
    last_ns_ = time_ns;
    read_event(time_ns, parse(event->bytes));
  }

  void read_clocks(const Message& snapshot) {
    const auto [begin, end] = snapshot.equal_range(1);
    for (auto clock = begin; clock != end; ++clock) {
      const auto reading = parse(clock->second.bytes);
      seen_.clocks[number(reading, 1)] = static_cast<std::int64_t>(number(reading, 2));
    }
    seen_.primary_clock = number(snapshot, 2);
  }

  void read_names(const Message& interned) {
    for (const auto& [field, entry] : interned) {
      const auto name = parse(entry.bytes);
      (field == 2 ? names_ : annotations_)[number(name, 1)] = find(name, 2)->bytes;
    }
  }

  void read_track(const Message& track) {
    const auto id = number(track, 1);
    if (const auto* process = find(track, 3)) {
      const auto about = parse(process->bytes);
      seen_.process = find(about, 6)->bytes;
      seen_.pid = number(about, 1);
      process_track_ = id;
      return;
    }
    if (number(track, 5) != process_track_) reject("a track of no process");
    if (!seen_.tracks.emplace(id, find(track, 2)->bytes).second) reject("a track twice");
    if (find(track, 8)) counters_.push_back(id);
  }

  void read_event(std::int64_t time_ns, const Message& event) {
    const auto track = number(event, 11);
    if (!seen_.tracks.contains(track)) reject("an event on no track");
    const bool is_counter = std::ranges::find(counters_, track) != counters_.end();
    const auto type = number(event, 9);
    if (is_counter != (type == 4)) reject("a slice on a counter, or the other way round");
    if (type == 4) return seen_.ages_ms.push_back(std::bit_cast<double>(number(event, 44)));
    auto& open = open_[track];
    if (type == 2) {
      if (open.empty()) reject("an end without a beginning");
      seen_.slices[static_cast<std::size_t>(open.back())].end_ns = time_ns;
      return open.pop_back();
    }
    if (type != 1) reject("an event of no known type");
    SeenSlice slice{.track = seen_.tracks[track],
                    .track_id = track,
                    .begin_ns = time_ns,
                    .parent = open.empty() ? -1 : open.back()};
    if (!names_.contains(number(event, 10))) reject("a name that was not declared");
    slice.name = names_[number(event, 10)];
    const auto [flow, last_flow] = event.equal_range(47);
    for (auto each = flow; each != last_flow; ++each) slice.flows.push_back(each->second.number);
    read_annotations(event, slice);
    open.push_back(static_cast<int>(seen_.slices.size()));
    seen_.slices.push_back(std::move(slice));
  }

  void read_annotations(const Message& event, SeenSlice& slice) {
    const auto [begin, end] = event.equal_range(4);
    for (auto each = begin; each != end; ++each) {
      const auto annotation = parse(each->second.bytes);
      if (!annotations_.contains(number(annotation, 1)))
        reject("an annotation's name that was not declared");
      if (const auto* text = find(annotation, 6)) {
        slice.texts[annotations_[number(annotation, 1)]] = text->bytes;
        continue;
      }
      const auto* real = find(annotation, 5);
      slice.annotations[annotations_[number(annotation, 1)]] =
          real ? std::bit_cast<double>(real->number) : static_cast<double>(number(annotation, 3));
    }
  }

  SeenTrace seen_;
  std::map<std::uint64_t, std::string> names_, annotations_;
  std::map<std::uint64_t, std::vector<int>> open_;
  std::vector<std::uint64_t> counters_;
  std::uint64_t process_track_ = 0, default_clock_ = 6;
  std::int64_t last_ns_ = 0;
  bool state_valid_ = false;
};

}  // namespace

std::vector<SeenSlice> SeenTrace::named(std::string_view name) const {
  std::vector<SeenSlice> found;
  std::ranges::copy_if(slices, std::back_inserter(found),
                       [&](const auto& slice) { return slice.name == name; });
  return found;
}

std::vector<SeenSlice> SeenTrace::along(std::uint64_t flow) const {
  std::vector<SeenSlice> found;
  std::ranges::copy_if(slices, std::back_inserter(found), [&](const auto& slice) {
    return std::ranges::find(slice.flows, flow) != slice.flows.end();
  });
  return found;
}

SeenTrace decode_trace(std::string_view bytes) {
  try {
    return Reader().read(bytes);
  } catch (const std::exception& error) {
    SeenTrace nothing;
    nothing.fault = error.what();
    return nothing;
  }
}

}  // namespace handcast::supervisor::test
