// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/read_image.h"

#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "soslam/image/distort_pixels.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/image_files.h"

namespace soslam {
namespace {

// Grey values that grow to the right and downwards, with enough detail that no part is negligible.
cv::Mat TestImage() {
  cv::Mat image(40, 60, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<uchar>(y, x) = static_cast<uchar>(2 * x + 3 * y + (7 * x * y) % 5);
    }
  }
  return image;
}

// Where pixel (x, y) of an image that viewers show is stored, as EXIF 2.32 defines orientations.
cv::Point StoredPixel(const cv::Size& stored, int orientation, int x, int y) {
  const int right = stored.width - 1, bottom = stored.height - 1;
  const cv::Point pixels[] = {{x, y}, {right - x, y},  {right - x, bottom - y}, {x, bottom - y},
                              {y, x}, {y, bottom - x}, {right - y, bottom - x}, {right - y, x}};
  return pixels[orientation - 1];
}

void ExpectTurned(const cv::Mat& upright, const cv::Mat& stored, int orientation) {
  const cv::Size size = orientation < 5 ? stored.size() : cv::Size(stored.rows, stored.cols);
  ASSERT_EQ(upright.size(), size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      ASSERT_EQ(upright.at<uchar>(y, x),
                stored.at<uchar>(StoredPixel(stored.size(), orientation, x, y)))
          << x << ", " << y;
    }
  }
}

constexpr int kGrey = cv::IMREAD_GRAYSCALE, kColour = cv::IMREAD_COLOR;

class ReadImageTest : public FolderTest {
 protected:
  // Expects that the file is refused by its path and these words, in grey as in colour.
  static void ExpectRefused(const std::filesystem::path& path,
                            std::vector<std::string> words = {}) {
    words.push_back(path.string());
    ExpectError<InputError>([&] { ReadImage(path, kGrey); }, words);
    ExpectError<InputError>([&] { ReadImage(path, kColour); }, words);
  }
};

// The image with a note of its orientation in each format that has one.
std::vector<std::string> WithOrientation(const cv::Mat& image, int orientation, ByteOrder order) {
  const std::string exif = ExifOf(orientation, order);
  const std::string png = EncodedImage(".png", image);
  return {JpegWithExif(EncodedImage(".jpg", image), exif), PngWithExif(png, exif, false),
          PngWithExif(png, exif, true),
          WebpWithExif(EncodedImage(".webp", image), image.size(), exif),
          GreyTiff(image, orientation, order)};
}

TEST_F(ReadImageTest, EveryOrientationIsTurnedUpright) {
  for (const ByteOrder order : {ByteOrder::kLittleEndian, ByteOrder::kBigEndian}) {
    const auto plain = WithOrientation(TestImage(), 1, order);
    for (int orientation = 1; orientation <= 8; ++orientation) {
      const auto files = WithOrientation(TestImage(), orientation, order);
      for (size_t i = 0; i < files.size(); ++i) {
        SCOPED_TRACE(testing::Message() << "orientation " << orientation << ", file " << i);
        const cv::Mat stored = ReadImage(Write("plain", plain[i]), kGrey);
        const auto path = Write("turned", files[i]);
        ExpectTurned(ReadImage(path, kGrey), stored, orientation);
        ExpectTurned(ReadImage(path, kGrey, ImageOrientation::kStored), stored, 1);
        EXPECT_EQ(ReadImage(path, kColour).size(), ReadImage(path, kGrey).size());
      }
    }
  }
}

TEST_F(ReadImageTest, SizesThatExifSwapsAreExplained) {
  const auto path = Write("a.jpg", JpegWithExif(EncodedImage(".jpg", TestImage()), ExifOf(6)));
  EXPECT_EQ(ReadImage(path, kGrey, ImageOrientation::kUpright, cv::Size(40, 60)).cols, 40);
  EXPECT_EQ(ReadImage(path, kColour, ImageOrientation::kStored, cv::Size(60, 40)).cols, 60);
  ExpectError<InputError>(
      [&] { ReadImage(path, kGrey, ImageOrientation::kUpright, cv::Size(60, 40)); },
      {"a.jpg", "40 x 60", "60 x 40", "orientation 6", "image_orientation"});
  ExpectError<InputError>(
      [&] { ReadImage(path, kGrey, ImageOrientation::kStored, cv::Size(40, 60)); },
      {"60 x 40", "upright image", "is stored"});
}

