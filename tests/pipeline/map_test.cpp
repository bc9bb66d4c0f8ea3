// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <list>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "dataset/labelled_box.h"
#include "dataset/trajectories.h"
#include "support/fake_colmap.h"
#include "support/image_files.h"
#include "support/run_command.h"
#include "support/small_pipeline.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::ContainsRegex;
using testing::EndsWith;
using testing::HasSubstr;

// Writes COLMAP's model of the small scene: its true poses, and points on the floor and above it.
void WriteModelOfSmallScene(const fs::path& dataset, const fs::path& folder) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 120; ++i) {
    points.emplace_back(2.0 + 0.2 * (i % 12), 0.3 * (i / 12) - 1.5, i % 4 == 0 ? 0.3 : 0.0);
  }
  std::vector<std::string> tracks(points.size());
  std::string images, lines;
  int count = 0;
  for (const TimedPose& pose : ReadTrajectory(dataset / "groundtruth.txt")) {
    const Rigid3d camera_from_world = pose.world_from_camera.Inverse();
    const Eigen::Quaterniond& q = camera_from_world.rotation;
    images += fmt::format("{} {} {} {} {} {} 1 rgb/IMG_{}.png\n", count + 1, q.w(), q.x(), q.y(),
                          q.z(), fmt::join(camera_from_world.translation, " "), count);
    ++count;
    for (size_t j = 0; j < points.size(); ++j) {
      const Eigen::Vector3d point = camera_from_world * points[j];
      images += fmt::format("{} {} {} ", 400.0 * point.x() / point.z() + 240.0,
                            400.0 * point.y() / point.z() + 180.0, j + 1);
      tracks[j] += fmt::format(" {} {}", count, j);
    }
    images += "\n";
  }
  for (size_t j = 0; j < points.size(); ++j) {
    lines += fmt::format("{} {} 0 0 0 0.3{}\n", j + 1, fmt::join(points[j], " "), tracks[j]);
  }
  fs::create_directories(folder);
  WriteBytes(folder / "cameras.txt", "1 PINHOLE 480 360 400 400 240 180\n");
  WriteBytes(folder / "images.txt", images);
  WriteBytes(folder / "points3D.txt", lines);
}

// `make map` of the project itself, on photos of the small scene in a folder with a name that make
// and the shell would read otherwise.
class MapTest : public testing::Test {
 protected:
  static constexpr int kFrames = 8;

  MapTest() {
    fs::create_directories(photos_);
    for (int i = 0; i < kFrames; ++i) {
      fs::copy(pipeline_.Dataset() / fmt::format("rgb/{:06}.png", i),
               photos_ / fmt::format("IMG {}.png", i));
    }
    fs::copy(pipeline_.Dataset() / "detections.csv", detections_);
    WriteModelOfSmallScene(pipeline_.Dataset(), programs_ / "models/0");
    WriteFakeColmap(programs_);
  }

  std::vector<std::string> Words(const std::vector<std::string>& settings) const {
    std::vector<std::string> words = MakeWords(
        {"-C", SOSLAM_SOURCE_DIR, "map", "--no-print-directory", "THREADS=2",
         "MAPS=" + maps_.string(), "BUILD=" + fs::path(SOSLAM_BINARY_DIR).parent_path().string()});
    words.insert(words.begin(), {"env", "PATH=" + programs_.string() + ":" + std::getenv("PATH")});
    words.insert(words.end(), settings.begin(), settings.end());
    return words;
  }
  std::vector<std::string> WordsForPhotos() const {
    return Words({"IMAGES=" + photos_.string(), "DETECTIONS=" + detections_.string()});
  }
  CommandResult MapPhotos() const { return RunCommand(WordsForPhotos()); }
  // What the steps made, without lists of files, which have their times.
  std::map<std::string, std::string> Made() const {
    auto made = SmallPipeline::Artefacts(maps_);
    std::erase_if(made,
                  [](const auto& file) { return file.first.find("/steps/") != std::string::npos; });
    return made;
  }

  SmallPipeline pipeline_{kFrames};
  fs::path photos_ = pipeline_.Folder() / "it's \"my\" $(room) #1";
  fs::path detections_ = pipeline_.Folder() / "boxes of $it.csv";
  fs::path programs_ = pipeline_.Folder() / "colmap programs";
  fs::path maps_ = pipeline_.Folder() / "maps";
};

class SlowMapTest : public MapTest {};

