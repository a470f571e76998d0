// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/client/handcast.h"
#include "ipc/msg/hand_poses.hpp"

/// What the functions of handcast.h have in common: errors as codes with a sentence, and handles
/// whose wrong use is an error and no crash.
namespace handcast::client {

/// The sentence of handcast_error().
inline thread_local std::string last_error;

inline handcast_result result_of(const Error& error) {
  last_error = error.what;
  switch (error.code) {
    case Errc::timeout:
      return HANDCAST_TIMEOUT;
    case Errc::bad_data:
      return HANDCAST_BAD_DATA;
    case Errc::disconnected:
      return HANDCAST_DISCONNECTED;
    case Errc::bad_config:
      return HANDCAST_WRONG_USE;
    case Errc::unavailable:
      break;
  }
  return HANDCAST_UNAVAILABLE;
}

/// Calls `work`, which returns a Result<void>; an exception, of which only a lack of memory is
/// expected, is an error, too.
template <class Work>
handcast_result guarded(const Work& work) {
  try {
    last_error.clear();
    if (const Result<void> done = work(); !done) return result_of(done.error());
    return HANDCAST_OK;
  } catch (const std::exception& fault) {
    return result_of({Errc::unavailable, fault.what()});
  }
}

/// All handles of a kind that are open, so that a pointer that was closed is an error. Any thread.
template <class T>
class Handles {
 public:
  static T* add(std::unique_ptr<T> handle) {
    const std::lock_guard lock(open().mutex);
    open().all.push_back(handle.get());
    return handle.release();
  }
  static bool has(const T* handle) {
    const std::lock_guard lock(open().mutex);
    return std::ranges::find(open().all, handle) != open().all.end();
  }
  static void remove(T* handle) {
    {
      const std::lock_guard lock(open().mutex);
      std::erase(open().all, handle);
    }
    delete handle;
  }

 private:
  struct Open {
    std::mutex mutex;
    std::vector<T*> all;
  };
  static Open& open() {
    static auto* const handles = new Open;  // outlives threads that end after main()
    return *handles;
  }
};

/// guarded(), for a handle that must be open. `opens` and `closes`: the functions that do so.
template <class T, class Work>
handcast_result with(T* handle, const char* function, const char* opens, const char* closes,
                     const Work& work) {
  return guarded([&]() -> Result<void> {
    if (Handles<T>::has(handle)) return work();
    return fail(Errc::bad_config,
                fmt::format("{}: this handle is not open; {}() gives one, and {}() ends it",
                            function, opens, closes));
  });
}

static_assert(HANDCAST_JOINTS == msg::kJoints);
static_assert(sizeof(handcast_joint) == sizeof(msg::Joint));

/// A sample of the tracker as the C interface has it.
inline handcast_both_hands both_hands(const msg::HandPoses& poses) {
  handcast_both_hands hands{};
  hands.time_ns = poses.header.origin_ns;
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    const auto* pose = poses.find(side);
    const auto index = static_cast<std::size_t>(side);
    if (!pose) continue;
    hands.is_there[index] = 1;
    std::memcpy(hands.joints[index], pose->joints.data(), sizeof hands.joints[index]);
  }
  return hands;
}

}  // namespace handcast::client
