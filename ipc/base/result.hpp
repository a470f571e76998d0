// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace handcast {

/// What went wrong, by what the caller can do about it: one code per reaction.
enum class Errc {
  timeout,       ///< nothing arrived before the deadline; try again
  bad_data,      ///< this item is unusable; drop it and go on
  disconnected,  ///< the device or peer is gone; reopen it, or exit and be restarted
  bad_config,    ///< restarting will not help; a person must change something
  unavailable,   ///< a resource is missing now; restarting may help
};

/// An error as a value: a code for the program, one full sentence for the person.
struct Error {
  Errc code = Errc::bad_data;
  std::string what;  ///< e.g. "camera 'A-2134': no frame within 50 ms"
};

template <class T>
using Result = tl::expected<T, Error>;

/// Shorthand for the unhappy return of a function that yields a Result.
inline tl::unexpected<Error> fail(Errc code, std::string what) {
  return tl::make_unexpected(Error{code, std::move(what)});
}

/// Passes an error on with the place it came from put in front of its sentence.
inline tl::unexpected<Error> fail_in(std::string_view place, Error error) {
  error.what = std::string(place) + ": " + error.what;
  return tl::make_unexpected(std::move(error));
}

}  // namespace handcast
