// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/ground/estimate_ground.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string_view>

#include "soslam/geometry/angles.h"
#include "soslam/ground/ground_checks.h"
#include "soslam/ground/object_heights.h"
#include "support/prior_scene.h"

namespace soslam {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::EndsWith;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const SemanticTable& ShippedTable() {
  static const SemanticTable table =
      ReadSemanticTable(SOSLAM_SOURCE_DIR "/pipelines/priors/semantic_table.json");
  return table;
}

// A room with 4 to 14 objects, and in three of four rooms a table.
PriorScene SceneOf(unsigned seed, double wrong_label_probability = 0.0) {
  std::mt19937 random(seed);
  PriorSceneOptions options;
  options.wrong_label_probability = wrong_label_probability;
  options.objects = std::uniform_int_distribution<int>(4, 14)(random);
  options.has_table = std::uniform_int_distribution<int>(0, 3)(random) != 0;
  return PriorSceneBuilder(ShippedTable(), seed, options).Build();
}

GroundEstimate Estimate(const Sequence& sequence, const std::vector<MapPoint>& points,
                        const GroundOptions& options = {}, const Edits& edits = {}) {
  return EstimateGround(sequence, points, {}, {}, {}, edits, ShippedTable(), options, 2);
}

// The height, or width, of the object with most boxes, `factor` times the true one.
Edits KnownSizeOf(const PriorScene& scene, bool is_width = false, double factor = 1.0) {
  std::map<int, std::vector<const Detection*>> boxes;
  for (const Detection& detection : scene.sequence.detections) {
    boxes[*detection.true_object_id].push_back(&detection);
  }
  const auto most = std::ranges::max_element(
      boxes, {}, [](const auto& id_and_boxes) { return id_and_boxes.second.size(); });
  Edit edit;
  edit.kind = EditKind::kSize;
  const Eigen::Vector3d& size_m = scene.sizes_m.at(static_cast<size_t>(most->first));
  (is_width ? edit.size.width_m : edit.size.height_m) =
      factor * (is_width ? size_m.y() : size_m.z());
  for (const Detection* detection : most->second) {
    edit.boxes.push_back({scene.sequence.FrameOf(*detection).image, detection->box});
  }
  return {.edits = {edit}};
}

// How many findings are of this check.
std::ptrdiff_t CountOf(std::string_view check, const std::vector<Finding>& findings) {
  return std::ranges::count(findings, check, &Finding::check);
}

bool IsNear(const std::vector<double>& heights, double height) {
  return std::ranges::any_of(heights,
                             [&](double other) { return std::abs(other - height) < 0.03; });
}

// Outcome of one scene against the truth.
struct Outcome {
  double log_error, log_sigma, relative_width, up_error_deg;
  bool is_within;
  int planes, missed_planes, wrong_planes;
};

Outcome Compare(const PriorScene& scene, const GroundEstimate& estimate) {
  const double truth = std::log(scene.metres_per_unit);
  const ScalePosterior& scale = *estimate.scale;
  Outcome outcome{scale.log_scale - truth,
                  scale.log_sigma,
                  (scale.high - scale.low) / (2.0 * 1.96 * scene.prior_log_sigma),
                  AngleBetweenDeg(estimate.up_in_input, scene.up_in_world),
                  scale.low < truth && truth < scale.high,
                  static_cast<int>(scene.plane_heights_m.size()),
                  0,
                  0};
  // Heights over the lowest plane in true metres.
  std::vector<double> heights;
  for (const EstimatedPlane& plane : estimate.planes) {
    heights.push_back(plane.point_in_world.z() * std::exp(-outcome.log_error));
  }
  for (const double height : scene.plane_heights_m) {
    outcome.missed_planes += IsNear(heights, height - scene.plane_heights_m.front()) ? 0 : 1;
  }
  for (const double height : heights) {
    outcome.wrong_planes += IsNear(scene.plane_heights_m, height) ? 0 : 1;
  }
  return outcome;
}

TEST(EstimateGroundTest, FindsUpScaleAndPlanesOfARoom) {
  const PriorScene scene = SceneOf(1);
  const GroundEstimate estimate = Estimate(scene.sequence, scene.points);
  ASSERT_TRUE(estimate.scale);
  const Outcome outcome = Compare(scene, estimate);
  EXPECT_TRUE(outcome.is_within) << outcome.log_error;
  EXPECT_LT(outcome.up_error_deg, 0.5);
  EXPECT_FALSE(estimate.cameras_are_turned);
  EXPECT_EQ(outcome.planes, 2);
  EXPECT_EQ(outcome.missed_planes, 0);
  EXPECT_EQ(outcome.wrong_planes, 0);
  const Sequence output = WithGround(scene.sequence, estimate);
  for (const SupportPlane& plane : output.planes) {
    EXPECT_EQ(plane.plane_in_world.normal, Eigen::Vector3d::UnitZ());
  }
  EXPECT_EQ(output.odometry_world, OdometryWorld::kOwnWithScale);
}

TEST(EstimateGroundTest, DoesNotDependOnTheWorldOfTheInput) {
  const PriorScene scene = SceneOf(2);
  const Similarity other{0.013, {Eigen::Quaterniond(0.1, 0.7, -0.5, 0.2).normalized(), {4, -2, 9}}};
  const GroundEstimate one = Estimate(scene.sequence, scene.points);
  const Sequence moved = Transformed(other, scene.sequence);
  const GroundEstimate two = Estimate(moved, Transformed(other, scene.points));
  ASSERT_TRUE(one.scale && two.scale);
  EXPECT_NEAR(two.scale->log_scale, one.scale->log_scale - std::log(other.scale), 1e-4);
  EXPECT_NEAR(two.scale->log_sigma, one.scale->log_sigma, 1e-4);
  EXPECT_LT((two.up_in_input - other.rigid.rotation * one.up_in_input).norm(), 1e-4);
  ASSERT_EQ(one.planes.size(), two.planes.size());
  const Sequence output = WithGround(scene.sequence, one), other_output = WithGround(moved, two);
  for (size_t i = 0; i < output.frames.size(); ++i) {
    const Rigid3d &pose = output.frames[i].world_from_camera,
                  &other_pose = other_output.frames[i].world_from_camera;
    EXPECT_LT((pose.translation - other_pose.translation).norm(), 1e-3);
    EXPECT_LT(pose.rotation.angularDistance(other_pose.rotation), 1e-4);
  }
}

TEST(EstimateGroundTest, KnownValuesNarrowTheScale) {
  const PriorScene scene = SceneOf(3);
  const auto expect_known = [&](const GroundOptions& options, double log_sigma) {
    const GroundEstimate estimate = Estimate(scene.sequence, scene.points, options);
    ASSERT_TRUE(estimate.scale);
    EXPECT_NEAR(estimate.scale->log_scale, std::log(scene.metres_per_unit), log_sigma);
    EXPECT_LT(estimate.scale->log_sigma, log_sigma + 0.001);
    EXPECT_EQ(CountOf(kObjectsAgainstSettingsCheck, CheckGround(estimate, options)), 0);
  };
  GroundOptions with_scale, with_height;
  with_scale.scale = scene.metres_per_unit;
  expect_known(with_scale, 0.02);
  with_height.camera_height_m = scene.median_camera_height_m;
  with_height.camera_height_log_sigma = 0.03;
  expect_known(with_height, 0.03);
}

TEST(EstimateGroundTest, TheSizeOfOneThingTellsTheScale) {
  const PriorScene scene = SceneOf(3);
  const GroundEstimate without = Estimate(scene.sequence, scene.points);
  const GroundEstimate with = Estimate(scene.sequence, scene.points, {}, KnownSizeOf(scene));
  EXPECT_NEAR(with.scale->log_scale, std::log(scene.metres_per_unit), 0.03);
  EXPECT_LT(with.scale->log_sigma, 0.5 * without.scale->log_sigma);
  const auto pull = [](const WorldReport::ObjectRow& object) {
    return object.pull ? std::abs(*object.pull) : 0.0;
  };
  EXPECT_TRUE(std::ranges::max_element(with.objects, {}, pull)->is_measured);
  const auto findings = CheckGround(with, {});
  EXPECT_EQ(CountOf(kObjectsAgainstSettingsCheck, findings), 0);
  EXPECT_THAT(EstimateWorldScale(with, findings)->found_by,
              testing::ElementsAre("objects", "edits"));
  // Boxes determine widths less than heights.
  const GroundEstimate width = Estimate(scene.sequence, scene.points, {}, KnownSizeOf(scene, true));
  EXPECT_NEAR(width.scale->log_scale, std::log(scene.metres_per_unit),
              2.0 * width.scale->log_sigma);
  EXPECT_LT(width.scale->log_sigma, 0.9 * without.scale->log_sigma);
  const GroundEstimate in_feet =
      Estimate(scene.sequence, scene.points, {}, KnownSizeOf(scene, false, 3.28));
  EXPECT_EQ(CountOf(kObjectsAgainstSettingsCheck, CheckGround(in_feet, {})), 1);
}

// Whether the objects overrule it or not.
TEST(EstimateGroundTest, AKnownValueThatObjectsContradictIsAFinding) {
  const PriorScene scene = SceneOf(3);
  for (const double factor : {0.01, 0.4, 2.5, 100.0}) {
    for (const double log_sigma : {0.02, 0.1}) {
      GroundOptions options;
      options.camera_height_m = factor * scene.median_camera_height_m;
      options.camera_height_log_sigma = log_sigma;
      const GroundEstimate estimate = Estimate(scene.sequence, scene.points, options);
      const auto findings = CheckGround(estimate, options);
      EXPECT_EQ(CountOf(kObjectsAgainstSettingsCheck, findings), 1) << factor << " " << log_sigma;
      const auto scale = EstimateWorldScale(estimate, findings);
      EXPECT_THAT(scale->contradicted_by, Contains(kObjectsAgainstSettingsCheck));
      EXPECT_THAT(ContradictionsInWords(*scale), HasSubstr("the camera's height given"));
    }
  }
}

TEST(CheckGroundTest, SettingsThatContradictEachOtherAreAFindingWithAndWithoutObjects) {
  GroundEstimate estimate;
  estimate.scale = ScalePosterior{.log_scale = 0.1, .log_sigma = 0.02, .low = 0.06, .high = 0.14};
  estimate.known_scales = {{0.0, 0.03, "scale"}, {0.31, 0.1, "camera_height_m"}};  // 0.104 together
  EXPECT_EQ(CountOf(kSettingsAgainstEachOtherCheck, CheckGround(estimate, {})), 0);
  estimate.known_scales[1].log_scale = 0.32;
  const auto findings = CheckGround(estimate, {});
  EXPECT_THAT(findings, Contains(AllOf(Field(&Finding::check, kSettingsAgainstEachOtherCheck),
                                       Field(&Finding::found, HasSubstr("is 1 m by scale, and "
                                                                        "1.377 m by camera")))));
  const auto scale = EstimateWorldScale(estimate, findings);
  EXPECT_EQ(SourcesInWords(*scale), "the scale given and the camera's height given");
  EXPECT_EQ(ContradictionsInWords(*scale),
            "the scale given and the camera's height given contradict each other");
}

// Settings are joined with the objects that agree; they stand alone where none does.
TEST(WorldScaleOfTest, ObjectsThatContradictOneAnotherCountWhereTheScaleRestsOnThem) {
  const std::vector<Finding> findings = {
      {kObjectsAgainstOneAnotherCheck, Severity::kWarning, "", "", "", ""}};
  GroundEstimate estimate;
  estimate.scale = ScalePosterior();
  EXPECT_EQ(SourcesInWords(*EstimateWorldScale(estimate, findings)),
            "objects that contradict one another");
  EXPECT_EQ(EstimateWorldScale(estimate, findings)->contradicted_by.size(), 1u);
  estimate.known_scales = {{0.0, 0.1, "camera_height_m"}};
  EXPECT_THAT(EstimateWorldScale(estimate, findings)->contradicted_by, IsEmpty());
  estimate.objects.resize(1);
  estimate.objects[0].agreement = 0.9;
  EXPECT_EQ(EstimateWorldScale(estimate, findings)->contradicted_by.size(), 1u);
}

TEST(CheckGroundTest, AnUncertainScaleSaysWhatItRestsOn) {
  GroundEstimate estimate;
  estimate.scale = ScalePosterior{.log_sigma = 0.3, .low = -0.6, .high = 0.6};
  estimate.objects.resize(3);
  for (WorldReport::ObjectRow& object : estimate.objects) object.weight = 0.7;
  estimate.objects[0].agreement = 0.9;
  estimate.objects[1].agreement = 0.1;  // of the other two, nothing counts
  const auto found = [&] {
    for (const Finding& finding : CheckGround(estimate, {})) {
      if (finding.check == "scale_uncertain") return finding.found;
    }
    return std::string();
  };
  EXPECT_THAT(found(), HasSubstr("from the usual heights of 1 detected thing; as heights of one "
                                 "label are alike, this thing counts as 0.7"));
  estimate.objects[1].agreement = 0.8;
  EXPECT_THAT(found(), HasSubstr("of 2 detected things; as heights of one label are alike, these "
                                 "things count as 1.4"));
  for (WorldReport::ObjectRow& object : estimate.objects) object.weight = 1.0;
  EXPECT_THAT(found(), EndsWith("of 2 detected things"));
}

// A plane of the output has priors of its tilt and of its height at the middle of its points. They
// are independent, and do not depend on where the origin of the input's world is.
TEST(EstimateGroundTest, TiltAndHeightOfPlanesAreIndependentWhereverTheOriginIs) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const PriorScene scene = SceneOf(seed);
    const Similarity far{1.0, {Eigen::Quaterniond::Identity(), {5e3, -2e3, 4e3}}};
    const GroundEstimate one = Estimate(scene.sequence, scene.points);
    const GroundEstimate two =
        Estimate(Transformed(far, scene.sequence), Transformed(far, scene.points));
    ASSERT_EQ(one.planes.size(), two.planes.size());
    for (size_t i = 0; i < one.planes.size(); ++i) {
      const Eigen::Matrix3d& covariance = *one.planes[i].covariance;
      EXPECT_LT((*two.planes[i].covariance - covariance).norm(), 1e-4 * covariance.norm());
      EXPECT_LT((two.planes[i].point_in_world - one.planes[i].point_in_world).norm(), 1e-3);
      for (int turn = 0; turn < 2; ++turn) {
        const double correlation =
            covariance(turn, 2) / std::sqrt(covariance(turn, turn) * covariance(2, 2));
        EXPECT_LT(std::abs(correlation), 0.1) << seed << " " << i;
      }
    }
  }
}

