// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/artefact/json_file.h"
#include "soslam/dataset/labelled_box.h"
#include "soslam/image/frame_choice.h"
#include "soslam/image/read_image.h"
#include "soslam/stage/stages.h"
#include "support/drawn_photos.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/lists.h"
#include "support/video_files.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class RunFramesTest : public FolderTest {
 protected:
  void SetUp() override { fs::create_directory(photos_); }

  json Run(const fs::path& images, const FrameOptions& options = {}, int threads = 2) {
    RunFrames(options, {{"images", images}, {"output", output_}}, threads);
    return ReadArtefact(output_ / "frames.json", "frames");
  }
  void AddViews(int count) {
    for (int i = 0; i < count; ++i) {
      WritePhoto(photos_ / ("view " + std::to_string(i) + ".jpg"), DrawnView(20 * i));
    }
  }

  fs::path photos_ = folder_ / "my photos' $x";
  fs::path output_ = folder_ / "room";
};

TEST_F(RunFramesTest, PhotosThatNeedNoChangeAreCopied) {
  AddViews(3);
  const json frames = Run(photos_);
  ASSERT_EQ(frames.at("frames").size(), 3u);
  EXPECT_EQ(frames.at("name"), "my photos' $x");
  EXPECT_EQ(frames.at("frames")[1].at("source"), "view 1.jpg");
  EXPECT_EQ(frames.at("frames")[1].at("image"), "rgb/view_1.jpg");
  EXPECT_TRUE(frames.at("focal_hint").is_null());
  EXPECT_EQ(FileBytes(output_ / "rgb/view_1.jpg"), FileBytes(photos_ / "view 1.jpg"));
  EXPECT_EQ(FileBytes(output_ / "rgb.txt"),
            "# timestamp filename\n0 rgb/view_0.jpg\n1 rgb/view_1.jpg\n2 rgb/view_2.jpg\n");
}

TEST_F(RunFramesTest, LargePhotosAreTurnedUprightAndScaledDown) {
  for (int i = 0; i < 2; ++i) {
    cv::Mat image = DrawnView(40 * i, {200, 100});
    image(cv::Rect(0, 0, 20, 20)).setTo(cv::Scalar(255, 255, 255));
    WritePhoto(photos_ / (std::to_string(i) + ".jpg"), image, ExifOfCamera(6, 26));
  }
  const json frames = Run(photos_, {.max_image_px = 100});
  EXPECT_EQ(frames.at("width"), 50);
  EXPECT_EQ(frames.at("height"), 100);
  EXPECT_EQ(frames.at("focal_hint").at("images"), 2);
  EXPECT_NEAR(frames.at("focal_hint").at("focal_px").get<double>(),
              26.0 / 43.267 * std::hypot(50.0, 100.0), 1e-9);
  const cv::Mat image =
      ReadImage(output_ / "rgb/0.jpg", cv::IMREAD_GRAYSCALE, ImageOrientation::kStored);
  EXPECT_EQ(image.size(), cv::Size(50, 100));
  EXPECT_GT(cv::mean(image(cv::Rect(42, 2, 6, 6)))[0], 240.0) << "the corner is at the top right";
  const auto header = ReadImageHeader(output_ / "rgb/0.jpg");
  EXPECT_EQ(header->orientation, 1);
  EXPECT_NEAR(header->focal_over_diagonal.value_or(0.0), 26.0 / 43.267, 1e-9);
}

// For a model of COLMAP, which may be of the stored photos. Boxes that are given are of the upright
// ones.
TEST_F(RunFramesTest, PhotosThatExifTurnsAreCopiedIfWanted) {
  for (int i = 0; i < 2; ++i) {
    WritePhoto(photos_ / (std::to_string(i) + ".jpg"), DrawnView(40 * i, {200, 100}),
               ExifOf(i == 0 ? 6 : 8));
  }
  WriteBytes(folder_ / "boxes.csv",
             "frame,label,score,x1,y1,x2,y2\n0,cup,0.9,10,20,30,50\n1,cup,0.9,10,20,30,50\n");
  FrameOptions options;
  options.keep_exif_turn = true;
  const fs::path boxes_file = folder_ / "boxes.csv";
  RunFrames(options, {{"images", photos_}, {"output", output_}, {"detections", boxes_file}}, 2);
  const json frames = ReadArtefact(output_ / "frames.json", "frames");
  EXPECT_EQ(frames.at("width"), 100);
  EXPECT_EQ(frames.at("height"), 200);
  EXPECT_FALSE(frames.contains("findings"));
  EXPECT_EQ(FileBytes(output_ / "rgb/0.jpg"), FileBytes(photos_ / "0.jpg"));
  const auto boxes = ReadDetectionsCsv(output_ / "detections.csv");
  for (const LabelledBox& box : boxes) EXPECT_EQ(box.box, (Box{10, 20, 30, 50}));
}