TEST_F(SlowMapTest, EndsWithOneLineAndGoesOnWhereSomethingChanged) {
  const std::string first = ExpectSuccess(MapPhotos());
  const fs::path map = maps_ / "it_s_my_room_1";
  EXPECT_THAT(first, ContainsRegex("\n3 objects, scale [+]- [0-9]+ %, page: "));
  EXPECT_THAT(first, EndsWith((map / "results/it_s_my_room_1/report.html").string() + "\n"));
  EXPECT_TRUE(fs::exists(map / "results/it_s_my_room_1/report.html"));
  const auto made = Made();

  EXPECT_THAT(ExpectSuccess(MapPhotos()), testing::Not(HasSubstr("[it_s_my_room_1]")))
      << "nothing to do";
  EXPECT_EQ(Made(), made);

  // Photos that were moved are the same ones.
  const fs::path elsewhere = pipeline_.Folder() / "elsewhere";
  fs::create_directory(elsewhere);
  fs::rename(photos_, elsewhere / photos_.filename());
  ExpectSuccess(RunCommand(Words({"IMAGES=" + (elsewhere / photos_.filename()).string(),
                                  "DETECTIONS=" + detections_.string()})));
  EXPECT_EQ(Made(), made);
  fs::rename(elsewhere / photos_.filename(), photos_);
  ExpectSuccess(MapPhotos());

  // Other boxes: images and poses stay.
  const std::string boxes = FileBytes(detections_);
  WriteBytes(detections_, boxes.substr(0, boxes.rfind("\n7,")) + "\n");
  EXPECT_THAT(ExpectSuccess(MapPhotos()), HasSubstr("[it_s_my_room_1] associate"));
  EXPECT_NE(Made(), made);
  WriteBytes(detections_, boxes);
  ExpectSuccess(MapPhotos());
  EXPECT_EQ(Made(), made);
}

TEST_F(SlowMapTest, TakesAFinishedModel) {
  fs::remove(programs_ / "colmap");
  std::vector<std::string> words = WordsForPhotos();
  words.insert(words.end(), {"MODEL=" + (programs_ / "models/0").string(), "NAME=room", "SCALE=1"});
  EXPECT_THAT(ExpectSuccess(RunCommand(words)), HasSubstr("3 objects, scale +- 4 %"));
  EXPECT_THAT(RunCommand(Words({"IMAGES=" + programs_.string(),
                                "DETECTIONS=" + detections_.string(), "NAME=room"}))
                  .errors,
              HasSubstr("is of other images"));
}

// The model is of the photos as they are stored, the boxes of the upright ones.
TEST_F(SlowMapTest, TakesAModelOfPhotosThatExifTurns) {
  for (int i = 0; i < kFrames; ++i) {
    const fs::path photo = photos_ / fmt::format("IMG {}.png", i);
    WriteBytes(photo, JpegWithExif(EncodedImage(".jpg", cv::imread(photo.string())), ExifOf(6)));
  }
  auto boxes = ReadDetectionsCsv(detections_);
  for (LabelledBox& box : boxes) {
    const Box& stored = box.box;
    box.box = {359.0 - stored.y_max, stored.x_min, 359.0 - stored.y_min, stored.x_max};
  }
  WriteBytes(detections_, LabelledBoxesText(boxes));
  std::vector<std::string> words = WordsForPhotos();
  words.insert(words.end(), {"MODEL=" + (programs_ / "models/0").string(), "NAME=room", "SCALE=1"});
  EXPECT_THAT(ExpectSuccess(RunCommand(words)), HasSubstr("3 objects, scale +- 4 %"));
}

TEST_F(SlowMapTest, OtherTargetsKnowAMapByItsName) {
  ExpectSuccess(MapPhotos());
  const auto made = Made();
  const auto make = [&](const std::vector<std::string>& settings) {
    std::vector<std::string> words = Words(settings);
    std::erase(words, "map");
    return RunCommand(words);
  };
  EXPECT_THAT(ExpectSuccess(make({"doctor", "NAME=it_s_my_room_1"})), HasSubstr("it_s_my_room_1"));
  const std::string results = (maps_ / "it_s_my_room_1/results").string();
  EXPECT_THAT(make({"doctor", "DATASET=it_s_my_room_1", "RESULTS=" + results}).errors,
              HasSubstr("expected NAME=it_s_my_room_1"));
  EXPECT_THAT(make({"doctor", "NAME=another"}).errors, HasSubstr("no such map"));
  EXPECT_THAT(make({"run", "NAME=it_s_my_room_1", "RESULTS=" + results}).errors,
              HasSubstr("expected one of them"));
  EXPECT_THAT(make({"demo", "NAME=it_s_my_room_1"}).errors, HasSubstr("takes no NAME"));
  EXPECT_THAT(make({"clean", "NAME=it_s_my_room_1 2"}).errors, HasSubstr("expected one name"));
  EXPECT_EQ(Made(), made);
  ExpectSuccess(make({"verify", "NAME=it_s_my_room_1"}));
}