TEST(EstimateGroundTest, AScaleThatCannotBeToldIsAFinding) {
  PriorScene scene = SceneOf(4);
  for (Object& object : scene.sequence.objects) object.label = "thing";
  const GroundEstimate estimate = Estimate(scene.sequence, scene.points);
  EXPECT_FALSE(estimate.scale);
  EXPECT_EQ(CountOf("scale_unknown", CheckGround(estimate, {})), 1);
  EXPECT_NEAR(estimate.output_from_input.scale, 1.0, 1e-9);
}

TEST(EstimateGroundTest, ContradictingHeightsAreAFinding) {
  PriorScene scene = SceneOf(3);
  for (Object& object : scene.sequence.objects) {
    if (object.label < "m") object.label = "bus";
  }
  EXPECT_EQ(CountOf(kObjectsAgainstOneAnotherCheck,
                    CheckGround(Estimate(scene.sequence, scene.points), {})),
            1);
}

TEST(EstimateGroundTest, WithoutPointsThereAreNoPlanes) {
  const PriorScene scene = SceneOf(1);
  const GroundEstimate estimate = Estimate(scene.sequence, {});
  EXPECT_THAT(estimate.planes, IsEmpty());
  EXPECT_EQ(CountOf("no_support_plane", CheckGround(estimate, {})), 1);
}

