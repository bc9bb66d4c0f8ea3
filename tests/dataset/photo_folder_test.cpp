// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/photo_folder.h"

#include <fmt/format.h>
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
  static std::vector<std::string> NamesOf(const std::vector<Photo>& photos) {
    return Fields(photos, [](const Photo& photo) { return photo.path.filename().string(); });
  }
  std::vector<std::string> Names() const { return NamesOf(ListPhotos(folder_.path())); }
  // Adds a photo of this minute of one hour.
  void AddOfMinute(const std::string& name, int minute, const cv::Size& size = {64, 48}) {
    Add(name, size, ExifOfTime("2024:05:01 12:" + std::to_string(10 + minute) + ":00"));
  }
  std::vector<std::string> InOrder(PhotoOrder* order = nullptr) const {
    auto photos = ListPhotos(folder_.path());
    const PhotoOrder found = OrderByTime(FindCommonCamera(folder_.path(), photos), &photos);
    if (order != nullptr) *order = found;
    return NamesOf(photos);
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

TEST_F(PhotoFolderTest, FoldersOfRawPhotosAreRefusedByName) {
  for (const char* name : {"1.tif", "2.tif"}) {  // renamed
    Write(name, TiffWithImageBelow(GreyOf(DrawnView(0, {8, 6})), GreyOf(DrawnView(0, {64, 48}))));
  }
  const auto find = [&] { FindCommonCamera(folder_.path(), ListPhotos(folder_.path())); };
  ExpectError<InputError>(find, {"none of its 2 images", "2 are RAW photos", "JPEGs"});
  EXPECT_TRUE(ListPhotos(folder_.path()).front().is_raw);
  Write("3.RAF", "of another camera");
  ExpectError<InputError>(find, {"none of its 3 images", "3 are RAW photos"});
}

TEST_F(PhotoFolderTest, LargerImagesWinTies) {
  using Rejection = FrameRejection;
  for (const char* name : {"1.jpg", "2.jpg"})
    Add(name, {60, 45}, ExifOf(1, ByteOrder::kBigEndian, name));
  Add("3.jpg", {240, 180});
  Add("4.jpg", {240, 180}, ExifOf(1));
  EXPECT_THAT(Reasons(), testing::ElementsAre(Rejection::kOtherSize, Rejection::kOtherSize,
                                              std::nullopt, std::nullopt));
  Add("5.jpg", {60, 45}, ExifOf(2));
  EXPECT_EQ(Reasons()[2], Rejection::kOtherSize) << "most images come first";
}

TEST_F(PhotoFolderTest, OriginalsAreNamedLikeMostPhotos) {
  Add("IMG_1.jpg");
  Add("IMG_3.jpg", {64, 48}, ExifOf(1));
  for (const char* name : {"IMG_1 (1).jpg", "Copy of IMG_1.jpg", "IMG_2.jpg"}) {
    std::filesystem::copy_file(folder_ / "IMG_1.jpg", folder_ / name);
  }
  const auto photos = ListPhotos(folder_.path());
  EXPECT_THAT(NamesOf(photos), testing::ElementsAre("Copy of IMG_1.jpg", "IMG_1 (1).jpg",
                                                    "IMG_1.jpg", "IMG_2.jpg", "IMG_3.jpg"));
  EXPECT_THAT(Fields(photos, &Photo::original),
              testing::ElementsAre("IMG_1.jpg", "IMG_1.jpg", "", "IMG_1.jpg", ""));
  Add("IMG_4.jpg", {240, 180});
  Add("IMG_5.jpg", {240, 180}, ExifOf(1));
  EXPECT_EQ(FindCommonCamera(folder_.path(), ListPhotos(folder_.path())).size.width, 240)
      << "duplicates do not count";
}

TEST_F(PhotoFolderTest, OriginalsKeepTheirPlaceInTheOrder) {
  for (int i = 1; i <= 4; ++i) {
    Add(fmt::format("IMG_000{}.jpg", i), {64, 48},
        ExifOf(1, ByteOrder::kBigEndian, fmt::format("{}", i)));
  }
  std::filesystem::copy_file(folder_ / "IMG_0002.jpg", folder_ / "best.jpg");
  std::filesystem::copy_file(folder_ / "IMG_0003.jpg", folder_ / "A.jpg");
  EXPECT_THAT(Fields(ListPhotos(folder_.path()), &Photo::original),
              testing::ElementsAre("IMG_0003.jpg", "", "", "", "", "IMG_0002.jpg"));
  const TemporaryFolder other;
  for (int i = 1; i <= 3; ++i) {
    const std::string name = fmt::format("IMG_{}", i);
    WritePhoto(other / (name + ".jpg"), DrawnView(i));
    std::filesystem::copy_file(other / (name + ".jpg"), other / (name + " (1).jpg"));
  }
  EXPECT_THAT(Fields(ListPhotos(other.path()), &Photo::original),
              testing::ElementsAre("IMG_1.jpg", "", "IMG_2.jpg", "", "IMG_3.jpg", ""))
      << "each photo twice";
}

TEST_F(PhotoFolderTest, TimesOrderNamesWithoutOrder) {
  AddOfMinute("9f1c.jpg", 1);
  AddOfMinute("03ab.jpg", 2);
  AddOfMinute("e4d0.jpg", 0);
  Add("screen.png", {32, 24});  // of another size, without a time
  Write("0.dng", "RAW");
  PhotoOrder order;
  EXPECT_THAT(InOrder(&order),
              testing::ElementsAre("e4d0.jpg", "9f1c.jpg", "03ab.jpg", "0.dng", "screen.png"));
  EXPECT_TRUE(order.is_by_time);
  Add("7777.jpg");  // without a time
  EXPECT_THAT(InOrder(&order), testing::ElementsAre("0.dng", "03ab.jpg", "9f1c.jpg", "7777.jpg",
                                                    "e4d0.jpg", "screen.png"));
  EXPECT_FALSE(order.is_by_time);
}

TEST_F(PhotoFolderTest, NamesThatCountKeepTheirOrder) {
  for (int i = 1; i <= 6; ++i) {  // the clock is set after the third
    AddOfMinute("IMG_000" + std::to_string(i) + ".jpg", i <= 3 ? 30 + i : i);
  }
  PhotoOrder order;
  EXPECT_EQ(InOrder(&order).front(), "IMG_0001.jpg");
  EXPECT_FALSE(order.is_by_time);
  EXPECT_EQ(order.usable, 6);
  EXPECT_EQ(order.steps_back, 1);
}

TEST_F(PhotoFolderTest, RenumberedPhotosKeepTheOrderOfTheirNames) {
  for (int i = 1; i <= 12; ++i) AddOfMinute(std::to_string(i) + ".jpg", 20 - i);
  PhotoOrder order;
  EXPECT_EQ(InOrder(&order).front(), "1.jpg");
  EXPECT_FALSE(order.is_by_time);
  EXPECT_EQ(order.steps_back, 11);
}

TEST_F(PhotoFolderTest, NumbersBeforeWordsAreAnOrder) {
  const auto is_by_time = [&](const std::vector<std::string>& names) {
    for (const auto& file : std::filesystem::directory_iterator(folder_.path())) {
      std::filesystem::remove(file);
    }
    int minute = 30;
    for (const std::string& name : names) AddOfMinute(name, --minute);
    PhotoOrder order;
    const auto in_order = InOrder(&order);
    EXPECT_EQ(in_order == names, !order.is_by_time);
    return order.is_by_time;
  };
  EXPECT_FALSE(is_by_time({"01_door.jpg", "02_window.jpg", "10_table.jpg"}));
  EXPECT_FALSE(is_by_time({"1 door.jpg", "2.jpg", "3-window 2.jpg", "11 door.jpg"}));
  EXPECT_FALSE(is_by_time({"room 1 door.jpg", "room 2 window.jpg", "room 10 table.jpg"}));
  EXPECT_TRUE(is_by_time({"door_01.jpg", "table_10.jpg", "window_02.jpg"}));
  EXPECT_TRUE(is_by_time({"2024_door.jpg", "2024_table.jpg", "2024_window.jpg"}));
  EXPECT_TRUE(is_by_time({"03ab-11.jpg", "9f1c-12.jpg", "77e0-13.jpg"}));
  EXPECT_TRUE(is_by_time({"01-02-2024_c.jpg", "30-01-2024_a.jpg", "31-01-2024_b.jpg"}));
  EXPECT_TRUE(is_by_time({"53012345690_a1b2.jpg", "53012345712_c3d4.jpg", "53012346001_e.jpg"}));
}

TEST_F(PhotoFolderTest, CountersMayBeginAnew) {
  AddOfMinute("DSC_9997.jpg", 0);
  AddOfMinute("DSC_9999.jpg", 1);
  AddOfMinute("DSC_0001.jpg", 2);
  AddOfMinute("DSC_0002.jpg", 3);
  PhotoOrder order;
  EXPECT_THAT(InOrder(&order),
              testing::ElementsAre("DSC_9997.jpg", "DSC_9999.jpg", "DSC_0001.jpg", "DSC_0002.jpg"));
  EXPECT_TRUE(order.is_by_time);
}

TEST_F(PhotoFolderTest, EqualTimesLeaveTheOrderOfNames) {
  for (const char* name : {"b.jpg", "a.jpg", "c.jpg"}) AddOfMinute(name, 0);
  EXPECT_THAT(InOrder(), testing::ElementsAre("a.jpg", "b.jpg", "c.jpg"));
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
