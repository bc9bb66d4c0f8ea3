// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "support/image_files.h"
#include "support/temporary_folder.h"

namespace soslam {

// A view of a large picture of rectangles, `shift` pixels to the right of its left end.
inline cv::Mat DrawnView(int shift, const cv::Size& size = {320, 240}) {
  cv::RNG random(7);
  cv::Mat picture(size.height, 4 * size.width, CV_8UC3, cv::Scalar(90, 90, 90));
  for (int i = 0; i < 300; ++i) {
    const cv::Point corner(random.uniform(0, picture.cols), random.uniform(0, picture.rows));
    const cv::Size sides(random.uniform(5, 40), random.uniform(5, 40));
    const cv::Scalar colour(random.uniform(0, 255), random.uniform(0, 255), random.uniform(0, 255));
    cv::rectangle(picture, {corner, sides}, colour, cv::FILLED);
  }
  return picture(cv::Rect({shift, 0}, size)).clone();
}

inline cv::Mat GreyOf(const cv::Mat& image) {
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

inline cv::Mat Blurred(const cv::Mat& image) {
  cv::Mat blurred;
  cv::GaussianBlur(image, blurred, {}, 4.0);
  return blurred;
}

// Writes the image as JPEG, with these EXIF data if any.
inline void WritePhoto(const std::filesystem::path& path, const cv::Mat& image,
                       const std::string& exif = "") {
  const std::string jpeg = EncodedImage(".jpg", image);
  WriteBytes(path, exif.empty() ? jpeg : JpegWithExif(jpeg, exif));
}

// EXIF data with an orientation and a focal length as of a film of 36 x 24 mm.
inline std::string ExifOfCamera(int orientation, int focal_mm,
                                ByteOrder order = ByteOrder::kBigEndian) {
  constexpr std::uint64_t kExifDirectory = 0x8769, kFocalLengthIn35mmFilm = 0xA405;
  const std::string directory =
      Tiff(order, {{kFocalLengthIn35mmFilm, static_cast<std::uint64_t>(focal_mm)}}).substr(8);
  return Tiff(order,
              {{274, static_cast<std::uint64_t>(orientation)}, {kExifDirectory, TiffRest(2), 4}},
              directory);
}

// EXIF data with the time at which a photo was taken, "2024:01:31 23:59:59", and at least four
// digits of the fraction of its second.
inline std::string ExifOfTime(const std::string& time, const std::string& fraction = "0000") {
  constexpr ByteOrder kOrder = ByteOrder::kLittleEndian;
  constexpr std::uint64_t kExifDirectory = 0x8769, kTime = 0x9003, kFraction = 0x9291, kAscii = 2;
  const size_t texts = TiffRest(1) + TiffRest(2) - 8;
  const std::string directory =
      Tiff(kOrder, {{kTime, texts, kAscii, time.size() + 1},
                    {kFraction, texts + time.size() + 1, kAscii, fraction.size() + 1}})
          .substr(8);
  return Tiff(kOrder, {{kExifDirectory, TiffRest(1), 4}},
              directory + time + std::string(1, '\0') + fraction + std::string(1, '\0'));
}

}  // namespace soslam
