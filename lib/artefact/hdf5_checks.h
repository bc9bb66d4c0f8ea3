// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "artefact/hdf5_file.h"
#include "artefact/hdf5_types.h"

namespace soslam {

// Why a data set of this shape must not be read, and what was expected; none when it may be. Its
// values have to be in the file itself, and not more than a file of `file_bytes` can hold.
std::optional<std::string> StorageProblem(const Hdf5Handle& data_set, const ArrayShape& shape,
                                          std::uint64_t file_bytes);

}  // namespace soslam
