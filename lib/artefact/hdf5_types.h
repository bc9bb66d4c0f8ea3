// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <hdf5.h>

#include "artefact/hdf5_file.h"

namespace soslam {

// HDF5 types of numbers in files and in memory for an OpenCV depth. Hdf5ElementOf throws
// std::logic_error for a depth that artefacts do not have.
struct Hdf5Element {
  hid_t file_type;
  hid_t memory_type;
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

// Texts are of fixed length and UTF-8; HDF5 has no length 0.
Hdf5Handle Hdf5TextType(size_t length);

}  // namespace soslam
