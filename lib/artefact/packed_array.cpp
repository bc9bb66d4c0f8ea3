// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/packed_array.h"

#include <fmt/format.h>
#include <isa-l/igzip_lib.h>
#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <numeric>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace soslam {
namespace {

static_assert(std::endian::native == std::endian::little, "files are little-endian");

// OpenCV counts pixels, and ISA-L bytes, by numbers of 32 bits.
constexpr size_t kMaxBytes = std::numeric_limits<std::int32_t>::max();

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

// In zlib's format. ISA-L takes a third of libdeflate's time, which takes less to unpack.
//
// The loop of ISA-L 2.30 that packs all but a few bytes begins with a hash of a register that holds
// an address, unless bytes went before. So the first ones go by themselves: what is that short is
// packed by another loop. Otherwise one array in thousands would be packed differently next time.
std::string Deflate(std::span<std::uint8_t> bytes) {
  constexpr size_t kFirst = 16;
  const size_t bound = bytes.size() + bytes.size() / 1000 + 100;  // as stored blocks, at most
  const auto deflated = std::make_unique_for_overwrite<std::uint8_t[]>(bound);
  const auto work_space = std::make_unique_for_overwrite<std::uint8_t[]>(ISAL_DEF_LVL1_DEFAULT);
  isal_zstream stream;
  isal_deflate_init(&stream);
  stream.level = 1;  // up to 2, all x86-64 processors with SSE 4.2 give the same bytes
  stream.level_buf = work_space.get();
  stream.level_buf_size = ISAL_DEF_LVL1_DEFAULT;
  stream.gzip_flag = IGZIP_ZLIB;
  stream.next_out = deflated.get();
  stream.avail_out = static_cast<std::uint32_t>(bound);
  const auto deflate = [&](std::span<std::uint8_t> some, std::uint16_t flush) {
    stream.next_in = some.data();
    stream.avail_in = static_cast<std::uint32_t>(some.size());
    stream.flush = flush;
    stream.end_of_stream = flush == NO_FLUSH;
    const int error = isal_deflate(&stream);
    if (error != COMP_OK) throw std::runtime_error(fmt::format("ISA-L: error {}", error));
  };
  const size_t first = std::min(kFirst, bytes.size());
  deflate(bytes.first(first), SYNC_FLUSH);
  deflate(bytes.subspan(first), NO_FLUSH);
  if (stream.internal_state.state != ZSTATE_END) throw std::logic_error("ISA-L: no room");
  return {deflated.get(), deflated.get() + stream.total_out};
}

}  // namespace

PackedArray Pack(const ArrayShape& shape, int depth, const void* values) {
  const auto element_size = static_cast<size_t>(CV_ELEM_SIZE1(depth));
  const size_t bytes =
      std::accumulate(shape.begin(), shape.end(), element_size, std::multiplies<size_t>());
  PackedArray packed{shape, depth, {}};
  if (bytes == 0) return packed;
  if (bytes > kMaxBytes) {
    throw std::length_error(
        fmt::format("an array of {} bytes cannot be packed; expected less than 2 GiB", bytes));
  }
  // OpenCV has no type for what is only read.
  auto* elements = const_cast<std::byte*>(static_cast<const std::byte*>(values));
  const auto shuffled = std::make_unique_for_overwrite<std::byte[]>(bytes);
  const size_t count = bytes / element_size;
  cv::split(Elements(elements, count, element_size), Channels(shuffled.get(), count, element_size));
  packed.bytes = Deflate({reinterpret_cast<std::uint8_t*>(shuffled.get()), bytes});
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
  if (values.size() > kMaxBytes) return false;
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>
      decompressor(libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
  if (!decompressor) throw std::bad_alloc();
  std::vector<std::byte> shuffled(values.size());
  size_t used = 0;
  const auto result = libdeflate_zlib_decompress_ex(  // as many bytes as there are, or an error
      decompressor.get(), packed.data(), packed.size(), shuffled.data(), shuffled.size(), &used,
      nullptr);
  if (result != LIBDEFLATE_SUCCESS || used != packed.size()) return false;
  const size_t count = values.size() / element_size;
  cv::Mat elements = Elements(values.data(), count, element_size);
  cv::merge(Channels(shuffled.data(), count, element_size), elements);
  return true;
}

}  // namespace soslam
