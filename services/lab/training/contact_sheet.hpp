// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "services/lab/training/generator.hpp"

namespace handcast::landmarks::training {

/// Writes a picture of the first `count` images of the generator in rows of ten: true landmarks
/// green, hidden ones blue, the tracker's joints red. Errors: unavailable.
Result<void> write_contact_sheet(Generator& generator, int count,
                                 const std::filesystem::path& file);

}  // namespace handcast::landmarks::training
