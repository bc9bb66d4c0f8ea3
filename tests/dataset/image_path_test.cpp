// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/image_path.h"

#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/folder_test.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

class ImagePathTest : public FolderTest {
 protected:
  ImagePathTest() {
    Write("dataset/rgb/0.png", "image");
    Write("elsewhere/secret.png", "image");
  }
  ~ImagePathTest() override { AllowOutsidePaths(false); }

  fs::path Path(const std::string& name) const { return folder_ / name; }
  fs::path Of(const std::string& image) const {
    return ImagePath(Path("dataset"), image, "rgb.txt");
  }
  void ExpectRefused(const std::string& image) const {
    ExpectError<InputError>([&] { Of(image); }, {"rgb.txt: image is '" + image + "'", "expected"});
  }
};

TEST_F(ImagePathTest, IsInTheDataset) {
  EXPECT_EQ(Of("rgb/0.png"), Path("dataset/rgb/0.png"));
  EXPECT_EQ(Of("rgb/absent.png"), Path("dataset/rgb/absent.png"));
  EXPECT_EQ(Of("./rgb/../rgb/0.png"), Path("dataset/rgb/0.png"));
  EXPECT_EQ(ImagePath(Path("dataset/"), "rgb/0.png", ""), Path("dataset/rgb/0.png"));
  EXPECT_EQ(ImagePath(".", "0.png", ""), fs::path("./0.png"));
}

TEST_F(ImagePathTest, NamesThatLeadOutAreRefused) {
  ExpectRefused("../elsewhere/secret.png");
  ExpectRefused("rgb/../../elsewhere/secret.png");
  ExpectRefused(Path("elsewhere/secret.png").string());
  ExpectRefused("../dataset2/absent.png");
  ExpectRefused("");
}

TEST_F(ImagePathTest, AbsolutePathsIntoTheDatasetAreTaken) {
  const std::string inside = Path("dataset/rgb/0.png").string();
  EXPECT_EQ(Of(inside), Path("dataset/rgb/0.png"));
  EXPECT_EQ(NameInDataset(Path("dataset"), inside), "rgb/0.png");
  fs::create_directory_symlink("dataset", Path("link"));
  EXPECT_EQ(NameInDataset(Path("link"), inside), "rgb/0.png");
  EXPECT_EQ(NameInDataset(Path("dataset"), "./rgb/0.png"), "./rgb/0.png");
  const std::string outside = Path("elsewhere/secret.png").string();
  EXPECT_EQ(NameInDataset(Path("dataset"), outside), outside);
  ExpectError<InputError>([&] { Of(outside); }, {outside, "an absolute path that leads outside"});
}

TEST_F(ImagePathTest, LinksThatLeadOutAreRefused) {
  fs::create_directory_symlink(Path("elsewhere"), Path("dataset/linked"));
  fs::create_symlink(Path("elsewhere/secret.png"), Path("dataset/rgb/1.png"));
  ExpectRefused("linked/secret.png");
  ExpectRefused("linked/absent.png");
  ExpectRefused("rgb/1.png");
}

TEST_F(ImagePathTest, LinksInTheDatasetAndOfTheDatasetAreFollowed) {
  fs::create_directory_symlink("rgb", Path("dataset/colour"));
  fs::create_directory_symlink("dataset", Path("link"));
  EXPECT_EQ(Of("colour/0.png"), Path("dataset/colour/0.png"));
  EXPECT_EQ(ImagePath(Path("link"), "rgb/0.png", ""), Path("link/rgb/0.png"));
}

TEST_F(ImagePathTest, AllAreTakenOnceAllowed) {
  fs::create_directory_symlink(Path("elsewhere"), Path("dataset/linked"));
  AllowOutsidePaths(true);
  EXPECT_EQ(Of("linked/secret.png"), Path("dataset/linked/secret.png"));
  EXPECT_EQ(Of(Path("elsewhere/secret.png").string()), Path("elsewhere/secret.png"));
  EXPECT_TRUE(fs::exists(Of("../elsewhere/secret.png")));
  ExpectRefused("");
}

class FrameLookupTest : public testing::Test {
 protected:
  FrameLookup lookup_{
      {{1.0, "rgb/12.50.png"}, {2.0, "rgb/12.51.png"}, {3.0, "a/0.png"}, {4.0, "b/0.png"}}};
};

TEST_F(FrameLookupTest, NamesWithOrWithoutFolderAndExtension) {
  for (const char* name : {"rgb/12.51.png", "12.51.png", "12.51", "elsewhere/rgb/12.51.png",
                           "rgb\\12.51.png", "C:\\data\\rgb\\12.51.png"}) {
    EXPECT_EQ(lookup_.Find(name, ""), 1) << name;
  }
  EXPECT_EQ(lookup_.Find("12.52.png", ""), std::nullopt);
  EXPECT_EQ(lookup_.Find("12", ""), std::nullopt);
}

