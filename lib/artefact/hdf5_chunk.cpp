// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/hdf5_chunk.h"

#include <hdf5.h>
#include <zlib.h>

#include <algorithm>
#include <vector>

namespace soslam {
namespace {

H5Z_filter_t Filter(const Hdf5Handle& creation, unsigned int index) {
  unsigned int flags = 0;
  size_t parameters = 0;
  return H5Pget_filter2(creation.id(), index, &flags, &parameters, nullptr, 0, nullptr, nullptr);
}

// True for what Hdf5DataSetCreation asks for.
bool IsOneChunk(const Hdf5Handle& creation, const ArrayShape& shape) {
  if (H5Pget_layout(creation.id()) != H5D_CHUNKED || H5Pget_nfilters(creation.id()) != 2) {
    return false;
  }
  std::vector<hsize_t> chunk(shape.size());
  H5Pget_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data());
  return std::ranges::equal(chunk, shape) && Filter(creation, 0) == H5Z_FILTER_SHUFFLE &&
         Filter(creation, 1) == H5Z_FILTER_DEFLATE;
}

}  // namespace

std::optional<std::string> ReadChunk(const Hdf5Handle& data_set, const ArrayShape& shape) {
  const Hdf5Handle creation{H5Dget_create_plist(data_set.id()), &H5Pclose};
  if (!IsOneChunk(creation, shape)) return std::nullopt;
  const std::vector<hsize_t> begin(shape.size());
  hsize_t size = 0;
  if (H5Dget_chunk_storage_size(data_set.id(), begin.data(), &size) < 0 ||
      size > H5Dget_storage_size(data_set.id())) {
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
