// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <arv.h>

#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

#include "ipc/base/result.hpp"

/// GLib's conventions as C++: references that are given back, errors as values.
namespace handcast::camera::aravis {

struct Unref {
  void operator()(void* object) const { g_object_unref(object); }
};
/// One reference to an object of GLib.
template <class T>
using Owned = std::unique_ptr<T, Unref>;

struct Free {
  void operator()(void* memory) const { g_free(memory); }
};

/// The code for an error of Aravis: whether the camera is gone, cannot be had now, or refuses.
inline Errc code_of(const GError& error) {
  if (error.domain == ARV_GC_ERROR) return Errc::bad_config;
  if (error.domain != ARV_DEVICE_ERROR) return Errc::unavailable;
  switch (error.code) {
    case ARV_DEVICE_ERROR_WRONG_FEATURE:
    case ARV_DEVICE_ERROR_FEATURE_NOT_FOUND:
    case ARV_DEVICE_ERROR_PROTOCOL_ERROR_NOT_IMPLEMENTED:
    case ARV_DEVICE_ERROR_PROTOCOL_ERROR_INVALID_PARAMETER:
    case ARV_DEVICE_ERROR_PROTOCOL_ERROR_WRITE_PROTECT:
      return Errc::bad_config;
    default:
      return Errc::unavailable;
  }
}

/// Calls a function of Aravis with a place for its error: `ask([&](GError** error) { return
/// arv_camera_new(name, error); })`. Errors: those of code_of(), with Aravis's sentence.
template <class Call>
auto ask(const Call& call) -> Result<std::invoke_result_t<Call, GError**>> {
  using Value = std::invoke_result_t<Call, GError**>;
  GError* raw = nullptr;
  const auto error_of = [](GError* error) {
    Error made{code_of(*error), error->message};
    g_error_free(error);
    return tl::make_unexpected(std::move(made));
  };
  if constexpr (std::is_void_v<Value>) {
    call(&raw);
    if (raw) return error_of(raw);
    return {};
  } else {
    Value value = call(&raw);
    if (raw) return error_of(raw);
    return value;
  }
}

/// A text of Aravis, which may be null.
inline std::string text_of(const char* text) { return text ? text : ""; }

}  // namespace handcast::camera::aravis