TEST_F(RunFramesTest, SaysWhatIsLeftOut) {
  AddViews(6);
  WritePhoto(photos_ / "view 2.jpg", Blurred(DrawnView(40)));
  WritePhoto(photos_ / "view 6.jpg", DrawnView(100), ExifOf(1));
  WritePhoto(photos_ / "view 7.jpg", DrawnView(0, {100, 100}));
  WriteBytes(photos_ / "view 8.jpg", FileBytes(photos_ / "view 0.jpg").substr(0, 2000));
  WriteBytes(photos_ / "view 9.heic", "HEIC");
  fs::copy_file(photos_ / "view 1.jpg", photos_ / "view 10 of 1.jpg");
  const json frames = Run(photos_);
  EXPECT_EQ(frames.at("frames").size(), 5u);
  std::map<std::string, std::string> reasons;
  for (const json& frame : frames.at("left_out")) {
    reasons[frame.at("source")] = frame.at("reason");
    EXPECT_THAT(frame.at("detail").get<std::string>(),
                testing::Not(testing::HasSubstr(folder_.path().string())));
  }
  EXPECT_EQ(reasons, (std::map<std::string, std::string>{{"view 2.jpg", "blurred"},
                                                         {"view 6.jpg", "no_motion"},
                                                         {"view 7.jpg", "other_size"},
                                                         {"view 8.jpg", "unreadable"},
                                                         {"view 9.heic", "unreadable"},
                                                         {"view 10 of 1.jpg", "duplicate"}}));
  EXPECT_EQ(frames.at("left_out").back().at("detail"), "the same file as view 1.jpg");
  EXPECT_EQ(frames.at("ordered_by"), "name");
  EXPECT_FALSE(frames.contains("findings"));
}

TEST_F(RunFramesTest, RawPhotosBesideTheirJpegsAreLeftOut) {
  AddViews(4);
  for (int i = 0; i < 4; ++i) {
    WriteBytes(photos_ / ("view " + std::to_string(i) + ".DNG"),
               TiffWithImageBelow(GreyOf(DrawnView(i, {32, 24})), GreyOf(DrawnView(20 * i))));
  }
  const json frames = Run(photos_);
  EXPECT_EQ(frames.at("width"), 320);
  EXPECT_EQ(frames.at("frames").size(), 4u);
  for (const json& frame : frames.at("left_out")) {
    EXPECT_EQ(frame.at("reason"), "unreadable");
    EXPECT_THAT(frame.at("detail").get<std::string>(), testing::HasSubstr("RAW"));
  }
  const json finding = Only(frames.at("findings"));
  EXPECT_EQ(finding.at("check"), "frames_unreadable");
  EXPECT_THAT(finding.at("cause").get<std::string>(), testing::HasSubstr("RAW"));
  EXPECT_THAT(finding.dump(), testing::Not(testing::HasSubstr("incompletely")));
}

// Boxes keep to the names.
TEST_F(RunFramesTest, TimesOrderPhotosWithoutOrderInTheirNames) {
  const std::vector<std::string> names = {"f00d.jpg", "1dea.jpg", "c0de.jpg"};
  for (size_t i = 0; i < names.size(); ++i) {
    WritePhoto(photos_ / names[i], DrawnView(static_cast<int>(20 * i)),
               ExifOfTime("2024:05:01 12:00:00", "000" + std::to_string(i)));
  }
  WriteBytes(photos_ / "1dea.DNG", "RAW");  // not counted
  const fs::path boxes = WriteBytes(
      folder_ / "boxes.csv", "frame,label,score,x1,y1,x2,y2\n0,1dea,1,1,2,3,4\n2,f00d,1,1,2,3,4\n");
  testing::internal::CaptureStdout();
  RunFrames({}, {{"images", photos_}, {"output", output_}, {"detections", boxes}}, 2);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::HasSubstr("order of their EXIF times"));
  const json frames = ReadArtefact(output_ / "frames.json", "frames");
  EXPECT_EQ(frames.at("ordered_by"), "time");
  EXPECT_EQ(Fields(frames.at("frames"),
                   [](const json& frame) { return frame.at("source").get<std::string>(); }),
            names);
  EXPECT_THAT(FileBytes(output_ / "detections.csv"),
              testing::HasSubstr("\n0,f00d,1.0000,1.00,2.00,3.00,4.00\n1,1dea,"));
}

