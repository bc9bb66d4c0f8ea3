// SPDX-License-Identifier: BSD-3-Clause
#include "image/read_image.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "base/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

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

std::string Encode(const std::string& extension, const cv::Mat& image) {
  std::vector<uchar> bytes;
  cv::imencode(extension, image, bytes);
  return {bytes.begin(), bytes.end()};
}

class ReadImageTest : public testing::Test {
 protected:
  std::filesystem::path Write(const std::string& name, const std::string& bytes) {
    WriteBytes(folder_ / name, bytes);
    return folder_ / name;
  }
  TemporaryFolder folder_;
};

TEST_F(ReadImageTest, PngComesBackExactly) {
  const cv::Mat read = ReadGreyImage(Write("a.png", Encode(".png", TestImage())), 60, 40);
  ASSERT_EQ(read.type(), CV_8UC1);
  EXPECT_EQ(cv::norm(read, TestImage(), cv::NORM_INF), 0.0);
}

TEST_F(ReadImageTest, ColourBecomesGrey) {
  const cv::Mat colour(8, 9, CV_8UC3, cv::Scalar(10, 20, 200));
  const cv::Mat read = ReadGreyImage(Write("a.png", Encode(".png", colour)));
  ASSERT_EQ(read.type(), CV_8UC1);
  // 0.299 red + 0.587 green + 0.114 blue = 72.7; 1 for the rounding of integer weights.
  EXPECT_NEAR(read.at<uchar>(4, 4), 72.7, 1.0);
}

TEST_F(ReadImageTest, ColourComesBackBlueGreenRed) {
  const cv::Mat colour(8, 9, CV_8UC3, cv::Scalar(10, 20, 200));
  const cv::Mat read = ReadColourImage(Write("a.png", Encode(".png", colour)));
  ASSERT_EQ(read.type(), CV_8UC3);
  EXPECT_EQ(read.at<cv::Vec3b>(4, 4), cv::Vec3b(10, 20, 200));
  const cv::Mat grey = ReadColourImage(Write("b.png", Encode(".png", TestImage())));
  EXPECT_EQ(grey.at<cv::Vec3b>(3, 5), cv::Vec3b::all(TestImage().at<uchar>(3, 5)));
}

TEST_F(ReadImageTest, OnePixelIsAnImage) {
  const cv::Mat pixel(1, 1, CV_8UC1, cv::Scalar(77));
  EXPECT_EQ(ReadGreyImage(Write("a.png", Encode(".png", pixel)), 1, 1).at<uchar>(0, 0), 77);
}

TEST_F(ReadImageTest, ExifOrientationIsIgnored) {
  std::string jpeg = Encode(".jpg", TestImage());
  // The marker APP1 with 34 bytes of EXIF: big endian, one entry, orientation 6 (turn by 90
  // degrees).
  constexpr char kExif[] =
      "\xff\xe1\0\x22"
      "Exif\0\0"
      "MM\0*\0\0\0\x08"
      "\0\x01"
      "\x01\x12\0\x03\0\0\0\x01\0\x06\0\0"
      "\0\0\0";
  jpeg.insert(2, kExif, sizeof(kExif));  // with its final zero
  const auto path = Write("a.jpg", jpeg);
  ASSERT_EQ(cv::imread(path.string(), cv::IMREAD_GRAYSCALE).cols, 40) << "the EXIF block is wrong";
  EXPECT_EQ(ReadGreyImage(path).cols, 60);
}

TEST_F(ReadImageTest, ZerosAfterTheEndAreAllowed) {
  for (const char* extension : {".jpg", ".png"}) {
    const auto path = Write(std::string("a") + extension,
                            Encode(extension, TestImage()) + std::string(100, '\0'));
    EXPECT_EQ(ReadGreyImage(path).cols, 60);
  }
}

TEST_F(ReadImageTest, CutShortAtAnyByteIsRefused) {
  for (const char* extension : {".jpg", ".png"}) {
    const std::string whole = Encode(extension, TestImage());
    for (size_t size = 0; size < whole.size(); ++size) {
      const auto path = Write(std::string("cut") + extension, whole.substr(0, size));
      ExpectError<InputError>([&] { ReadGreyImage(path); }, {path.string()});
    }
  }
}

TEST_F(ReadImageTest, BadFilesAreNamed) {
  const auto read = [](const std::filesystem::path& path) { ReadGreyImage(path); };
  ExpectError<InputError>([&] { read(folder_ / "none.png"); }, {"none.png", "no such file"});
  ExpectError<InputError>([&] { read(folder_.path()); }, {folder_.path().string()});
  ExpectError<InputError>([&] { read(Write("empty.png", "")); }, {"empty.png", "is empty"});
  ExpectError<InputError>([&] { read(Write("text.png", "hello")); },
                          {"text.png", "decoded", "PNG or JPEG"});
  const std::string jpeg = Encode(".jpg", TestImage());
  ExpectError<InputError>([&] { read(Write("cut.jpg", jpeg.substr(0, jpeg.size() / 2))); },
                          {"cut.jpg", "cut short", "EOI"});
  const std::string png = Encode(".png", TestImage());
  ExpectError<InputError>([&] { read(Write("cut.png", png.substr(0, png.size() - 12))); },
                          {"cut.png", "cut short", "IEND"});
}

TEST_F(ReadImageTest, SizesBeyondMemoryAreRefusedUnread) {
  std::string png = Encode(".png", TestImage());
  png.replace(16, 8, std::string("\0\0\x7f\xff\0\0\x7f\xff", 8));  // width and height in IHDR
  ExpectError<InputError>([&] { ReadColourImage(Write("a.png", png)); },
                          {"a.png", "32767 x 32767", "at most"});
  std::string jpeg = Encode(".jpg", TestImage());
  const size_t frame = jpeg.find("\xff\xc0");  // marker, length, bits, height, width
  jpeg.replace(frame + 5, 4, "\xff\xfe\xff\xff");
  ExpectError<InputError>([&] { ReadColourImage(Write("a.jpg", jpeg)); },
                          {"a.jpg", "65535 x 65534", "at most"});
}

// Decoders read past what may not be there.
TEST_F(ReadImageTest, SizesWhereOnlyDecodersLookAreRefused) {
  std::string png = Encode(".png", TestImage());
  const std::string chunk("\0\0\0\x08teXt\0\0\0\x10\0\0\0\x10\xa5\x72\x8b\x4d", 20);
  png.insert(8, chunk);
  ExpectError<InputError>([&] { ReadColourImage(Write("a.png", png)); }, {"a.png"});
  std::string jpeg = Encode(".jpg", TestImage());
  jpeg.insert(2, std::string("\xff\xd0", 2));
  ExpectError<InputError>([&] { ReadColourImage(Write("a.jpg", jpeg)); }, {"a.jpg"});
}

TEST_F(ReadImageTest, OtherFormatsAreRefused) {
  for (const char* extension : {".bmp", ".pgm", ".tiff", ".webp"}) {
    const auto path = Write(std::string("a") + extension, Encode(extension, TestImage()));
    ExpectError<InputError>([&] { ReadGreyImage(path); }, {path.string(), "PNG or JPEG"});
  }
}

TEST_F(ReadImageTest, WrongSizeIsNamed) {
  const auto path = Write("a.png", Encode(".png", TestImage()));
  ExpectError<InputError>([&] { ReadGreyImage(path, 40, 60); }, {"a.png", "60 x 40", "40 x 60"});
  ExpectError<InputError>([&] { ReadColourImage(path, 40, 60); }, {"a.png", "60 x 40", "40 x 60"});
}

}  // namespace
}  // namespace soslam
