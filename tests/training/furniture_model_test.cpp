// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/training/furniture_model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/image_files.h"

namespace soslam {
namespace {

// A box of 2 x 3 x 4 in a mesh's axes (x right, y up, z towards the front), whose front is painted.
constexpr const char* kBox = R"(mtllib box.mtl
v 0 0 0
v 2 0 0
v 2 3 0
v 0 3 0
v 0 0 4
v 2 0 4
v 2 3 4
v 0 3 4
vt 0 0
vt 1 0
vt 1 1
usemtl sides of it
f 1 4 3 2
f 1/1 2/2 6/3 5/1
f 3 4 8 7
f 1 5 8 4
f 2 3 7 6
usemtl front
f -4/1 -3/2 -2/3 -1/1
)";
constexpr const char* kMaterials = R"(# colours
newmtl front
Kd 1.0 0.5 0.0
Ks 0.25 0.25 0.25
newmtl sides of it
Kd 0 0 1
map_Kd wood.png
)";
constexpr const char* kCatalogue =
    "id=test\r\nname#1=Box\r\ncategory#1=Things\r\nmodel#1=/models/box.obj\r\n"
    "width#1=60\r\ndepth#1=50\r\nheight#1=90\r\ncreator#1=the test\r\n";

class FurnitureModelTest : public FolderTest {
 protected:
  FurnitureModelTest() {
    Write("library/PluginFurnitureCatalog.properties", kCatalogue);
    Write("library/models/box.obj", kBox);
    Write("library/models/box.mtl", kMaterials);
    Write("library/models/wood.png",
          EncodedImage(".png", cv::Mat(4, 8, CV_8UC3, cv::Scalar(10, 20, 30))));
  }
  std::vector<FurnitureEntry> Entries() const { return ReadFurnitureLibrary(folder_ / "library"); }
  // The corners of triangles of a material.
  static std::vector<FurnitureModel::Corner> CornersOf(const FurnitureModel& model, int material) {
    std::vector<FurnitureModel::Corner> corners;
    for (size_t i = 0; i < model.corners.size(); ++i) {
      if (model.materials_of_triangles[i / 3] == material) corners.push_back(model.corners[i]);
    }
    return corners;
  }
};

TEST_F(FurnitureModelTest, CatalogueEntriesHaveTheirSizeAlongTheirOwnAxes) {
  const auto entries = Entries();
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(entries[0].name, "Box");
  EXPECT_EQ(entries[0].collection, "library");
  EXPECT_EQ(entries[0].category, "Things");
  EXPECT_EQ(entries[0].creator, "the test");
  EXPECT_LT((entries[0].size - Eigen::Vector3d(0.5, 0.6, 0.9)).norm(), 1e-12);
  EXPECT_EQ(entries[0].own_from_file, Eigen::Matrix3d::Identity());
}

TEST_F(FurnitureModelTest, AMeshIsReadWithItsAxesSizeAndMaterials) {
  const FurnitureModel model = ReadFurnitureModel(Entries().at(0));
  EXPECT_EQ(model.corners.size(), 36u);
  ASSERT_EQ(model.materials.size(), 2u);
  EXPECT_LT((model.materials[0].colour - Eigen::Vector3f(1, 0, 0)).norm(), 1e-6f);
  EXPECT_EQ(model.materials[0].texture.size(), cv::Size(8, 4));
  EXPECT_LT((model.materials[1].colour - Eigen::Vector3f(0, 0.5f, 1)).norm(), 1e-6f);
  EXPECT_EQ(model.materials[1].gloss, 0.25f);
  EXPECT_TRUE(model.materials[1].texture.empty());
  Eigen::AlignedBox3f extent;
  for (const auto& corner : model.corners) extent.extend(corner.position);
  EXPECT_LT((extent.min() - Eigen::Vector3f(-0.25f, -0.3f, 0.0f)).norm(), 1e-5f);
  EXPECT_LT((extent.max() - Eigen::Vector3f(0.25f, 0.3f, 0.9f)).norm(), 1e-5f);
  for (const auto& corner : CornersOf(model, 1)) {  // the front
    EXPECT_NEAR(corner.position.x(), 0.25f, 1e-5f);
    EXPECT_LT((corner.normal - Eigen::Vector3f::UnitX()).norm(), 1e-5f);
  }
  // The mesh's right is the object's left: it faces the beholder.
  const auto front = CornersOf(model, 1);
  EXPECT_LT((front[0].texture - Eigen::Vector2f(0, 0)).norm(), 1e-6f);
  EXPECT_NEAR(front[0].position.y(), -0.3f, 1e-5f);
  EXPECT_LT((front[2].texture - Eigen::Vector2f(1, 1)).norm(), 1e-6f);
  EXPECT_NEAR(front[2].position.y(), 0.3f, 1e-5f);
  EXPECT_NEAR(front[2].position.z(), 0.9f, 1e-5f);
}

TEST_F(FurnitureModelTest, ACatalogueMayTurnAMesh) {
  // A quarter turn about the mesh's y axis takes its x axis to its z axis: to the front.
  Write("library/PluginFurnitureCatalog.properties",
        std::string(kCatalogue) + "modelRotation#1=0 0 -1 0 1 0 1 0 0\r\n");
  const FurnitureModel model = ReadFurnitureModel(Entries().at(0));
  for (const auto& corner : CornersOf(model, 1)) {
    EXPECT_NEAR(corner.position.y(), -0.3f, 1e-5f);
    EXPECT_LT((corner.normal + Eigen::Vector3f::UnitY()).norm(), 1e-5f);
  }
}

TEST_F(FurnitureModelTest, NormalsAreSmoothUnlessThereIsAnEdge) {
  Write("library/models/box.obj", "v 0 0 0\nv 2 0 0\nv 2 0 2\nv 0 0.2 2\nf 1 2 3\nf 1 3 4\n");
  const FurnitureModel model = ReadFurnitureModel(Entries().at(0));
  EXPECT_EQ(model.corners[0].normal, model.corners[3].normal);  // the same point
  EXPECT_NE(model.corners[1].normal, model.corners[5].normal);
}

TEST_F(FurnitureModelTest, BadFilesAreNamed) {
  Write("library/models/box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  ExpectError<InputError>([&] { ReadFurnitureModel(Entries().at(0)); }, {"box.obj", "triangle"});
  std::filesystem::remove(folder_ / "library/models/box.obj");
  ExpectError<InputError>([&] { ReadFurnitureModel(Entries().at(0)); }, {"box.obj"});
  Write("library/PluginFurnitureCatalog.properties", "name#3=Box\nmodel#3=/box.obj\nwidth#3=60\n");
  ExpectError<InputError>([&] { Entries(); }, {"PluginFurnitureCatalog.properties", "model 3"});
  ExpectError<InputError>([&] { ReadFurnitureLibrary(folder_ / "none"); },
                          {"PluginFurnitureCatalog.properties"});
}

}  // namespace
}  // namespace soslam
