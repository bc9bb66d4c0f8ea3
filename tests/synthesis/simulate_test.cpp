// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/synthesis/simulate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scene.h"

namespace soslam {
namespace {

// Boxes on a floor in a line ahead of a camera that drives towards them.
Scene Row(int frames = 20) {
  Scene scene;
  scene.name = "row";
  scene.camera = {640, 480, 500.0, 500.0, 319.5, 239.5};
  scene.planes.push_back({3, "floor", Plane{}, std::nullopt});
  scene.objects.push_back({1, "a", Shape::kBox, {0.2, 0.3, 0.25}, {3.0, -0.6}, 0.4, 0, 1});
  scene.objects.push_back({2, "b", Shape::kEllipsoid, {0.3, 0.2, 0.25}, {3.5, 0.1}, 0.0, 0, 2});
  scene.objects.push_back({3, "c", Shape::kCylinder, {0.2, 0.2, 0.3}, {4.0, 1.0}, 0.0, 0, 3});
  scene.trajectory.frames = frames;
  scene.trajectory.waypoints = {{{0.0, 0.0, 0.6}, {3.5, 0.1, 0.3}},
                                {{1.0, 0.2, 0.6}, {3.5, 0.1, 0.3}}};
  scene.seed = 1;
  return scene;
}

SceneNoise AllNoise() { return {0.02, 0.5, 0.1, 0.02, 0.01, 0.5, 1.0}; }

TEST(ObjectGroundTruth, TellsSymmetries) {
  const Scene scene = Row();
  const auto truth = [&](int i) { return ObjectGroundTruth(scene, scene.objects[i]); };
  EXPECT_TRUE(truth(0).mirror_symmetric);
  EXPECT_FALSE(truth(0).mirror_symmetric_yz);
  EXPECT_FALSE(truth(0).rotationally_symmetric);
  EXPECT_FALSE(truth(1).rotationally_symmetric);
  EXPECT_TRUE(truth(2).rotationally_symmetric);
}

TEST(Simulate, ObjectBehindAnotherIsNotInSight) {
  Scene scene = Row(1);
  const Eigen::Vector2d ahead(3.5, 0.1);  // of object b, seen from the first pose
  scene.objects.push_back({4, "wall", Shape::kBox, {0.05, 0.4, 0.4}, 0.6 * ahead, 0.0, 0, 4});
  const Simulation simulation = Simulate(scene, false);
  std::vector<int> seen;
  for (const SimulatedBox& row : simulation.exact_boxes) seen.push_back(row.object_index);
  EXPECT_EQ(seen, (std::vector<int>{0, 2, 3}));
}

// What stands before another object is moved away.
TEST(Simulate, ObjectsAreThereInTheirFrames) {
  Scene scene = Row(6);
  SceneObject wall{0, "wall", Shape::kBox, {0.05, 0.4, 0.4}, {2.1, 0.06}, 0.0, 0, 4};
  wall.until_frame = 2;
  scene.objects.insert(scene.objects.begin(), wall);
  scene.objects[3].from_frame = 4;
  std::vector<std::vector<int>> seen(6);
  for (const SimulatedBox& row : Simulate(scene, false).detections) {
    seen[row.frame_index].push_back(scene.objects[row.object_index].id);
  }
  const std::vector<int> with_wall = {0, 1}, without = {1, 2}, last = {1, 2, 3};
  EXPECT_EQ(seen, (std::vector{with_wall, with_wall, without, without, last, last}));
}

TEST(Simulate, TruncatedAndPassedObjectsAreNotInSight) {
  Scene scene = Row(1);
  scene.objects[0].position_on_plane = {1.2, -0.75};  // reaches over the image's border
  scene.objects[2].position_on_plane = {-4.0, 1.0};   // behind the camera
  const Simulation simulation = Simulate(scene, false);
  ASSERT_EQ(simulation.exact_boxes.size(), 1u);
  EXPECT_EQ(simulation.exact_boxes[0].object_index, 1);
}

// A thin board on the floor, `x` metres ahead of the camera of Boards.
SceneObject Board(int id, double x, double y_min, double y_max, double height) {
  constexpr double kThin = 1e-4;
  return {id,
          "board",
          Shape::kBox,
          {kThin, 0.5 * (y_max - y_min), 0.5 * height},
          {x + kThin, 0.5 * (y_min + y_max)},
          0.0,
          0,
          id};
}

// Boards before a level camera 0.5 m above the origin that looks along x: a point of the world
// appears at (319.5 - 500 y / x, 239.5 + 500 (0.5 - z) / x).
Scene Boards(const std::vector<SceneObject>& boards) {
  Scene scene = Row(1);
  scene.boxes = BoxedPart::kVisible;
  scene.objects = boards;
  scene.trajectory.waypoints = {{{0.0, 0.0, 0.5}, {3.0, 0.0, 0.5}}};
  return scene;
}

void ExpectBox(const SimulatedBox& seen, int object_index, const Box& box, double share) {
  EXPECT_EQ(seen.object_index, object_index);
  EXPECT_NEAR(seen.box.x_min, box.x_min, 0.51);
  EXPECT_NEAR(seen.box.y_min, box.y_min, 0.51);
  EXPECT_NEAR(seen.box.x_max, box.x_max, 0.51);
  EXPECT_NEAR(seen.box.y_max, box.y_max, 0.51);
  EXPECT_NEAR(seen.score, 0.3 + 0.65 * share, 0.01);
}

TEST(Simulate, VisibleBoxIsOfTheHalfThatNothingHides) {
  Scene scene = Boards({Board(1, 3.0, -0.4, 0.4, 0.8), Board(2, 1.5, -0.6, 0.0, 0.9)});
  const auto seen = Simulate(scene, false).exact_boxes;
  ASSERT_EQ(seen.size(), 2u);
  ExpectBox(seen[0], 0, {252.83, 189.5, 319.5, 322.83}, 0.5);
  ExpectBox(seen[1], 1, {319.5, 106.17, 519.5, 406.17}, 1.0);
  scene.min_visible_share = 0.48;
  EXPECT_EQ(Simulate(scene, false).exact_boxes.size(), 2u);
  scene.min_visible_share = 0.52;
  EXPECT_EQ(Simulate(scene, false).exact_boxes.size(), 1u);
  scene.boxes = BoxedPart::kWhole;
  EXPECT_EQ(Simulate(scene, false).exact_boxes.back().score, 1.0);
}

TEST(Simulate, VisibleBoxEndsAtTheBorderOfTheImage) {
  // The border on the right is at y = -1.92, a third of the board from its end.
  Scene scene = Boards({Board(1, 3.0, -2.12, -1.52, 0.8)});
  const auto seen = Simulate(scene, false).exact_boxes;
  ASSERT_EQ(seen.size(), 1u);
  ExpectBox(seen[0], 0, {572.83, 189.5, 639.5, 322.83}, 2.0 / 3.0);
  EXPECT_EQ(seen[0].box.x_max, 639.5);
  scene.min_visible_share = 0.68;
  EXPECT_TRUE(Simulate(scene, false).exact_boxes.empty());
}

TEST(Simulate, TablesHideWhatIsBehindThem) {
  Scene scene = Boards({Board(1, 3.0, -0.4, 0.4, 0.8)});
  scene.planes.push_back({4, "table", Plane{Eigen::Vector3d::UnitZ(), -0.4}, TableTop{}});
  scene.planes[1].table->position_on_plane = {1.6, 0.0};
  scene.planes[1].table->half_size = {0.1, 1.0};
  scene.planes[1].table->thickness = 0.4;
  const auto seen = Simulate(scene, false).exact_boxes;
  ASSERT_EQ(seen.size(), 1u);
  const double edge = 239.5 + 500.0 * 0.1 / 1.7;  // the far edge of the table's top
  ExpectBox(seen[0], 0, {252.83, 189.5, 386.17, edge}, (edge - 189.5) / 133.33);
}

TEST(Simulate, VisibleBoxesHaveTenPixels) {
  const Scene scene = Boards({Board(1, 3.0, 0.1, 0.5, 0.05), Board(2, 3.0, -0.5, -0.1, 0.07)});
  const auto seen = Simulate(scene, false).exact_boxes;
  ASSERT_EQ(seen.size(), 1u) << "the first is 8 pixels high, the second 12";
  EXPECT_EQ(seen[0].object_index, 1);
}

TEST(Simulate, BodiesBesideAndBehindTheCameraHideNothing) {
  Scene scene = Boards({Board(1, 3.0, -0.4, 0.4, 0.8), Board(2, -1.0, -0.4, 0.4, 0.8)});
  // From before the camera to behind it, so that it has no outline.
  scene.objects.push_back({3, "beside", Shape::kBox, {1.0, 0.1, 0.2}, {0.0, 0.8}, 0.0, 0, 3});
  scene.min_visible_share = 0.9;
  const auto seen = Simulate(scene, false).exact_boxes;
  ASSERT_EQ(seen.size(), 1u);
  ExpectBox(seen[0], 0, {252.83, 189.5, 386.17, 322.83}, 1.0);
}

TEST(Simulate, FalseBoxesAreAsManyAsToldAndChangeNothingElse) {
  Scene scene = Row(1000);
  scene.noise = AllNoise();
  const Simulation without = Simulate(scene, true);
  scene.noise.false_share = 0.2;
  const Simulation with = Simulate(scene, true);
  std::vector<SimulatedBox> true_ones, false_ones;
  for (const SimulatedBox& row : with.detections) {
    (row.is_false ? false_ones : true_ones).push_back(row);
  }
  ASSERT_EQ(true_ones.size(), without.detections.size());
  for (size_t i = 0; i < true_ones.size(); ++i) {
    EXPECT_EQ(true_ones[i].box, without.detections[i].box);
    EXPECT_EQ(true_ones[i].score, 1.0);
  }
  const auto all = static_cast<double>(true_ones.size());
  EXPECT_NEAR(static_cast<double>(false_ones.size()), 0.2 * all, 4.0 * std::sqrt(0.16 * all));
  std::vector<int> of_label(scene.objects.size());
  for (const SimulatedBox& row : false_ones) {
    EXPECT_GE(DistanceToBorder(row.box, 640, 480), 0.0);
    EXPECT_GE(row.box.Height(), 0.05 * 480 - 1e-9);
    EXPECT_LE(row.box.Height(), 0.5 * 480 + 1e-9);
    EXPECT_LE(std::abs(std::log2(row.box.Width() / row.box.Height())), 1.0 + 1e-9);
    EXPECT_GE(row.score, 0.25);
    EXPECT_LE(row.score, 0.6);
    ++of_label[row.object_index];
  }
  for (const int count : of_label) EXPECT_GT(count, 100);
  EXPECT_EQ(with.odometry_world_from_camera.back().translation,
            without.odometry_world_from_camera.back().translation);
  EXPECT_EQ(Simulate(scene, false).detections.size(), with.exact_boxes.size());
}

TEST(Simulate, BoxNoiseHasItsSigma) {
  Scene scene = Row(1000);
  scene.noise.box_edge_sigma = 0.03;
  scene.noise.box_sigma_px = 1.0;
  const Simulation simulation = Simulate(scene, true);
  ASSERT_EQ(simulation.detections.size(), 3000u);
  Eigen::Vector4d squares = Eigen::Vector4d::Zero();
  for (size_t i = 0; i < simulation.detections.size(); ++i) {
    const Box& noisy = simulation.detections[i].box;
    const Box& exact = simulation.exact_boxes[i].box;
    const double sigma_x = std::hypot(0.03 * exact.Width(), 1.0);
    const double sigma_y = std::hypot(0.03 * exact.Height(), 1.0);
    squares += Eigen::Vector4d(
                   (noisy.x_min - exact.x_min) / sigma_x, (noisy.y_min - exact.y_min) / sigma_y,
                   (noisy.x_max - exact.x_max) / sigma_x, (noisy.y_max - exact.y_max) / sigma_y)
                   .cwiseAbs2();
  }
  // The mean of 3000 squares of standard normals has sigma sqrt(2 / 3000) = 0.026.
  for (int edge = 0; edge < 4; ++edge) EXPECT_NEAR(squares[edge] / 3000.0, 1.0, 0.12);
}

TEST(Simulate, MissesAsOftenAsToldAndStaysInTheImage) {
  Scene scene = Row(1000);
  scene.noise.miss_probability = 0.3;
  scene.noise.box_sigma_px = 200.0;
  const Simulation simulation = Simulate(scene, true);
  scene.noise.box_sigma_px = 0.0;
  // 3000 draws have sigma 0.008.
  EXPECT_NEAR(static_cast<double>(Simulate(scene, true).detections.size()) / 3000.0, 0.7, 0.04);
  for (const SimulatedBox& row : simulation.detections) {
    EXPECT_GE(DistanceToBorder(row.box, 640, 480), 0.0);
    EXPECT_GT(row.box.Width(), 0.0);
    EXPECT_GT(row.box.Height(), 0.0);
  }
}

TEST(Simulate, OdometryStartsAtTheTruthAndDriftsAsTold) {
  Scene scene = Row(50);
  scene.noise.odometry_translation_sigma = 0.01;
  double squares = 0.0;
  constexpr int kRuns = 400;
  for (int seed = 0; seed < kRuns; ++seed) {
    scene.seed = seed;
    const Simulation simulation = Simulate(scene, true);
    const auto& odometry = simulation.odometry_world_from_camera;
    const auto& truth = simulation.true_world_from_camera;
    ASSERT_EQ(odometry.front().Matrix(), truth.front().Matrix());
    EXPECT_NEAR(odometry.back().rotation.angularDistance(truth.back().rotation), 0.0, 1e-7);
    squares += (odometry.back().translation - truth.back().translation).squaredNorm();
  }
  // A random walk over the 1.02 m of the drive on three axes; the mean of 1200 squares has a
  // relative sigma of 0.04.
  EXPECT_NEAR(squares / kRuns / (3.0 * 0.01 * 0.01 * std::hypot(1.0, 0.2)), 1.0, 0.2);
}

TEST(Simulate, OdometryRotatesAndScales) {
  Scene scene = Row();
  scene.noise.odometry_rotation_sigma_deg = 1.0;
  const Simulation turned = Simulate(scene, true);
  const double angle = turned.odometry_world_from_camera.back().rotation.angularDistance(
      turned.true_world_from_camera.back().rotation);
  EXPECT_GT(angle, 1e-3);
  EXPECT_LT(angle, 0.15);

  scene.noise = {};
  scene.noise.odometry_scale_sigma = 0.1;
  const Simulation scaled = Simulate(scene, true);
  const auto travelled = [](const std::vector<Rigid3d>& poses, size_t i) {
    return (poses[i].translation - poses[i - 1].translation).norm();
  };
  const double scale =
      travelled(scaled.odometry_world_from_camera, 1) / travelled(scaled.true_world_from_camera, 1);
  EXPECT_GT(std::abs(scale - 1.0), 1e-4);
  EXPECT_NEAR(travelled(scaled.odometry_world_from_camera, 19),
              scale * travelled(scaled.true_world_from_camera, 19), 1e-12)
      << "one scale for the whole trajectory";
}

TEST(Simulate, SameSeedSameMeasurementsOtherSeedOther) {
  Scene scene = Row();
  scene.noise = AllNoise();
  const Simulation first = Simulate(scene, true), again = Simulate(scene, true);
  scene.seed = 2;
  const Simulation other = Simulate(scene, true);
  ASSERT_EQ(first.detections.size(), again.detections.size());
  for (size_t i = 0; i < first.detections.size(); ++i) {
    EXPECT_EQ(first.detections[i].box.x_min, again.detections[i].box.x_min);
  }
  EXPECT_NE(first.detections[0].box.x_min, other.detections[0].box.x_min);
  EXPECT_EQ(first.odometry_world_from_camera.back().translation,
            again.odometry_world_from_camera.back().translation);
  EXPECT_NE(first.odometry_world_from_camera.back().translation,
            other.odometry_world_from_camera.back().translation);
  scene.seed = 1;
  scene.noise.box_edge_sigma = scene.noise.miss_probability = 0.0;
  EXPECT_EQ(Simulate(scene, true).odometry_world_from_camera.back().translation,
            first.odometry_world_from_camera.back().translation)
      << "kinds of noise are independent";
}

}  // namespace
}  // namespace soslam
