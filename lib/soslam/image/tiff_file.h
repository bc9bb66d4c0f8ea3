// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "soslam/image/image_format.h"

namespace soslam {

// The orientation in EXIF data, 1 to 8; none if they have none.
std::optional<int> ExifOrientation(std::string_view exif);

// The focal length in EXIF data over the diagonal of the image, which has `stored` pixels: a guess,
// as cameras round it. From FocalLengthIn35mmFilm, otherwise from FocalLength and the resolution of
// the sensor. None if the data have neither, an absurd one, or one of an image that was cropped
// since.
std::optional<double> ExifFocalOverDiagonal(std::string_view exif, const ImageSize& stored);

// DateTimeOriginal in EXIF data with the fraction of its second, as text that sorts by time,
// "20240131235959.25"; empty if they have none.
std::string ExifTimeTaken(std::string_view exif);

// A segment of a JPEG file with EXIF data that have this focal length only, rounded to a millimetre
// of 35 mm film.
std::string FocalLengthSegment(double focal_over_diagonal);

}  // namespace soslam
