// SPDX-License-Identifier: BSD-3-Clause
#include "image/exif_focal_length.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/drawn_photos.h"

namespace soslam {
namespace {

constexpr ImageSize kPhoto = {4000, 3000};
constexpr std::uint64_t kDirectory = 0x8769, kInFilm = 0xA405;
constexpr double kFilmDiagonalMm = 43.267;

// EXIF data whose own directory has these fields, then `rest`.
std::string ExifWith(const std::vector<TiffField>& fields, const std::string& rest = "") {
  constexpr ByteOrder kOrder = ByteOrder::kLittleEndian;
  return Tiff(kOrder, {{kDirectory, TiffRest(1), 4}}, Tiff(kOrder, fields).substr(8) + rest);
}

TEST(ExifFocalLengthTest, IsThatOfTheFilm) {
  for (const ByteOrder order : {ByteOrder::kLittleEndian, ByteOrder::kBigEndian}) {
    const auto focal = ExifFocalOverDiagonal(ExifOfCamera(1, 26, order), kPhoto);
    ASSERT_TRUE(focal);
    EXPECT_NEAR(*focal, 26.0 / kFilmDiagonalMm, 1e-12);
  }
}

// 5.4 mm with 7000 pixels per centimetre are 3780 pixels, in an image with a diagonal of 5000.
TEST(ExifFocalLengthTest, OfTheSensorIsScaledWithTheImage) {
  const auto ratio = [](std::uint64_t numerator, std::uint64_t denominator) {
    return NumberBytes(numerator, 4, ByteOrder::kLittleEndian) +
           NumberBytes(denominator, 4, ByteOrder::kLittleEndian);
  };
  const std::uint64_t values = TiffRest(1) + TiffRest(5) - 8;
  const std::string exif = ExifWith(
      {{0x920A, values, 5}, {0xA002, 4000}, {0xA003, 3000}, {0xA20E, values + 8, 5}, {0xA210, 3}},
      ratio(54, 10) + ratio(7000, 1));
  for (const ImageSize& stored : {kPhoto, ImageSize{1000, 750}, ImageSize{750, 1000}}) {
    const auto focal = ExifFocalOverDiagonal(exif, stored);
    ASSERT_TRUE(focal);
    EXPECT_NEAR(*focal, 3780.0 / 5000.0, 1e-12);
  }
}

TEST(ExifFocalLengthTest, IsNotKnown) {
  EXPECT_FALSE(ExifFocalOverDiagonal("", kPhoto));
  EXPECT_FALSE(ExifFocalOverDiagonal("no EXIF data", kPhoto));
  EXPECT_FALSE(ExifFocalOverDiagonal(ExifOf(1), kPhoto));
  EXPECT_FALSE(ExifFocalOverDiagonal(ExifWith({{kInFilm, 0}}), kPhoto)) << "0: unknown";
  EXPECT_FALSE(ExifFocalOverDiagonal(ExifWith({{kInFilm, 5000}}), kPhoto)) << "absurd";
  EXPECT_FALSE(ExifFocalOverDiagonal(ExifWith({{0x920A, 0xFFFFFFF0, 5}, {0xA20E, 0, 5}}), kPhoto))
      << "beyond the end";
  const std::string of_other_shape = ExifWith({{0xA002, 4000}, {0xA003, 3000}, {kInFilm, 26}});
  EXPECT_TRUE(ExifFocalOverDiagonal(of_other_shape, kPhoto));
  EXPECT_FALSE(ExifFocalOverDiagonal(of_other_shape, {3000, 3000})) << "cropped";
}

TEST(ExifFocalLengthTest, EveryTruncationIsTaken) {
  const std::string exif = ExifOfCamera(6, 26);
  for (size_t size = 0; size < exif.size(); ++size) {
    const auto focal = ExifFocalOverDiagonal(std::string_view(exif).substr(0, size), kPhoto);
    EXPECT_TRUE(!focal || std::abs(*focal - 26.0 / kFilmDiagonalMm) < 1e-12) << size;
  }
}

TEST(ExifFocalLengthTest, IsInTheHeaderOfAPhoto) {
  const TemporaryFolder folder;
  WritePhoto(folder / "photo.jpg", DrawnView(0), ExifOfCamera(6, 28));
  const auto header = ReadImageHeader(folder / "photo.jpg");
  ASSERT_TRUE(header && header->focal_over_diagonal);
  EXPECT_EQ(header->orientation, 6);
  EXPECT_NEAR(*header->focal_over_diagonal, 28.0 / kFilmDiagonalMm, 1e-12);
  WritePhoto(folder / "photo.jpg", DrawnView(0));
  EXPECT_FALSE(ReadImageHeader(folder / "photo.jpg")->focal_over_diagonal);
}

}  // namespace
}  // namespace soslam