TEST_F(RunFramesTest, NumbersThatContradictTheTimesAreAFinding) {
  for (int i = 0; i < 6; ++i) {
    WritePhoto(photos_ / (std::to_string(i) + ".jpg"), DrawnView(20 * i),
               ExifOfTime("2024:05:01 12:00:00", "000" + std::to_string(9 - i)));
  }
  const json frames = Run(photos_);
  EXPECT_EQ(frames.at("ordered_by"), "name");
  EXPECT_EQ(Only(frames.at("findings")).at("check"), "photo_order");
}

TEST_F(RunFramesTest, MuchThatIsLeftOutIsAFinding) {
  AddViews(4);
  for (int i = 0; i < 3; ++i) WriteBytes(photos_ / (std::to_string(i) + ".jpg"), "damaged");
  const json finding = Only(Run(photos_).at("findings"));
  EXPECT_EQ(finding.at("check"), "frames_unreadable");
  EXPECT_THAT(finding.at("found").get<std::string>(), testing::HasSubstr("3 of 7 images"));
}

TEST_F(RunFramesTest, FramesOfAVideoHaveTheirTimes) {
  std::vector<cv::Mat> views;
  for (int i = 0; i < 30; ++i) views.push_back(DrawnView(10 * (i / 3)));  // each three times
  const fs::path video = folder_ / "my video.avi";
  WriteVideo(video, {{views}});
  const json frames = Run(video);
  ASSERT_EQ(frames.at("frames").size(), 10u);
  EXPECT_EQ(frames.at("left_out").size(), 20u);
  for (int i = 0; i < 10; ++i) {
    const json& frame = frames.at("frames")[i];
    const int number = frame.at("frame_number");
    EXPECT_EQ(number / 3, i);
    EXPECT_NEAR(frame.at("time_s").get<double>(), 0.1 * number, 1e-6);
    const cv::Mat image =
        ReadImage(output_ / frame.at("image").get<std::string>(), cv::IMREAD_COLOR);
    EXPECT_LT(cv::norm(image, DrawnView(10 * i), cv::NORM_L1) / (3 * 320 * 240), 12.0);
  }
}

TEST_F(RunFramesTest, FramesOfAVideoHaveTheSizeThatMostHave) {
  std::vector<cv::Mat> views = {DrawnView(0, {160, 120}), DrawnView(10, {160, 120})};
  for (int i = 0; i < 4; ++i) views.push_back(DrawnView(20 * i));
  const fs::path video = folder_ / "call.avi";
  WriteVideo(video, {{views}});
  const json frames = Run(video);
  EXPECT_EQ(frames.at("width"), 320);
  EXPECT_EQ(frames.at("frames").size(), 4u);
  ASSERT_EQ(frames.at("left_out").size(), 2u);
  EXPECT_EQ(frames.at("left_out")[0].at("reason"), "other_size");
  EXPECT_EQ(frames.at("left_out")[0].at("detail"), "160 x 120 px, not 320 x 240");
}

TEST_F(RunFramesTest, AVideoWithAFaultIsAFinding) {
  std::vector<cv::Mat> views;
  for (int i = 0; i < 8; ++i) views.push_back(DrawnView(20 * i));
  const fs::path video = folder_ / "video.mov";
  WriteVideo(video, {{views}});
  EXPECT_FALSE(Run(video).contains("findings"));
  const std::string whole = FileBytes(video);
  WriteBytes(video, whole.substr(0, whole.size() - 10));
  EXPECT_EQ(Only(Run(video).at("findings")).at("check"), "video_cut_short");
  std::string damaged = whole;
  const size_t jpeg = damaged.find("\xff\xd8", damaged.size() / 2);
  WriteBytes(video, damaged.replace(jpeg, 700, 700, '\0'));
  EXPECT_EQ(Only(Run(video).at("findings")).at("check"), "video_damaged");
  WriteVideo(folder_ / "old.mkv", {{views, {}, {1, 1}, "90"}});
  EXPECT_EQ(Only(Run(folder_ / "old.mkv").at("findings")).at("check"), "video_rotation");
  WriteBytes(video, whole.substr(0, whole.find("mdat") + 100));
  ExpectError<InputError>([&] { Run(video); }, {video.string(), "no frame", "cut short"});
}

