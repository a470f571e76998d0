// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "services/landmarks/training/generator.hpp"

namespace handcast::landmarks::training {

/// A picture of the first `count` images: labels green (hidden ones dark), the tracker's joints
/// red. Errors: unavailable.
Result<void> write_contact_sheet(Generator& generator, int count,
                                 const std::filesystem::path& file);

}  // namespace handcast::landmarks::training
