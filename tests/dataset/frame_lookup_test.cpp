// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/image_path.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

class FrameLookupTest : public testing::Test {
 protected:
  FrameLookup lookup_{
      {{1.0, "rgb/12.50.png"}, {2.0, "rgb/12.51.png"}, {3.0, "a/0.png"}, {4.0, "b/0.png"}}};
};

TEST_F(FrameLookupTest, NamesWithOrWithoutFolderAndExtension) {
  for (const char* name : {"rgb/12.51.png", "12.51.png", "12.51", "elsewhere/rgb/12.51.png"}) {
    EXPECT_EQ(lookup_.Find(name, ""), 1) << name;
  }
  EXPECT_EQ(lookup_.Find("12.52.png", ""), std::nullopt);
  EXPECT_EQ(lookup_.Find("12", ""), std::nullopt);
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
