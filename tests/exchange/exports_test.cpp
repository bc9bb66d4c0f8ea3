// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/exchange/exports.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "soslam/dataset/labelled_box.h"
#include "soslam/dataset/text_file.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/geometry/angles.h"
#include "support/exported_world.h"
#include "support/labelled_boxes.h"
#include "support/lists.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using nlohmann::json;

class CocoBoxesTest : public testing::Test {
 protected:
  std::vector<LabelledBox> ReadBack(bool with_dataset) const {
    const TemporaryFolder folder;
    WriteBytes(folder / "results.json", CocoResultsText({world_}));
    WriteBytes(folder / "dataset.json", CocoDatasetText({world_}, CocoAnnotations::kNone));
    return with_dataset ? ReadCocoResults(folder / "results.json", folder / "dataset.json").boxes
                        : ReadCocoResults(folder / "results.json").boxes;
  }

  World world_ = ExportedWorld();
};

TEST_F(CocoBoxesTest, DatasetReaderReadsThemBack) {
  for (WorldFrame& frame : world_.frames) frame.camera = {10000, 10000, 500.0, 500.0, 5e3, 5e3};
  const std::vector<LabelledBox> boxes = ReadBack(true);
  ASSERT_EQ(boxes.size(), 6u);  // three landmarks in the two frames that look at them
  for (size_t i = 0; i < boxes.size(); ++i) {
    const WorldObject& object = world_.objects[i % 3];
    const WorldFrame& frame = world_.frames[i / 3];
    const auto outline = OutlineBox(frame.camera, Transform(frame.world_from_camera.Inverse(),
                                                            *object.estimate.landmark_in_world));
    ExpectLabelledBox(boxes[i], frame.image, object.label, 0.25, outline.value());
  }
}

TEST_F(CocoBoxesTest, LabelsOfCocoNeedNoDataset) {
  world_.objects.resize(2);
  world_.frames.resize(1);
  const std::vector<LabelledBox> boxes = ReadBack(false);
  EXPECT_EQ(Fields(boxes, &LabelledBox::label), (std::vector<std::string>{"dining table", "cup"}));
  EXPECT_EQ(boxes.at(0).frame, FrameKey(10));
}

TEST_F(CocoBoxesTest, BoxesAreCutAtTheImageBorder) {
  world_.objects.resize(1);
  world_.frames.resize(1);
  world_.frames[0].camera = {200, 100, 100.0, 100.0, 99.5, 49.5};
  Landmark& landmark = *world_.objects[0].estimate.landmark_in_world;
  landmark = {
      {Eigen::Quaterniond::Identity(), {-2.0, 0.5, 2.0}}, {1.0, 0.25, 1.0}, kCuboidExponent};
  // Its near face, at a depth of 1 m, spans x from -300 to -100 and y from 25 to 75 px about the
  // principal point, the outer corner being at (-100, -50); its far face, at 3 m, ends at x = -33.
  const json result = json::parse(CocoResultsText({world_})).at(0);
  const auto bbox = result.at("bbox").get<std::vector<double>>();
  EXPECT_EQ(bbox[0], 0.0);
  EXPECT_NEAR(bbox[1], 50.0 + 25.0 / 3.0, 0.5);  // edges are rounded by a thousandth
  EXPECT_NEAR(bbox[2], 100.0 - 100.0 / 3.0, 0.5);
  EXPECT_EQ(bbox[1] + bbox[3], 100.0);

  landmark.frame_from_object.translation.x() = -6.0;  // beside the image
  EXPECT_EQ(json::parse(CocoResultsText({world_})), json::array());
}

TEST_F(CocoBoxesTest, NothingIsSeenFromInsideOrBehind) {
  world_.frames.erase(world_.frames.begin(), world_.frames.begin() + 2);
  EXPECT_EQ(json::parse(CocoResultsText({world_})), json::array());
  world_.frames[0].world_from_camera.translation =
      world_.objects[0].estimate.landmark_in_world->Centre();
  EXPECT_EQ(json::parse(CocoResultsText({world_})), json::array());
}

TEST_F(CocoBoxesTest, LabelsOfOneCategoryOfCocoAreOne) {
  world_.objects[1].label = "dining table";
  for (const LabelledBox& box : ReadBack(true)) {
    EXPECT_TRUE(box.label == "Dining_Table" || box.label == world_.objects[2].label) << box.label;
  }
}

