// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "artefact/hdf5_file.h"

namespace soslam {

// Chunks as Hdf5File writes them, read without the HDF5 library's filters: those of version 1.10 do
// not check that a chunk holds as many values as the data set says, and read beyond it.

// The stored bytes of a data set of this shape that is one chunk, shuffled and deflated; none of
// any other.
std::optional<std::string> ReadChunk(const Hdf5Handle& data_set, const ArrayShape& shape);

// Inflates and unshuffles a chunk of elements of so many bytes. False when it is damaged, or does
// not fill `values`.
bool DecodeChunk(const std::string& chunk, size_t element_size, std::span<std::byte> values);

}  // namespace soslam
