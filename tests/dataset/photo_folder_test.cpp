// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/photo_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/drawn_photos.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/lists.h"

namespace soslam {
namespace {

class PhotoFolderTest : public FolderTest {
 protected:
  void Add(const std::string& name, const cv::Size& size = {64, 48}, const std::string& exif = "") {
    WritePhoto(folder_ / name, DrawnView(0, size), exif);
  }
  std::vector<std::string> Names() const {
    return Fields(ListPhotos(folder_.path()),
                  [](const Photo& photo) { return photo.path.filename().string(); });
  }
  std::vector<std::optional<FrameRejection>> Reasons() const {
    const auto photos = ListPhotos(folder_.path());
    const CommonCamera common = FindCommonCamera(folder_.path(), photos);
    return Fields(photos, [&](const Photo& photo) {
      const auto other = FindOtherCamera(photo, common);
      return other ? std::optional(other->reason) : std::nullopt;
    });
  }
};

TEST_F(PhotoFolderTest, NumbersInNamesAreNumbers) {
  for (const char* name : {"IMG_10.JPG", "IMG_9.jpg", "a b.png", "IMG_009.jpg", "$x's \"1\".jpeg",
                           "Küche 2.jpg", "Küche 10.jpg", "Ähre.jpg"}) {
    Add(name);
  }
  EXPECT_THAT(Names(),
              testing::ElementsAre("$x's \"1\".jpeg", "IMG_009.jpg", "IMG_9.jpg", "IMG_10.JPG",
                                   "Küche 2.jpg", "Küche 10.jpg", "a b.png", "Ähre.jpg"));
}

TEST_F(PhotoFolderTest, OtherFilesAreIgnored) {
  Add("1.jpg");
  Add("2.jpg");
  Write("._1.jpg", "of a file system");
  Write("notes.txt", "notes");
  std::filesystem::create_directory(folder_ / "3.jpg");
  EXPECT_THAT(Names(), testing::ElementsAre("1.jpg", "2.jpg"));
}

TEST_F(PhotoFolderTest, RefusesFoldersWithoutPhotos) {
  const auto list = [&] { ListPhotos(folder_.path()); };
  ExpectError<InputError>(list, {folder_.path().string(), "has 0 image(s)", "a video is given"});
  Write("video.mp4", "video");
  ExpectError<InputError>(list, {"has 0 image(s)", "video.mp4"});
  Add("1.jpg");
  ExpectError<InputError>(list, {"has 1 image(s)", "at least 2"});
  ExpectError<InputError>([&] { ListPhotos(folder_ / "none"); }, {"none", "no such folder"});
  Add("\xff.jpg");
  ExpectError<InputError>(list, {folder_.path().string(), "not UTF-8"});
}

TEST_F(PhotoFolderTest, NamesTheConversionOfOtherFormats) {
  for (const char* name : {"IMG_1.HEIC", "IMG_2.HEIC"}) Write(name, "an image of HEIF");
  const auto find = [&] { FindCommonCamera(folder_.path(), ListPhotos(folder_.path())); };
  ExpectError<InputError>(find, {folder_.path().string(), "none of its 2 images", "heif-convert"});
}

TEST_F(PhotoFolderTest, MostPhotosDecideOnSizeAndFocalLength) {
  using Rejection = FrameRejection;
  Add("1.jpg", {64, 48}, ExifOfCamera(1, 26));
  Add("2.jpg", {64, 48}, ExifOfCamera(1, 26));
  Add("3.jpg", {64, 48}, ExifOfCamera(6, 26));  // shown upright it is 48 x 64
  Add("4.jpg", {48, 64}, ExifOfCamera(6, 26));  // shown upright it is 64 x 48
  Add("5.jpg", {64, 48}, ExifOfCamera(1, 13));
  Add("6.jpg", {64, 48});
  Write("7.jpg", "damaged");
  EXPECT_THAT(Reasons(),
              testing::ElementsAre(std::nullopt, std::nullopt, Rejection::kOtherSize, std::nullopt,
                                   Rejection::kOtherFocalLength, std::nullopt, std::nullopt));
}

}  // namespace
}  // namespace soslam
