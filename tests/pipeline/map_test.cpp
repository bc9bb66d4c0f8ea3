// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <list>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "soslam/artefact/json_file.h"
#include "soslam/dataset/colmap_model.h"
#include "soslam/dataset/labelled_box.h"
#include "soslam/dataset/trajectories.h"
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

// `soslam map` of the project itself, on photos of the small scene in a folder with a name that
// make and the shell would read otherwise.
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

  // The words that call ./soslam of the project.
  std::vector<std::string> Words(const std::string& command,
                                 const std::vector<std::string>& options) const {
    std::vector<std::string> words = {"env",
                                      "PATH=" + programs_.string() + ":" + std::getenv("PATH"),
                                      SOSLAM_SOURCE_DIR "/soslam",
                                      command,
                                      "--threads",
                                      "2",
                                      "--maps",
                                      maps_,
                                      "--build",
                                      fs::path(SOSLAM_BINARY_DIR).parent_path()};
    words.insert(words.end(), options.begin(), options.end());
    return words;
  }
  std::vector<std::string> WordsForPhotos(const std::vector<std::string>& options = {}) const {
    std::vector<std::string> words = Words("map", {photos_, "--detections", detections_});
    words.insert(words.end(), options.begin(), options.end());
    return words;
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
  for (const char* file :
       {"landmarks.csv", "boxes.csv", "map.glb", "transforms.json", "overlays/IMG_7.jpg"}) {
    EXPECT_TRUE(fs::exists(map / "export" / file)) << file;
  }
  const ColmapModel model = ReadColmapModel(map / "export/colmap");
  EXPECT_EQ(model.images.size(), size_t{kFrames});
  EXPECT_EQ(model.points.size(), 120u);
  EXPECT_TRUE(fs::exists(map / "data/it_s_my_room_1/rgb" / model.images.front().pose.image));
  const auto made = Made();

  EXPECT_THAT(ExpectSuccess(MapPhotos()), testing::Not(HasSubstr("[it_s_my_room_1]")))
      << "nothing to do";
  EXPECT_EQ(Made(), made);

  // Photos that were moved are the same ones.
  const fs::path elsewhere = pipeline_.Folder() / "elsewhere";
  fs::create_directory(elsewhere);
  fs::rename(photos_, elsewhere / photos_.filename());
  ExpectSuccess(
      RunCommand(Words("map", {elsewhere / photos_.filename(), "--detections", detections_})));
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
  EXPECT_THAT(ExpectSuccess(RunCommand(WordsForPhotos(
                  {"--model", programs_ / "models/0", "--name", "room", "--scale", "1"}))),
              HasSubstr("3 objects, scale +- 4 %"));
  EXPECT_THAT(
      RunCommand(Words("map", {programs_, "--detections", detections_, "--name", "room"})).errors,
      HasSubstr("is of other images"));
}

// The truth has the photos under other times; the map is the same with it.
TEST_F(SlowMapTest, IsEvaluatedByTheTruthOfItsPhotos) {
  const fs::path truth = pipeline_.Folder() / "truth of $it",
                 map = maps_ / "room/results/room/OursSP";
  fs::create_directory(truth);
  std::string list, poses;
  for (TimedPose pose : ReadTrajectory(pipeline_.Dataset() / "groundtruth.txt")) {
    const auto count = static_cast<int>(std::ranges::count(list, '\n'));
    pose.timestamp = 100.0 + count;
    list += fmt::format("{} rgb/IMG {}.png\n", pose.timestamp, count);
    poses += TrajectoryLine(pose);
  }
  WriteBytes(truth / "rgb.txt", list);
  WriteBytes(truth / "groundtruth.txt", poses);
  fs::copy(pipeline_.Dataset() / "objects.json", truth);
  std::vector<std::string> options = {"--model", programs_ / "models/0", "--name", "room"};
  ExpectSuccess(RunCommand(WordsForPhotos(options)));
  const auto landmarks = ParseJsonFile(map / "map.json")["objects"];
  EXPECT_FALSE(ParseJsonFile(map / "metrics.json").contains("map_quality"));

  options.insert(options.end(), {"--truth", truth});
  EXPECT_THAT(
      ExpectSuccess(RunCommand(WordsForPhotos(options))),
      testing::AllOf(HasSubstr("8 of 8 photos have a true pose"), HasSubstr("[room] import"),
                     testing::Not(HasSubstr("[room] reconstruct"))));
  EXPECT_EQ(ParseJsonFile(map / "map.json")["objects"], landmarks);
  const auto quality = ParseJsonFile(map / "metrics.json")["map_quality"];
  EXPECT_EQ(quality["scores"][0]["found"], 3);
  EXPECT_LT(quality["alignments"][0]["up_error_deg"], 2.0);

  fs::remove(truth / "objects.json");
  EXPECT_THAT(RunCommand(WordsForPhotos(options)).errors, HasSubstr("has no objects.json"));
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
  EXPECT_THAT(ExpectSuccess(RunCommand(WordsForPhotos(
                  {"--model", programs_ / "models/0", "--name", "room", "--scale", "1"}))),
              HasSubstr("3 objects, scale +- 4 %"));
}

