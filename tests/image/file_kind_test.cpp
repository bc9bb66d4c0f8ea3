// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/file_kind.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/image/read_image.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/image_files.h"

namespace soslam {
namespace {

using namespace std::string_literals;

const std::string kLfsPointer =
    "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";

TEST(FileKind, IsToldByTheFirstBytes) {
  const std::vector<std::pair<std::string, const char*>> kinds = {
      {"\x89HDF\r\n\x1a\n\0"s, "an HDF5 file"},
      {EncodedImage(".png", cv::Mat(4, 4, CV_8UC1, 7.0)), "a PNG image"},
      {EncodedImage(".jpg", cv::Mat(4, 4, CV_8UC1, 7.0)), "a JPEG image"},
      {EncodedImage(".bmp", cv::Mat(4, 4, CV_8UC1, 7.0)), "a BMP image"},
      {"\x1f\x8b\x08\0"s, "a gzip archive"},
      {"PK\x03\x04"s, "a zip archive"},
      {"\0\0\0\x18"
       "ftypheic"s,
       "an HEIF image (HEIC, AVIF)"},
      {"\0\0\0\x18"
       "ftypisom"s,
       "a video (MP4, MOV)"},
      {kLfsPointer, "a Git LFS pointer, not the file itself (git lfs pull fetches it)"},
      {"\xff\xfe{"s, "UTF-16 text"},
      {"\xEF\xBB\xBF [1]", "JSON"},
      {"{}", "JSON"},
      {"<?xml version=\"1.0\"?>", "XML"},
      {"<annotation verified=\"yes\">", "XML"}};
  for (const auto& [bytes, kind] : kinds) EXPECT_EQ(FileKind(bytes), kind);
  for (const char* page : {"<!DOCTYPE html>\n<html>", "\n  <HTML lang=en>"}) {
    EXPECT_THAT(FileKind(page), testing::StartsWith("an HTML page"));
  }
}

TEST(FileKind, IsUnknownForOtherTexts) {
  for (const char* text : {"", " \n", "BM_0001.png\nBM_0002.png\n", "0,1,2\n", "version 2\n",
                           "%YAML:1.0\n---", "<background>", "# comment"}) {
    EXPECT_EQ(FileKind(text), "") << text;
    EXPECT_NO_THROW(CheckIsText(text, "file", "text"));
  }
  EXPECT_NO_THROW(CheckIsText("{a: 1}", "file", "text"));
  EXPECT_NO_THROW(CheckIsText("<?xml version=\"1.0\"?>", "file", "text"));
}

class KindOfFileTest : public FolderTest {};

TEST_F(KindOfFileTest, IsNamedByReadersOfImages) {
  const auto refuse = [&](const std::string& content, const std::string& kind) {
    ExpectError<InputError>([&] { ReadImage(Write("a.png", content), cv::IMREAD_GRAYSCALE); },
                            {"a.png: is " + kind, "expected a JPEG, PNG"});
  };
  refuse(kLfsPointer, "a Git LFS pointer");
  refuse("<!doctype html><title>404</title>", "an HTML page");
  refuse("\x89HDF\r\n\x1a\n", "an HDF5 file");
}

}  // namespace
}  // namespace soslam
