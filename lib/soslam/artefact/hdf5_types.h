// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "soslam/artefact/hdf5_file.h"

namespace soslam {

// HDF5 type of the numbers of an OpenCV depth, little-endian. Hdf5ElementOf throws std::logic_error
// for a depth that artefacts do not have.
struct Hdf5Element {
  hid_t type;
  const char* name;
};
Hdf5Element Hdf5ElementOf(int depth);

// File access properties for format 1.8, in which attributes may be larger than 64 KiB and metadata
// has checksums.
Hdf5Handle Hdf5FileAccess();

// Creation property list for files, groups or data sets that stores no times.
Hdf5Handle Hdf5Timeless(hid_t list_class);

// For a data set of this shape: one chunk, shuffled and deflated.
Hdf5Handle Hdf5DataSetCreation(const ArrayShape& shape);

// Chunks are read without the HDF5 library's filters: those of version 1.10 do not check that a
// chunk holds as many values as the data set says, and read beyond it.

// The stored bytes of a data set of this shape with the properties of Hdf5DataSetCreation. None for
// other properties, or if its size is more than `max_bytes`.
std::optional<std::string> ReadChunk(const Hdf5Handle& data_set, const ArrayShape& shape,
                                     std::uint64_t max_bytes);

// Inflates and unshuffles a chunk of elements of so many bytes. False when it is damaged, or does
// not fill `values`.
bool DecodeChunk(const std::string& chunk, size_t element_size, std::span<std::byte> values);

}  // namespace soslam
