// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "soslam/artefact/files.h"
#include "soslam/report/page_parts.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/scene.h"

namespace soslam {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr int kBoxes = 6;

size_t CountOf(const std::string& words, const std::string& text) {
  size_t count = 0;
  for (size_t at = text.find(words); at != text.npos; at = text.find(words, at + 1)) ++count;
  return count;
}

// An object with six boxes, of which one was not explained, with a duplicate of the first, beside a
// track that was left out.
class BoxesSectionTest : public FolderTest {
 protected:
  BoxesSectionTest() {
    for (size_t i = 0; i < sequence_.frames.size(); ++i) {
      sequence_.frames[i].image = "rgb/<" + std::to_string(i) + ">.png";
    }
    sequence_.objects[0].label = "<cup>";
    associations_.tracks = {{.fate = TrackFate::kObject, .boxes = kBoxes, .detections = 5},
                            {.track = 1, .fate = TrackFate::kMoves, .boxes = 1, .detections = 1}};
    associations_.objects = {{sequence_.objects[0].id, 0, "cup", {}, 5}};
    for (int i = 0; i < kBoxes; ++i) Add(i, 10 + i, BoxFate::kExplained, 0);
    associations_.detections[3].fate = BoxFate::kUnexplained;
    Add(0, 30, BoxFate::kDuplicate, {});
    associations_.detections.back().duplicate_of = associations_.detections.front().name;
    Add(1, 40, BoxFate::kAlone, 1);
  }
  void Add(int frame, int given_object, BoxFate fate, std::optional<int> track) {
    const Associations::DetectionName name = {
        sequence_.frames[frame].id, given_object, {10.4 + frame, 20.0, 60.6 + frame, 70.5}};
    associations_.detections.push_back(
        {.name = name, .label = "cup", .fate = fate, .track = track});
  }
  std::string Html(const ImageSource& images, size_t max_bytes = 1'000'000) const {
    WriteAssociations(folder_ / "associations.json", associations_, {});
    return BoxesSection(folder_.path(), sequence_, images, max_bytes, 2);
  }

  Sequence sequence_ = CuboidSequence(2, 8);
  Associations associations_;
  const ImageSource images_ = {[](int) { return true; },
                               [this](int frame) {
                                 const Camera& camera = sequence_.CameraOf(sequence_.frames[frame]);
                                 return cv::Mat(camera.height, camera.width, CV_8UC3,
                                                cv::Scalar(9, 90, 200));
                               }};
  const ImageSource no_images_ = {[](int) { return false; }, {}};
};

TEST_F(BoxesSectionTest, ShowsAllBoxesOfAnObject) {
  const std::string html = Html(images_);
  EXPECT_EQ(CountOf("<h3>", html), 1u);
  EXPECT_THAT(html,
              HasSubstr("<h3>&lt;cup&gt; " + std::to_string(sequence_.objects[0].id) + "</h3>"));
  EXPECT_THAT(html, HasSubstr("7 boxes, 2 not used. "));
  EXPECT_EQ(CountOf("<image ", html), 7u);
  EXPECT_EQ(CountOf("<polygon class=\"detection\"", html), 7u);
  EXPECT_EQ(CountOf("<figure class=\"unused\">", html), 2u);
  EXPECT_EQ(CountOf("<strong>unexplained</strong> 3: &lt;3&gt;.png</summary>", html), 1u);
  EXPECT_EQ(CountOf("<strong>duplicate</strong> 0: &lt;0&gt;.png</summary>", html), 1u);
  EXPECT_THAT(html, HasSubstr("<code>{&quot;image&quot;: &quot;rgb/&lt;2&gt;.png&quot;, "
                              "&quot;box&quot;: [12.4, 20.0, 62.6, 70.5]}</code>"));
}

TEST_F(BoxesSectionTest, WithoutImagesBoxesAreInEmptyFrames) {
  sequence_.frames[2].image.clear();
  const std::string html = Html(no_images_);
  EXPECT_EQ(CountOf("<image ", html), 0u);
  EXPECT_EQ(CountOf("<polygon class=\"detection\"", html), 7u);
  const Camera& camera = sequence_.camera;
  EXPECT_THAT(html, HasSubstr("viewBox=\"0 0 " + std::to_string(camera.width) + " " +
                              std::to_string(camera.height) + "\""));
  EXPECT_THAT(html, HasSubstr("<summary>2</summary><code>It has no image.</code>"));
}

TEST_F(BoxesSectionTest, ShowsFewerWhereThereIsLessRoom) {
  const size_t all = Html(images_).size();
  const std::string fewer = Html(images_, all - 1);
  EXPECT_LT(fewer.size(), all);
  EXPECT_EQ(CountOf("<image ", fewer), 6u);
  EXPECT_THAT(fewer, HasSubstr("7 boxes, 2 not used; 6 of them are shown. "));
  EXPECT_EQ(Html(images_, 500), "");
}

TEST_F(BoxesSectionTest, LongTracksAreShownInPart) {
  for (int i = 0; i < 40; ++i) Add(6, 100 + i, BoxFate::kSecond, 0);
  const std::string html = Html(images_);
  EXPECT_THAT(html, HasSubstr("47 boxes, 42 not used; 24 of them are shown. "));
  EXPECT_EQ(CountOf("<image ", html), 24u);
}

TEST_F(BoxesSectionTest, SaysWhatHoldsAnObject) {
  const int object = sequence_.objects[0].id;
  const auto& rows = associations_.detections;
  associations_.held_least = {{object, rows[1].name, rows[3].name, {0, 31, -0.5, 4.0, 1.0}}};
  associations_.kept_out = {{object, 1, 1, 1, rows.back().name, {12, 40, 0.7, -0.2, -3.0, 1.0}}};
  const std::string frames =
      std::to_string(rows[1].name.frame) + " and " + std::to_string(rows[3].name.frame);
  const std::string html = Html(images_);
  EXPECT_EQ(CountOf("<image ", html), 8u);
  EXPECT_EQ(CountOf("<strong>kept out</strong> 1: &lt;1&gt;.png", html), 1u);
  EXPECT_THAT(html, HasSubstr("7 boxes, 2 not used. "));
  EXPECT_THAT(
      html,
      HasSubstr(
          "Held least by 0 of 31 points of frames " + frames +
          ". Kept out, the nearest: cup, left out with 1 box, by log odds of -1.5 "
          "(12 of 40 points: 0.7; colours -0.2, body -3.0, labels 1.0); 1 frame with both.</p>"));
}

TEST_F(BoxesSectionTest, GivenIdsHaveNone) {
  EXPECT_EQ(BoxesSection(folder_.path(), sequence_, images_, 1'000'000, 1), "");
}

TEST_F(BoxesSectionTest, FramesOfAnotherSequenceAreRefused) {
  associations_.detections[2].name.frame = 777;
  ExpectError<InputError>([&] { Html(images_); }, {"associations.json", "frame 777"});
}

}  // namespace
}  // namespace soslam