constexpr const char* kExtensions[] = {".jpg", ".png", ".webp", ".bmp", ".tiff"};

TEST_F(ReadImageTest, BytesAfterTheEndAreNotRead) {
  const std::string other = EncodedImage(".jpg", cv::Mat(8, 8, CV_8UC1, cv::Scalar(3)));
  for (const char* extension : kExtensions) {
    const std::string image = EncodedImage(extension, TestImage());
    const cv::Mat expected = ReadImage(Write("plain", image), kGrey);
    for (const std::string& tail :
         {std::string(100, '\0'), std::string("\n"), std::string("\xff"), other,
          std::string("\0\0\x01\x0bMotionPhoto_Data\0\0\0\x18"
                      "ftypmp42SEFT",
                      36)}) {
      const cv::Mat read = ReadImage(Write("tail", image + tail), kGrey);
      EXPECT_EQ(cv::norm(read, expected, cv::NORM_INF), 0.0) << extension;
    }
  }
}

TEST_F(ReadImageTest, OtherKindsOfJpegAreRead) {
  for (const std::vector<int>& parameters :
       {std::vector<int>{cv::IMWRITE_JPEG_PROGRESSIVE, 1},
        std::vector<int>{cv::IMWRITE_JPEG_RST_INTERVAL, 2},
        std::vector<int>{cv::IMWRITE_JPEG_PROGRESSIVE, 1, cv::IMWRITE_JPEG_RST_INTERVAL, 1}}) {
    const std::string jpeg = EncodedImage(".jpg", TestImage(), parameters);
    const cv::Mat expected = cv::imdecode(std::vector<char>(jpeg.begin(), jpeg.end()), 0);
    EXPECT_EQ(cv::norm(ReadImage(Write("a.jpg", jpeg + "\n"), kGrey), expected, cv::NORM_INF), 0.0);
    for (size_t size = 0; size < jpeg.size(); size += 7) {
      ExpectRefused(Write("cut.jpg", jpeg.substr(0, size)));
    }
  }
}

// The ends of other images do not end the image.
TEST_F(ReadImageTest, CutShortBeforeAnotherImageIsRefused) {
  const std::string thumbnail = EncodedImage(".jpg", cv::Mat(8, 8, CV_8UC1, cv::Scalar(3)));
  const std::string jpeg =
      JpegWithExif(EncodedImage(".jpg", TestImage()), ExifOf(1, ByteOrder::kBigEndian, thumbnail));
  EXPECT_NO_THROW(ReadImage(Write("whole.jpg", jpeg), kGrey));
  for (const size_t missing : {2u, 10u, 100u}) {
    const std::string cut = jpeg.substr(0, jpeg.size() - missing);
    for (const std::string& tail : {std::string(), thumbnail, std::string("\xff\xc0\xff\xd9")}) {
      ExpectRefused(Write("cut.jpg", cut + tail), {"cut short", "EOI"});
    }
  }
  const std::string png = EncodedImage(".png", TestImage());
  ExpectRefused(Write("cut.png", png.substr(0, png.size() - 30) + png.substr(png.size() - 12)),
                {"cut short", "IEND"});
}

// A bitmap that is packed by run lengths.
std::string PackedBmp(const cv::Mat& grey) {
  constexpr size_t kCompression = 30, kPixels = 54 + 4 * 256;
  std::string bmp = EncodedImage(".bmp", grey).substr(0, kPixels);
  bmp[kCompression] = 1;
  for (int y = grey.rows - 1; y >= 0; --y) {
    for (int x = 0; x < grey.cols; ++x) bmp += {'\1', static_cast<char>(grey.at<uchar>(y, x))};
    bmp += {'\0', y > 0 ? '\0' : '\1'};  // end of a row, of the picture
  }
  return bmp;
}