TEST_F(FrameLookupTest, CopiesOfAnnotationTools) {
  EXPECT_EQ(lookup_.CountOtherNames(), 0u);
  EXPECT_EQ(lookup_.Find("12.51_png.rf.0123456789abcdef0123456789abcdef.jpg", ""), 1);
  EXPECT_EQ(lookup_.Find("train/12.51_png.rf.0123456789abcdef0123456789abcdef.jpg", ""), 1);
  EXPECT_EQ(lookup_.Find("images/1a2b3c4d-12.50.png", ""), 0);
  EXPECT_EQ(lookup_.CountOtherNames(), 2u);
  EXPECT_EQ(FrameLookup({{1.0, "a.jpg"}}).Find("1a2b3c4d__a", ""), 0);
  EXPECT_EQ(FrameLookup({{1.0, "a.jpg"}}).Find("a_jpg.rf.0123456789abcdef", ""), 0);
  for (const char* no_copy : {"12.51_png.rf..jpg", "1a2b3c4-12.50.png", "1a2b3c4d12.50.png",
                              "x_png.rf.0123456789abcdef.jpg"}) {
    EXPECT_EQ(lookup_.Find(no_copy, ""), std::nullopt) << no_copy;
  }
}

TEST_F(FrameLookupTest, AnotherEndingIsTheSameImage) {
  for (const char* name : {"12.51.jpg", "images/12.51.jpg"}) {
    FrameLookup lookup({{1.0, "12.50.png"}, {2.0, "rgb/12.51.png"}});
    EXPECT_EQ(lookup.Find(name, ""), 1) << name;
    EXPECT_EQ(lookup.CountOtherNames(), 1u);
    ExpectError<InputError>([&] { lookup.Find("12.51.png", "images.txt:5"); },
                            {"images.txt:5", "'12.51.png'", "row 1", "one name of each image"});
  }
  EXPECT_EQ(FrameLookup({{1.0, "rgb/IMG_1.jpg"}}).Find("IMG_1.JPG", ""), 0);
  EXPECT_EQ(FrameLookup({{1.0, "a.jpg"}}).Find("1a2b3c4d-a.png", ""), 0);
  EXPECT_EQ(FrameLookup({{1.0, "a.jpg"}, {2.0, "a.png"}}).Find("a.png", ""), 1);
  EXPECT_EQ(lookup_.Find("12.jpg", ""), std::nullopt);
  EXPECT_EQ(lookup_.Find("12.51.txt", ""), std::nullopt);
  ExpectError<InputError>([&] { lookup_.Find("0.jpg", "images.txt:5"); }, {"2, 3"});
  EXPECT_EQ(lookup_.Find("b/0.jpg", ""), 3);
}

TEST_F(FrameLookupTest, SeveralCopiesOfAnImageAreRefused) {
  const std::string copy = "12.51_png.rf.0123456789abcdef.jpg";
  EXPECT_EQ(lookup_.Find(copy, ""), 1);
  EXPECT_EQ(lookup_.Find(copy, ""), 1);
  for (const char* other : {"12.51_png.rf.fedcba9876543210.jpg", "12.51.png"}) {
    ExpectError<InputError>([&] { lookup_.Find(other, "boxes.json#/4"); },
                            {"boxes.json#/4", other, "another copy", "without augmentation"});
  }
  ExpectError<InputError>([&] { lookup_.Find("1a2b3c4d-0.png", "boxes.json#/4"); }, {"2, 3"});
}

TEST_F(FrameLookupTest, FolderSettlesEqualNames) {
  EXPECT_EQ(lookup_.Find("b/0.png", ""), 3);
  ExpectError<InputError>([&] { lookup_.Find("0.png", "boxes.json#/4"); },
                          {"boxes.json#/4", "'0.png'", "2, 3"});
}

TEST_F(FrameLookupTest, AFolderOfAnotherNameMayBeTheSame) {
  EXPECT_EQ(lookup_.Find("images/12.50.png", ""), 0);
  EXPECT_EQ(lookup_.Find("/data/images/12.50.png", ""), 0);
  EXPECT_EQ(lookup_.Find("./images/12.51.png", ""), 1);
  EXPECT_EQ(FrameLookup({{1.0, "RGB/1.png"}}).Find("rgb/1.png", ""), 0);
  EXPECT_EQ(FrameLookup({{1.0, "image_02/000/1.png"}}).Find("image_2/0/1.png", ""), 0);
}

TEST_F(FrameLookupTest, ImagesOfAnotherCameraAreNotListed) {
  for (const auto& [listed, named] :
       std::vector<std::pair<const char*, const char*>>{{"cam0/1.jpg", "cam1/1.jpg"},
                                                        {"mav0/cam0/data/1.jpg", "cam1/data/1.jpg"},
                                                        {"image_02/1.jpg", "/kitti/image_3/1.jpg"},
                                                        {"left/1.jpg", "right/1.jpg"},
                                                        {"Left/1.jpg", "Right/1.jpg"}}) {
    FrameLookup lookup({{1.0, listed}});
    EXPECT_EQ(lookup.Find(named, ""), std::nullopt) << named;
    EXPECT_EQ(lookup.Find(listed, ""), 0) << listed;
  }
}

TEST_F(FrameLookupTest, ImagesOfTwoFoldersAreNotOne) {
  FrameLookup lookup({{1.0, "front/1.jpg"}});
  EXPECT_EQ(lookup.Find("front/1.jpg", ""), 0);
  ExpectError<InputError>([&] { lookup.Find("back/1.jpg", "boxes.json#/4"); },
                          {"boxes.json#/4", "'back/1.jpg'", "'front'", "one folder"});
}

}  // namespace
}  // namespace soslam