TEST_F(MapTest, RefusesWhatIsMissing) {
  const auto expect_refused = [&](const std::vector<std::string>& settings,
                                  const std::string& words) {
    SCOPED_TRACE(words);
    EXPECT_THAT(ExpectExit(2, RunCommand(Words(settings))).errors, HasSubstr(words));
    EXPECT_FALSE(fs::exists(maps_));
  };
  const std::string images = "IMAGES=" + photos_.string();
  const std::string network = "NETWORK=" + detections_.string();
  const std::string marker = (pipeline_.Folder() / "marker").string();
  expect_refused({}, "expected IMAGES=");
  expect_refused({images}, "expected NETWORK=");
  expect_refused({images, "NETWORK=$(shell touch " + marker + ")"}, "no such file");
  expect_refused({images, "NETWORK=`touch " + marker + "`"}, "no such file");
  expect_refused({images, "NETWORK=a\ntouch " + marker}, "expected a path of one line");
  expect_refused({images, network, "SCALE=2m"}, "SCALE='2m': expected a number");
  expect_refused({images, network, "SCALE=-2"}, "SCALE='-2': expected a number");
  expect_refused({images, network, "SCALE=.5"}, "found no MODEL");
  expect_refused({images, network, "SCALE=2"}, "found no MODEL");
  expect_refused({images, network, "CAMERA_HEIGHT=160"}, "expected metres");
  expect_refused({images, network, "CAMERA_HEIGHT=1,6"},
                 "CAMERA_HEIGHT='1,6': expected a decimal point");
  expect_refused({images, network, "VARIANT=InitS"}, "the first one makes no map");
  expect_refused({images, network, "VARIANT=OursS Best"}, "VARIANT='Best': no such variant");
  expect_refused({"IMAGE=x", network}, "IMAGE=...: no variable of this Makefile");
  expect_refused({images, network, "NAME=room 2"}, "expected one name of letters and digits");
  expect_refused({images, "NETWORK=x", "NAME=.."}, "expected letters and digits");
  expect_refused({images, "NETWORK=x", "NAME=../x"}, "expected letters and digits");
  expect_refused({"IMAGES=/nowhere's", "NETWORK=x"}, "'/nowhere's': no such folder");
  EXPECT_FALSE(fs::exists(marker));
}

TEST_F(MapTest, GoesIntoTheFolderOfMapsByDefault) {
  std::vector<std::string> words =
      Words({"IMAGES=" + photos_.string(), "NETWORK=x", "VARIANT=OursS OursSTE", "-n"});
  std::erase(words, "MAPS=" + maps_.string());
  EXPECT_THAT(ExpectSuccess(RunCommand(words)),
              testing::AllOf(HasSubstr("MAP_ROOT=maps/"), HasSubstr("'OursS OursSTE'")));
  std::erase(words, "VARIANT=OursS OursSTE");
  EXPECT_THAT(RunCommand(words).output, HasSubstr("MAP_VARIANT='OursSP'"));
}

TEST_F(SlowMapTest, KilledAnywhereItGoesOn) {
  const auto begin = std::chrono::steady_clock::now();
  ExpectSuccess(MapPhotos());
  const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - begin;
  const auto made = Made();
  std::mt19937 random(1);
  for (int i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    fs::remove_all(maps_);
    std::list<BackgroundCommand> killed;
    for (int kill = 0; kill < 2; ++kill) {
      BackgroundCommand& run = killed.emplace_back(WordsForPhotos());
      std::this_thread::sleep_for(duration * std::uniform_real_distribution<double>(0, 1)(random));
      i % 2 == 0 ? run.KillAll() : run.KillFirst();
    }
    ExpectSuccess(MapPhotos());
    for (BackgroundCommand& run : killed) run.WaitForAll();
    EXPECT_EQ(Made(), made);
  }
}

}  // namespace
}  // namespace soslam
