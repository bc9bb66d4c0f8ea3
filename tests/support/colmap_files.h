// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>
#include <string>
#include <vector>

namespace soslam {

// Bytes of COLMAP's binary files, one number after the other.
class ColmapBytes {
 public:
  template <typename Number>
  ColmapBytes& Add(Number number) {
    std::string bytes(sizeof(Number), '\0');
    std::memcpy(bytes.data(), &number, sizeof(Number));
    bytes_ += bytes;
    return *this;
  }
  ColmapBytes& Reals(const std::vector<double>& numbers) {
    for (const double number : numbers) Add(number);
    return *this;
  }
  ColmapBytes& Text(const std::string& text) {
    bytes_ += text + '\0';
    return *this;
  }
  operator const std::string&() const { return bytes_; }  // NOLINT: reads as the bytes

 private:
  std::string bytes_;
};

inline std::string ColmapCamerasBinary(int model, const std::vector<double>& parameters) {
  return ColmapBytes()
      .Add<std::uint64_t>(1)
      .Add<std::uint32_t>(1)
      .Add<std::int32_t>(model)
      .Add<std::uint64_t>(640)
      .Add<std::uint64_t>(480)
      .Reals(parameters);
}

}  // namespace soslam