TEST(EstimateGroundTest, TurnedImagesTellUpFromDown) {
  const PriorScene scene = SceneOf(3);
  // Boxes alone do not.
  EXPECT_EQ(Estimate(scene.sequence, {}).up_of_cameras.orientation, CameraOrientation::kLevel);
  const std::vector<TurnedImage> upside_down = {{0, {3.0, 2.0, 20.0, 2.0}}};
  const GroundEstimate estimate =
      EstimateGround(scene.sequence, {}, {}, upside_down, {}, {}, ShippedTable(), {}, 2);
  EXPECT_EQ(estimate.up_of_cameras.orientation, CameraOrientation::kRolled180);
  EXPECT_GT(AngleBetweenDeg(estimate.up_in_input, scene.up_in_world), 170.0);
}

TEST(EstimateGroundTest, WaysToHoldCamerasHaveProbabilities) {
  const PriorScene scene = SceneOf(3);
  const GroundEstimate estimate = Estimate(scene.sequence, scene.points);
  EXPECT_GT(estimate.up_probability, 0.99);
  EXPECT_LT(Estimate(scene.sequence, {}).up_probability, estimate.up_probability)
      << "cameras alone are less sure";
  const UpEstimate& up = estimate.up_of_cameras;
  double sum = 0.0;
  for (const TriedOrientation& tried : up.orientations) sum += tried.probability;
  EXPECT_NEAR(sum, 1.0, 1e-9);
  EXPECT_EQ(up.orientation, CameraOrientation::kLevel);
  EXPECT_EQ(up.orientation_tilt_variance, 0.0);
}

