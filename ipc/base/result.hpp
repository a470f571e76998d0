// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace handcast {

/// Error codes. Each code stands for one reaction of the caller.
enum class Errc {
  timeout,       ///< Nothing arrived before the deadline. Try again.
  bad_data,      ///< This item is unusable. Drop it and continue.
  disconnected,  ///< The device or peer is gone. Reopen it, or exit and be restarted.
  bad_config,    ///< A restart will not help. A person must change something.
  unavailable,   ///< A resource is missing now. A restart may help.
};

/// An error value: a code for the program and a sentence for the person.
struct Error {
  Errc code = Errc::bad_data;  ///< tells the caller how to react
  std::string what;            ///< e.g. "camera 'A-2134': no frame within 50 ms"
};

/// The return type of a function that can fail: a T or an Error.
template <class T>
using Result = tl::expected<T, Error>;

/// Makes the error return of a function that returns a Result.
inline tl::unexpected<Error> fail(Errc code, std::string what) {
  return tl::make_unexpected(Error{code, std::move(what)});
}

/// Passes an error on, with "`place`: " put before its sentence.
inline tl::unexpected<Error> fail_in(std::string_view place, Error error) {
  error.what = std::string(place) + ": " + error.what;
  return tl::make_unexpected(std::move(error));
}

}  // namespace handcast
