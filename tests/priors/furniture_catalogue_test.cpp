// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/priors/furniture_catalogue.h"

#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/folder_test.h"

namespace soslam {
namespace {

constexpr const char* kHeader = "name,category,depth_m,width_m,height_m,collection\n";

class FurnitureCatalogueTest : public FolderTest {
 protected:
  std::vector<CatalogueModel> Read(const std::string& text) const {
    return ReadFurnitureCatalogue(Write("models.csv", text));
  }
  CatalogueNames ReadNames(const std::string& text) const {
    return ReadCatalogueNames(Write("names.json", text));
  }
};

TEST_F(FurnitureCatalogueTest, ReadsHalfAxesFrontFirst) {
  const auto models = Read(kHeader + std::string("Wing chair,Hall,0.8,0.6,1.0,Ours\n"));
  ASSERT_EQ(models.size(), 1u);
  EXPECT_EQ(models[0].name, "Wing chair");
  EXPECT_EQ(models[0].category, "Hall");
  EXPECT_EQ(models[0].half_axes, Eigen::Vector3d(0.4, 0.3, 0.5));
}

TEST_F(FurnitureCatalogueTest, BadFilesAreRefusedByLineAndField) {
  const std::string header = kHeader;
  ExpectBadTexts({{"name,category,depth_m,width_m\n", {":1", "height_m"}},
                  {header + "Cup,Hall,1,wide,1,Ours\n", {":2", "width_m", "wide"}},
                  {header + "Cup,Hall,1,1,0,Ours\n", {":2", "height_m is 0"}}},
                 "models.csv", [&](const std::string& text) { Read(text); });
}

TEST_F(FurnitureCatalogueTest, NamesHoldInAnyCategoryOrInOne) {
  const CatalogueNames names =
      ReadNames(R"({"labels": {"chair": ["Stool", {"name": "Chair", "category": "Hall"}]}})");
  const auto is_chair = [&](const char* name, const char* category) {
    return GoesBy({name, category, {}}, names.at("chair"));
  };
  EXPECT_TRUE(is_chair("stool", "Garden"));
  EXPECT_TRUE(is_chair("CHAIR", "hall"));
  EXPECT_FALSE(is_chair("Chair", "Garden"));
  EXPECT_FALSE(is_chair("Chair with cushion", "Hall"));
}

TEST_F(FurnitureCatalogueTest, NamesOfAnotherFormAreRefused) {
  ExpectBadTexts(
      {{R"({"labels": {"chair": "Stool"}})", {"/labels/chair"}}, {R"({"chair": []})", {}}},
      "names.json", [&](const std::string& text) { ReadNames(text); });
}

}  // namespace
}  // namespace soslam