TEST(EstimateGroundTest, PlanesTellUpWhereCamerasAreTurnedInManyWays) {
  const PriorScene scene = PriorSceneBuilder(ShippedTable(), 3, {.roll_sigma_deg = 30.0}).Build();
  const GroundEstimate estimate = Estimate(scene.sequence, scene.points);
  EXPECT_EQ(CountOf(kCamerasTurnedCheck, CheckGround(estimate, {})), 1);
  EXPECT_LT(AngleBetweenDeg(estimate.up_in_input, scene.up_in_world), 0.5);
}

TEST(WithSizesTest, NamedBoxesAreOfOneObject) {
  Edits edits;
  edits.edits.resize(5);
  for (const size_t i : {0, 1, 2, 4}) edits.edits[i].kind = EditKind::kSize;
  edits.edits[0].size.height_m = 0.5;
  edits.edits[1].size.width_m = 0.6;
  edits.edits[2].size.depth_m = 0.7;
  edits.edits[4].size.width_m = 0.8;
  // Most of a group and a stray box; the same group again; boxes of no group; another edit; another
  // length of the first thing.
  const FoundEdits found = {edits, {{2, 3, 9}, {4}, {20, 21}, {8}, {9}}, {}};
  const auto groups = WithSizes(found, {{1, 2, 3, 4}, {7, 8, 9}});
  std::map<std::vector<int>, KnownSize> sizes;
  for (const BoxGroup& group : groups) sizes[group.detections] = group.size;
  ASSERT_EQ(sizes.size(), 4u);
  EXPECT_EQ((sizes.at({1, 2, 3, 9}).height_m), 0.5);
  EXPECT_EQ((sizes.at({1, 2, 3, 9}).width_m), 0.8);
  EXPECT_EQ((sizes.at({4}).width_m), 0.6);
  EXPECT_EQ((sizes.at({20, 21}).depth_m), 0.7);
  EXPECT_FALSE((sizes.at({7, 8}).Any()));
}

