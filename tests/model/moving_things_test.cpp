// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/moving_things.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

// Three frames with a person, also where its box is not used, beside other boxes.
class MovingThingsTest : public testing::Test {
 protected:
  MovingThingsTest() {
    sequence_.camera = {100, 100, 80.0, 80.0, 49.5, 49.5};
    for (const int id : {0, 5, 10}) sequence_.frames.push_back({id, 0.1 * id, "", {}, {}});
    sequence_.objects = {{1, "Person", kNoPlane, {}}, {2, "chair", kNoPlane, {}}};
    sequence_.detections = {
        {0, 0, 0.9, person_, {}}, {0, 1, 0.9, chair_, {}}, {1, 1, 0.9, chair_, {}}};
    sequence_.rejected = {{1, "person", 0.3, person_, {}, {}, "near_border"},
                          {2, "person", 0.2, person_, {}, {}, "low_score"}};
  }

  Box person_ = {10.0, 20.0, 30.0, 90.0};
  Box chair_ = {60.0, 60.0, 90.0, 90.0};
  Sequence sequence_;
};

TEST_F(MovingThingsTest, AllBoxesOfTheirLabelsCountButThoseOfLowScores) {
  EXPECT_THAT(BoxesOfMovingThings(sequence_),
              ElementsAre(ElementsAre(person_), ElementsAre(person_), IsEmpty()));
  sequence_.moving_labels = "chair";
  EXPECT_THAT(BoxesOfMovingThings(sequence_),
              ElementsAre(ElementsAre(chair_), ElementsAre(chair_), IsEmpty()));
  sequence_.moving_labels = "";
  EXPECT_THAT(BoxesOfMovingThings(sequence_), ElementsAre(IsEmpty(), IsEmpty(), IsEmpty()));
}

TEST_F(MovingThingsTest, PointsMostlySeenInTheirBoxesAreLeftOut) {
  const auto seen_at = [](const std::vector<Eigen::Vector2d>& pixels) {
    MapPoint point;
    for (size_t i = 0; i < pixels.size(); ++i) {
      point.observations.push_back({static_cast<int>(5 * i), pixels[i]});
    }
    return point;
  };
  const Eigen::Vector2d in(20.0, 50.0), out(40.0, 50.0);
  const std::vector<MapPoint> points = {
      seen_at({in, in, in}),  // the third box is no evidence of a person
      seen_at({in, out}), seen_at({in, out, out}), seen_at({out, out, out}), seen_at({})};
  const std::vector<MapPoint> kept = WithoutMovingThings(sequence_, points);
  ASSERT_THAT(kept, SizeIs(3));
  EXPECT_EQ(kept[0].observations[1].pixel, out);
  EXPECT_EQ(kept[1].observations[0].pixel, out);
}

TEST_F(MovingThingsTest, TheyAreCounted) {
  const auto found = [&] { return CheckMovingThings(sequence_).at(0).found; };
  EXPECT_THAT(found(), HasSubstr("a box of Person in 1 image, a box of person in 1 image: "));
  EXPECT_THAT(found(), Not(HasSubstr("more than half")));
  // Together they cover 52 % of the image.
  sequence_.detections[0].box = {-0.5, -0.5, 29.5, 99.5};
  sequence_.rejected[0] = {0, "dog", 0.9, {19.5, -0.5, 51.5, 99.5}, {}, {}, ""};
  EXPECT_THAT(found(), HasSubstr("they cover more than half of 1 image"));
  sequence_.rejected[0].box.x_max = 48.5;
  EXPECT_THAT(found(), Not(HasSubstr("more than half")));
  sequence_.moving_labels = "cat";
  EXPECT_THAT(CheckMovingThings(sequence_), IsEmpty());
}

}  // namespace
}  // namespace soslam
