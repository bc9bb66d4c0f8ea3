// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/hdf5_types.h"

#include <fmt/format.h>
#include <zlib.h>

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
  const bool empty = std::ranges::find(shape, 0U) != shape.end();
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

namespace {

// Largest compression ratio of deflate, reached for zeros.
constexpr std::uint64_t kMaxPacking = 1032;

std::uint64_t BytesOf(const Hdf5Handle& data_set, const ArrayShape& shape) {
  const Hdf5Handle type{H5Dget_type(data_set.id()), &H5Tclose};
  std::uint64_t bytes = H5Tget_size(type.id());
  for (const std::uint64_t size : shape) bytes *= size;
  return bytes;
}

H5Z_filter_t Filter(const Hdf5Handle& creation, unsigned int index) {
  unsigned int flags = 0;
  size_t parameters = 0;
  return H5Pget_filter2(creation.id(), index, &flags, &parameters, nullptr, 0, nullptr, nullptr);
}

// Rejects repeated deflate: with it a few bytes would decompress to more than the memory.
bool IsPackedAtMostOnce(const Hdf5Handle& creation) {
  const int filters = H5Pget_nfilters(creation.id());
  int deflates = 0;
  for (int i = 0; i < filters; ++i) {
    const H5Z_filter_t filter = Filter(creation, static_cast<unsigned int>(i));
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

namespace {

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
