// SPDX-License-Identifier: Apache-2.0
#include "renderer/media/film_reader.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <limits>

#include "ipc/base/input_file.hpp"

namespace handcast::renderer {
namespace fs = std::filesystem;

Result<std::unique_ptr<FilmReader>> open_film(const fs::path& file) {
  if (const auto fd = open_input(file, std::numeric_limits<std::int64_t>::max()); !fd)
    return tl::make_unexpected(fd.error());
  const auto library = fs::read_symlink("/proc/self/exe").parent_path().parent_path() /
                       "lib/handcast/libhandcast-film.so";
  void* loaded = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);  // it stays loaded
  if (!loaded) return fail(Errc::bad_config, fmt::format("films cannot be read: {}", ::dlerror()));
  const auto open =
      reinterpret_cast<decltype(&handcast_open_film)>(::dlsym(loaded, "handcast_open_film"));
  if (!open)
    return fail(Errc::bad_config, fmt::format("{} is of another version", library.string()));
  std::unique_ptr<FilmReader> film(open(file.c_str()));
  if (!film)
    return fail(Errc::bad_config,
                fmt::format("'{}' is no film that FFmpeg can read", file.string()));
  return film;
}

}  // namespace handcast::renderer
