// SPDX-License-Identifier: BSD-3-Clause
#include "support/degenerate_scenes.h"

#include <gtest/gtest.h>

#include "association/association.h"
#include "base/error.h"
#include "initialisation/initialise.h"
#include "mapping/back_end.h"
#include "mapping/initial_landmarks.h"
#include "planes/estimate_planes.h"
#include "planes/up_prior.h"
#include "support/association_scenes.h"
#include "support/scene.h"

namespace soslam {
namespace {

constexpr int kObjects = 3;
constexpr int kFrames = 8;

// What is defined is finite; what is not has a name.
void ExpectDefined(const Landmark& landmark) {
  const Rigid3d& pose = landmark.frame_from_object;
  EXPECT_TRUE(pose.translation.allFinite() && pose.rotation.coeffs().allFinite());
  EXPECT_NEAR(pose.rotation.norm(), 1.0, 1e-6);
  EXPECT_TRUE(landmark.half_axes.allFinite() && (landmark.half_axes.array() > 0.0).all())
      << landmark.half_axes.transpose();
}

void ExpectDefined(const LandmarkEstimates& estimates) {
  for (const ObservationEstimate& observation : estimates.observations) {
    EXPECT_EQ(observation.hypotheses.empty(), !observation.failure.empty());
    for (const Hypothesis& hypothesis : observation.hypotheses) {
      ExpectDefined(hypothesis.landmark_in_camera);
      EXPECT_TRUE(std::isfinite(hypothesis.cost));
    }
  }
  for (const ObjectEstimate& object : estimates.objects) {
    EXPECT_EQ(!object.landmark_in_world, !object.failure.empty());
    if (object.landmark_in_world) ExpectDefined(*object.landmark_in_world);
  }
}

void ExpectDefined(const MapEstimate& map, int max_iterations) {
  ExpectDefined(LandmarkEstimates{{}, map.objects});
  for (const ObjectEstimate& object : map.objects) {
    if (object.covariance) {
      EXPECT_TRUE(object.covariance->allFinite());
    }
  }
  for (const Rigid3d& pose : map.world_from_camera) {
    EXPECT_TRUE(pose.translation.allFinite() && pose.rotation.coeffs().allFinite());
  }
  for (const Plane& plane : map.planes_in_world) {
    EXPECT_TRUE(plane.normal.allFinite() && std::isfinite(plane.offset));
  }
  for (const auto& [plane, covariance] : map.plane_covariances) {
    EXPECT_TRUE(covariance.allFinite());
  }
  EXPECT_TRUE(std::isfinite(map.solver.final_cost));
  EXPECT_LE(map.solver.iterations, max_iterations);
}

class DegenerateTest : public testing::TestWithParam<Degeneracy> {
 protected:
  static Sequence Make(int seed) {
    Sequence sequence = SyntheticSequence(
        RandomScene(seed, kObjects, kFrames, {Shape::kBox, Shape::kEllipsoid}), /*noise=*/false);
    GetParam().apply(&sequence);
    return sequence;
  }

  // `work` gives an answer or refuses by name; where nothing is degenerate, an answer.
  template <typename Work>
  static void ExpectAnswerOrRefusal(const Work& work, int scenes = 3) {
    for (int seed = 0; seed < scenes; ++seed) {
      SCOPED_TRACE(seed);
      const Sequence sequence = Make(seed);
      try {
        work(sequence, TrueCuboidPriors(sequence, 0.1));
      } catch (const NothingUsableError& error) {
        EXPECT_STRNE(GetParam().name, kNoDegeneracy) << error.what();
      } catch (const NumericalError& error) {
        EXPECT_STRNE(GetParam().name, kNoDegeneracy) << error.what();
      }
    }
  }
};

using Priors = std::vector<std::optional<ShapePrior>>;

TEST_P(DegenerateTest, SingleFrameEllipsoids) {
  ExpectAnswerOrRefusal([](const Sequence& sequence, const Priors& priors) {
    std::vector<std::optional<Eigen::Vector2d>> ratios;
    for (const auto& prior : priors) ratios.emplace_back(prior->ratio);
    ExpectDefined(InitialiseSingleFrame(sequence, ratios, {}, 1));
  });
}

TEST_P(DegenerateTest, SweepOverYaw) {
  ExpectAnswerOrRefusal([](const Sequence& sequence, const Priors& priors) {
    ExpectDefined(InitialiseUpright(sequence, priors, {}, 1));
  });
}

TEST_P(DegenerateTest, SeveralViews) {
  ExpectAnswerOrRefusal([](const Sequence& sequence, const Priors& priors) {
    ExpectDefined(InitialiseSvd(sequence));
    ExpectDefined(InitialiseMultiView(sequence, priors, {}, 1));
  });
}

TEST_P(DegenerateTest, BackEndWithEllipsoids) {
  ExpectAnswerOrRefusal([](const Sequence& sequence, const Priors& priors) {
    BackEndInput input{sequence, {}, priors, {}, {}};
    for (const Object& object : sequence.objects) {
      input.initial_landmarks.emplace_back(object.ground_truth->landmark_in_world);
    }
    const OptimiseOptions options;
    ExpectDefined(OptimiseMap(input, options), options.max_iterations);
  });
}

TEST_P(DegenerateTest, BackEndWithBodiesOfAnyShape) {
  ExpectAnswerOrRefusal([](const Sequence& sequence, const Priors& priors) {
    OptimiseOptions options;
    options.detection_model = DetectionModel::kTangency;
    BackEndInput input{sequence, {}, priors, {}, {}};
    input.initial_landmarks = ChooseInitialUprightLandmarks(
        input, InitialiseUpright(sequence, priors, UprightOptions(), 1), options, 1);
    ExpectDefined(OptimiseMap(input, options), options.max_iterations);
  });
}

TEST_P(DegenerateTest, Association) {
  ExpectAnswerOrRefusal([](const Sequence& sequence, const Priors&) {
    const auto association = Associate(sequence, UnknowingTable(), EstimatedAssociation(), 1);
    EXPECT_EQ(association.detections.size(), sequence.detections.size());
    for (const Track& track : association.tracks) {
      if (track.fit) ExpectDefined(track.fit->landmark_in_world);
    }
  });
}

TEST_P(DegenerateTest, SupportPlanes) {
  ExpectAnswerOrRefusal(
      [](const Sequence& sequence, const Priors& priors) {
        std::vector<Rigid3d> poses;
        for (const Frame& frame : sequence.frames) poses.push_back(frame.world_from_camera);
        const auto estimate =
            FindPlanes(sequence, priors, UpPriorFromCameras(poses, 0.1, 0.5, 0.3), PlanesOptions(),
                       /*threads=*/1);
        if (!estimate) ThrowNoPlanes(sequence);
        for (const EstimatedPlane& plane : estimate->planes) {
          EXPECT_TRUE(plane.plane_in_world.normal.allFinite());
          EXPECT_TRUE(std::isfinite(plane.plane_in_world.offset));
        }
      },
      /*scenes=*/1);
}

INSTANTIATE_TEST_SUITE_P(Scenes, DegenerateTest, testing::ValuesIn(Degeneracies()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace soslam