TEST_F(CocoBoxesTest, OtherCategoriesAreNumberedInAlphabeticalOrder) {
  world_.objects[3].label = "zither";
  const json dataset = json::parse(CocoDatasetText({world_}, CocoAnnotations::kNone));
  EXPECT_EQ(dataset.at("categories"),
            json::parse(R"([{"id": 47, "name": "cup", "supercategory": "object"},
      {"id": 67, "name": "Dining_Table", "supercategory": "object"},
      {"id": 1001, "name": "a \"b\", c", "supercategory": "object"},
      {"id": 1002, "name": "zither", "supercategory": "object"}])"));
  EXPECT_EQ(dataset.at("images").at(1),
            json::parse(R"({"id": 15, "file_name": "rgb/b.png", "width": 640, "height": 480})"));
  EXPECT_EQ(dataset["images"].at(2).at("file_name"), "20");
  EXPECT_EQ(dataset.at("annotations"), json::array()) << "they are no truth";
}

// With all keys that coco.py and cocoeval.py of pycocotools 2.0.11 and before look up: COCO, its
// queries and loadRes, which looks at the first result and takes some keys for another task, then
// COCOeval of boxes, for which 0 is "not matched".
TEST_F(CocoBoxesTest, HaveTheKeysThatPycocotoolsLooksUp) {
  const json results = json::parse(CocoResultsText({world_}));
  const json dataset = json::parse(CocoDatasetText({world_}, CocoAnnotations::kVisibleBoxes));
  EXPECT_TRUE(dataset.at("info").is_object());
  EXPECT_TRUE(dataset.at("licenses").is_array());
  ASSERT_GT(results.size(), 0u);
  ASSERT_EQ(dataset.at("annotations").size(), results.size());
  for (size_t i = 0; i < results.size(); ++i) {
    json expected = results[i];
    expected.erase("score");
    expected.erase("category_name");
    EXPECT_EQ(expected.size(), 4u);  // image_id, category_id, bbox, object_id
    const auto bbox = expected.at("bbox").get<std::vector<double>>();
    const double right = bbox[0] + bbox[2], bottom = bbox[1] + bbox[3];
    expected["id"] = i + 1;
    expected["iscrowd"] = 0;
    expected["area"] = bbox[2] * bbox[3];
    expected["segmentation"] = {{bbox[0], bbox[1], bbox[0], bottom, right, bottom, right, bbox[1]}};
    EXPECT_EQ(dataset["annotations"][i], expected);
  }
}

// The table of these worlds as read back: rows of fields by column.
std::vector<std::map<std::string, std::string>> TableOf(const std::vector<World>& worlds) {
  const std::string text = LandmarksCsvText(worlds);
  CsvColumns columns;
  std::istringstream header(text.substr(0, text.find('\n')));
  for (std::string name; std::getline(header, name, ',');) columns.required.push_back(name);
  const TemporaryFolder folder;
  WriteBytes(folder / "landmarks.csv", text);
  std::vector<std::map<std::string, std::string>> table;
  ForEachCsvRow(folder / "landmarks.csv", columns,
                [&](const CsvRow& row) { table.push_back(row.fields); });
  return table;
}

TEST(LandmarksCsvTest, RowsHoldWhatTheMapKnows) {
  World world = ExportedWorld();
  world.objects[0].verdict = LandmarkVerdict{"found", 7, 0.5};
  world.objects[1].verdict = LandmarkVerdict{"false", std::nullopt, std::nullopt, "background"};
  world.objects[3].segment.reset();
  world.objects[1].estimate.front_probability = 0.75;
  const auto table = TableOf({world});
  ASSERT_EQ(table.size(), 4u);
  for (size_t i = 0; i < 3; ++i) {
    const WorldObject& object = world.objects[i];
    const Landmark& landmark = *object.estimate.landmark_in_world;
    const auto number = [&](const char* column) { return std::stod(table[i].at(column)); };
    EXPECT_EQ(table[i].at("id"), std::to_string(object.id));
    EXPECT_EQ(table[i].at("label"), object.label);
    EXPECT_EQ(table[i].at("segment"), "4");
    EXPECT_EQ(number("observations"), object.estimate.observations);
    EXPECT_EQ(number("centre_y"), landmark.Centre().y());
    EXPECT_EQ(number("qx"), landmark.frame_from_object.rotation.x());
    EXPECT_EQ(number("qw"), landmark.frame_from_object.rotation.w());
    EXPECT_EQ(number("half_axis_a"), landmark.half_axes.x());
    EXPECT_EQ(number("half_axis_c"), landmark.half_axes.z());
    EXPECT_NEAR(number("yaw_deg"), ComputeYaw(object) * kDegPerRad, 1e-9);
    EXPECT_EQ(number("shape_exponent"), landmark.shape_exponents.horizontal);
    EXPECT_EQ(number("vertical_exponent"), landmark.shape_exponents.vertical);
    EXPECT_EQ(table[i].at("failure"), "");
  }
  const auto expect_fields = [&](size_t row, const std::map<std::string, std::string>& fields) {
    for (const auto& [column, text] : fields) EXPECT_EQ(table[row].at(column), text) << column;
  };
  expect_fields(0, {{"fate", "found"}, {"true_object", "7"}, {"iou", "0.5"}, {"reason", ""}});
  expect_fields(1, {{"fate", "false"}, {"iou", ""}, {"reason", "background"}});
  expect_fields(1, {{"sigma_centre_x", ""}, {"sigma_yaw_deg", ""}, {"front_probability", "0.75"}});
  expect_fields(0, {{"front_probability", ""}});
  expect_fields(2, {{"fate", ""}});
  expect_fields(3, {{"segment", ""}, {"centre_x", ""}, {"shape_exponent", ""}});
  expect_fields(3, {{"failure", "no_start"}});
}

