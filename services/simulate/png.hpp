#pragma once
#include <cstdint>
#include <filesystem>

#include "ipc/base/result.hpp"
#include "renderer/image.hpp"

namespace handcast::simulate {

Result<void> write_png(const std::filesystem::path& file, renderer::View<const std::uint8_t> grey);
/// RGBA8 pixels; alpha is not written.
Result<void> write_png(const std::filesystem::path& file, renderer::View<const std::uint32_t> colour);

}  // namespace handcast::simulate
