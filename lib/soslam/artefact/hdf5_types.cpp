// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/hdf5_types.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace soslam {

Hdf5Element Hdf5ElementOf(int depth) {
  switch (depth) {
    case CV_8U:
      return {H5T_STD_U8LE, "uint8"};
    case CV_16S:
      return {H5T_STD_I16LE, "int16"};
    case CV_32S:
      return {H5T_STD_I32LE, "int32"};
    case CV_32F:
      return {H5T_IEEE_F32LE, "float32"};
    case CV_64F:
      return {H5T_IEEE_F64LE, "float64"};
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
  Hdf5Handle access{H5Pcreate(H5P_FILE_ACCESS), &H5Pclose};
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V18);
  return access;
}

Hdf5Handle Hdf5Timeless(hid_t list_class) {
  Hdf5Handle creation{H5Pcreate(list_class), &H5Pclose};
  H5Pset_obj_track_times(creation.id(), false);
  return creation;
}

Hdf5Handle Hdf5DataSetCreation(const ArrayShape& shape) {
  Hdf5Handle creation = Hdf5Timeless(H5P_DATASET_CREATE);
  const bool empty = std::ranges::find(shape, 0U) != shape.end();
  if (empty) return creation;  // a chunk cannot be empty
  const std::vector<hsize_t> chunk(shape.begin(), shape.end());
  H5Pset_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data());
  H5Pset_shuffle(creation.id());
  constexpr unsigned kFastest = 1;
  H5Pset_deflate(creation.id(), kFastest);
  return creation;
}

std::optional<std::string> ReadChunk(const Hdf5Handle& data_set, const ArrayShape& shape,
                                     std::uint64_t max_bytes) {
  // Only what has the properties of Hdf5DataSetCreation is read.
  const Hdf5Handle creation{H5Dget_create_plist(data_set.id()), &H5Pclose};
  if (H5Pget_layout(creation.id()) != H5D_CHUNKED || H5Pget_nfilters(creation.id()) != 2) {
    return std::nullopt;
  }
  const auto filter = [&](unsigned int index) {
    unsigned int flags = 0;
    size_t parameters = 0;
    return H5Pget_filter2(creation.id(), index, &flags, &parameters, nullptr, 0, nullptr, nullptr);
  };
  std::vector<hsize_t> chunk(shape.size());
  H5Pget_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data());
  if (!std::ranges::equal(chunk, shape) || filter(0) != H5Z_FILTER_SHUFFLE ||
      filter(1) != H5Z_FILTER_DEFLATE) {
    return std::nullopt;
  }
  const std::vector<hsize_t> begin(shape.size());
  hsize_t size = 0;
  if (H5Dget_chunk_storage_size(data_set.id(), begin.data(), &size) < 0 || size > max_bytes) {
    return std::nullopt;
  }
  std::string bytes(size, '\0');
  std::uint32_t skipped_filters = 0;
  if (H5Dread_chunk(data_set.id(), H5P_DEFAULT, begin.data(), &skipped_filters, bytes.data()) < 0 ||
      skipped_filters != 0) {
    return std::nullopt;
  }
  return bytes;
}

bool DecodeChunk(const std::string& chunk, size_t element_size, std::span<std::byte> values) {
  std::vector<Bytef> shuffled(values.size());
  uLongf inflated = shuffled.size();
  uLong used = chunk.size();
  if (uncompress2(shuffled.data(), &inflated, reinterpret_cast<const Bytef*>(chunk.data()),
                  &used) != Z_OK ||
      inflated != shuffled.size() || used != chunk.size()) {
    return false;
  }
  // First the first bytes of all elements, then the second ones, ...
  const size_t count = values.size() / element_size;
  for (size_t k = 0; k < element_size; ++k) {
    for (size_t i = 0; i < count; ++i) {
      values[i * element_size + k] = std::byte{shuffled[k * count + i]};
    }
  }
  return true;
}

}  // namespace soslam