TEST_F(RunFramesTest, SameBytesForAnyNumberOfThreads) {
  AddViews(5);
  ExpectSameBytesForThreads([&](int threads) { Run(photos_, {.max_image_px = 200}, threads); },
                            {output_ / "frames.json", output_ / "rgb/view_3.jpg"});
}

TEST_F(RunFramesTest, ADatasetIsReplacedUnlessItHasFilesOfOthers) {
  AddViews(3);
  Run(photos_);
  fs::remove(photos_ / "view 0.jpg");
  EXPECT_EQ(Run(photos_).at("frames").size(), 2u);
  EXPECT_FALSE(fs::exists(output_ / "rgb/view_0.jpg"));
  for (const char* name : {"detections.csv", "rgb/mine.jpg"}) {
    WriteBytes(output_ / name, "by hand");
    ExpectError<SettingsError>([&] { Run(photos_); }, {output_.string(), name, "lost"});
    EXPECT_EQ(FileBytes(output_ / name), "by hand");
    fs::remove(output_ / name);
  }
  EXPECT_NO_THROW(Run(photos_));
}

TEST_F(RunFramesTest, ImagesHavePlainNamesOfTheirOwn) {
  const std::vector<std::string> names = {"-1 $x.jpg", "-1_$x.jpg", "Küche's \"2\".jpeg", "b.JPG"};
  for (size_t i = 0; i < names.size(); ++i) {
    WritePhoto(photos_ / names[i], DrawnView(static_cast<int>(20 * i)));
  }
  const auto image_of = [](const json& frame) { return frame.at("image").get<std::string>(); };
  EXPECT_THAT(Fields(Run(photos_).at("frames"), image_of),
              testing::ElementsAre("rgb/_1__x.jpg", "rgb/_1__x_2.jpg", "rgb/K__che_s__2_.jpeg",
                                   "rgb/b.jpg"));
}

TEST_F(RunFramesTest, BoxesOfAllImagesBecomeThoseOfTheChosenOnes) {
  AddViews(3);
  WritePhoto(photos_ / "view 1.jpg", DrawnView(0));  // the same as view 0
  const fs::path boxes = folder_ / "boxes.csv";
  WriteBytes(boxes,
             "frame,label,score,x1,y1,x2,y2\n2,cup,0.9,-0.5,19.5,99.5,119.5\n1,cup,0.8,1,2,3,4\n"
             "0,tv,1,9.5,9.5,19.5,29.5\n7,tv,1,1,2,3,4\n");
  const FrameOptions options = {.max_image_px = 160};  // half the size
  const StageFiles files = {{"images", photos_}, {"output", output_}, {"detections", boxes}};
  for (int run = 0; run < 2; ++run) {  // its own boxes may be replaced
    RunFrames(options, files, 1);
    EXPECT_EQ(FileBytes(output_ / "detections.csv"),
              "# Written by soslam-frames from boxes.csv\nframe,label,score,x1,y1,x2,y2\n"
              "0,tv,1.0000,4.50,4.50,9.50,14.50\n1,cup,0.9000,-0.50,9.50,49.50,59.50\n");
  }
  WriteBytes(boxes, "frame,label,score,x1,y1,x2,y2\n9,cup,0.9,0,20,100,120\n");
  ExpectError<InputError>([&] { RunFrames(options, files, 1); },
                          {boxes.string(), "none of its 1 boxes"});
  // The header of soslam-detect, of the two images that were chosen.
  WriteBytes(boxes,
             "# {}\n# input {}\n# input {}\nframe,label,score,x1,y1,x2,y2\n1,cup,1,1,2,3,4\n");
  ExpectError<InputError>([&] { RunFrames(options, files, 1); },
                          {boxes.string(), "is of 2 images", "all 3 photos"});
}

TEST_F(RunFramesTest, RefusesWhatMakesNoDataset) {
  WritePhoto(photos_ / "1.jpg", DrawnView(0));
  ExpectError<InputError>([&] { Run(photos_); }, {photos_.string(), "has 1 image(s)"});
  WritePhoto(photos_ / "2.jpg", DrawnView(0));
  ExpectError<NothingUsableError>([&] { Run(photos_); },
                                  {photos_.string(), "1 of 2 images", "1 repeating another one"});
  WritePhoto(photos_ / "2.jpg", DrawnView(0), ExifOf(1));
  ExpectError<NothingUsableError>([&] { Run(photos_); },
                                  {photos_.string(), "1 of 2 images", "1 no motion"});
  ExpectError<InputError>([&] { Run(photos_ / "1.jpg"); },
                          {"1.jpg: is one image; expected a folder of several"});
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "nothing is left";
}

}  // namespace
}  // namespace soslam
