// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/report/page_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/evp.h>

#include <atomic>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "soslam/base/error.h"
#include "soslam/geometry/angles.h"
#include "soslam/model/segments.h"
#include "soslam/report/page.h"
#include "soslam/report/page_html.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

using nlohmann::json;

// A curve over half a turn in steps of 2 degrees with `minima` equal minima, one of them at
// `lowest_deg`, another cost that knows nothing.
SymmetryRecord Record(double lowest_deg, int minima, double true_deg) {
  SymmetryRecord record;
  const double nan = std::nan("");
  for (int deg = 0; deg < 180; deg += 2) {
    record.yaw.push_back(deg * kRadPerDeg);
    record.cost["wave"].push_back(1.0 - std::cos(2.0 * minima * (deg - lowest_deg) * kRadPerDeg) -
                                  1e-3 * std::cos(2.0 * (deg - lowest_deg) * kRadPerDeg));
    record.cost["gap"].push_back(nan);
  }
  record.true_yaw = true_deg * kRadPerDeg;
  return record;
}

TEST(PageDescriptors, CountErrorsModuloHalfATurnAndMinima) {
  const auto found = PageDescriptors({Record(40, 1, 44), Record(10, 1, 190), Record(100, 1, 160)});
  ASSERT_EQ(found.size(), 1u);  // what has no cost anywhere says nothing
  const auto& wave = found.at("wave");
  EXPECT_EQ(wave.at("observations"), 3);
  EXPECT_NEAR(wave.at("median_error_deg").get<double>(), 4.0, 1e-3);
  // 4 degrees off twice, 60 once.
  EXPECT_EQ(wave.at("within")[0], 0.0);
  EXPECT_NEAR(wave.at("within")[1].get<double>(), 2.0 / 3.0, 1e-4);
  EXPECT_NEAR(wave.at("within")[11].get<double>(), 2.0 / 3.0, 1e-4);
  EXPECT_EQ(wave.at("within")[12], 1.0);
  EXPECT_EQ(wave.at("within")[90 / kErrorStepDeg], 1.0);
  EXPECT_EQ(wave.at("minima"), 1.0);
  EXPECT_EQ(PageDescriptors({Record(40, 3, 40)}).at("wave").at("minima"), 3.0);
}

TEST(PageDescriptors, TellWhereTheTrueYawHasNoCost) {
  SymmetryRecord gap = Record(40, 1, 100);
  for (size_t i = 45; i < 56; ++i) gap.cost["wave"][i] = std::nan("");  // 90 to 110 degrees
  const auto wave = PageDescriptors({gap, Record(40, 1, 44)}).at("wave");
  EXPECT_EQ(wave.at("known_at_truth"), 0.5);
  EXPECT_EQ(wave.at("near_where_known"), 1.0);
  EXPECT_EQ(wave.at("within")[2], 0.5);
  EXPECT_TRUE(PageDescriptors({gap}).at("wave").at("near_where_known").is_null());
}

// Frames with ids `first_id`, 10 more and so on; a detection in every `step`-th.
Sequence Recording(int frames, int step, int first_id = 10) {
  Sequence sequence;
  sequence.objects = {{7, "cup", kNoPlane, {}}};
  for (int i = 0; i < frames; ++i) {
    Frame frame;
    frame.id = first_id + 10 * i;
    sequence.frames.push_back(frame);
    Detection detection;
    detection.frame_index = i;
    if (i % step == 0) sequence.detections.push_back(detection);
  }
  return sequence;
}