TEST(CheckGroundTest, ASizeThatTellsNothingIsAFinding) {
  PriorScene scene = SceneOf(3);
  const Edits edits = KnownSizeOf(scene);
  for (Object& object : scene.sequence.objects) object.label = "unknown thing";
  const GroundEstimate estimate = Estimate(scene.sequence, scene.points, {}, edits);
  EXPECT_EQ(CountOf("size_tells_nothing", CheckGround(estimate, {})), 1);
}

TEST(GroupBoxesTest, GroupsAreOfOneObject) {
  const PriorScene scene = SceneOf(5);
  const Eigen::Vector3d& up = scene.up_in_world;
  const UpPrior known_up = {1e4 * (Eigen::Matrix3d::Identity() - up * up.transpose()), up};
  const Edits no_edits;
  for (const double metres_per_unit : {0.8, 2.0, 5.0}) {
    SCOPED_TRACE(metres_per_unit);
    const Sequence sequence =
        Transformed(Similarity{scene.metres_per_unit / metres_per_unit, {}}, scene.sequence);
    const FoundEdits edits = FindBoxes(no_edits, sequence, {});
    const auto groups = GroupBoxes(sequence, FramesToGroup(sequence, edits), edits, ShippedTable(),
                                   {}, known_up, {}, 1);
    size_t in_largest = 0, mixed = 0;
    std::map<int, size_t> largest;
    for (const auto& group : groups) {
      std::map<int, size_t> counts;
      for (const int index : group) {
        ++counts[*scene.sequence.detections[index].true_object_id];
      }
      if (counts.size() > 1) ++mixed;
      for (const auto& [id, count] : counts) largest[id] = std::max(largest[id], count);
    }
    for (const auto& [id, count] : largest) in_largest += count;
    EXPECT_LE(mixed, 1u);
    EXPECT_GE(in_largest, 80 * scene.sequence.detections.size() / 100);
  }
}

