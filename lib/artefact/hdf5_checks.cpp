// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/hdf5_checks.h"

#include <algorithm>
#include <vector>

namespace soslam {
namespace {

// Largest compression ratio of deflate, reached for zeros.
constexpr std::uint64_t kMaxPacking = 1032;

std::uint64_t BytesOf(const Hdf5Handle& data_set, const ArrayShape& shape) {
  const Hdf5Handle type{H5Dget_type(data_set.id()), &H5Tclose};
  std::uint64_t bytes = H5Tget_size(type.id());
  for (const std::uint64_t size : shape) bytes *= size;
  return bytes;
}

// Rejects repeated deflate: with it a few bytes would decompress to more than the memory.
bool IsPackedAtMostOnce(const Hdf5Handle& creation) {
  const int filters = H5Pget_nfilters(creation.id());
  int deflates = 0;
  for (int i = 0; i < filters; ++i) {
    unsigned int flags = 0;
    size_t parameters = 0;
    const H5Z_filter_t filter = H5Pget_filter2(creation.id(), static_cast<unsigned int>(i), &flags,
                                               &parameters, nullptr, 0, nullptr, nullptr);
    if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE) return false;
    deflates += filter == H5Z_FILTER_DEFLATE ? 1 : 0;
  }
  return filters >= 0 && deflates <= 1;
}

// Largest stored size of `bytes`: deflate slightly enlarges incompressible data.
std::uint64_t MostStored(std::uint64_t bytes) {
  constexpr std::uint64_t kSlack = 1 << 16;
  return bytes + bytes / 16 + kSlack;
}

// True if no chunk is larger than the data set, as the library reads whole chunks into memory.
bool HasChunksWithin(const Hdf5Handle& creation, const ArrayShape& shape) {
  std::vector<hsize_t> chunk(shape.size());
  const auto rank = static_cast<int>(shape.size());
  return H5Pget_chunk(creation.id(), rank, chunk.data()) == rank &&
         std::equal(chunk.begin(), chunk.end(), shape.begin(), std::less_equal<>());
}

}  // namespace

std::optional<std::string> StorageProblem(const Hdf5Handle& data_set, const ArrayShape& shape,
                                          std::uint64_t file_bytes) {
  const Hdf5Handle creation{H5Dget_create_plist(data_set.id()), &H5Pclose};
  const H5D_layout_t layout = H5Pget_layout(creation.id());
  if (layout == H5D_VIRTUAL || H5Pget_external_count(creation.id()) != 0) {
    return "has its values in other files; expected them in this one";
  }
  if (layout == H5D_CHUNKED && !HasChunksWithin(creation, shape)) {
    return "has chunks that are larger than itself; the file is damaged";
  }
  if (!IsPackedAtMostOnce(creation)) return "is packed by other filters than shuffle and deflate";
  const std::uint64_t stored = H5Dget_storage_size(data_set.id());
  const std::uint64_t bytes = BytesOf(data_set, shape);
  if (stored > std::min(file_bytes, MostStored(bytes)) || bytes > kMaxPacking * stored) {
    return "has not the values that its size says; the file is cut short or damaged";
  }
  return std::nullopt;
}

}  // namespace soslam
