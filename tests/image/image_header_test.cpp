// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/image/image_format.h"
#include "soslam/image/tiff_file.h"
#include "support/drawn_photos.h"
#include "support/folder_test.h"
#include "support/image_files.h"

namespace soslam {
namespace {

const cv::Mat kImage(40, 60, CV_8UC1, cv::Scalar(90));

class ImageHeaderTest : public FolderTest {
 protected:
  std::optional<ImageHeader> Read(const std::string& bytes) {
    return ReadImageHeader(Write("image", bytes));
  }
  void ExpectHeader(const std::string& bytes, int orientation) {
    const auto header = Read(bytes);
    ASSERT_TRUE(header);
    EXPECT_EQ(header->stored.width, 60);
    EXPECT_EQ(header->stored.height, 40);
    EXPECT_EQ(header->orientation, orientation);
  }
};

TEST_F(ImageHeaderTest, SizesOfAllFormats) {
  for (const char* extension : {".jpg", ".png", ".webp", ".bmp", ".tiff"}) {
    SCOPED_TRACE(extension);
    ExpectHeader(EncodedImage(extension, kImage), 1);
  }
  ExpectHeader(EncodedImage(".webp", kImage, {cv::IMWRITE_WEBP_QUALITY, 50}), 1);  // with loss
}

TEST_F(ImageHeaderTest, ExifMayComeAfterOtherSegments) {
  const std::string jpeg = JpegWithExif(EncodedImage(".jpg", kImage), ExifOf(6));
  const std::string xmp = JpegSegment('\xe1', std::string("http://ns.adobe.com/xap/1.0/\0", 29));
  ExpectHeader(std::string(jpeg).insert(2, xmp + "\xff\xff"), 6);
}

TEST_F(ImageHeaderTest, OrientationsThatMeanNothingAreUpright) {
  const std::string jpeg = EncodedImage(".jpg", kImage);
  for (const int orientation : {0, 9, 300}) {
    ExpectHeader(JpegWithExif(jpeg, ExifOf(orientation)), 1);
  }
  ExpectHeader(JpegWithExif(jpeg, ""), 1);
  ExpectHeader(JpegWithExif(jpeg, ExifOf(6).substr(0, 12)), 1);
  ExpectHeader(JpegWithExif(jpeg, Tiff(ByteOrder::kBigEndian, {{274, 6, 10}})), 1);  // no integer
}

TEST_F(ImageHeaderTest, NoHeaderWhereThereIsNone) {
  EXPECT_FALSE(ReadImageHeader(folder_ / "none"));
  EXPECT_FALSE(ReadImageHeader(folder_.path()));
  for (const char* bytes : {"", "hello", "BM", "\xff\xd8\xff", "RIFF", "P5 2 2 255 "}) {
    EXPECT_FALSE(Read(bytes)) << bytes;
  }
  for (const char* extension : {".jpg", ".png", ".webp", ".bmp"}) {
    EXPECT_FALSE(Read(EncodedImage(extension, kImage).substr(0, 20))) << extension;
  }
}

// Whatever a file has before and after what is asked for.
TEST_F(ImageHeaderTest, ReadsFewBytes) {
  const cv::Mat image = cv::Mat::zeros(500, 500, CV_8UC1);
  const std::string profile = JpegSegment('\xe2', std::string(60'000, 'x'));
  std::string jpeg = EncodedImage(".jpg", image).insert(2, profile + profile + profile);
  for (const std::string& bytes :
       {JpegWithExif(jpeg, ExifOf(6)), PngWithExif(EncodedImage(".png", image), ExifOf(6), true),
        GreyTiff(image, 6, ByteOrder::kLittleEndian)}) {
    size_t read = 0;
    const ImageBytes file([&](std::uint64_t begin, size_t count) {
      const std::string part = begin < bytes.size() ? bytes.substr(begin, count) : "";
      read += part.size();
      return part;
    });
    const auto header = FindImageFormat(bytes.substr(0, kSignatureSize))->header(file);
    ASSERT_TRUE(header);
    EXPECT_EQ(header->orientation, 6);
    EXPECT_LT(read, 500u);
  }
}

TEST_F(ImageHeaderTest, AmbiguousTiffsAreRefused) {
  const std::string tiff = GreyTiff(kImage, 1, ByteOrder::kLittleEndian);
  std::string twice = tiff;  // the tag of the height becomes another width
  twice.replace(8 + 2 + 12, 2, NumberBytes(256, 2, ByteOrder::kLittleEndian));
  EXPECT_FALSE(Read(twice));
  std::string wide = tiff;  // 32 bits a pixel
  wide.replace(8 + 2 + 2 * 12 + 8, 2, NumberBytes(32, 2, ByteOrder::kLittleEndian));
  EXPECT_FALSE(Read(wide));
}

constexpr ImageSize kPhoto = {4000, 3000};
constexpr std::uint64_t kDirectory = 0x8769, kInFilm = 0xA405;
constexpr double kFilmDiagonalMm = 43.267;

// EXIF data whose own directory has these fields, then `rest`.
std::string ExifWith(const std::vector<TiffField>& fields, const std::string& rest = "") {
  constexpr ByteOrder kOrder = ByteOrder::kLittleEndian;
  return Tiff(kOrder, {{kDirectory, TiffRest(1), 4}}, Tiff(kOrder, fields).substr(8) + rest);
}

TEST(ExifTimeTest, SortsByTime) {
  EXPECT_EQ(ExifTimeTaken(ExifOfTime("2024:01:31 23:59:59", "2500")), "20240131235959.2500");
  const std::vector<TiffField> short_fraction = {{0x9003, TiffRest(1) + TiffRest(2) - 8, 2, 20},
                                                 {0x9291, '2' | '5' << 8, 2, 3}};  // in its place
  EXPECT_EQ(ExifTimeTaken(ExifWith(short_fraction, "2024:01:31 23:59:59")), "20240131235959.25");
  EXPECT_LT(ExifTimeTaken(ExifOfTime("2024:01:31 23:59:59", "2500")),
            ExifTimeTaken(ExifOfTime("2024:01:31 23:59:59", "3000")));
  for (const char* unknown : {"0000:00:00 00:00:00", "    :  :     :  :  ", "", "2024:01:31"}) {
    EXPECT_EQ(ExifTimeTaken(ExifOfTime(unknown)), "") << unknown;
  }
  EXPECT_EQ(ExifTimeTaken(ExifOf(1)), "");
  EXPECT_EQ(ExifTimeTaken(ExifOfTime("2024:01:31 23:59:59").substr(0, 30)), "");
}

TEST_F(ImageHeaderTest, TimesAreReadInAllFormats) {
  const std::string exif = ExifOfTime("2024:01:31 23:59:59");
  for (const std::string& bytes :
       {JpegWithExif(EncodedImage(".jpg", kImage), exif),
        PngWithExif(EncodedImage(".png", kImage), exif, true),
        WebpWithExif(EncodedImage(".webp", kImage), kImage.size(), exif)}) {
    EXPECT_EQ(Read(bytes).value_or(ImageHeader()).time_taken, "20240131235959.0000");
  }
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

}  // namespace
}  // namespace soslam
