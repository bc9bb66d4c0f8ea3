// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/hdf5_checks.h"

#include <algorithm>
#include <vector>

namespace soslam {
namespace {

// What deflate makes of zeros.
constexpr std::uint64_t kMaxPacking = 1032;

std::uint64_t BytesOf(const Hdf5Handle& data_set, const Hdf5Shape& shape) {
  const Hdf5Handle type{H5Dget_type(data_set.id()), &H5Tclose};
  std::uint64_t bytes = H5Tget_size(type.id());
  for (const std::uint64_t size : shape) bytes *= size;
  return bytes;
}

// The library reads whole chunks into memory.
bool HasChunksWithin(const Hdf5Handle& creation, const Hdf5Shape& shape) {
  std::vector<hsize_t> chunk(shape.size());
  const auto rank = static_cast<int>(shape.size());
  return H5Pget_chunk(creation.id(), rank, chunk.data()) == rank &&
         std::equal(chunk.begin(), chunk.end(), shape.begin(), std::less_equal<>());
}

}  // namespace

std::optional<std::string> StorageProblem(const Hdf5Handle& data_set, const Hdf5Shape& shape,
                                          std::uint64_t file_bytes) {
  const Hdf5Handle creation{H5Dget_create_plist(data_set.id()), &H5Pclose};
  const H5D_layout_t layout = H5Pget_layout(creation.id());
  if (layout == H5D_VIRTUAL || H5Pget_external_count(creation.id()) != 0) {
    return "has its values in other files; expected them in this one";
  }
  if (layout == H5D_CHUNKED && !HasChunksWithin(creation, shape)) {
    return "has chunks that are larger than itself; the file is damaged";
  }
  const std::uint64_t stored = H5Dget_storage_size(data_set.id());
  if (stored > file_bytes || BytesOf(data_set, shape) > kMaxPacking * stored) {
    return "has not the values that its size says; the file is cut short or damaged";
  }
  return std::nullopt;
}

bool IsTree(const Hdf5Handle& file) {
  struct Counts {
    int links = 0;
    int objects = 0;
  } counts;
  const auto count_link = [](hid_t, const char*, const H5L_info_t*, void* data) -> herr_t {
    ++static_cast<Counts*>(data)->links;
    return 0;
  };
  const auto count_object = [](hid_t, const char*, const H5O_info_t*, void* data) -> herr_t {
    ++static_cast<Counts*>(data)->objects;
    return 0;
  };
  // Both visit a group once, whatever number of names it has.
  const bool is_sound =
      H5Lvisit(file.id(), H5_INDEX_NAME, H5_ITER_NATIVE, count_link, &counts) >= 0 &&
      H5Ovisit2(file.id(), H5_INDEX_NAME, H5_ITER_NATIVE, count_object, &counts, H5O_INFO_BASIC) >=
          0;
  return is_sound && counts.objects == counts.links + 1;  // the root has no link
}

}  // namespace soslam
