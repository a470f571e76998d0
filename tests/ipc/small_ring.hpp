// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <memory>

#include "ipc/ring/copy.hpp"
#include "ipc/ring/protocol.hpp"
#include "ipc/ring/real_atomics.hpp"

namespace handcast::ipc::samples {

/// A ring in private memory with the production protocol. All words of a message are equal.
class SmallRing {
 public:
  static constexpr std::size_t kWords = 512;        ///< words of a message
  static constexpr int kRows = 3;                   ///< reader rows
  using Payload = std::array<PayloadWord, kWords>;  ///< a message

  /// An empty ring.
  SmallRing(int slots, bool keep_history)
      : lines_(std::make_unique<ControlWords<RealAtomics>::Line[]>(control_lines(slots, kRows))),
        payloads_(std::make_unique<Payload[]>(static_cast<std::size_t>(slots))),
        words_(lines_.get(), slots, keep_history, kRows) {}

  /// The control words.
  const ControlWords<RealAtomics>& words() const { return words_; }
  /// The first byte of a slot.
  std::byte* slot(int number) {
    return reinterpret_cast<std::byte*>(payloads_[static_cast<std::size_t>(number)].data());
  }

 private:
  std::unique_ptr<ControlWords<RealAtomics>::Line[]> lines_;
  std::unique_ptr<Payload[]> payloads_;
  ControlWords<RealAtomics> words_;
};

}  // namespace handcast::ipc::samples