TEST(LandmarksCsvTest, SigmasAreOfMetresAndDegrees) {
  World world = ExportedWorld();
  world.objects[0].support_normal = Eigen::Vector3d(0.0, 0.6, 0.8);
  world.objects[0].estimate.landmark_in_world->half_axes = {1.0, 2.0, 3.0};
  Covariance9 covariance = Covariance9::Zero();
  covariance.diagonal() << 0.0, 0.01, 0.02, 0.04, 0.09, 0.16, 0.01, 0.0225, 0.04;
  covariance(1, 2) = covariance(2, 1) = 0.005;
  world.objects[0].estimate.covariance = covariance;
  const auto row = TableOf({world})[0];
  const auto number = [&](const char* column) { return std::stod(row.at(column)); };
  EXPECT_NEAR(number("sigma_centre_x"), 0.2, 1e-12);
  EXPECT_NEAR(number("sigma_centre_z"), 0.4, 1e-12);
  EXPECT_NEAR(number("sigma_half_axis_a"), 0.1, 1e-12);
  EXPECT_NEAR(number("sigma_half_axis_b"), 0.3, 1e-12);
  EXPECT_NEAR(number("sigma_half_axis_c"), 0.6, 1e-12);
  // 0.36 * 0.01 + 0.64 * 0.02 + 2 * 0.48 * 0.005
  EXPECT_NEAR(number("sigma_yaw_deg"), std::sqrt(0.0212) * kDegPerRad, 1e-9);
}

// A body with half axes 1, 2 and 3 m, whose label wants quoting, in a world with z up.
std::string BoxOf(const Eigen::Quaterniond& world_from_object) {
  World world = ExportedWorld();
  WorldObject object = world.objects[2];
  object.support_normal = Eigen::Vector3d::UnitZ();
  object.estimate.landmark_in_world =
      Landmark{{world_from_object, {0.5, -1.25, 3.0}}, {1.0, 2.0, 3.0}};
  world.objects = {object, world.objects[3]};
  const std::string text = BoxesCsvText(world);
  const std::string header = "label,x,y,z,size_x,size_y,size_z,yaw_deg,score,id\n";
  EXPECT_EQ(text.substr(0, header.size()), header);
  return text.substr(header.size());
}

Eigen::Quaterniond TurnDeg(double angle_deg, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_deg * kRadPerDeg, axis));
}

TEST(BoxesCsvTest, AreUprightWithFullLengths) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  const std::string begin = "\"a \"\"b\"\", c\",0.5,-1.25,3,";
  const Eigen::Quaterniond yaw = TurnDeg(30.0, z);
  EXPECT_EQ(BoxOf(yaw), begin + "2,4,6,30,0.25,5\n");
  EXPECT_EQ(BoxOf(yaw * TurnDeg(180.0, x)), begin + "2,4,6,30,0.25,5\n") << "hangs";
  EXPECT_EQ(BoxOf(yaw * TurnDeg(20.0, x)), begin + "2,4,6,30,0.25,5\n") << "leans";
  EXPECT_EQ(BoxOf(yaw * TurnDeg(90.0, x)), begin + "2,6,4,30,0.25,5\n") << "y is up";
  // x is down, and y takes its place.
  EXPECT_EQ(BoxOf(yaw * TurnDeg(90.0, y)), begin + "4,6,2,120,0.25,5\n");
}

TEST(TumTrajectoryTest, ReadsBackBitForBit) {
  World world = ExportedWorld();
  for (WorldFrame& frame : world.frames) {
    // Exactly those of a unit quaternion, for the reader divides by the norm.
    frame.world_from_camera = {Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5),
                               RandomVector(-1e-7, 1e-7) + RandomVector(-100, 100)};
  }
  const TemporaryFolder folder;
  WriteBytes(folder / "poses.txt", TumTrajectoryText(world));
  const std::vector<TimedPose> poses = ReadTrajectory(folder / "poses.txt");
  ASSERT_EQ(poses.size(), world.frames.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].timestamp, world.frames[i].timestamp);
    const Rigid3d& expected = world.frames[i].world_from_camera;
    EXPECT_EQ(poses[i].world_from_camera.translation, expected.translation);
    EXPECT_EQ(poses[i].world_from_camera.rotation.coeffs(), expected.rotation.coeffs());
  }
}

}  // namespace
}  // namespace soslam
