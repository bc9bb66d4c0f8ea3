// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/packed_array.h"

#include <libdeflate.h>

#include <bit>
#include <functional>
#include <memory>
#include <new>
#include <numeric>
#include <opencv2/core.hpp>

namespace soslam {
namespace {

static_assert(std::endian::native == std::endian::little, "files are little-endian");

// Bytes as an image of one row, whose pixels are elements, and its channels: the first bytes of all
// elements, then the second bytes of all, ...
cv::Mat Elements(std::byte* bytes, size_t count, size_t element_size) {
  return {1, static_cast<int>(count), CV_8UC(static_cast<int>(element_size)), bytes};
}
std::vector<cv::Mat> Channels(std::byte* shuffled, size_t count, size_t element_size) {
  std::vector<cv::Mat> channels;
  for (size_t k = 0; k < element_size; ++k) {
    channels.push_back(Elements(shuffled + k * count, count, 1));
  }
  return channels;
}

}  // namespace

PackedArray Pack(const ArrayShape& shape, int depth, const void* values) {
  const auto element_size = static_cast<size_t>(CV_ELEM_SIZE1(depth));
  const size_t bytes =
      std::accumulate(shape.begin(), shape.end(), element_size, std::multiplies<size_t>());
  PackedArray packed{shape, depth, {}};
  if (bytes == 0) return packed;
  // OpenCV has no type for what is only read.
  auto* elements = const_cast<std::byte*>(static_cast<const std::byte*>(values));
  std::vector<std::byte> shuffled(bytes);
  const size_t count = bytes / element_size;
  cv::split(Elements(elements, count, element_size),
            Channels(shuffled.data(), count, element_size));
  constexpr int kFastest = 1;
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kFastest), &libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  packed.bytes.resize(libdeflate_zlib_compress_bound(compressor.get(), bytes));
  packed.bytes.resize(libdeflate_zlib_compress(compressor.get(), shuffled.data(), bytes,
                                               packed.bytes.data(), packed.bytes.size()));
  return packed;
}

PackedArray Pack(const cv::Mat& matrix) {
  ArrayShape shape = {static_cast<std::uint64_t>(matrix.rows),
                      static_cast<std::uint64_t>(matrix.cols)};
  if (matrix.channels() > 1) shape.push_back(static_cast<std::uint64_t>(matrix.channels()));
  const cv::Mat contiguous = matrix.isContinuous() ? matrix : matrix.clone();
  return Pack(shape, matrix.depth(), contiguous.data);
}

bool Unpack(const std::string& packed, size_t element_size, std::span<std::byte> values) {
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>
      decompressor(libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
  if (!decompressor) throw std::bad_alloc();
  std::vector<std::byte> shuffled(values.size());
  const auto result = libdeflate_zlib_decompress(  // as many bytes as there are, or an error
      decompressor.get(), packed.data(), packed.size(), shuffled.data(), shuffled.size(), nullptr);
  if (result != LIBDEFLATE_SUCCESS) return false;
  const size_t count = values.size() / element_size;
  cv::Mat elements = Elements(values.data(), count, element_size);
  cv::merge(Channels(shuffled.data(), count, element_size), elements);
  return true;
}

}  // namespace soslam
