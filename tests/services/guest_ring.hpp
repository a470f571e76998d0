// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <optional>
#include <random>
#include <string>
#include <string_view>

#include "ipc/ring/writer.hpp"
#include "ipc/shm/open_ring.hpp"

namespace handcast::test {

/// The ring of a stream that a program outside the rig writes, and that program.
template <class T>
class GuestRing {
 public:
  explicit GuestRing(std::string_view stream, std::size_t bytes = sizeof(T))
      : segment_(ipc::Segment::create(ipc::RingSpec::of<T>(std::string(stream), 16, true, bytes))
                     .value()) {
    begin();
  }

  /// What a service opens it with.
  ipc::OpenRing open() const {
    return [this](std::string_view) { return again(); };
  }
  /// A program begins to write; one that does so already ends.
  void begin() {
    writer_.reset();
    writer_.emplace(ipc::Writer<T>::attach(again().value()).value());
  }
  void send(const T& message) requires(!ipc::HasTail<T>) { writer_->publish(message); }
  void send(ipc::Loan<T>&& message) { writer_->publish(std::move(message)); }
  /// Begins a message and does not publish it.
  ipc::Loan<T> stop_in_the_middle() { return writer_->loan(); }
  /// Writes noise over everything behind the header.
  void write_noise(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    for (std::size_t i = 4096; i + 8 <= segment_.size(); i += 8) {
      const auto word = random();
      std::memcpy(segment_.data() + i, &word, sizeof word);
    }
  }
  /// Writes zeros over everything behind the header: numbers begin anew.
  void wipe() { std::memset(segment_.data() + 4096, 0, segment_.size() - 4096); }

 private:
  Result<ipc::Segment> again() const { return ipc::Segment::open(UniqueFd(::dup(segment_.fd()))); }

  ipc::Segment segment_;
  std::optional<ipc::Writer<T>> writer_;
};

}  // namespace handcast::test