// A TIFF file with a strip for each of red, green and blue, which are all the same.
std::string TiffOfPlanes(const cv::Mat& grey) {
  constexpr ByteOrder kOrder = ByteOrder::kLittleEndian;
  const size_t lists = TiffRest(10), pixels = lists + 6 + 12 + 12;
  const std::string plane(grey.datastart, grey.dataend);
  std::string rest;
  for (int i = 0; i < 3; ++i) rest += NumberBytes(8, 2, kOrder);
  for (int i = 0; i < 3; ++i) rest += NumberBytes(pixels + i * plane.size(), 4, kOrder);
  for (int i = 0; i < 3; ++i) rest += NumberBytes(plane.size(), 4, kOrder);
  const auto height = static_cast<std::uint64_t>(grey.rows);
  return Tiff(kOrder,
              {{256, static_cast<std::uint64_t>(grey.cols)},
               {257, height},
               {258, lists, 3, 3},
               {259, 1},
               {262, 2},  // red, green, blue
               {273, lists + 6, 4, 3},
               {277, 3},
               {278, height},
               {279, lists + 18, 4, 3},
               {284, 2}},  // separate
              rest + plane + plane + plane);
}

TEST_F(ReadImageTest, PackedBitmapsAndSeparatePlanesAreRead) {
  for (const std::string& file : {PackedBmp(TestImage()), TiffOfPlanes(TestImage())}) {
    const cv::Mat read = ReadImage(Write("a", file), kGrey);
    EXPECT_EQ(cv::norm(read, TestImage(), cv::NORM_INF), 0.0);
  }
}

TEST_F(ReadImageTest, CutShortAnywhereIsRefused) {
  const std::string packed = PackedBmp(TestImage());
  for (const std::string& whole :
       {EncodedImage(".jpg", TestImage()), EncodedImage(".png", TestImage()),
        EncodedImage(".webp", TestImage()), EncodedImage(".bmp", TestImage()),
        packed.substr(0, packed.size() - 2),  // which has all pixels
        GreyTiff(TestImage(), 1, ByteOrder::kBigEndian), TiffOfPlanes(TestImage())}) {
    for (size_t missing = 1; missing <= whole.size(); missing += 1 + missing / 20) {
      ExpectRefused(Write("cut", whole.substr(0, whole.size() - missing)));
    }
  }
}

TEST_F(ReadImageTest, BadFilesAreNamed) {
  ExpectRefused(folder_ / "none.png", {"no such file"});
  ExpectRefused(folder_.path());
  ExpectRefused(Write("empty.png", ""), {"is empty"});
  ExpectRefused(Write("text.png", "hello"), {"decoded", "JPEG, PNG"});
}

TEST_F(ReadImageTest, SizesBeyondMemoryAreRefusedUnread) {
  std::string png = EncodedImage(".png", TestImage());
  png.replace(16, 8, std::string("\0\0\x7f\xff\0\0\x7f\xff", 8));  // width and height in IHDR
  ExpectRefused(Write("a.png", png), {"32767 x 32767", "at most"});
  std::string jpeg = EncodedImage(".jpg", TestImage());
  const size_t frame = jpeg.find("\xff\xc0");  // marker, length, bits, height, width
  jpeg.replace(frame + 5, 4, "\xff\xfe\xff\xff");
  ExpectRefused(Write("a.jpg", jpeg), {"65535 x 65534", "at most"});
  std::string bmp = EncodedImage(".bmp", TestImage());
  bmp.replace(18, 8, std::string("\xff\xff\0\0\xff\xff\0\0", 8));
  ExpectRefused(Write("a.bmp", bmp), {"65535", "at most"});
  std::string tiff = GreyTiff(TestImage(), 1, ByteOrder::kBigEndian);
  for (const size_t entry : {0u, 1u}) tiff.replace(8 + 2 + 12 * entry + 8, 2, "\xff\xff");
  ExpectRefused(Write("a.tiff", tiff), {"65535", "at most"});
  const std::string webp = WebpWithExif(EncodedImage(".webp", TestImage()), {1 << 20, 1 << 20}, "");
  ExpectRefused(Write("a.webp", webp), {"1048576", "at most"});
}

