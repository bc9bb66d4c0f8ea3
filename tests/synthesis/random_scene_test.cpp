// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "synthesis/simulate.h"

namespace soslam {
namespace {

struct Size {
  int objects;
  int frames;
};

class RandomSceneTest : public testing::TestWithParam<Size> {};

INSTANTIATE_TEST_SUITE_P(Sizes, RandomSceneTest,
                         testing::Values(Size{1, 1}, Size{3, 5}, Size{8, 30}, Size{40, 200},
                                         Size{100, 200}),
                         [](const auto& info) {
                           return std::to_string(info.param.objects) + "in" +
                                  std::to_string(info.param.frames);
                         });

TEST_P(RandomSceneTest, ShowsEveryObjectInSeveralFrames) {
  const auto [objects, frames] = GetParam();
  for (int seed = 0; seed < 5; ++seed) {
    const Sequence sequence = SyntheticSequence(RandomScene(seed, objects, frames), false);
    ASSERT_EQ(sequence.frames.size(), static_cast<size_t>(frames));
    ASSERT_EQ(sequence.objects.size(), static_cast<size_t>(objects));
    std::set<std::string> labels;
    for (const Object& object : sequence.objects) labels.insert(object.label);
    EXPECT_EQ(labels.size(), sequence.objects.size());
    for (const std::vector<int>& detections : DetectionsByObject(sequence)) {
      EXPECT_GE(detections.size(), static_cast<size_t>(std::min(3, frames)));
    }
  }
}

TEST(RandomScene, ObjectsStandApart) {
  const Scene scene = RandomScene(4, 20, 60);
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      const SceneObject &first = scene.objects[i], &second = scene.objects[j];
      EXPECT_GT((first.position_on_plane - second.position_on_plane).norm(),
                first.half_axes.head<2>().norm() + second.half_axes.head<2>().norm());
    }
  }
}

TEST(RandomScene, SeedDecides) {
  const Scene first = RandomScene(1, 4, 20), again = RandomScene(1, 4, 20),
              other = RandomScene(2, 4, 20);
  EXPECT_EQ(first.objects[3].half_axes, again.objects[3].half_axes);
  EXPECT_EQ(first.objects[3].position_on_plane, again.objects[3].position_on_plane);
  EXPECT_NE(first.objects[3].half_axes, other.objects[3].half_axes);
}

TEST(RandomScene, DrawsShapesFromTheGivenOnes) {
  std::set<Shape> shapes;
  for (const SceneObject& object : RandomScene(1, 20, 60).objects) shapes.insert(object.shape);
  EXPECT_EQ(shapes, std::set<Shape>{Shape::kEllipsoid});
  shapes.clear();
  for (const SceneObject& object :
       RandomScene(1, 20, 60, {Shape::kBox, Shape::kCylinder}).objects) {
    shapes.insert(object.shape);
  }
  EXPECT_EQ(shapes, (std::set<Shape>{Shape::kBox, Shape::kCylinder}));
}

TEST(RandomScene, RefusesWhatCannotBe) {
  EXPECT_THROW(RandomScene(0, 0, 10), SettingsError);
  EXPECT_THROW(RandomScene(0, 3, 0), SettingsError);
  EXPECT_THROW(RandomScene(0, 3, 10, {}), SettingsError);
  EXPECT_THROW(RandomScene(0, 60, 1), SettingsError) << "one image has no room for 60 objects";
}

}  // namespace
}  // namespace soslam
