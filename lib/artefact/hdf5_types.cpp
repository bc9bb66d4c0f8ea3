// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/hdf5_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace soslam {
namespace {

Hdf5Handle PropertyList(hid_t list_class) { return {H5Pcreate(list_class), &H5Pclose}; }

}  // namespace

Hdf5Element Hdf5ElementOf(int depth) {
  switch (depth) {
    case CV_8U:
      return {H5T_STD_U8LE, H5T_NATIVE_UINT8, "uint8"};
    case CV_16S:
      return {H5T_STD_I16LE, H5T_NATIVE_INT16, "int16"};
    case CV_32S:
      return {H5T_STD_I32LE, H5T_NATIVE_INT32, "int32"};
    case CV_32F:
      return {H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, "float32"};
    case CV_64F:
      return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, "float64"};
    default:
      throw std::logic_error(fmt::format("no HDF5 type for OpenCV depth {}", depth));
  }
}

Hdf5Handle Hdf5FileAccess() {
  H5dont_atexit();  // its clean-up at exit crashes on a file that a full disk left unfinished
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors become exceptions, not text on stderr
  // Prevents a file from making the library read other files or load plug-ins.
  H5Lunregister(H5L_TYPE_EXTERNAL);
  H5PLset_loading_state(0);
  Hdf5Handle access = PropertyList(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V18);
  return access;
}

Hdf5Handle Hdf5Timeless(hid_t list_class) {
  Hdf5Handle creation = PropertyList(list_class);
  H5Pset_obj_track_times(creation.id(), false);
  return creation;
}

Hdf5Handle Hdf5DataSetCreation(const ArrayShape& shape) {
  Hdf5Handle creation = Hdf5Timeless(H5P_DATASET_CREATE);
  const bool empty = std::find(shape.begin(), shape.end(), 0U) != shape.end();
  if (empty) return creation;  // a chunk cannot be empty
  const std::vector<hsize_t> chunk(shape.begin(), shape.end());
  H5Pset_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data());
  H5Pset_shuffle(creation.id());
  constexpr unsigned kFastest = 1;
  H5Pset_deflate(creation.id(), kFastest);
  return creation;
}

Hdf5Handle Hdf5TextType(size_t length) {
  Hdf5Handle type{H5Tcopy(H5T_C_S1), &H5Tclose};
  H5Tset_size(type.id(), std::max<size_t>(length, 1));
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

}  // namespace soslam