// Decoders read past what may not be there.
TEST_F(ReadImageTest, SizesWhereOnlyDecodersLookAreRefused) {
  std::string png = EncodedImage(".png", TestImage());
  const std::string chunk("\0\0\0\x08teXt\0\0\0\x10\0\0\0\x10\xa5\x72\x8b\x4d", 20);
  png.insert(8, chunk);
  ExpectRefused(Write("a.png", png));
  std::string jpeg = EncodedImage(".jpg", TestImage());
  jpeg.insert(2, std::string("\xff\xd0", 2));
  ExpectRefused(Write("a.jpg", jpeg));
}

TEST_F(ReadImageTest, FormatsWithoutLossComeBackExactly) {
  cv::Mat colour(40, 60, CV_8UC3);
  cv::randu(colour, 0, 256);
  for (const char* extension : {".png", ".webp", ".bmp", ".tiff"}) {
    const auto path = Write("a", EncodedImage(extension, colour));
    EXPECT_EQ(cv::norm(ReadImage(path, kColour), colour, cv::NORM_INF), 0.0) << extension;
  }
}

TEST_F(ReadImageTest, OtherFormatsAreRefused) {
  ExpectRefused(Write("a.pgm", EncodedImage(".pgm", TestImage())),
                {"JPEG, PNG, WebP, BMP or TIFF"});
  const auto heif = Write("a.heic", std::string("\0\0\0\x18"
                                                "ftypheic\0\0\0\0mif1heic",
                                                24));
  ExpectRefused(heif, {"is an HEIF image", "expected a JPEG"});
  ExpectRefused(Write("a.tiff", EncodedImage(".tiff", cv::Mat(8, 8, CV_32FC1, 0.5))), {"TIFF"});
  std::string tiff = GreyTiff(TestImage(), 1, ByteOrder::kLittleEndian);
  tiff.replace(8 + 2 + 3 * 12 + 8, 2,
               NumberBytes(513, 2, ByteOrder::kLittleEndian));  // compression
  ExpectRefused(Write("a.tiff", tiff), {"TIFF"});
}

const cv::Mat kThumbnail(6, 8, CV_8UC1, cv::Scalar(50));

// Photos of Adobe, Nikon, Sony and others, whatever their names are.
TEST_F(ReadImageTest, RawPhotosAreRefused) {
  const cv::Mat photo = TestImage();
  const std::string header = Tiff(ByteOrder::kLittleEndian, {}).substr(0, 8);
  const std::string thumbnail_first = TiffWithImageBelow(kThumbnail, photo);
  for (const std::string& raw :
       {thumbnail_first, TiffWithImageBelow(kThumbnail, photo, 0, 0),
        thumbnail_first.substr(0, 180),                        // without the photo
        header + TiffImage(photo, 8, {{50706, 0x401, 1, 4}}),  // DNGVersion
        header + TiffImage(photo, 8, {{262, 32803}}),          // pixels of a colour filter
        TiffOfTwo(kThumbnail, photo, {{254, 1, 4}, {262, 32803}}),
        std::string("II*\0\x10\0\0\0CR\2\0\0\0\0\0", 16) + TiffImage(kThumbnail, 16),  // CR2
        std::string("FUJIFILMCCD-RAW 0201"), std::string("IIRO\x08\0\0\0 of Olympus", 19),
        std::string("\0\0\0\x18"
                    "ftypcrx \0\0\0\1crx isom",
                    24)}) {
    const auto path = Write("a.tif", raw);
    ExpectRefused(path, {"RAW", "JPEG"});
    EXPECT_TRUE(IsRawPhoto(path));
    EXPECT_FALSE(ReadImageHeader(path));
  }
  const auto named = Write("a.NEF", EncodedImage(".tiff", photo));
  ExpectRefused(named, {"RAW"});
  EXPECT_FALSE(ReadImageHeader(named));
}

