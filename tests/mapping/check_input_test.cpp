// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/check_input.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "soslam/mapping/initial_landmarks.h"
#include "support/cuboid_map.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Fault {
  std::vector<std::string> expected;  // parts of the message
  std::function<void(Sequence* sequence, BackEndInput* input)> make;
};

TEST(CheckBackEndInput, NamesWhatIsWrong) {
  const Fault faults[] = {
      {{"priors", "0", "3, one per object"}, [](auto*, auto* input) { input->priors.clear(); }},
      {{"initial_landmarks", "2"}, [](auto*, auto* input) { input->initial_landmarks.pop_back(); }},
      {{"detection 1", "frame_index is 99"},
       [](auto* sequence, auto*) { sequence->detections[1].frame_index = 99; }},
      {{"detection 0", "object_index is -1"},
       [](auto* sequence, auto*) { sequence->detections[0].object_index = -1; }},
      {{"detection 2", "not finite"},
       [](auto* sequence, auto*) { sequence->detections[2].box.x_max = kNan; }},
      {{"object 0", "plane_index", "support has to be false"},
       [](auto* sequence, auto*) { sequence->objects[0].plane_index = kNoPlane; }},
      {{"plane 0", "norm"},
       [](auto* sequence, auto*) { sequence->planes[0].plane_in_world.normal *= 2.0; }},
      {{"frame 3", "norm 2"},
       [](auto* sequence, auto*) {
         sequence->frames[3].world_from_camera.rotation.coeffs() *= 2.0;
       }},
      {{"frame 0", "focal length"}, [](auto* sequence, auto*) { sequence->camera.fx = kNan; }},
      {{"object 1", "log_sigma"},
       [](auto*, auto* input) { input->priors[1]->log_sigma.x() = 0.0; }},
      {{"object 2", "exponent is 0.1"},
       [](auto*, auto* input) { input->priors[2]->shape_exponents = 0.1; }},
      {{"object 1", "half axis"},
       [](auto*, auto* input) { input->initial_landmarks[1]->half_axes.z() = -1.0; }},
      {{"images", "detection is 500"},
       [](auto*, auto* input) { input->images.emplace_back(500, nullptr); }},
      {{"images", "detection 1 is null"},
       [](auto*, auto* input) { input->images.emplace_back(1, nullptr); }}};
  const Sequence good = CuboidSequence(3, 4);
  const OptimiseOptions options = TangencyOptions();
  EXPECT_NO_THROW(CheckBackEndInput(TruthInput(good), options));
  for (const Fault& fault : faults) {
    Sequence sequence = good;
    BackEndInput input = TruthInput(sequence);
    fault.make(&sequence, &input);
    ExpectError<InputError>([&] { OptimiseMap(input, options); }, fault.expected);
  }
}

TEST(CheckBackEndInput, LandmarksThatAreSoughtNeedNotBeGiven) {
  const Sequence sequence = CuboidSequence(2, 6);
  BackEndInput input = TruthInput(sequence);
  input.initial_landmarks.clear();
  EXPECT_TRUE(ChooseInitialUprightLandmarks(input, {}, TangencyOptions(), 1).front());
  input.priors.pop_back();
  EXPECT_THROW(ChooseInitialUprightLandmarks(input, {}, TangencyOptions(), 1), InputError);
}

TEST(CheckBackEndInput, ObjectsNeedNoPlaneWithoutSupport) {
  Sequence sequence = CuboidSequence(2, 6);
  const BackEndInput input = TruthInput(sequence);
  sequence.planes.clear();
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  OptimiseOptions options = TangencyOptions();
  options.support = false;
  const auto landmark = OptimiseMap(input, options).objects.front().landmark_in_world;
  ASSERT_TRUE(landmark);
  // Pictures tell yaws about the normal of a plane: here they tell nothing.
  BoxAppearance seen_from_the_front;
  for (int bin = 0; bin < kAzimuthBins; ++bin) {
    seen_from_the_front.azimuth_costs[bin] = static_cast<float>(100 * bin);
  }
  for (Detection& detection : sequence.detections) {
    detection.appearance = std::make_shared<const BoxAppearance>(seen_from_the_front);
  }
  const auto with_pictures = OptimiseMap(input, options).objects.front().landmark_in_world;
  ASSERT_TRUE(with_pictures);
  EXPECT_EQ(with_pictures->frame_from_object.Matrix(), landmark->frame_from_object.Matrix());
}

}  // namespace
}  // namespace soslam
