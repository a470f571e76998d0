// SPDX-License-Identifier: Apache-2.0
#include "renderer/media/film_reader.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <limits>

#include "ipc/base/input_file.hpp"
#include "ipc/base/program.hpp"
#include "renderer/media/colour_film.hpp"

namespace handcast::renderer {
namespace fs = std::filesystem;

/// A function of libhandcast-film.so. Errors: bad_config.
template <class Function>
static Result<Function*> function_of(const char* name) {
  const auto library = program_folder().parent_path() / "lib/handcast/libhandcast-film.so";
  void* loaded = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);  // it stays loaded
  if (!loaded) return fail(Errc::bad_config, fmt::format("films cannot be read: {}", ::dlerror()));
  const auto function = reinterpret_cast<Function*>(::dlsym(loaded, name));
  if (!function)
    return fail(Errc::bad_config, fmt::format("{} is of another version", library.string()));
  return function;
}

Result<std::unique_ptr<FilmReader>> open_film(const fs::path& file) {
  if (const auto fd = open_input(file, std::numeric_limits<std::int64_t>::max()); !fd)
    return tl::make_unexpected(fd.error());
  const auto open = function_of<decltype(handcast_open_film)>("handcast_open_film");
  if (!open) return tl::make_unexpected(open.error());
  std::unique_ptr<FilmReader> film((*open)(file.c_str()));
  if (!film)
    return fail(Errc::bad_config,
                fmt::format("'{}' is no film that FFmpeg can read", file.string()));
  return film;
}

Result<std::unique_ptr<ColourFilm>> open_colour_film(const FilmOpening& opening,
                                                     const std::atomic<bool>& is_over) {
  if (opening.kind == FilmOpening::Kind::file)
    if (const auto fd = open_input(opening.address, std::numeric_limits<std::int64_t>::max()); !fd)
      return tl::make_unexpected(fd.error());
  const auto open = function_of<decltype(handcast_open_colour_film)>("handcast_open_colour_film");
  if (!open) return tl::make_unexpected(open.error());
  Error error;
  std::unique_ptr<ColourFilm> film((*open)(opening, is_over, error));
  if (!film) return tl::make_unexpected(std::move(error));
  return film;
}

}  // namespace handcast::renderer