TEST(PageCurves, AreOfObservationsSpreadOverEachObject) {
  std::vector<SymmetryRecord> records;
  for (int i = 0; i < 9; ++i) {
    records.push_back(Record(40, 1, 44));
    records.back().frame_id = 10 * i;
    records.back().object_id = 7;
    records.back().samples.assign(500, {1.0f, 2.0f});
    records.back().mirrored.assign(500, {3.0f, 4.0f});
  }
  const Sequence sequence = Recording(9, 1, 0);
  const auto curves =
      PageCurves(records, sequence, SelectForPage(sequence, {0, 10, 20, 40, 50, 60}));
  ASSERT_EQ(curves.size(), kCurvesPerObject);
  EXPECT_EQ(curves[0].at("detection"), 0);
  EXPECT_EQ(curves[1].at("detection"), 2);
  EXPECT_EQ(curves[2].at("detection"), 4);
  EXPECT_TRUE(PageCurves(records, sequence, SelectForPage(sequence, {})).empty());
  EXPECT_NEAR(curves[0].at("true_yaw_deg").get<double>(), 44.0, 1e-3);
  EXPECT_TRUE(curves[0].at("refined_yaw_deg").is_null());
  EXPECT_EQ(curves[0].at("pairs").size(), kPairsOfCurve);
  EXPECT_EQ(curves[0].at("pairs")[0], nlohmann::json({1.0, 2.0, 3.0, 4.0}));
  EXPECT_EQ(curves[0].at("pairs_in_all"), 500);
  EXPECT_TRUE(curves[0].at("cost").at("gap")[0].is_null());
}

constexpr size_t kFloor = 0;

TEST(CameraAbovePlane, SeesEstimatedPlanesWhereTheDetectionDoes) {
  Sequence sequence = CuboidSequence(3, 5);
  sequence.planes[kFloor].attitude_information = Eigen::Matrix3d::Identity();
  for (Detection& detection : sequence.detections) {
    // The boxes of one frame differ from odometry by some degrees and centimetres.
    const Rigid3d off = {ExpRotation(RandomVector(-0.1, 0.1)), RandomVector(-0.1, 0.1)};
    detection.plane_in_camera = Transform(off, detection.plane_in_camera);
    const Rigid3d camera_from_world = CameraAbovePlane(sequence, detection);
    const Plane seen = Transform(camera_from_world, sequence.planes[kFloor].plane_in_world);
    EXPECT_LT((seen.Homogeneous() - detection.plane_in_camera.Homogeneous()).norm(), 1e-9);
  }
}

TEST(CameraAbovePlane, SeesGivenPlanesFromTheTruePose) {
  Sequence sequence = CuboidSequence(3, 5);
  for (Frame& frame : sequence.frames) {
    frame.true_world_from_camera = frame.world_from_camera;
    frame.world_from_camera.translation += Eigen::Vector3d(0.5, 0.2, 0.1);
  }
  const Detection& detection = sequence.detections.front();
  const Rigid3d camera_from_world = CameraAbovePlane(sequence, detection);
  const Rigid3d& truth = *sequence.FrameOf(detection).true_world_from_camera;
  EXPECT_LT(((camera_from_world * truth).Matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-9);
}

// Segments are known by any numbers.
TEST(PageSequence, SegmentsAreCountedFromZero) {
  Sequence sequence = CuboidSequence(3, 5);
  const int first_of_second = static_cast<int>(sequence.frames.size() / 2);
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    sequence.frames[i].segment = static_cast<int>(i) < first_of_second ? 2147483647 : -5;
  }
  std::set<int> ids;
  for (const Frame& frame : sequence.frames) ids.insert(frame.id);
  const nlohmann::json page = PageSequence(sequence, SelectForPage(sequence, ids));
  EXPECT_EQ(page.at("segments").size(), 2u);
  EXPECT_EQ(page.at("frames").front().at("segment"), 0);
  EXPECT_EQ(page.at("frames").back().at("segment"), 1);
  for (const auto& object : page.at("objects")) {
    EXPECT_THAT(object.at("segment"), testing::AnyOf(0, 1));
  }
}

TEST(GridsOfMap, AreOnThePlanesOfTheMap) {
  const Sequence sequence = CuboidSequence(3, 5);
  MapEstimate map;
  map.planes_in_world = {{Eigen::Vector3d(0.1, 0.0, 1.0).normalized(), 0.2}};
  map.objects.push_back({1, 5, sequence.objects[1].ground_truth->landmark_in_world, {}, ""});
  const PlaneGrids grids = GridsOfMap(map, sequence);
  ASSERT_EQ(grids.size(), 1u);
  ASSERT_FALSE(grids[kFloor].empty());
  for (const LineSegment3& line : grids[kFloor]) {
    EXPECT_NEAR(map.planes_in_world[kFloor].SignedDistance(line[0]), 0.0, 1e-9);
    EXPECT_NEAR(map.planes_in_world[kFloor].SignedDistance(line[1]), 0.0, 1e-9);
  }
  EXPECT_TRUE(GridsOfMap({}, sequence).empty());
}