TEST_F(SlowMapTest, OtherTargetsKnowAMapByItsName) {
  ExpectSuccess(MapPhotos());
  const auto made = Made();
  const auto run = [&](const std::string& command, const std::vector<std::string>& options) {
    return RunCommand(Words(command, options));
  };
  const std::string name = "it_s_my_room_1";
  EXPECT_THAT(ExpectSuccess(run("doctor", {"--name", name})), HasSubstr(name));
  const std::string results = maps_ / name / "results";
  EXPECT_THAT(run("doctor", {name, "--results", results}).errors,
              HasSubstr("is of a map of photos"));
  EXPECT_THAT(run("doctor", {"--name", "another"}).errors, HasSubstr("no such map"));
  EXPECT_THAT(run("run", {"room_a", "--name", name}).errors, HasSubstr("expected one of them"));
  EXPECT_THAT(run("run", {"--name", name + " 2"}).errors, HasSubstr("expected letters and digits"));
  EXPECT_EQ(Made(), made);
  ExpectSuccess(run("export", {"--name", name}));
  ExpectSuccess(run("verify", {"--name", name}));
  const fs::path overlays = fs::path(results) / name / "OursSP/export/overlays";
  fs::remove(overlays / "IMG_0.jpg");
  EXPECT_THAT(run("verify", {"--name", name}).output, HasSubstr("IMG_0.jpg"));
}

TEST_F(MapTest, RefusesWhatIsMissing) {
  const auto expect_refused = [&](const std::vector<std::string>& options, int code,
                                  const std::string& words) {
    SCOPED_TRACE(words);
    EXPECT_THAT(ExpectExit(code, RunCommand(Words("map", options))).errors, HasSubstr(words));
    EXPECT_FALSE(fs::exists(maps_));
  };
  const auto expect_refused_for_photos = [&](std::vector<std::string> options,
                                             const std::string& words) {
    options.insert(options.begin(), {photos_, "--network", detections_});
    expect_refused(options, 2, words);
  };
  const std::string marker = pipeline_.Folder() / "marker";
  expect_refused({}, 2, "images are not given; expected a folder of photos");
  expect_refused({photos_}, 2, "expected a network");
  for (const std::string& network : {"$(shell touch " + marker + ")", "`touch " + marker + "`"}) {
    expect_refused({photos_, "--network", network}, 3, "no such file");
  }
  expect_refused({photos_, "--network", "a\ntouch " + marker}, 2, "several lines; expected one");
  expect_refused({"/nowhere's", "--network", detections_}, 3, "'/nowhere's'; there is no such");
  expect_refused_for_photos({"--detections", detections_}, "found a network and detections");
  expect_refused_for_photos({"--scale", "2m"}, "scale is '2m'; expected a number");
  expect_refused_for_photos({"--scale", "-2"}, "scale is '-2'; expected a number");
  expect_refused_for_photos({"--scale", ".5"}, "found no model");
  expect_refused_for_photos({"--scale", "2"}, "found no model");
  expect_refused_for_photos({"--camera_height", "160"}, "expected metres");
  expect_refused_for_photos({"--camera_height", "1,6"}, "with a decimal point");
  expect_refused_for_photos({"--variant", "InitS"}, "the first one makes no map");
  expect_refused_for_photos({"--variant", "OursS Best"}, "variant 'Best': no such variant");
  expect_refused_for_photos({"--variant", "InitSA"}, "makes no map");
  expect_refused(
      {photos_, "--detections", detections_, "--networks", "/none", "--variant", "OursSPA"}, 3,
      "looks at pictures by the network YOLOX-nano");
  expect_refused_for_photos({"--image", "x"}, "--image: no such option");
  expect_refused_for_photos({photos_}, "was named before it");
  for (const std::string name : {"room 2", "..", "../x"}) {
    expect_refused_for_photos({"--name", name}, "expected letters and digits");
  }
  EXPECT_FALSE(fs::exists(marker));
}

TEST_F(MapTest, TheVariantIsOursSpUnlessGiven) {
  const fs::path results = maps_ / "room/results/room";
  fs::create_directories(results / "OursSP");
  fs::create_directories(results / "OursS");
  // Ends where the images are another map's, with the folders of the variants of this command.
  WriteBytes(programs_ / "soslam-frames", "#!/bin/sh\nexit 7\n");
  fs::permissions(programs_ / "soslam-frames", fs::perms::owner_all);
  for (const std::string variant : {"", " OursSP "}) {
    EXPECT_NE(RunCommand(Words("map", {photos_, "--detections", detections_, "--name", "room",
                                       "--variant", variant, "--bin", programs_}))
                  .exit_code,
              0);
    EXPECT_TRUE(fs::exists(results / "OursSP")) << variant;
  }
  EXPECT_FALSE(fs::exists(results / "OursS"));
}

// Make and the door are told the same.
TEST_F(MapTest, MakeTakesPathsWithAnyCharacters) {
  const auto errors = [&](const std::string& network) {
    return RunCommand(MakeWords({"-C", SOSLAM_SOURCE_DIR, "map", "MAPS=" + maps_.string(),
                                 "IMAGES=" + photos_.string(), "NETWORK=" + network}))
        .errors;
  };
  EXPECT_THAT(errors("$(shell it's)"), HasSubstr("'$(shell it's)': no such file"));
  EXPECT_THAT(errors(""), HasSubstr("expected a network"));
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
