// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "artefact/hdf5_file.h"
#include "artefact/hdf5_types.h"

namespace soslam {

// Error message when a data set of this shape must not be read, with found and expected values;
// none when it may be. Its values must be stored in the file itself and fit in a file of
// `file_bytes`.
std::optional<std::string> StorageProblem(const Hdf5Handle& data_set, const ArrayShape& shape,
                                          std::uint64_t file_bytes);

}  // namespace soslam