TEST(UpOfSegment, IsTheFloorsAndNotTheWalls) {
  Sequence sequence = CuboidSequence(3, 5);
  const Plane floor = sequence.planes[kFloor].plane_in_world;
  const Eigen::Vector3d sideways = floor.normal.unitOrthogonal();
  sequence.planes.insert(sequence.planes.begin(), {1, {sideways, 2.0}});
  sequence.planes.push_back({2, {-floor.normal, 3.0}});
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    sequence.objects[i].plane_index = static_cast<int>(i);
  }
  EXPECT_LT((UpOfSegment(sequence, 0) - floor.normal).norm(), 1e-12);
}

using testing::ElementsAre;

const auto kNoImage = [](int) { return false; };

TEST(FramesToShow, AreThoseWithImages) {
  EXPECT_THAT(FramesToShow(Recording(9, 2), [](int frame) { return frame % 4 == 1; }),
              ElementsAre(20, 60));
}

TEST(FramesToShow, AreFewOfManyAndHaveDetections) {
  const Sequence sequence = Recording(1000, 4);
  const std::set<int> ids = FramesToShow(sequence, kNoImage);
  EXPECT_EQ(ids.size(), kMaxShownFrames);
  for (const int id : ids) EXPECT_EQ((id / 10 - 1) % 4, 0);
  EXPECT_GT(*ids.rbegin(), 9000);
}

cv::Mat Noise() {
  cv::Mat image(480, 640, CV_8UC3);
  cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, 255);
  return image;
}

size_t Bytes(const EncodedImages& encoded) {
  size_t bytes = 0;
  for (const auto& image : encoded.images) bytes += image.base64.size();
  return bytes;
}

const ImageSource kNoises = {[](int) { return true; }, [](int) { return Noise(); }};

// Frame 1 has no image, that of frame 2 is damaged.
const ImageSource kFaulty = {[](int frame) { return frame != 1; },
                             [](int frame) {
                               if (frame == 2) throw InputError("2.png: is empty");
                               return Noise();
                             }};