TEST_F(ReadImageTest, SeveralImagesAreRefused) {
  const cv::Mat photo = TestImage();
  ExpectRefused(Write("a.tif", TiffOfTwo(photo, photo, {})), {"several images"});
  ExpectRefused(Write("a.tif", TiffOfTwo(photo, kThumbnail, {{254, 2, 4}})), {"several images"});
  const std::string header = Tiff(ByteOrder::kLittleEndian, {}).substr(0, 8);
  const std::string circle = header + TiffImage(photo, 8, {{254, 0, 4}}, 8);
  ExpectRefused(Write("a.tif", circle), {"several images"});
  const auto animated = [&](char images) {
    std::string png = EncodedImage(".png", photo);
    return png.insert(33,
                      PngChunk("acTL", std::string("\0\0\0", 3) + images + std::string(4, '\0')));
  };
  ExpectRefused(Write("a.png", animated(2)), {"animation"});
  EXPECT_EQ(ReadImage(Write("a.png", animated(1)), kGrey).size(), photo.size());
  std::string webp = WebpWithExif(EncodedImage(".webp", photo), photo.size(), "");
  webp[20] = 2;  // the flags of VP8X
  ExpectRefused(Write("a.webp", webp), {"animation"});
}

TEST_F(ReadImageTest, ThumbnailsAndMasksAfterThePhotoDoNotMatter) {
  const cv::Mat photo = TestImage();
  for (const std::string& tiff :
       {TiffOfTwo(photo, kThumbnail, {{254, 1, 4}}), TiffOfTwo(photo, photo, {{254, 4, 4}}),
        TiffOfTwo(photo, kThumbnail, {{513, 8, 4}}), TiffWithImageBelow(photo, kThumbnail, 0, 1)}) {
    const cv::Mat read = ReadImage(Write("a.tif", tiff), kGrey);
    EXPECT_EQ(cv::norm(read, photo, cv::NORM_INF), 0.0);
  }
}

TEST_F(ReadImageTest, FilesThatCannotBeDecodedAtOnceAreRefusedUnread) {
  const auto path = Write("a.png", EncodedImage(".png", TestImage()));
  std::filesystem::resize_file(path, std::uintmax_t{1} << 31);  // takes no room on the disk
  ExpectRefused(path, {"2147483648 bytes"});
}

const Camera kLensCamera = {64, 48, 60.0, 62.0, 31.0, 24.5};
const Distortion kLens = {-0.2, 0.05, 0.004, -0.003, 0.0};

// A grey value that says which undistorted pixel it belongs to, smooth enough to interpolate.
double Grey(const Eigen::Vector2d& pixel) {
  return 120.0 + 50.0 * std::sin(0.11 * pixel.x()) + 40.0 * std::cos(0.09 * pixel.y());
}

// What the lens makes of Grey.
cv::Mat DistortedImage() {
  cv::Mat image(kLensCamera.height, kLensCamera.width, CV_32FC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const auto pixel = UndistortPixels(kLensCamera, kLens, {Eigen::Vector2d(x, y)}).front();
      image.at<float>(y, x) = static_cast<float>(Grey(pixel.value()));
    }
  }
  return image;
}

TEST(ImageUndistorterTest, GivesWhatAPinholeCameraWouldSee) {
  const cv::Mat undistorted = ImageUndistorter(kLensCamera, kLens).Undistort(DistortedImage());
  ASSERT_EQ(undistorted.size(), cv::Size(kLensCamera.width, kLensCamera.height));
  int compared = 0;
  for (int y = 0; y < undistorted.rows; ++y) {
    for (int x = 0; x < undistorted.cols; ++x) {
      const Eigen::Vector2d source =
          DistortPixels(kLensCamera, kLens, {Eigen::Vector2d(x, y)}).front();
      if (source.x() < 0 || source.y() < 0 || source.x() > kLensCamera.width - 1 ||
          source.y() > kLensCamera.height - 1) {
        continue;
      }
      // Linear interpolation between pixels: half the second derivative over a quarter.
      EXPECT_NEAR(undistorted.at<float>(y, x), Grey({x, y}), 0.3) << x << " " << y;
      ++compared;
    }
  }
  EXPECT_GT(compared, 2000);
}

TEST(ImageUndistorterTest, WhatTheLensDidNotSeeHasNoEdge) {
  const cv::Mat white(kLensCamera.height, kLensCamera.width, CV_8UC1, cv::Scalar(255));
  const Distortion pincushion = {0.4, 0.0, 0.0, 0.0, 0.0};  // corners come from outside
  const cv::Mat undistorted = ImageUndistorter(kLensCamera, pincushion).Undistort(white);
  EXPECT_EQ(cv::countNonZero(undistorted == 255), kLensCamera.width * kLensCamera.height);
}

}  // namespace
}  // namespace soslam