TEST(GroupBoxesTest, FramesAreSpreadOverVeryMany) {
  Sequence sequence;
  sequence.frames.resize(1000);
  sequence.objects.resize(1);
  for (int frame = 0; frame < 1000; frame += 2) {
    sequence.detections.emplace_back().frame_index = frame;
  }
  const Edits no_edits;
  FoundEdits edits{no_edits, {}, {}};
  const std::vector<int> frames = FramesToGroup(sequence, edits);
  EXPECT_EQ(frames.size(), 200u);
  EXPECT_GT(frames.back(), 990);
  edits.boxes = {{1}};  // of frame 2
  EXPECT_THAT(FramesToGroup(sequence, edits), AllOf(SizeIs(201), Contains(2)));
}

// Figures of docs/planes.md: SOSLAM_SCENES=200.
TEST(SlowGroundTest, TrueScalesAreWithinTheirIntervals) {
  const char* count = std::getenv("SOSLAM_SCENES");
  const int scenes = count ? std::atoi(count) : 40;
  int within = 0, planes = 0, missed = 0, wrong = 0, narrow = 0, tried = 0;
  int within_with_size = 0, within_with_wrong_labels = 0;
  double largest_up_error = 0.0, squared_errors = 0.0, width = 0.0, ratio_with_size = 0.0;
  for (int seed = 1; seed <= scenes; ++seed) {
    const PriorScene scene = SceneOf(static_cast<unsigned>(seed));
    const GroundEstimate estimate = Estimate(scene.sequence, scene.points);
    if (scene.objects < 3) continue;
    ++tried;
    ASSERT_TRUE(estimate.scale) << seed;
    const Outcome outcome = Compare(scene, estimate);
    within += outcome.is_within ? 1 : 0;
    narrow += outcome.relative_width <= 1.3 ? 1 : 0;
    width += outcome.relative_width;
    squared_errors += std::pow(outcome.log_error / outcome.log_sigma, 2.0);
    planes += outcome.planes;
    missed += outcome.missed_planes;
    wrong += outcome.wrong_planes;
    if (scene.objects >= 5) largest_up_error = std::max(largest_up_error, outcome.up_error_deg);
    const Outcome with_size =
        Compare(scene, Estimate(scene.sequence, scene.points, {}, KnownSizeOf(scene)));
    within_with_size += with_size.is_within ? 1 : 0;
    ratio_with_size += with_size.relative_width / outcome.relative_width;
    const PriorScene mislabelled = SceneOf(static_cast<unsigned>(seed), 0.2);
    const GroundEstimate by_wrong = Estimate(mislabelled.sequence, mislabelled.points);
    within_with_wrong_labels += by_wrong.scale && Compare(mislabelled, by_wrong).is_within ? 1 : 0;
  }
  const std::string summary = fmt::format(
      "{} scenes: {} within, mean width {:.2f}, {} at most 1.3, rms error {:.2f} sigma, up off by "
      "at most {:.2f} degrees, {} planes, {} missed, {} wrong; with one height {} within, {:.2f} "
      "times as wide; with a fifth of the labels wrong {} within",
      tried, within, width / tried, narrow, std::sqrt(squared_errors / tried), largest_up_error,
      planes, missed, wrong, within_with_size, ratio_with_size / tried, within_with_wrong_labels);
  if (count) fmt::print("{}\n", summary);
  EXPECT_GE(within, 0.9 * tried) << summary;
  EXPECT_LE(width, 1.3 * tried) << summary;
  EXPECT_GE(within_with_size, 0.9 * tried) << summary;
  EXPECT_GE(within_with_wrong_labels, 0.9 * tried) << summary;
  EXPECT_LE(ratio_with_size, 0.5 * tried) << summary;
  EXPECT_LT(largest_up_error, 1.5) << summary;
  EXPECT_LE(missed, 0.05 * planes) << summary;
  EXPECT_LE(wrong, 0.05 * planes) << summary;
}

}  // namespace
}  // namespace soslam