TEST(EncodeImages, AreAsLargeAsThereIsRoom) {
  const EncodedImages large = EncodeImages({0, 1, 2}, kNoises, 10'000'000, 2);
  const EncodedImages small = EncodeImages({0, 1, 2}, kNoises, 300'000, 2);
  EXPECT_GT(Bytes(large), 300'000u);
  EXPECT_EQ(large.scaled_to_px, 0);
  EXPECT_LE(Bytes(small), 300'000u);
  EXPECT_GT(Bytes(small), 30'000u);
  EXPECT_EQ(small.images.size(), 3u);
  EXPECT_EQ(small.scaled_to_px, 320);
}

TEST(EncodeImages, AreFewerWhenTheSmallestAreTooLarge) {
  const std::vector<int> frames = {0, 1, 2, 3, 4, 5, 6, 7};
  const EncodedImages few = EncodeImages(frames, kNoises, 50'000, 2);
  EXPECT_LE(Bytes(few), 50'000u);
  EXPECT_FALSE(few.images.empty());
  EXPECT_EQ(few.left_out + few.images.size(), frames.size());
  EXPECT_GT(few.left_out, 0u);
  EXPECT_TRUE(EncodeImages(frames, kNoises, 100, 2).images.empty());
}

TEST(EncodeImages, LeaveOutWhatIsNotThereAndNameWhatIsDamaged) {
  const EncodedImages encoded = EncodeImages({0, 1, 2, 3}, kFaulty, 10'000'000, 2);
  ASSERT_EQ(encoded.images.size(), 2u);
  EXPECT_EQ(encoded.images[1].frame_index, 3);
  EXPECT_EQ(encoded.failures, std::vector<std::string>{"2.png: is empty"});
  EXPECT_EQ(encoded.left_out, 0u);
}

// The size of a JPEG file in base 64.
cv::Size SizeOf(const std::string& base64) {
  const auto* text = reinterpret_cast<const unsigned char*>(base64.data());
  std::vector<unsigned char> bytes(base64.size());
  EXPECT_GT(EVP_DecodeBlock(bytes.data(), text, static_cast<int>(base64.size())), 0);
  return cv::imdecode(bytes, cv::IMREAD_COLOR).size();
}

TEST(AddJpegs, ArePartsOfImagesThatAreReadOnce) {
  const cv::Rect large(0, 0, 320, 200), tall(600, 0, 100, 480), small(10, 10, 40, 30);
  std::vector<Picture> pictures = {{0, large}, {1, large}, {2, large},
                                   {3, tall},  {3, small}, {3, cv::Rect()}};
  std::vector<Picture*> all;
  for (Picture& picture : pictures) all.push_back(&picture);
  std::atomic<int> reads = 0;
  AddJpegs(all, 160,
           {kFaulty.has,
            [&](int frame) {
              ++reads;
              return kFaulty.read(frame);
            }},
           2);
  EXPECT_EQ(reads, 3);
  EXPECT_EQ(SizeOf(pictures[0].jpeg), cv::Size(160, 100));
  // 40 of its 100 columns are in the image.
  EXPECT_EQ(SizeOf(pictures[3].jpeg), cv::Size(13, 160));
  EXPECT_EQ(SizeOf(pictures[4].jpeg), cv::Size(40, 30));
  for (const size_t without : {1, 2, 5}) EXPECT_EQ(pictures[without].jpeg, "");
}

// A page of three variants whose parts have 10 000 bytes each, in at most so many.
DatasetPage Fitted(size_t max_bytes) {
  const std::string part(10'000, 'x');
  DatasetPage page;
  page.sequences.push_back({{}, {{0}, {0}, {}}, {{"frames", part}, {"counts", 3}}});
  page.symmetries.push_back({{"curves", part}, {"descriptors", 5}});
  for (const auto& [name, kind] : {std::pair("SVD", VariantKind::kViews),
                                   {"OursP", VariantKind::kMap},
                                   {"InitP", VariantKind::kFrames}}) {
    PageVariant variant = {name, {}, kind};
    variant.metrics.summary.objects = 7;
    variant.objects.resize(2);
    variant.data = {{"outlines", part}};
    page.variants.push_back(variant);
  }
  FitPage(
      max_bytes, [](const DatasetPage& all) { return PageText(MakePageData(all)).size(); }, &page);
  for (const PageVariant& variant : page.variants) EXPECT_EQ(variant.metrics.summary.objects, 7);
  return page;
}

TEST(FitPage, ReducesSingleFramesFirstAndKeepsNumbersWhateverHappens) {
  const DatasetPage some = Fitted(35'000);
  EXPECT_LE(PageText(MakePageData(some)).size(), 35'000 + 200u);  // the notes
  EXPECT_TRUE(some.variants[0].data.contains("outlines"));
  EXPECT_TRUE(some.variants[1].data.contains("outlines"));
  EXPECT_TRUE(some.variants[2].numbers_only);
  EXPECT_TRUE(some.variants[2].data.empty());
  EXPECT_TRUE(some.variants[2].objects.empty());
  EXPECT_EQ(some.notes.back(), "For lack of room only the numbers of InitP are shown.");
  EXPECT_FALSE(some.sequences[0].data["frames"].empty());
  const DatasetPage numbers = Fitted(1000);
  EXPECT_EQ(numbers.symmetries[0]["descriptors"], 5);
  EXPECT_EQ(numbers.sequences[0].data["counts"], 3);
  EXPECT_TRUE(numbers.sequences[0].data["frames"].empty());
  EXPECT_TRUE(numbers.sequences[0].selection.shown.empty());
}

}  // namespace
}  // namespace soslam
