// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/traits.hpp>
#include <span>
#include <string>
#include <vector>

namespace soslam {

using ArrayShape = std::vector<std::uint64_t>;

// Numbers as HDF5's filters "shuffle" and "deflate" store them: first bytes of all elements, second
// bytes of all, ..., in zlib's format. Made without the HDF5 library, so that any thread may pack
// and unpack.
struct PackedArray {
  ArrayShape shape;
  int depth;          // CV_8U, CV_16S, CV_32S, CV_32F or CV_64F
  std::string bytes;  // none of no elements
};

// `values` fill the shape, in less than 2 GiB. Throws std::length_error otherwise.
PackedArray Pack(const ArrayShape& shape, int depth, const void* values);

// Rows x columns, or rows x columns x channels where there are several.
PackedArray Pack(const cv::Mat& matrix);

template <typename T>
PackedArray Pack(const std::vector<T>& values) {
  return Pack({values.size()}, cv::DataType<T>::depth, values.data());
}

// False when `packed` is damaged, or does not make up `values`, which are elements of so many
// bytes.
bool Unpack(const std::string& packed, size_t element_size, std::span<std::byte> values);

}  // namespace soslam
