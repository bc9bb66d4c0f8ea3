// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>

#include "fuzz/fuzz_target.h"
#include "soslam/image/image_format.h"
#include "soslam/image/onnx_header.h"
#include "soslam/image/read_image.h"

namespace soslam {
namespace {

// What is read has the size that the header says.
void CheckHeader(const std::filesystem::path& file) {
  const auto header = ReadImageHeader(file);
  const cv::Mat image = ReadImage(file, cv::IMREAD_GRAYSCALE);
  const ImageSize size = header ? header->Size(ImageOrientation::kUpright) : ImageSize{};
  if (size.width == image.cols && size.height == image.rows) return;
  throw std::logic_error("the header says another size: " + file.string());
}

const FuzzTarget kImage("image", [](const HostileInput& input) {
  const auto file = input.AsFile("image.png");
  IsAccepted(file, [&] {
    ReadImage(file, cv::IMREAD_GRAYSCALE, ImageOrientation::kUpright, cv::Size(60, 40));
  });
  IsAccepted(file, [&] { ReadImage(file, cv::IMREAD_COLOR, ImageOrientation::kStored); });
  if (IsAccepted(file, [&] { ReadImage(file, cv::IMREAD_GRAYSCALE); })) CheckHeader(file);
});

// Not OpenCV's reader, which is not for hostile input.
const FuzzTarget kNetworks("networks", [](const HostileInput& input) {
  const auto file = input.AsFile("network.onnx");
  const std::string bytes = FileBytes(file);
  IsAccepted(file, [&] { ReadOnnxHeader(bytes, file.string()); });
});

}  // namespace
}  // namespace soslam
